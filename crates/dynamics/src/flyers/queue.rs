//! What is ahead of flyers, in order of time.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use carom_math::SimTime;

/// What happens at an entry's time, if the bodies still move as they did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Ahead {
    /// The search for flyers that `a` meets reaches no further.
    Horizon,
    /// The search for what does not fly reaches no further.
    Ground,
    /// From now on flyers `a` and `b` are near enough to meet.
    Near,
    /// From now on flyer `a` is near enough to meet shape `b` of a body that does not fly.
    NearShape,
    /// The impacts of bodies `a` and `b`, ever faster, end here.
    Collapse,
    /// Body `a` strikes body `b`, as slot says.
    Impact { slot: u32 },
}

/// An entry of the queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub(crate) time: SimTime,
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// Sum of the two bodies' versions: versions only grow, so that it is equal only if both are.
    pub(crate) stamp: u32,
    pub(crate) ahead: Ahead,
}

impl Ord for Entry {
    /// Equal times are taken in order of bodies, never of insertion.
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |entry: &Self| (entry.time, entry.a, entry.b, entry.ahead, entry.stamp);
        key(self).cmp(&key(other))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The entries. Stale ones are not searched for: they are dropped when they come up.
#[derive(Clone, Debug, Default)]
pub(crate) struct Queue {
    heap: BinaryHeap<Reverse<Entry>>,
}

impl Queue {
    pub(crate) fn push(&mut self, entry: Entry) {
        self.heap.push(Reverse(entry));
    }

    /// When the next entry is due.
    pub(crate) fn next(&mut self) -> Option<SimTime> {
        self.heap.peek().map(|Reverse(entry)| entry.time)
    }

    pub(crate) fn pop(&mut self) -> Option<Entry> {
        self.heap.pop().map(|Reverse(entry)| entry)
    }

    /// Keeps only what `keep` says.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(&Entry) -> bool) {
        self.heap.retain(|Reverse(entry)| keep(entry));
    }
}
