//! Groups at rest leave the solver; whoever is met comes back.

use carom_math::{SimTime, Vec2};

use crate::{BodyKind, EventKind, Sleep, World};

/// Looks for groups at rest so often in the time that a group must have been at rest.
const LOOKS: f64 = 4.0;

impl World {
    /// Puts every group to sleep whose bodies have all been slow for long enough.
    pub(super) fn rest(&mut self, sleep: Sleep, time: SimTime) {
        let passed = self.pool.since_rest;
        if passed < sleep.time / LOOKS {
            return;
        }
        self.pool.since_rest = 0.0;
        let mut ready = false;
        for slot in 0..self.pool.seats.places() {
            if self.pool.seats.get(slot).kind != BodyKind::Dynamic {
                continue;
            }
            let seats = &self.pool.seats;
            let seat = seats.get(slot);
            let line = &seats.rig.lines[slot as usize];
            let speed = line.v().length() + line.w().abs() * seat.reach;
            // Only what something holds can be at rest: the top of a throw is not.
            let held = seats.rig.is_pushed(slot);
            let state = self.bodies.get_mut(seat.body);
            state.slow_for = if held && speed <= sleep.speed {
                state.slow_for + passed
            } else {
                0.0
            };
            ready |= state.slow_for >= sleep.time;
        }
        if ready {
            self.fall_asleep(sleep, time);
        }
    }

    fn fall_asleep(&mut self, sleep: Sleep, time: SimTime) {
        let seats = &self.pool.seats;
        let mut tree = crate::sleep::Tree::new(seats.rig.lines.len());
        let mut restless = Vec::new();
        for (a, b) in seats.rig.lanes.links() {
            match (seats.get(a).kind, seats.get(b).kind) {
                (BodyKind::Dynamic, BodyKind::Dynamic) => tree.join(a, b),
                (BodyKind::Kinematic, _) => restless.push((a, b)),
                (_, BodyKind::Kinematic) => restless.push((b, a)),
                _ => {}
            }
        }
        let mut least = vec![f64::INFINITY; seats.rig.lines.len()];
        for (slot, seat) in seats.moving() {
            if seat.kind == BodyKind::Dynamic {
                let root = tree.root(slot) as usize;
                least[root] = least[root].min(self.bodies.get(seat.body).slow_for);
            }
        }
        for (driven, other) in restless {
            let line = &seats.rig.lines[driven as usize];
            if line.v() != Vec2::ZERO || line.w() != 0.0 {
                least[tree.root(other) as usize] = 0.0;
            }
        }
        let sleepers = seats.moving().filter(|(slot, seat)| {
            seat.kind == BodyKind::Dynamic && least[tree.root(*slot) as usize] >= sleep.time
        });
        let mut sleepers: Vec<(u32, u32)> =
            sleepers.map(|(slot, seat)| (seat.body, slot)).collect();
        sleepers.sort_unstable();
        let mut lying = Vec::new();
        for (index, slot) in sleepers {
            self.sync(index, slot, time);
            self.leave(index, slot);
            let state = self.bodies.get_mut(index);
            state.motion.velocity = Vec2::ZERO;
            state.motion.acceleration = Vec2::ZERO;
            state.motion.spin = 0.0;
            state.motion.angular_acceleration = 0.0;
            state.asleep = true;
            self.events.push(time, EventKind::Asleep(state.id));
            self.bodies.renew(index);
            lying.push(index);
        }
        for index in lying {
            self.quit(index, time);
            self.lie_down(index, time);
        }
        self.pool.seats.close_up();
    }
}
