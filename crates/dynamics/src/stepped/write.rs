//! Motions for everybody else: written where somebody asks, and once at the end of a step.

use arrayvec::ArrayVec;
use carom_collision::Motion;
use carom_math::{SimTime, Vec2};

use crate::uncommon::Lag;
use crate::{BodyKind, World};

/// Places that differ by less, as a part of the reach and the way, are one but for rounding.
const SAME: f64 = 1e-12;

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

    /// Motions of the last sub-step for all who move, but for those who joined within it: `newcomers`, in order.
    pub(super) fn write_motions(&mut self, newcomers: &[u32]) {
        let (start, all) = (self.clock.last(), self.moves_all());
        let mut slots = 0..self.pool.seats.places();
        loop {
            let seats = &self.pool.seats;
            // Kinematic bodies fly beside a crowd.
            let is_written = |slot: &u32| {
                let seat = seats.get(*slot);
                match seat.kind {
                    BodyKind::Dynamic => newcomers.binary_search(&seat.body).is_err(),
                    BodyKind::Kinematic => all,
                    BodyKind::Fixed => false,
                }
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

    /// Notes where everybody is before a sub-step within which somebody may ask, and forgets it before any other.
    pub(super) fn note_places(&mut self, asked: bool) {
        let pool = &mut self.pool;
        pool.places.clear();
        if asked {
            let lines = pool.seats.rig.lines.iter();
            pool.places
                .extend(lines.map(|line| (line.d(), line.turn())));
        }
    }

    /// The end of a sub-step within which somebody asked has the bits that it has if nobody did.
    pub(super) fn end_way(&mut self) {
        if self.pool.places.is_empty() || self.settings.history > 0 {
            return;
        }
        self.note_places(false);
        let start = self.clock.last();
        // Whoever was changed meanwhile goes on from there.
        let mut changed = self.bodies.touched.clone();
        changed.sort_unstable();
        for slot in 0..self.pool.seats.places() {
            let seat = self.pool.seats.get(slot);
            if seat.kind != BodyKind::Fixed && changed.binary_search(&seat.body).is_err() {
                self.write_motion(slot, start);
            }
        }
    }

    /// A body's motion of the last sub-step, begun at `start`: from the velocity before to the one after, to
    /// where it is.
    ///
    /// That is where it came from, too, unless a contact stopped it or pushed it out within the sub-step. Such a body goes
    /// evenly from place to place: a path between two that are free, and no faster than it was.
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
        if let Some(&from) = self.pool.places.get(slot as usize) {
            let off = (line.d() - way - from.0).length() + (turn - from.1).abs() * seat.reach;
            if off > SAME * (seat.reach + way.length()) {
                return self.write_even_motion(slot, from, (v, w), start);
            }
        }
        self.bodies.go_on_as(index, &motion, angle);
        self.bodies.renew(index);
    }
    /// The same of a body whose velocity changed from `before` within the sub-step: evenly from displacement and turn
    /// `from` to where it is.
    fn write_even_motion(
        &mut self,
        slot: u32,
        from: (Vec2, f64),
        before: (Vec2, f64),
        start: SimTime,
    ) {
        let (h, rate) = (self.clock.h, self.law.inverse_h());
        let seats = &self.pool.seats;
        let (seat, line) = (seats.get(slot), &seats.rig.lines[slot as usize]);
        let even = ((line.d() - from.0) * rate, (line.turn() - from.1) * rate);
        let lag = Lag::of_even(even, before, (line.v(), line.w()), h);
        let motion = Motion {
            start,
            velocity: even.0,
            rotation: seat.base.rotation.turned_slightly(from.1),
            spin: even.1,
            ..Motion::resting(seat.base.position + from.0)
        };
        let (index, angle) = (seat.body, seat.base_angle + from.1);
        self.bodies.go_on_as(index, &motion, angle);
        self.bodies.get_mut(index).set_lag(lag);
        self.bodies.renew(index);
    }
}
