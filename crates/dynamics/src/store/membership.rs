//! Which analytic island a body is in, and until when none is looked for.

use carom_math::SimTime;

/// Sub-steps that a body waits after a mode solve that failed: doubled each time, up to this.
const LONGEST_WAIT: u32 = 256;

/// No group.
const NO_GROUP: u32 = u32::MAX;

/// Membership of a body in groups.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Membership {
    /// Place of the group, or [`NO_GROUP`].
    pub(crate) group: u32,
    /// Its modes are not solved for again before this instant, while nothing happens to it.
    not_before: SimTime,
    /// Sub-steps that it waited the last time.
    waited: u32,
}

impl Default for Membership {
    fn default() -> Self {
        Self {
            group: NO_GROUP,
            not_before: SimTime::ZERO,
            waited: 0,
        }
    }
}

impl Membership {
    pub(crate) const fn is_closed(self) -> bool {
        self.group != NO_GROUP
    }

    /// A member of the group at `place`.
    pub(crate) fn of(place: u32) -> Self {
        Self {
            group: place,
            ..Self::default()
        }
    }

    /// A mode solve failed: the next one is later, and later each time, in sub-steps of `h` seconds.
    pub(crate) fn wait(&mut self, time: SimTime, h: f64) {
        self.waited = (2 * self.waited + 1).min(LONGEST_WAIT);
        self.not_before = time + h * (f64::from(self.waited) - 0.5);
    }

    /// Something happened: failed mode solves of before are void.
    pub(crate) fn forget(&mut self) {
        (self.not_before, self.waited) = (SimTime::ZERO, 0);
    }

    /// A neighbour's failed mode solve counts for all.
    pub(crate) fn wait_until(&mut self, until: SimTime) {
        self.not_before = until;
    }

    /// Until when a failed mode solve counts, if it still does at `time`.
    pub(crate) fn waits(self, time: SimTime) -> Option<SimTime> {
        Some(self.not_before).filter(|until| *until > time)
    }
}
