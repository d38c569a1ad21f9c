//! The first touch of two bodies within a sub-step, in order of time.

use core::cmp::Ordering;

/// A touch of way `a`, `wait` seconds on, with a piece of another body; `b`: that body's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meeting {
    pub(super) wait: f64,
    pub(super) order: (u64, u64),
    pub(super) a: usize,
    pub(super) b: Option<usize>,
}

impl Eq for Meeting {}

impl PartialOrd for Meeting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The earliest is the greatest: it leaves a heap first.
impl Ord for Meeting {
    fn cmp(&self, other: &Self) -> Ordering {
        let wait = other.wait.total_cmp(&self.wait);
        wait.then(other.order.cmp(&self.order))
    }
}
