//! Motions for everybody else: written where somebody asks, and once at the end of a step.

use arrayvec::ArrayVec;
use carom_collision::Motion;
use carom_math::SimTime;

use crate::{BodyKind, World};

/// So many bodies are read one after the other, before their motions are written. With 4 a settled pile takes 6 to 8 % more time,
/// with 128 no less (AMD EPYC, 2026-11-23).
const AT_ONCE: usize = 64;

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
        self.bodies.go_on_as(index, &motion, angle);
    }

    /// Motions of the last sub-step for all who move, but for those who joined within it: `newcomers`, in order.
    pub(super) fn write_motions(&mut self, newcomers: &[u32]) {
        let start = self.clock.last();
        let mut slots = 0..self.pool.seats.places();
        loop {
            let seats = &self.pool.seats;
            // Kinematic bodies fly beside a crowd.
            let is_written = |slot: &u32| {
                let seat = seats.get(*slot);
                seat.kind == BodyKind::Dynamic && newcomers.binary_search(&seat.body).is_err()
            };
            let batch: ArrayVec<u32, AT_ONCE> =
                slots.by_ref().filter(is_written).take(AT_ONCE).collect();
            if batch.is_empty() {
                return;
            }
            self.bodies
                .read_ahead(batch.iter().map(|slot| seats.get(*slot).body));
            for slot in batch {
                self.write_motion(slot, start);
            }
        }
    }

    /// A body's motion of the last sub-step, begun at `start`: from the velocity before to the one after, to
    /// where it is.
    pub(super) fn write_motion(&mut self, slot: u32, start: SimTime) {
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
        let way = motion.travel(h);
        motion.centre -= way;
        let turn = line.turn() - motion.turn(h);
        motion.rotation = motion.rotation.turned_slightly(turn);
        let (index, angle) = (seat.body, seat.base_angle + turn);
        self.bodies.go_on_as(index, &motion, angle);
        self.bodies.renew(index);
    }
}
