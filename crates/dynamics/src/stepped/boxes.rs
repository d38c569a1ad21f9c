//! Boxes of bodies that are stepped: made where a body is, and kept as long as it keeps the course they were made for.

use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime};

use super::courses::Course;
use super::seats::Seats;
use crate::World;
use crate::broad::PADDING;

/// Boxes are stretched over so many ticks of a body's motion.
const TICKS: f64 = 2.0;

impl World {
    /// Whether a change by the caller took the boxes of a body.
    pub(super) fn lacks_boxes(&self, index: u32) -> bool {
        let mut shapes = self.bodies.get(index).colliders.iter();
        shapes.any(|at| self.colliders[*at as usize].node.is_none())
    }

    /// New boxes for a body that leaves its course within `seconds`; whether it got some.
    pub(super) fn rebox(&mut self, index: u32, slot: u32, time: SimTime, seconds: f64) -> bool {
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let pull = seats.rig.pull(slot);
        let holds = |course: &Course| course.holds(seat, line, &pull, time, seconds);
        if seats.courses.of(slot).is_some_and(holds) && !self.lacks_boxes(index) {
            return false;
        }
        let (lasts, line_of) = (TICKS * self.settings.tick, *line);
        let seat = self.pool.seats.get_mut(slot);
        seat.roamed = f64::INFINITY;
        let course = Course {
            from: time,
            centre: seat.base.position + line_of.d(),
            velocity: line_of.v(),
            acceleration: pull.acceleration,
            angle: seat.base_angle + line_of.turn(),
            spin: line_of.w(),
            // The last instant counts.
            lasts: lasts * (1.0 + 1e-9),
        };
        self.pool.seats.courses.begin(slot, course);
        self.box_anew(index, slot, time);
        true
    }

    /// New boxes for a body that stays within its padding for a while.
    pub(super) fn rebox_slow(&mut self, index: u32, slot: u32, time: SimTime) {
        let seats = &mut self.pool.seats;
        seats.get_mut(slot).roamed = 0.0;
        seats.courses.end(slot);
        self.box_anew(index, slot, time);
    }

    /// New boxes, stretched along a body's course.
    fn box_anew(&mut self, index: u32, slot: u32, time: SimTime) {
        let seat = self.pool.seats.get(slot);
        let on_course = self.pool.seats.is_on_course(slot);
        let lasts = if on_course {
            TICKS * self.settings.tick
        } else {
            0.0
        };
        let padding = PADDING * seat.reach;
        let way = Stretch::new(&self.pool.seats, slot, lasts);
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            let fat = way
                .around(&self.colliders[at as usize].solid)
                .grown(padding);
            let in_cells = on_course && self.pool.throng.takes(fat);
            self.broad.put(&mut self.colliders, at, fat, time, in_cells);
        }
        self.look_down_first(time);
    }
}

/// The way of a body over some seconds, as boxes see it.
struct Stretch {
    from: Pose,
    to: Pose,
    /// What the way leaves its chord by, at most, in m.
    room: f64,
}

impl Stretch {
    fn new(seats: &Seats, slot: u32, seconds: f64) -> Self {
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let (pull, from) = (seats.rig.pull(slot), seats.pose(slot));
        let half = 0.5 * seconds * seconds;
        let to = Pose::new(
            from.position + line.v() * seconds + pull.acceleration * half,
            from.rotation
                .turned_slightly(line.w() * seconds + pull.angular * half),
        );
        // |a| h²/8 beyond the chord, and r (ω² + |α|) h²/8 for a point at distance r, which is never 2 r from it.
        let turn = line.w().abs() * seconds + pull.angular.abs() * (2.0 * half);
        let wound = pull.angular.abs() * (2.0 * half);
        let arc = if seat.rim > 0.0 {
            seat.rim * (0.125 * (turn * turn + wound)).min(2.0)
        } else {
            0.0
        };
        let bulge = 0.25 * half * pull.acceleration.length();
        Self {
            from,
            to,
            room: arc + bulge + 1e-9 * seat.reach,
        }
    }

    fn around(&self, shape: &Shape) -> Aabb {
        let ends = shape.aabb(self.from).union(shape.aabb(self.to));
        ends.grown(self.room)
    }
}
