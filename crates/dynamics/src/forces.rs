//! Forces that a caller applied act for one step.

use carom_math::Vec2;

use crate::World;

impl World {
    /// Forces of the step that begins.
    pub(crate) fn begin_forces(&mut self) {
        let now = self.clock.now;
        let forced = self.forced.clone();
        for &index in &forced {
            // An analytic body is handed back first, since that assumes the motion stored for its island.
            self.hand_back_of(index, now);
            self.bodies.change(index, now, |_| {});
            let state = self.bodies.get_mut(index);
            let acts = state.uncommon_mut();
            let (force, torque) = core::mem::take(&mut acts.pending);
            (acts.force, acts.torque) = (force, torque);
            state.motion.acceleration += force * state.inverse_mass;
            state.motion.angular_acceleration += torque * state.inverse_inertia;
        }
        for index in forced {
            self.deflected(index, now);
        }
    }

    /// Forces last one step.
    pub(crate) fn end_forces(&mut self) {
        let now = self.clock.now;
        let forced = core::mem::take(&mut self.forced);
        for &index in &forced {
            self.hand_back_of(index, now);
            self.bodies.change(index, now, |_| {});
            let state = self.bodies.get_mut(index);
            let acts = state.uncommon_mut();
            let (force, torque) = (acts.force, acts.torque);
            (acts.force, acts.torque) = (Vec2::ZERO, 0.0);
            // A body that fell asleep under its force is accelerated by nothing, and wakes without it.
            if state.is_asleep() {
                continue;
            }
            if state.is_free() {
                // (g + F/m) − F/m is g in a third of all cases: a rounding that is left would bend the parabola for good.
                let (acceleration, turning) = self.bodies.freely(index, now);
                let motion = &mut self.bodies.get_mut(index).motion;
                (motion.acceleration, motion.angular_acceleration) = (acceleration, turning);
            } else {
                state.motion.acceleration -= force * state.inverse_mass;
                state.motion.angular_acceleration -= torque * state.inverse_inertia;
            }
        }
        for index in forced {
            if self.bodies.get(index).is_asleep() {
                self.wake_around(index, now);
            }
            self.deflected(index, now);
        }
    }
}
