//! Motions that were replaced, for looking back inside the last steps.

use std::collections::VecDeque;

use carom_collision::Motion;
use carom_math::SimTime;

/// A bounded log: the oldest entries go first, and a look beyond them finds nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    log: VecDeque<(u32, Motion)>,
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

    /// Keeps the motion that body `index` followed until `until`.
    pub(crate) fn replaced(&mut self, index: u32, motion: &Motion, until: SimTime) {
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
            self.complete_since = self.log.front().map_or(until, |(_, oldest)| oldest.start);
        }
        self.log.push_back((index, *motion));
    }

    /// The motion that body `index` followed at `time`.
    pub(crate) fn at(&self, index: u32, time: SimTime) -> Option<&Motion> {
        if time < self.complete_since {
            return None;
        }
        self.log
            .iter()
            .rev()
            .find(|(of, motion)| *of == index && motion.start <= time)
            .map(|(_, motion)| motion)
    }

    /// Forgets a body whose place another one takes.
    pub(crate) fn forget(&mut self, index: u32) {
        self.log.retain(|(of, _)| *of != index);
    }
}
