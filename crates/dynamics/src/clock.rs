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

    /// Whether a sub-step must begin for the world to be known up to `end`.
    ///
    /// A look at the grid's own instants sees the end of one sub-step, not the start of the next,
    /// even where sums of `dt` round past it.
    pub(crate) fn is_due(&self, end: SimTime) -> bool {
        end - self.next() > 1e-9 * self.h
    }

    pub(crate) fn begin(&mut self) {
        self.begun += 1;
    }
}
