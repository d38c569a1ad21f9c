//! Forces that a caller applied act for one step.
//!
//! What flies, or goes by events, is accelerated for as long as the step lasts. The engine has sub-steps of its own, which neither begin
//! nor end with a step: in each a body with contacts is pulled by the mean of what acts in it, as far as that is known where it begins,
//! and of what was applied since within the one before.

use std::collections::BTreeSet;

use carom_math::{SimTime, Vec2};

use crate::stepping::Stepping;
use crate::{BodyIx, World};

impl World {
    /// Forces of the step that begins, and would end at `end`.
    pub(crate) fn begin_forces(&mut self, end: SimTime) {
        let now = self.clock.now;
        self.joins.forced_until = end;
        let (pushed, forced): (Vec<BodyIx>, Vec<BodyIx>) =
            (self.forced.iter()).partition(|index| self.has_rows(**index));
        for index in pushed {
            self.bodies.get_mut(index).uncommon_mut().acted = now;
            self.joins.pushed.insert(index);
        }
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
        let waits =
            |index: &BodyIx| self.bodies.get(*index).uncommon().pending != (Vec2::ZERO, 0.0);
        let (pushed, forced): (Vec<BodyIx>, Vec<BodyIx>) = forced.into_iter().partition(waits);
        for index in pushed {
            let acts = self.bodies.get_mut(index).uncommon_mut();
            acts.owe_until(now, self.clock.h);
            acts.pending = (Vec2::ZERO, 0.0);
        }
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

    /// Bodies that forces act on in this step, or did in the last sub-step of the engine.
    pub(crate) fn all_forced(&self) -> BTreeSet<BodyIx> {
        let all = self.forced.iter().chain(&self.joins.pushed).copied();
        all.filter(|index| self.bodies.is_alive(*index)).collect()
    }

    /// Whether the engine moves a body that touches something there, or did when forces began to act on it.
    fn has_rows(&self, index: BodyIx) -> bool {
        let touches = || {
            let stepping = self.stepping.as_ref()?;
            let mut contacts = stepping.engine.contacts_of(stepping.id(index)?).ok()?;
            contacts.next()
        };
        self.is_engines(index) && (self.joins.pushed.contains(&index) || touches().is_some())
    }

    /// Forces of the sub-step of the engine from `start` on.
    pub(crate) fn push_in_substep(&mut self, stepping: &mut Stepping, start: SimTime) {
        let (end, h) = (self.joins.forced_until, self.clock.h);
        for index in core::mem::take(&mut self.joins.pushed) {
            if !self.bodies.is_alive(index) {
                continue;
            }
            let is_engines = self.is_engines(index);
            let acts = self.bodies.get_mut(index).uncommon_mut();
            if !is_engines {
                // It fell asleep.
                acts.owed = (Vec2::ZERO, 0.0);
                continue;
            }
            acts.act(start, end, h);
            if acts.force != Vec2::ZERO || acts.torque != 0.0 {
                self.joins.pushed.insert(index);
            }
            stepping.pull_one(&self.bodies, index);
        }
    }
}
