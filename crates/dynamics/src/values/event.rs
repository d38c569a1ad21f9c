//! What happened during a step.

use carom_math::{SimTime, Vec2};

use crate::BodyId;

/// Something that happened to one or two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// When.
    pub time: SimTime,
    /// What.
    pub kind: EventKind,
}

/// How two bodies in lasting contact move against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ContactMode {
    /// They part.
    Open,
    /// Both are at rest.
    Rest,
    /// They move as one.
    Stick,
    /// Something round rolls without slip.
    Roll,
    /// One slips along the other.
    Slide,
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EventKind {
    /// Two bodies struck each other: once for all points of a flat landing.
    Impact {
        /// The body that the normal points away from.
        a: BodyId,
        /// The body that the normal points to.
        b: BodyId,
        /// Point of contact, in m; of a flat landing the one at which its impulses act together.
        point: Vec2,
        /// Unit normal from A to B.
        normal: Vec2,
        /// Impulse on B along the normal, in N·s.
        normal_impulse: f64,
        /// Impulse on B along the normal turned by +90 degrees, in N·s.
        tangential_impulse: f64,
        /// Normal speed of approach, in m/s; 0 of a touch that rested or opened, and only passes on another's blow.
        speed: f64,
    },
    /// Two bodies began to touch and stay in touch: an impact alone is no begin. Where they have several shapes each two of these
    /// begin and end by themselves.
    Begin {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// Which shapes of A and of B, in the order of insertion.
        shapes: (usize, usize),
    },
    /// Two bodies, or two of their shapes, no longer touch.
    End {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// Which shapes of A and of B, in the order of insertion.
        shapes: (usize, usize),
    },
    /// A contact in closed form began to move in this way.
    Mode {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// How they move against each other from now on.
        mode: ContactMode,
    },
    /// Impacts of a pair came ever faster, and infinitely many of them end here; or they outran their
    /// budget, and the rest of them is left to the solver.
    Collapse {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// Kinetic energy of the pair's relative motion at that moment, in J.
        energy: f64,
    },
    /// A body fell asleep with its group.
    Asleep(BodyId),
    /// A body woke up.
    Awake(BodyId),
}

impl EventKind {
    /// An impact of bodies A and B: where and along which normal, its impulses along that and across, and the speed of approach.
    pub(crate) const fn impact(
        [a, b]: [BodyId; 2],
        (point, normal): (Vec2, Vec2),
        (normal_impulse, tangential_impulse): (f64, f64),
        speed: f64,
    ) -> Self {
        Self::Impact {
            a,
            b,
            point,
            normal,
            normal_impulse,
            tangential_impulse,
            speed: speed.max(0.0),
        }
    }
}

/// The events of the last step, in order of time, up to a bound.
#[derive(Clone, Debug, Default)]
pub struct Events {
    list: Vec<Event>,
    capacity: usize,
    dropped: usize,
    /// When the step began: nothing happens before.
    since: SimTime,
    /// How many of them some step has delivered, kept and dropped.
    delivered: (usize, usize),
}

impl Events {
    pub(crate) fn new(capacity: usize) -> Self {
        Self {
            capacity,
            ..Self::default()
        }
    }

    /// Keeps so many of a step from now on.
    pub(crate) const fn set_capacity(&mut self, capacity: usize) {
        self.capacity = capacity;
    }

    /// The events in order of time.
    pub fn iter(&self) -> core::slice::Iter<'_, Event> {
        self.list.iter()
    }

    /// How many events are kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether nothing happened.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How many events found no room.
    #[must_use]
    pub const fn dropped(&self) -> usize {
        self.dropped
    }

    /// Whether something happened that no step has delivered, whether there was room for it or not.
    pub(crate) fn are_due(&self) -> bool {
        self.list.len() + self.dropped > self.delivered.0 + self.delivered.1
    }

    /// Tells what happened at `time`; the grid of sub-steps is met where sums of a caller's `dt` round past it, too.
    pub(crate) fn push(&mut self, time: SimTime, kind: EventKind) {
        let time = time.max(self.since);
        if self.list.len() < self.capacity {
            self.list.push(Event { time, kind });
        } else {
            self.dropped += 1;
        }
    }

    /// Puts what was told after later events among them.
    pub(crate) fn sort(&mut self) {
        self.list[self.delivered.0..].sort_by_key(|event| event.time);
    }

    /// Makes room for the events of a step. What happened since the last one, by what the caller
    /// changed, is delivered with it.
    pub(crate) fn begin_step(&mut self, now: SimTime) {
        self.since = now;
        // A step in which much happened leaves no room behind.
        let (kept, dropped) = core::mem::take(&mut self.delivered);
        self.list.shrink_to(4 * kept);
        self.list.drain(..kept);
        self.dropped -= dropped;
    }

    pub(crate) fn end_step(&mut self) {
        self.delivered = (self.list.len(), self.dropped);
    }
}

impl<'a> IntoIterator for &'a Events {
    type Item = &'a Event;
    type IntoIter = core::slice::Iter<'a, Event>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_in_which_much_happened_leaves_no_room_behind() {
        let mut events = Events::new(4096);
        let id = BodyId {
            index: crate::BodyIx::default(),
            generation: 0,
        };
        for count in [3000, 2, 0, 0] {
            events.begin_step(SimTime::ZERO);
            for _ in 0..count {
                events.push(SimTime::ZERO, EventKind::Awake(id));
            }
            events.end_step();
            assert_eq!(events.len(), count);
        }
        assert_eq!(events.list.capacity(), 0);
    }
}
