//! Boxes of bodies that are stepped: made where a body is, and kept as long as it keeps the course they were made for.

use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime, Vec2};

use super::courses::Course;
use super::seats::Seats;
use crate::World;
use crate::broad::{PADDING, swept_box};

/// Boxes are stretched over so many ticks of a body's motion.
const TICKS: f64 = 2.0;

impl World {
    /// Whether a change by the caller took the boxes of a body.
    pub(super) fn lacks_boxes(&self, index: u32) -> bool {
        let mut shapes = self.bodies.get(index).colliders.iter();
        shapes.any(|at| self.colliders[*at as usize].node.is_none())
    }

    /// New boxes for a body that went out of its old ones in a sub-step, from displacement and turn `from` on.
    pub(super) fn hold_way(
        &mut self,
        (index, slot): (u32, u32),
        from: (Vec2, f64),
        start: SimTime,
        seconds: f64,
    ) {
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let holds = if let Some(course) = seats.courses.of(slot) {
            // It went straight on. Whoever left its course may have met whom it could not have met on it.
            let ends = [(from, start), ((line.d(), line.turn()), start + seconds)];
            ends.into_iter()
                .all(|(at, time)| course.passes(seat, at, time))
                && !self.lacks_boxes(index)
        } else {
            self.boxes_hold(index, start, seconds)
        };
        if !holds {
            // The way is not over: the boxes hold what is ahead of it, and what lies behind.
            let state = self.bodies.get(index);
            let behind = state.colliders.iter();
            let behind = behind.map(|at| {
                let collider = &self.colliders[*at as usize];
                swept_box(collider, &state.motion, start, seconds)
            });
            let behind: Vec<Aabb> = behind.collect();
            self.pool.seats.courses.end(slot);
            self.box_anew(index, slot, start, &behind);
            self.seek_partners(index, slot, start);
        }
    }

    /// Whether a body stays in its boxes along its motion, `seconds` long.
    fn boxes_hold(&self, index: u32, start: SimTime, seconds: f64) -> bool {
        let state = self.bodies.get(index);
        state.colliders.iter().all(|at| {
            let collider = &self.colliders[*at as usize];
            let swept = swept_box(collider, &state.motion, start, seconds);
            collider.node.is_some() && collider.fat.contains(swept)
        })
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
        self.box_anew(index, slot, time, &[]);
        true
    }

    /// New boxes for a body that stays within its padding for a while.
    pub(super) fn rebox_slow(&mut self, index: u32, slot: u32, time: SimTime) {
        let seats = &mut self.pool.seats;
        seats.get_mut(slot).roamed = 0.0;
        seats.courses.end(slot);
        self.box_anew(index, slot, time, &[]);
    }

    /// New boxes, stretched along a body's course; `with`: what else is to be in each.
    fn box_anew(&mut self, index: u32, slot: u32, time: SimTime, with: &[Aabb]) {
        let seat = self.pool.seats.get(slot);
        let on_course = self.pool.seats.is_on_course(slot);
        let lasts = if on_course || !with.is_empty() {
            TICKS * self.settings.tick
        } else {
            0.0
        };
        let padding = PADDING * seat.reach;
        let way = Stretch::new(&self.pool.seats, slot, lasts);
        for k in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[k];
            let mut fat = way.around(&self.colliders[at as usize].solid);
            fat = with.get(k).map_or(fat, |more| fat.union(*more));
            let fat = fat.grown(padding);
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
