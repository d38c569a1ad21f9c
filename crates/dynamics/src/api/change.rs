//! What a caller changes: places, velocities, kinds, impulses, forces, fields.
//!
//! Every change counts as energy brought in from outside, wakes what touches the body, and has all
//! that was predicted for it predicted anew.

use std::sync::Arc;

use carom_collision::contacts;
use carom_math::{Pose, SimTime, Vec2};

use crate::events::free::FreeBodies;
use crate::motion::flight::fly;
use crate::stepping::{accepted, is_blow};
use crate::store::course::Course;
use crate::store::pull::Pull;
use crate::store::state::BodyState;
use crate::values::error::{check_finite, check_positive, check_vec2};
use crate::{
    BodyDef, BodyError, BodyId, BodyIx, BodyKind, Field, Filter, Force, Impulse, Mode, World,
};

impl World {
    /// Places a body's frame anew; its velocity stays.
    ///
    /// # Errors
    /// If the body is not there or a number is not finite.
    pub fn teleport(&mut self, id: BodyId, pose: Pose) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_pose(pose)?;
        self.disturb(index, |state| {
            let turned = (pose.rotation * state.motion.rotation.inverse()).angle();
            state.motion.rotation = pose.rotation;
            state.motion.centre = pose.point(state.mass.centroid);
            state.turned += turned;
        });
        Ok(())
    }

    /// Sets the velocity of the centre of mass (m/s) and the angular velocity (rad/s).
    ///
    /// Fixed bodies stay at rest, locked rotations do not turn.
    ///
    /// # Errors
    /// If the body is not there or a number is not finite.
    pub fn set_velocity(&mut self, id: BodyId, velocity: Vec2, spin: f64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_vec2("velocity.x", "velocity.y", velocity)?;
        check_finite("spin", spin)?;
        let (pull, twist) = self.bodies.freely(index, self.clock.now);
        self.disturb(index, |state| {
            let in_engine = state.in_engine();
            let motion = &mut state.motion;
            if in_engine && is_blow(motion.acceleration - pull, pull) {
                // The rest of a blow of this sub-step is not for the velocity that it has now.
                (motion.acceleration, motion.angular_acceleration) = (pull, twist);
            }
            if state.kind != BodyKind::Fixed {
                motion.velocity = velocity;
                motion.spin = if state.locked_rotation { 0.0 } else { spin };
            }
        });
        Ok(())
    }

    /// Gives a kinematic body the velocity and spin that bring its frame to `pose` in `seconds`, by the shorter
    /// turn. It keeps them: on its way from pose to pose it is told anew at each.
    ///
    /// # Errors
    /// If the body is not there or not kinematic, a number is not finite, or `seconds` is not above 0.
    pub fn drive_to(&mut self, id: BodyId, pose: Pose, seconds: f64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_pose(pose)?;
        check_finite("seconds", seconds)?;
        check_positive("seconds", seconds)?;
        let state = self.bodies.get(index);
        if state.kind != BodyKind::Kinematic {
            return Err(BodyError::NotKinematic(id));
        }
        let now = self.clock.now;
        let way = pose.point(state.mass.centroid) - state.centre_at(now);
        let turn = (pose.rotation * state.rotation_at(now).inverse()).angle();
        let turn = if state.locked_rotation { 0.0 } else { turn };
        self.set_velocity(id, way / seconds, turn / seconds)
    }

    /// Changes what moves a body; one of that kind already goes on as it does.
    ///
    /// # Errors
    /// If the body is not there, it would move by forces but has no mass, or it would move and has a
    /// half-plane among its shapes.
    pub fn set_kind(&mut self, id: BodyId, kind: BodyKind) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let state = self.bodies.get(index);
        if kind == state.kind {
            return Ok(());
        }
        if kind != BodyKind::Fixed {
            let shapes = state.colliders.iter();
            let mut solids = shapes.map(|at| &self.bodies.colliders[*at].solid);
            if let Some(shape) = solids.position(|solid| !solid.is_bounded()) {
                return Err(BodyError::HalfPlaneMoves { shape });
            }
        }
        if kind == BodyKind::Dynamic {
            check_positive("mass", state.mass.mass)?;
            if !state.locked_rotation {
                check_positive("inertia", state.mass.inertia)?;
            }
        }
        self.remake(index, |state| state.set_kind(kind));
        Ok(())
    }

    /// Changes the collision filter of all shapes of a body.
    ///
    /// # Errors
    /// If the body is not there.
    pub fn set_filter(&mut self, id: BodyId, filter: Filter) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        for &at in &self.bodies.get(index).colliders.clone() {
            self.bodies.colliders[at].set_filter(filter);
        }
        self.remake(index, |_| {});
        Ok(())
    }

    /// Changes the collision filter of one shape of a body; shapes count from 0 in the order of insertion.
    ///
    /// # Errors
    /// If the body or the shape is not there.
    pub fn set_shape_filter(
        &mut self,
        id: BodyId,
        shape: usize,
        filter: Filter,
    ) -> Result<(), BodyError> {
        let at = self.collider_of(id, shape)?;
        self.bodies.colliders[at].set_filter(filter);
        self.remake(id.index, |_| {});
        Ok(())
    }

    /// Applies an impulse at once: `v += J/m`, `ω += (r × J)/I`. No effect on infinite masses.
    ///
    /// # Errors
    /// If the body is not there, a number is not finite, or the body would be faster than [`WORLD_LIMIT`](crate::WORLD_LIMIT).
    pub fn apply(&mut self, id: BodyId, impulse: Impulse) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let impulse = impulse.checked()?;
        let (now, state) = (self.clock.now, self.bodies.get(index));
        let angular = impulse.about(state.centre_at(now));
        let velocity = state.velocity_at(now) + impulse.linear * state.inverse_mass;
        check_vec2("velocity.x", "velocity.y", velocity)?;
        check_finite("spin", state.spin_at(now) + angular * state.inverse_inertia)?;
        self.disturb(index, |state| {
            let angular = impulse.about(state.motion.centre);
            state.motion.velocity += impulse.linear * state.inverse_mass;
            state.motion.spin += angular * state.inverse_inertia;
        });
        Ok(())
    }

    /// Adds a force that acts during the next step (of any length above 0) and is gone after it.
    ///
    /// Of bodies in contact that the engine moves, a step that ends within a sub-step leaves what is not known where that begins to the
    /// next one.
    ///
    /// # Errors
    /// If the body is not there, a number is not finite, or all its forces would accelerate the body by more than
    /// [`WORLD_LIMIT`](crate::WORLD_LIMIT), in m/s² and rad/s².
    pub fn apply_force(&mut self, id: BodyId, force: Force) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let force = force.checked()?;
        let now = self.clock.now;
        let state = self.bodies.get(index);
        let (linear, torque) = state.uncommon().pending;
        let all = (
            linear + force.linear,
            torque + force.about(state.centre_at(now)),
        );
        check_vec2(
            "acceleration.x",
            "acceleration.y",
            all.0 * state.inverse_mass,
        )?;
        check_finite("angular acceleration", all.1 * state.inverse_inertia)?;
        self.wake_around(index, now);
        self.bodies.get_mut(index).uncommon_mut().pending = all;
        if !self.forced.contains(&index) {
            self.forced.push(index);
        }
        Ok(())
    }

    /// Changes what velocity and spin of a body lose by themselves, in 1/s, as by
    /// [`BodyDef::damped`](crate::BodyDef::damped).
    ///
    /// # Errors
    /// If the body is not there, a number is not finite or below 0.
    pub fn set_damping(&mut self, id: BodyId, linear: f64, angular: f64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        BodyDef::dynamic().damped(linear, angular).check()?;
        let change = |state: &mut BodyState| state.uncommon_mut().damping = (linear, angular);
        if self.settings.mode == Mode::Stepped || self.bodies.get(index).in_engine() {
            self.remake(index, change);
        } else {
            self.disturb(index, change);
        }
        Ok(())
    }

    /// Adds a field that all dynamic bodies feel from now on.
    pub fn add_field(&mut self, field: impl Field + 'static) {
        self.change_fields(|fields| fields.push(Arc::new(field)));
    }

    /// Takes all fields away.
    pub fn clear_fields(&mut self) {
        self.change_fields(Vec::clear);
    }

    fn change_fields(&mut self, change: impl FnOnce(&mut Vec<Arc<dyn Field>>)) {
        self.change_pull(|pull| change(&mut pull.fields));
    }

    /// Changes what pulls at all bodies; what it adds to their potential energy is brought in from outside.
    pub(crate) fn change_pull(&mut self, change: impl FnOnce(&mut Pull)) {
        let now = self.clock.now;
        let all: Vec<BodyIx> = self.bodies.indices().collect();
        for &index in &all {
            // No closed form holds in other fields than it was found in.
            let group = self.bodies.get(index).membership.group;
            self.dissolve(group, now);
            self.bodies.change(index, now, |_| {});
        }
        let before = self.bodies.ledger(now).potential;
        let members_before = self.potential_of_members();
        let gravity = self.bodies.pull.gravity;
        change(&mut self.bodies.pull);
        let after = self.bodies.ledger(now).potential;
        self.bodies.book.external.add(after - before);
        let brought = self.potential_of_members() - members_before;
        self.joins.balance.add(-brought);
        if self.bodies.pull.gravity != gravity {
            // Bodies in flight look for each other in a frame that falls with them.
            for &index in &all {
                self.free.vanish(&mut self.bodies, index);
            }
            self.free = FreeBodies::under(self.bodies.pull.gravity);
        }
        if let Some(stepping) = &mut self.stepping {
            accepted(stepping.engine.set_gravity(self.bodies.pull.gravity));
        }
        for index in all {
            if !self.bodies.get(index).in_engine() {
                self.arrive(index);
            }
            if self.bodies.get(index).is_asleep() {
                self.wake(index, now);
            }
        }
    }

    /// A caller's change of a body: its energy counts as brought in from outside, sleepers that
    /// touch it wake, and what was predicted for it is predicted anew.
    pub(crate) fn disturb(&mut self, index: BodyIx, change: impl FnOnce(&mut BodyState)) {
        self.alter(index, change);
        self.unsettle_on(index, self.clock.now);
        self.bodies.check_regime(index, self.settings.mode);
    }

    /// [`Self::disturb`], but for what rests on the body: it is not yet where its pairs are made.
    pub(crate) fn alter(&mut self, index: BodyIx, change: impl FnOnce(&mut BodyState)) {
        let now = self.clock.now;
        self.wake_around(index, now);
        let before = self.bodies.energy_of(index, now);
        self.bodies.change(index, now, |_| {});
        change(self.bodies.get_mut(index));
        let after = self.bodies.energy_of(index, now);
        let brought = after - before;
        self.bodies.book.external.add(brought);
        if self.bodies.get(index).in_engine() {
            self.joins.balance.add(-brought);
        }
        self.deflected(index, now);
        self.drop_unheld(&[index], now);
    }

    /// Wakes sleepers on a kinematic body with a new motion, and solves for the modes of analytic islands on it anew.
    ///
    /// A kinematic body has no pairs with what sleeps: it is looked for by boxes.
    ///
    /// A fixed body that was put into sleepers wakes them; what sleeps beside it sleeps on.
    pub(crate) fn unsettle_on(&mut self, index: BodyIx, time: SimTime) {
        if self.settings.mode == Mode::Stepped {
            // The engine wakes the sleepers that it was put into.
            return;
        }
        let drives = match self.bodies.get(index).kind {
            BodyKind::Dynamic => return,
            BodyKind::Kinematic => true,
            BodyKind::Fixed => false,
        };
        let mut around: Vec<BodyIx> = Vec::new();
        for place in &self.bodies.get(index).pairs {
            let pair = self.pairs.get(*place);
            if pair.touching {
                around.extend([pair.bodies.0, pair.bodies.1]);
            }
        }
        let mut found = Vec::new();
        let state = self.bodies.get(index);
        for at in &state.colliders {
            let mine = &self.bodies.colliders[*at];
            let pose = state.motion.pose_at(time);
            for other in self.broad.in_tree(&self.bodies, mine.solid.aabb(pose)) {
                let theirs = &self.bodies.colliders[other];
                let partner = self.bodies.get(theirs.body);
                if !partner.is_asleep() || !self.broad.may_touch(&self.bodies, (*at, other)) {
                    continue;
                }
                // What fell asleep on it may have sunk in, or hover within the solver's margin.
                let size = partner.reach.min(state.reach);
                let touch = if drives { 1e-3 } else { -1e-3 } * size;
                let seen = partner.motion.pose_at(time).seen_from(pose);
                found.clear();
                contacts(&mine.solid, &theirs.solid, seen, touch.max(0.0), &mut found);
                let depths = found.iter().filter_map(|part| part.manifold.deepest());
                if depths.fold(f64::INFINITY, f64::min) <= touch {
                    around.push(theirs.body);
                }
            }
        }
        around.sort_unstable();
        around.dedup();
        for other in around {
            if self.bodies.get(other).is_asleep() {
                self.wake(other, time);
            }
            self.solve_modes_anew(other, time, None);
        }
    }

    /// A body that is new where it is: it gets its flight, its boxes and its pairs.
    pub(crate) fn arrive(&mut self, index: BodyIx) {
        let (now, mode) = (self.clock.now, self.settings.mode);
        if mode == Mode::Stepped {
            self.bodies.touch(index);
            self.bodies.get_mut(index).arrive(mode);
            self.show_engine(index);
            return self.deflected(index, now);
        }
        self.leave(index, now);
        self.show_engine(index);
        self.hand_back_of(index, now);
        self.free.vanish(&mut self.bodies, index);
        self.end_unsettled(index);
        let state = self.bodies.get_mut(index);
        state.course = Course::default();
        // A law goes on from piece to piece: without a piece there is none.
        state.flight = None;
        state.set_piece(SimTime::NEVER);
        let sleeps = state.is_asleep();
        if !sleeps {
            state.arrive(mode);
        }
        let (moves, is_dynamic) = (state.kind != BodyKind::Fixed, state.is_dynamic());
        if moves {
            self.joins.note_flight(&self.bodies, index);
        }
        if is_dynamic && !self.bodies.bends(index) {
            fly(&mut self.bodies, index, now);
        }
        // It flies once all that sleeps with it is awake.
        if sleeps {
            let mut woken = self.woken_with(index, now);
            woken.retain(|other| *other != index);
            self.bodies.get_mut(index).arrive(mode);
            self.resume_woken(&woken, now);
        }
        self.deflected(index, now);
    }
}

fn check_pose(pose: Pose) -> Result<(), BodyError> {
    check_vec2("position.x", "position.y", pose.position)?;
    check_finite("rotation", pose.rotation.angle())
}
