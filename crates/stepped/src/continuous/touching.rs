//! The first touch of two bodies within a sub-step, in order of time.

use core::cmp::Ordering;

use crate::BodyIx;
use carom_math::Vec2;

/// A touch of fast body `a`, `wait` seconds on, with a piece of another body; `b`: that body if it is fast and moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touching {
    pub(super) wait: f64,
    pub(super) order: (u64, u64),
    pub(super) a: usize,
    pub(super) b: Option<usize>,
    /// Slot of the other body, fast or not.
    pub(super) other: BodyIx,
    /// How often both had touched when it was found: after a later touch they go elsewhere.
    pub(super) touches: [u8; 2],
    /// Unit normal from A to the other body; none if it is not known, or they are stopped there.
    pub(super) normal: Option<Vec2>,
    /// Velocity of A against the other body, in m/s.
    pub(super) against: Vec2,
}

impl Eq for Touching {}

impl PartialOrd for Touching {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The earliest is the greatest: it leaves a heap first.
impl Ord for Touching {
    fn cmp(&self, other: &Self) -> Ordering {
        let wait = other.wait.total_cmp(&self.wait);
        wait.then(other.order.cmp(&self.order))
    }
}
