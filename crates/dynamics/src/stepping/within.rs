//! Changes in the middle of a sub-step: bodies go on from where they are, and not through others.

use carom_math::{SimTime, Vec2};
use carom_stepped::BodyId;

use super::write::go_evenly;
use super::{Stepping, accepted, place};
use crate::BodyIx;
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;

/// Whether contacts accelerate a body, in m/s², by more than what bears it does against what pulls it.
pub(crate) fn is_blow(acceleration: Vec2, pull: Vec2) -> bool {
    acceleration.length() > 2.0 * pull.length()
}

impl Stepping {
    /// Bodies that a caller changed or removes within a sub-step go on as they do, and what contacts connect with them as it is seen.
    pub(crate) fn leave_ways(&mut self, bodies: &mut Bodies, changed: &[BodyIx], clock: &Clock) {
        let (now, left) = (clock.now, clock.next() - clock.now);
        if !clock.is_within(now) {
            return;
        }
        let there = changed.iter().filter(|index| bodies.is_alive(**index));
        let ids: Vec<BodyId> = there.filter_map(|index| self.id(*index)).collect();
        let passed = 1.0 - left / clock.h;
        let Ok(pulled) = self.engine.leave_ways(&ids, passed) else {
            return;
        };
        for id in pulled {
            self.leave_blow(bodies, id, (now, left));
        }
    }

    /// A body that something pulls goes on as it is seen, without the rest of a blow: of more than twice what pulls it.
    fn leave_blow(&mut self, bodies: &mut Bodies, id: BodyId, (now, left): (SimTime, f64)) {
        let Ok(mut there) = self.engine.state(id) else {
            return;
        };
        let index = place(&there);
        let state = bodies.get(index);
        let seen = (state.velocity_at(now), state.spin_at(now));
        let (pull, twist) = bodies.pull_on(index, state.centre_at(now));
        let after = (seen.0 + pull * left, seen.1 + twist * left);
        let h = self.engine.settings().substep();
        if state.is_guest || !is_blow((there.velocity.0 - after.0) / h, pull) {
            return;
        }
        let from = (state.centre_pose(now), state.turned_at(now));
        accepted(self.engine.set_velocity(id, after.0, after.1));
        there.velocity = after;
        go_evenly(bodies, now, from, [seen, after], &there, left);
    }

    /// Bodies that are changed or fast go on from where they are now.
    pub(crate) fn carry(&mut self, bodies: &Bodies, going: &[BodyIx], now: SimTime) {
        for &index in going {
            if let Some(id) = self.id(index).filter(|_| bodies.is_alive(index)) {
                accepted(self.engine.carry(id, bodies.get(index).centre_pose(now)));
            }
        }
    }

    /// Bodies that were stopped go evenly to where they are in `left` seconds.
    pub(crate) fn show_stopped(
        &self,
        bodies: &mut Bodies,
        stopped: Vec<BodyId>,
        now: SimTime,
        left: f64,
    ) {
        for id in stopped {
            let Ok(there) = self.engine.state(id) else {
                continue;
            };
            let state = bodies.get(place(&there));
            let from = (state.centre_pose(now), state.turned_at(now));
            let shown = [(state.velocity_at(now), state.spin_at(now)), there.velocity];
            go_evenly(bodies, now, from, shown, &there, left);
        }
    }
}
