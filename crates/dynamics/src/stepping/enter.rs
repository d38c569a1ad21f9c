//! What a caller changed enters the engine before the next sub-step.

use std::collections::BTreeSet;
use std::sync::Arc;

use carom_collision::part_count;
use carom_math::{Pose, SimTime, Vec2};
use carom_stepped::{BodyId, BodyInput, PieceInput, State};

use super::{Stepping, accepted, place};
use crate::store::bodies::Bodies;
use crate::store::clock::Clock;
use crate::store::state::BodyState;
use crate::{BodyIx, BodyKind, Ix, Mode};

/// A place that differs by less, as a part of the reach, is the same but for rounding: what was only looked at stays.
const SAME: f64 = 1e-12;

/// A body that was put farther away than this part of its reach, and than it goes within a sub-step, leaves its contacts behind.
const FAR: f64 = 0.05;

impl Stepping {
    /// Enters bodies that came or were changed, before the sub-step from `time` on.
    pub(crate) fn enter_changed(&mut self, bodies: &mut Bodies, mode: Mode, time: SimTime) {
        let mut touched = core::mem::take(&mut bodies.touched);
        touched.sort_unstable();
        touched.dedup();
        for &index in &touched {
            if !bodies.is_alive(index) {
                continue;
            }
            match (self.id(index), belongs(bodies.get_mut(index), mode)) {
                (Some(id), true) => self.tell(bodies, index, id, time),
                (None, true) => self.enter(bodies, index, time),
                (Some(_), false) => self.remove(index),
                (None, false) => {}
            }
        }
        touched.clear();
        bodies.touched = touched;
    }

    pub(super) fn enter(&mut self, bodies: &Bodies, index: BodyIx, time: SimTime) {
        let state = bodies.get(index);
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
                let solid = Arc::clone(&bodies.colliders[*at].solid);
                PieceInput::shared(solid).tagged(u64::from(at.number()))
            })
            .collect();
        // All numbers were checked where they entered the world.
        let Ok(id) = self.engine.insert(input, &pieces) else {
            return;
        };
        // However it turns, its box is no wider than the diagonal of this one.
        let widths = state
            .colliders
            .iter()
            .map(|at| &bodies.colliders[*at].solid)
            .filter(|solid| part_count(solid) > 1)
            .map(|solid| solid.aabb(Pose::IDENTITY).extents().length());
        self.widest = widths.fold(self.widest, f64::max);
        *self.ids.grown(index, None) = Some(id);
        self.set_pull(bodies, (index, id), state.centre_at(time));
        if bodies.get(index).is_asleep() {
            accepted(self.engine.sleep(id));
        }
    }

    /// Takes over velocity, place and pull.
    fn tell(&mut self, bodies: &Bodies, index: BodyIx, id: BodyId, time: SimTime) {
        let state = bodies.get(index);
        let Ok(known) = self.engine.state(id) else {
            return;
        };
        if !state.is_asleep() && self.engine.is_asleep(id) == Ok(true) {
            accepted(self.engine.wake(id));
        }
        let frame = state.centre_pose(time);
        let [_, lack] = known.lack.unwrap_or_default();
        let motion = (
            state.velocity_at(time) + lack.0,
            state.spin_at(time) + lack.1,
        );
        let d = frame.position - known.pose.position;
        let turn = (frame.rotation * known.pose.rotation.inverse()).angle();
        let reach = state.reach.min(1e9);
        let size = |(way, turn): (Vec2, f64)| way.length() + turn.abs() * reach;
        let off = size((d, turn));
        let goes = (size(motion) + size(known.velocity)) * self.engine.settings().substep();
        let engine = &mut self.engine;
        if state.kind == BodyKind::Fixed {
            // It may reach without end: any move counts.
            if frame != known.pose {
                accepted(engine.set_pose(id, frame));
            }
        } else if off > FAR * reach + goes {
            accepted(engine.set_pose(id, frame));
        } else if off > SAME * (reach + frame.position.length()) {
            accepted(engine.shift(id, frame));
        }
        accepted(engine.set_turned(id, state.turned_at(time)));
        if motion != known.velocity && state.kind != BodyKind::Fixed {
            accepted(engine.set_velocity(id, motion.0, motion.1));
        }
        self.set_pull(bodies, (index, id), frame.position);
    }

    /// What pulls a body at a place, from now on.
    fn set_pull(&mut self, bodies: &Bodies, (index, id): (BodyIx, BodyId), at: Vec2) {
        let (pull, twist) = bodies.pull_on(index, at);
        accepted(self.engine.set_pull(id, pull, twist));
    }

    /// Pulls of the sub-step that begins now; the work of `forced` bodies' forces since motions were last written is booked.
    pub(crate) fn book_pulls(
        &mut self,
        bodies: &mut Bodies,
        forced: &BTreeSet<BodyIx>,
        clock: &Clock,
        first: bool,
    ) {
        for &index in forced {
            if !first && let Some(state) = self.state(index) {
                self.write_one(bodies, &state, (clock.last(), clock.h));
            }
            bodies.change(index, clock.next(), |_| {});
        }
        bodies.touched.clear();
        self.pull(bodies);
    }

    /// What pulls a body where it is.
    pub(crate) fn pull_one(&mut self, bodies: &Bodies, index: BodyIx) {
        if let Some(state) = self.state(index) {
            self.set_pull(bodies, (index, state.id), state.pose.position);
        }
    }

    /// What fields do to bodies where they are.
    pub(crate) fn pull(&mut self, bodies: &Bodies) {
        if !bodies.pull.fields.is_empty() {
            let awake: Vec<State> = self.engine.awake().collect();
            for state in awake {
                self.set_pull(bodies, (place(&state), state.id), state.pose.position);
            }
        }
    }
}

/// Whether the engine is to know a body; one that does not belong to it any more is no guest.
fn belongs(state: &mut BodyState, mode: Mode) -> bool {
    state.is_guest &= state.rests_or_drives() && !state.in_engine();
    mode == Mode::Stepped || state.in_engine() || state.is_guest
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
    input.turned = state.turned_at(time);
    input.damping = [linear, angular];
    input.gravity_scale = state.gravity_scale();
    input.sleep_allowed = state.sleep_allowed();
    input.tag = u64::from(state.id.index.number());
    // Bodies join, and guests are invited, when they are near.
    input.order = Some(input.tag);
    input
}
