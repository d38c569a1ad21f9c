//! Motions that were replaced, for looking back inside the last steps.

use std::collections::VecDeque;
use std::sync::Arc;

use carom_collision::Motion;
use carom_math::{Pose, SimTime};

use crate::law::flight::Flight;

/// A motion, and the law that it stood for.
pub(crate) type Followed = (Motion, Option<Arc<Flight>>);

/// A bounded log: the oldest entries go first, and a look beyond them finds nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    log: VecDeque<(u32, Followed)>,
    capacity: usize,
    /// Before this instant something may be missing.
    complete_since: SimTime,
}

impl History {
    pub(crate) fn new(capacity: usize) -> Self {
        Self {
            log: VecDeque::new(),
            capacity,
            complete_since: SimTime::ZERO,
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
            self.complete_since = (self.log.front()).map_or(now, |(_, (oldest, _))| oldest.start);
        }
    }

    /// Keeps the motion that body `index` followed until `until`.
    pub(crate) fn replaced(
        &mut self,
        index: u32,
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
            self.complete_since = self
                .log
                .front()
                .map_or(until, |(_, (oldest, _))| oldest.start);
        }
        self.log.push_back((index, (*motion, flight.cloned())));
    }

    /// Frame of the centre of mass of body `index` at `time`.
    pub(crate) fn pose_at(&self, index: u32, time: SimTime) -> Option<Pose> {
        if time < self.complete_since {
            return None;
        }
        self.log
            .iter()
            .rev()
            .find(|(of, (motion, _))| *of == index && motion.start <= time)
            .map(|(_, (motion, flight))| match flight {
                Some(flight) => Pose::new(flight.at(time).0, flight.turn_at(time).0),
                None => motion.pose_at(time),
            })
    }

    /// Forgets a body: another one takes its place.
    pub(crate) fn forget(&mut self, index: u32) {
        self.log.retain(|(of, _)| *of != index);
    }
}
