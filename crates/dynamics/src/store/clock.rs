//! The grid of sub-steps: whole divisions of a tick, whatever `dt` the caller asks for.

use carom_math::SimTime;

/// Where the world is on the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// Length of a sub-step, in s.
    pub(crate) h: f64,
    /// Sub-steps begun.
    begun: u64,
    /// What the caller sees.
    pub(crate) now: SimTime,
}

impl Clock {
    pub(crate) const fn new(h: f64) -> Self {
        Self {
            h,
            begun: 0,
            now: SimTime::ZERO,
        }
    }

    /// Where the present sub-step ends and the next begins. Before the first: the start of time.
    pub(crate) fn next(&self) -> SimTime {
        SimTime::multiple(self.begun, self.h)
    }

    /// Where the present sub-step began.
    pub(crate) fn last(&self) -> SimTime {
        SimTime::multiple(self.begun.saturating_sub(1), self.h)
    }

    /// Whether a sub-step must begin for the world to be known up to `end`.
    ///
    /// A look at the grid's own instants sees the end of one sub-step, not the start of the next,
    /// even where sums of `dt` round past it.
    pub(crate) fn is_due(&self, end: SimTime) -> bool {
        end - self.next() > 1e-9 * self.h
    }

    /// Whether the present sub-step goes on after `time`.
    pub(crate) fn is_within(&self, time: SimTime) -> bool {
        self.next() - time > 1e-9 * self.h
    }

    /// Moves on to the first instant of the grid at or after `time`.
    pub(crate) fn catch_up(&mut self, time: SimTime) {
        let near = whole(time, self.h);
        self.begun = self.begun.max(near.saturating_sub(2));
        while self.next() < time {
            self.begun += 1;
        }
    }

    /// Which sub-step of its tick begins next, of so many.
    pub(crate) fn phase(&self, substeps: u32) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "less than the sub-steps of a tick"
        )]
        let phase = (self.begun % u64::from(substeps)) as u32;
        phase
    }

    /// In which tick the next sub-step lies, of so many sub-steps each.
    pub(crate) fn tick(&self, substeps: u32) -> u64 {
        self.begun / u64::from(substeps)
    }

    pub(crate) fn begin(&mut self) {
        self.begun += 1;
    }
}

/// How many whole spans of so many seconds there are until an instant.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates; time is not negative"
)]
pub(crate) fn whole(time: SimTime, span: f64) -> u64 {
    (time.as_secs() / span) as u64
}
