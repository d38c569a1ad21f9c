//! The event queue of the sub-steps: predicted impacts in order of (time, pair).

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use crate::store::bodies::Bodies;
use crate::store::pairs::Pair;

/// An impact that takes place unless one of the two motions changes before.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) time: SimTime,
    /// Colliders of the pair: equal times are taken in this order, never in order of insertion.
    pub(crate) key: (u32, u32),
    /// Its place, which may be another pair's by then.
    pub(crate) pair: u32,
    /// Versions of the two bodies that it was predicted with.
    pub(crate) versions: (u32, u32),
    /// Unit normal from A to B.
    pub(crate) normal: Vec2,
    /// One point, or both ends of a common stretch, in m.
    pub(crate) points: ArrayVec<Vec2, 2>,
}

impl Entry {
    /// An impact of the pair at a place, by the motions that its bodies have now.
    pub(crate) fn of(
        bodies: &Bodies,
        (place, pair): (u32, &Pair),
        time: SimTime,
        normal: Vec2,
        points: ArrayVec<Vec2, 2>,
    ) -> Self {
        let (a, b) = pair.bodies;
        Self {
            time,
            key: pair.colliders,
            pair: place,
            versions: (bodies.version(a), bodies.version(b)),
            normal,
            points,
        }
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.time, self.key, self.versions).cmp(&(other.time, other.key, other.versions))
    }
}

/// Predicted impacts in order. Stale ones are not searched for: they are dropped when they come up.
#[derive(Clone, Debug, Default)]
pub(crate) struct EventQueue {
    heap: BinaryHeap<Reverse<Entry>>,
}

impl EventQueue {
    pub(crate) fn push(&mut self, entry: Entry) {
        self.heap.push(Reverse(entry));
    }

    /// When the next entry is due.
    pub(crate) fn next(&self) -> Option<SimTime> {
        self.heap.peek().map(|Reverse(entry)| entry.time)
    }

    /// Takes the next entry if it is due by `end`.
    pub(crate) fn next_until(&mut self, end: SimTime) -> Option<Entry> {
        if self.heap.peek()?.0.time > end {
            return None;
        }
        self.heap.pop().map(|Reverse(entry)| entry)
    }

    pub(crate) fn clear(&mut self) {
        self.heap.clear();
    }
}
