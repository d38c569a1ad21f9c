//! Boxes of bodies that are stepped: made where a body is, and kept as long as it goes the way they were made for.

use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use super::seats::Seat;
use crate::World;
use crate::broad::{LOOK_AHEAD, PADDING, misses, swept_box};
use crate::solver::{Line, Pull};

/// Boxes are stretched over so many ticks of a body's motion.
const TICKS: f64 = 2.0;

/// The motion that the boxes of a body were stretched along.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    from: SimTime,
    centre: Vec2,
    velocity: Vec2,
    acceleration: Vec2,
    angle: f64,
    spin: f64,
    /// Up to so many seconds after `from`.
    lasts: f64,
}

impl Course {
    /// Whether a body at `time` stays within its boxes for `seconds`: it is no farther off its course,
    /// now and then, than they are padded.
    fn holds(&self, seat: &Seat, line: &Line, pull: &Pull, time: SimTime, seconds: f64) -> bool {
        let passed = time - self.from;
        if passed + seconds > self.lasts {
            return false;
        }
        let padding = PADDING * seat.reach;
        let off = seat.base.position + line.d()
            - (self.centre + (self.velocity + self.acceleration * (0.5 * passed)) * passed);
        let turned = seat.base_angle + line.turn() - (self.angle + self.spin * passed);
        let drift = line.v() - (self.velocity + self.acceleration * passed);
        let then =
            off + (drift + (pull.acceleration - self.acceleration) * (0.5 * seconds)) * seconds;
        let turned_then = turned + (line.w() - self.spin) * seconds;
        let far = |off: Vec2, turned: f64| off.length() + seat.rim * turned.abs();
        far(off, turned) <= padding && far(then, turned_then) <= padding
    }
}

impl World {
    /// Whether a change by the caller took the boxes of a body.
    pub(super) fn lacks_boxes(&self, index: u32) -> bool {
        let mut shapes = self.bodies.get(index).colliders.iter();
        shapes.any(|at| self.colliders[*at as usize].node.is_none())
    }

    /// Whether the boxes that a pair was found with still overlap.
    pub(super) fn keeps(&self, place: u32) -> bool {
        let pair = self.pairs.get(place);
        let ends = [pair.colliders.0, pair.colliders.1].map(|at| &self.colliders[at as usize]);
        self.broad.keeps(&self.colliders, pair) && !misses(ends[0], ends[1])
    }

    /// New boxes for a body that leaves its old ones within `seconds`.
    pub(super) fn rebox(&mut self, index: u32, slot: u32, time: SimTime, seconds: f64) {
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let pull = seats.rig.pull(slot);
        let holds = |course: &Course| course.holds(seat, line, &pull, time, seconds);
        if seat.course.as_ref().is_some_and(holds) {
            return;
        }
        self.sync(index, slot, time);
        self.hold_way(index, slot, time, seconds);
    }

    /// New boxes for a body that leaves its old ones along its motion within `seconds`.
    pub(super) fn hold_way(&mut self, index: u32, slot: u32, time: SimTime, seconds: f64) {
        let state = self.bodies.get(index);
        let holds = |at: &u32| {
            let collider = &self.colliders[*at as usize];
            let swept = swept_box(collider, &state.motion, time, seconds);
            collider.node.is_some() && collider.fat.contains(swept)
        };
        if !state.colliders.iter().all(holds) {
            self.pool.seats.get_mut(slot).roamed = f64::INFINITY;
            self.box_anew(index, slot, time);
        }
    }

    /// New boxes, stretched over two ticks of the body's motion.
    pub(super) fn box_anew(&mut self, index: u32, slot: u32, time: SimTime) {
        let state = self.bodies.get(index);
        for at in &state.colliders {
            self.colliders[*at as usize].fat = Aabb::EMPTY;
        }
        let lasts = TICKS * self.settings.tick;
        let motion = &state.motion;
        self.pool.seats.get_mut(slot).course = Some(Course {
            from: time,
            centre: motion.centre_at(time),
            velocity: motion.velocity_at(time),
            acceleration: motion.acceleration,
            angle: state.turned + motion.turn(time - motion.start),
            spin: motion.spin_at(time),
            // The last instant counts.
            lasts: lasts * (1.0 + 1e-9),
        });
        self.refit_among(index, time, lasts / LOOK_AHEAD, false);
    }
}
