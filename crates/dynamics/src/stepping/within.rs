//! Changes in the middle of a sub-step: continuous collision for its rest.
//!
//! The engine has bodies at the poses that the sub-step ends with. A body that would pass through another one until then is
//! stopped, keeps its velocity, and is shown to move there evenly.

use super::{Stepping, place};
use crate::World;

impl World {
    /// Before time goes on within a sub-step in which a caller changed bodies.
    pub(super) fn enter_within(&mut self, stepping: &mut Stepping) {
        let (now, end) = (self.clock.now, self.clock.next());
        if self.bodies.touched.is_empty() || !self.clock.is_within(now) {
            return;
        }
        let under_way = stepping.engine.fast();
        let under_way = under_way.filter_map(|id| stepping.engine.state(id).ok());
        let mut going: Vec<u32> = under_way.map(|state| place(&state)).collect();
        going.extend(&self.bodies.touched);
        going.sort_unstable();
        going.dedup();
        self.enter_changed(stepping, end, now);
        for index in going {
            if let Some(id) = stepping.id(index).filter(|_| self.bodies.is_alive(index)) {
                let from = self.bodies.get(index).centre_pose(now);
                let told = stepping.engine.carry(id, from);
                debug_assert!(told.is_ok(), "{told:?}");
            }
        }
        let left = end - now;
        self.invite_ahead(stepping, left);
        for id in stepping.engine.stop_fast(left, &self.rules()) {
            let Ok(there) = stepping.engine.state(id) else {
                continue;
            };
            let index = place(&there);
            let state = self.bodies.get(index);
            let from = (
                state.centre_pose(now),
                state.turned + state.turn_by(now),
                (state.velocity_at(now), state.spin_at(now)),
            );
            self.go_evenly(index, now, from, &there, left);
        }
        // The engine has them there already.
        self.bodies.touched.clear();
    }
}
