//! Motions that were replaced, for looking back inside the last steps.

use std::collections::VecDeque;
use std::sync::Arc;

use carom_collision::Motion;
use carom_math::{Pose, SimTime, Vec2};

use super::state::drawn_at;
use crate::BodyIx;
use crate::law::flight::Flight;

/// What a body did until its motion was replaced.
#[derive(Clone, Debug)]
struct Entry {
    body: BodyIx,
    motion: Motion,
    /// The law that the motion stood for.
    flight: Option<Arc<Flight>>,
    /// Where its centre of mass lay in its shapes' own frame, in m: other shapes have another one.
    centroid: Vec2,
}

/// A bounded log: the oldest entries go first, and a look beyond them finds nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    log: VecDeque<Entry>,
    capacity: usize,
    /// Before this instant something may be missing.
    complete_since: SimTime,
}

impl History {
    pub(crate) fn new(capacity: usize) -> Self {
        Self {
            capacity,
            ..Self::default()
        }
    }

    /// Whether replaced motions are kept at all.
    pub(crate) const fn is_kept(&self) -> bool {
        self.capacity > 0
    }

    /// Keeps so many from now on; the oldest of those beyond go.
    pub(crate) fn set_capacity(&mut self, capacity: usize, now: SimTime) {
        if self.capacity == 0 {
            // Some of what went on until now was not even written.
            self.complete_since = now;
        }
        self.capacity = capacity;
        let beyond = self.log.len().saturating_sub(capacity);
        if beyond > 0 {
            self.log.drain(..beyond);
            self.complete_since = (self.log.front()).map_or(now, |oldest| oldest.motion.start);
        }
    }

    /// Keeps the motion that body `index`, with its centre of mass at `centroid`, followed until `until`.
    pub(crate) fn replaced(
        &mut self,
        (index, centroid): (BodyIx, Vec2),
        motion: &Motion,
        flight: Option<&Arc<Flight>>,
        until: SimTime,
    ) {
        if self.capacity == 0 {
            self.complete_since = until;
            return;
        }
        if motion.start == until {
            return;
        }
        if self.log.len() == self.capacity {
            self.log.pop_front();
            // What went may have lasted until the start of what is oldest now.
            self.complete_since = self.log.front().map_or(until, |oldest| oldest.motion.start);
        }
        self.log.push_back(Entry {
            body: index,
            motion: *motion,
            flight: flight.cloned(),
            centroid,
        });
    }

    /// Frame of the shapes that body `index` had at `time`.
    pub(crate) fn pose_at(&self, index: BodyIx, time: SimTime) -> Option<Pose> {
        if time < self.complete_since {
            return None;
        }
        let then = |entry: &&Entry| entry.body == index && entry.motion.start <= time;
        let entry = self.log.iter().rev().find(then)?;
        let frame = match &entry.flight {
            Some(flight) => Pose::new(flight.at(time).0, flight.turn_at(time).0),
            None => entry.motion.pose_at(time),
        };
        Some(drawn_at(frame, entry.centroid))
    }

    /// Forgets a body: another one takes its place.
    pub(crate) fn forget(&mut self, index: BodyIx) {
        self.log.retain(|entry| entry.body != index);
    }
}
