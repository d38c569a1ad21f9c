//! Which analytic island a body is in, and when none was found last.

use carom_math::SimTime;

use crate::{IslandIx, Ix};

/// Membership of a body in groups.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Membership {
    /// Place of the group, or [`Ix::NONE`].
    pub(crate) group: IslandIx,
    /// When a mode solve failed last, unless something happened since.
    failed: SimTime,
}

impl Default for Membership {
    fn default() -> Self {
        Self {
            group: IslandIx::NONE,
            failed: SimTime::NEVER,
        }
    }
}

impl Membership {
    pub(crate) fn is_closed(self) -> bool {
        self.group != IslandIx::NONE
    }

    /// A member of the group at `place`.
    pub(crate) fn of(place: IslandIx) -> Self {
        Self {
            group: place,
            ..Self::default()
        }
    }

    /// A mode solve failed: none is made again at this instant.
    pub(crate) fn fail(&mut self, time: SimTime) {
        self.failed = time;
    }

    /// Something happened: failed mode solves of before are void.
    pub(crate) fn forget(&mut self) {
        self.failed = SimTime::NEVER;
    }

    /// Whether a mode solve failed at this instant.
    pub(crate) fn has_failed(self, time: SimTime) -> bool {
        self.failed == time
    }
}
