//! Changes in the middle of a sub-step: bodies go on from where they are, and not through others.

use carom_math::SimTime;
use carom_stepped::BodyId;

use super::write::go_evenly;
use super::{Stepping, accepted, place};
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;

impl Stepping {
    /// Bodies that a caller changed go on as they do, and what contacts connect with them as it is seen.
    pub(crate) fn leave_ways(&mut self, bodies: &Bodies, clock: &Clock) {
        for &index in &bodies.touched {
            if bodies.is_alive(index) {
                self.leave_way(index, clock);
            }
        }
    }

    /// See [`Self::leave_ways`].
    pub(crate) fn leave_way(&mut self, index: u32, clock: &Clock) {
        if let Some(id) = self.id(index).filter(|_| clock.is_within(clock.now)) {
            let passed = (clock.now - clock.last()) / clock.h;
            accepted(self.engine.leave_way(id, passed));
        }
    }

    /// Bodies that are changed or fast go on from where they are now.
    pub(crate) fn carry(&mut self, bodies: &Bodies, going: &[u32], now: SimTime) {
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
