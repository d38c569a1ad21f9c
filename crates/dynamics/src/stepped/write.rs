//! Motions for everybody else: written where somebody asks, and once at the end of a step.

use carom_collision::Motion;
use carom_math::SimTime;

use crate::{BodyKind, World};

impl World {
    /// Writes where a body is at `time`, for boxes.
    pub(super) fn sync(&mut self, index: u32, slot: u32, time: SimTime) {
        let seats = &self.pool.seats;
        let pose = seats.pose(slot);
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let pull = seats.rig.pull(slot);
        let angle = seat.base_angle + line.turn();
        let (velocity, spin) = (line.v(), line.w());
        let motion = Motion {
            start: time,
            centre: pose.position,
            velocity,
            acceleration: pull.acceleration,
            rotation: pose.rotation,
            spin,
            angular_acceleration: pull.angular,
            left_out: 0.0,
        };
        self.go_on_as(index, motion, angle);
    }

    /// The motion of a body from `motion.start` on, turned by `angle` in all; the log keeps what it did till then.
    pub(super) fn go_on_as(&mut self, index: u32, motion: Motion, angle: f64) {
        let old = self.bodies.get(index).motion;
        self.bodies
            .history
            .replaced(index, &old, None, motion.start);
        let state = self.bodies.get_mut(index);
        (state.motion, state.turned) = (motion, angle);
    }

    /// Books what forces did since the motions of the bodies they act on were last told.
    pub(super) fn book_forces(&mut self, time: SimTime, first: bool) {
        for k in 0..self.forced.len() {
            let index = self.forced[k];
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            if !first {
                self.write_motion(slot, self.clock.last());
            }
            self.bodies.change(index, time, |_| {});
        }
        self.bodies.touched.clear();
    }

    /// Motions of the last sub-step for all who move.
    pub(super) fn write_motions(&mut self) {
        let start = self.clock.last();
        for slot in 0..self.pool.seats.places() {
            let kind = self.pool.seats.get(slot).kind;
            // Kinematic bodies fly beside a crowd.
            if kind == BodyKind::Dynamic || kind == BodyKind::Kinematic && self.moves_all() {
                self.write_motion(slot, start);
            }
        }
    }

    /// A body's motion of the last sub-step, begun at `start`: from the velocity before to the one after, to
    /// where it is.
    fn write_motion(&mut self, slot: u32, start: SimTime) {
        let h = self.clock.h;
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let (v, w) = seats.rig.before(slot, h);
        let mut motion = Motion {
            start,
            centre: seat.base.position + line.d(),
            velocity: v,
            acceleration: (line.v() - v) * self.law.inverse_h(),
            rotation: seat.base.rotation,
            spin: w,
            angular_acceleration: (line.w() - w) * self.law.inverse_h(),
            left_out: 0.0,
        };
        motion.centre -= motion.travel(h);
        let turn = line.turn() - motion.turn(h);
        motion.rotation = motion.rotation.turned_slightly(turn);
        let (index, angle) = (seat.body, seat.base_angle + turn);
        self.go_on_as(index, motion, angle);
        self.bodies.renew(index);
    }
}
