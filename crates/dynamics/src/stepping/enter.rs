//! What a caller changed enters the engine before the next sub-step.

use std::sync::Arc;

use carom_collision::part_count;
use carom_math::{Pose, SimTime, Vec2};
use carom_stepped::{BodyInput, PieceInput};

use super::{Stepping, place};
use crate::store::state::BodyState;
use crate::{BodyKind, Mode, World};

/// A place that differs by less, as a part of the reach, is the same but for rounding: what was only looked at stays.
const SAME: f64 = 1e-12;

/// A body that was put farther away than this part of its reach leaves its contacts behind.
const FAR: f64 = 0.05;

impl World {
    /// Enters bodies that came or were changed, before the sub-step from `time` on. Bodies that this wakes are reported at `told`.
    pub(super) fn enter_changed(&mut self, stepping: &mut Stepping, time: SimTime, told: SimTime) {
        let mut touched = core::mem::take(&mut self.bodies.touched);
        touched.sort_unstable();
        touched.dedup();
        for &index in &touched {
            if !self.bodies.is_alive(index) {
                continue;
            }
            match (stepping.id(index), self.belongs(index)) {
                (Some(id), true) => self.tell_engine(stepping, index, id, time),
                (None, true) => self.enter(stepping, index, time),
                (Some(_), false) => stepping.remove(index),
                (None, false) => {}
            }
        }
        touched.clear();
        self.bodies.touched = touched;
        self.tell_sleep(stepping, told);
        self.stopwatch.lap(|p| &mut p.pairs);
    }

    /// Whether the engine is to know a body; one that does not belong to it any more is no guest.
    fn belongs(&mut self, index: u32) -> bool {
        let state = self.bodies.get_mut(index);
        state.is_guest &= state.rests_or_drives() && !state.in_engine();
        self.settings.mode == Mode::Stepped || state.in_engine() || state.is_guest
    }

    pub(super) fn enter(&mut self, stepping: &mut Stepping, index: u32, time: SimTime) {
        let state = self.bodies.get(index);
        // A body that joined within a sub-step waited there.
        let at = if state.in_engine() {
            state.motion.start
        } else {
            time
        };
        let input = input_of(state, at);
        let pieces: Vec<_> = state
            .colliders
            .iter()
            .map(|at| {
                let solid = Arc::clone(&self.colliders[*at as usize].solid);
                PieceInput::shared(solid).tagged(u64::from(*at))
            })
            .collect();
        // All numbers were checked where they entered the world.
        let Ok(id) = stepping.engine.insert(input, &pieces) else {
            return;
        };
        // However it turns, its box is no wider than the diagonal of this one.
        let widths = state
            .colliders
            .iter()
            .map(|at| &self.colliders[*at as usize].solid)
            .filter(|solid| part_count(solid) > 1)
            .map(|solid| solid.aabb(Pose::IDENTITY).extents().length());
        stepping.widest = widths.fold(stepping.widest, f64::max);
        let at = index as usize;
        if stepping.ids.len() <= at {
            stepping.ids.resize(at + 1, None);
        }
        stepping.ids[at] = Some(id);
        let (pull, twist) = self.pull_on(index, state.centre_at(time));
        let told = stepping.engine.set_pull(id, pull, twist);
        debug_assert!(told.is_ok(), "{told:?}");
        if self.bodies.get(index).is_asleep() {
            let told = stepping.engine.sleep(id);
            debug_assert!(told.is_ok(), "{told:?}");
        }
    }

    /// Takes over velocity, place and pull.
    fn tell_engine(
        &mut self,
        stepping: &mut Stepping,
        index: u32,
        id: carom_stepped::BodyId,
        time: SimTime,
    ) {
        let state = self.bodies.get(index);
        let Ok(known) = stepping.engine.state(id) else {
            return;
        };
        if !state.is_asleep() && stepping.engine.is_asleep(id) == Ok(true) {
            let told = stepping.engine.wake(id);
            debug_assert!(told.is_ok(), "{told:?}");
        }
        let frame = state.centre_pose(time);
        let motion = (state.velocity_at(time), state.spin_at(time));
        let d = frame.position - known.pose.position;
        let turn = (frame.rotation * known.pose.rotation.inverse()).angle();
        let reach = state.reach.min(1e9);
        let off = d.length() + turn.abs() * reach;
        let engine = &mut stepping.engine;
        let mut told = Ok(());
        if state.kind == BodyKind::Fixed {
            // It may reach without end: any move counts.
            if frame != known.pose {
                told = told.and(engine.set_pose(id, frame));
            }
        } else if off > FAR * reach {
            told = told.and(engine.set_pose(id, frame));
        } else if off > SAME * (reach + frame.position.length()) {
            told = told.and(engine.shift(id, frame));
        }
        told = told.and(engine.set_turned(id, state.turned + state.turn_by(time)));
        if motion != known.velocity && state.kind != BodyKind::Fixed {
            told = told.and(engine.set_velocity(id, motion.0, motion.1));
        }
        let (pull, twist) = self.pull_on(index, frame.position);
        told = told.and(engine.set_pull(id, pull, twist));
        debug_assert!(told.is_ok(), "{told:?}");
    }

    /// A body that goes, or comes back as another one, leaves the engine; whether it was there: then its touches end, and sleepers
    /// on it wake, which is for the caller to see to.
    pub(super) fn leave_engine(&mut self, index: u32, time: SimTime) -> bool {
        let Some(mut stepping) = self.stepping.take() else {
            return false;
        };
        let known = stepping.id(index).is_some();
        if known {
            stepping.remove(index);
            self.tell_sleep(&mut stepping, time);
        }
        self.stepping = Some(stepping);
        self.bodies.get_mut(index).is_guest = false;
        known
    }

    /// What accelerates a body at a place besides contacts and damping, in m/s² and rad/s²; a field that is not finite there
    /// accelerates nothing.
    pub(super) fn pull_on(&self, index: u32, centre: Vec2) -> (Vec2, f64) {
        let state = self.bodies.get(index);
        if !state.is_dynamic() {
            return (Vec2::ZERO, 0.0);
        }
        let pull = state.gravity_scale() * self.bodies.pull.at(centre)
            + state.force() * state.inverse_mass;
        let pull = if pull.is_finite() { pull } else { Vec2::ZERO };
        (pull, state.torque() * state.inverse_inertia)
    }

    /// Pulls of the sub-step that begins at `time`; the work of forces since motions were last written is booked.
    pub(super) fn book_pulls(&mut self, stepping: &mut Stepping, time: SimTime, first: bool) {
        for k in 0..self.forced.len() {
            let index = self.forced[k];
            if !first && let Some(state) = stepping.state(index) {
                self.write_one(stepping, &state, self.clock.last());
            }
            self.bodies.change(index, time, |_| {});
        }
        self.bodies.touched.clear();
        self.pull_members(stepping);
    }

    /// What fields do to bodies where they are.
    pub(super) fn pull_members(&self, stepping: &mut Stepping) {
        if !self.bodies.pull.fields.is_empty() {
            let pulls: Vec<_> = (stepping.engine.awake())
                .map(|state| (state.id, self.pull_on(place(&state), state.pose.position)))
                .collect();
            for (id, (pull, twist)) in pulls {
                let told = stepping.engine.set_pull(id, pull, twist);
                debug_assert!(told.is_ok(), "{told:?}");
            }
        }
    }
}

/// A body as the engine takes it.
fn input_of(state: &BodyState, time: SimTime) -> BodyInput {
    let kind = match state.kind {
        BodyKind::Fixed => carom_stepped::BodyKind::Fixed,
        BodyKind::Kinematic => carom_stepped::BodyKind::Kinematic,
        BodyKind::Dynamic => carom_stepped::BodyKind::Dynamic,
    };
    let mut input = BodyInput::new(kind);
    input.pose = Pose::new(state.centre_at(time), state.rotation_at(time));
    (input.velocity, input.spin) = (state.velocity_at(time), state.spin_at(time));
    if state.is_dynamic() {
        input.mass = state.mass.mass;
        input.inertia = if state.inverse_inertia > 0.0 {
            state.mass.inertia
        } else {
            f64::INFINITY
        };
    }
    let (linear, angular) = state.damping();
    input.turned = state.turned + state.turn_by(time);
    input.damping = [linear, angular];
    input.gravity_scale = state.gravity_scale();
    input.sleep_allowed = state.sleep_allowed();
    input.tag = u64::from(state.id.index);
    // Bodies join, and guests are invited, when they are near.
    input.order = Some(input.tag);
    input
}
