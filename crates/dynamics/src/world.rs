//! The world: bodies in, bodies out, what the caller changes and reads. No mechanics here.

use std::sync::Arc;

use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime, StateHash, Sum, Vec2, cross};

use crate::agenda::Agenda;
use crate::bodies::Bodies;
use crate::body::{BodyState, Collider, frame_of};
use crate::broad::{Broad, part};
use crate::clock::Clock;
use crate::error::{check_finite, check_vec2};
use crate::flight::fly;
use crate::groups::Groups;
use crate::narrow::Narrow;
use crate::pairs::Pairs;
use crate::sleep::wake_around;
use crate::solver::Law;
use crate::{
    Body, BodyDef, BodyError, BodyId, BodyKind, Contact, EnergyLedger, EventKind, Events, Field,
    Force, Impulse, Material, Momentum, PairMaterial, Settings, SettingsError, StepReport,
};

/// Rigid bodies and the time that passes for them.
///
/// # Examples
/// A ball dropped from 5 m is at half g t² after half a second, whatever the steps.
/// ```
/// use carom_dynamics::{BodyDef, Material, Settings, World};
/// use carom_geometry::Circle;
/// use carom_math::vec2;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = World::new(Settings { gravity: vec2(0.0, -10.0), ..Settings::default() })?;
/// let ball = world.insert(
///     BodyDef::dynamic().at(vec2(0.0, 5.0)),
///     Circle::new(0.1)?,
///     Material::default(),
/// )?;
/// for _ in 0..30 {
///     world.step(1.0 / 60.0);
/// }
/// let height = world.body(ball).ok_or("it is there")?.centre().y;
/// assert!((height - 3.75).abs() < 1e-14);                      // 5 − 10 · 0.5² / 2 m
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) settings: Settings,
    pub(crate) law: Law,
    pub(crate) clock: Clock,
    pub(crate) bodies: Bodies,
    pub(crate) colliders: Vec<Collider>,
    free_colliders: Vec<u32>,
    pub(crate) pairs: Pairs,
    pub(crate) broad: Broad,
    pub(crate) narrow: Narrow,
    pub(crate) groups: Groups,
    pub(crate) agenda: Agenda,
    pub(crate) events: Events,
    pub(crate) report: StepReport,
    /// Impacts that the report counted before the present sub-step.
    pub(crate) impacts_before: u64,
    forced: Vec<u32>,
}

impl World {
    /// An empty world.
    ///
    /// # Errors
    /// If a setting is not finite or out of its range.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.check()?;
        let h = settings.h();
        Ok(Self {
            law: Law::new(&settings.contact, h),
            clock: Clock::new(h),
            bodies: Bodies::new(settings.gravity, settings.history),
            colliders: Vec::new(),
            free_colliders: Vec::new(),
            pairs: Pairs::default(),
            broad: Broad::new(settings.pair_search),
            narrow: Narrow::default(),
            groups: Groups::default(),
            agenda: Agenda::default(),
            events: Events::new(settings.events),
            report: StepReport::default(),
            impacts_before: 0,
            forced: Vec::new(),
            settings,
        })
    }

    /// What the world was told at its start.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Simulated time.
    #[must_use]
    pub const fn time(&self) -> SimTime {
        self.clock.now
    }

    /// Inserts a body of one shape.
    ///
    /// # Errors
    /// If a number is not finite or out of its range, or a moving body has no mass.
    pub fn insert(
        &mut self,
        def: BodyDef,
        shape: impl Into<Shape>,
        material: Material,
    ) -> Result<BodyId, BodyError> {
        self.insert_compound(def, vec![(shape.into(), material)])
    }

    /// Inserts a body of several shapes, each with its own material; their frame is one.
    ///
    /// # Errors
    /// As [`Self::insert`], and if there is no shape.
    pub fn insert_compound(
        &mut self,
        def: BodyDef,
        shapes: Vec<(Shape, Material)>,
    ) -> Result<BodyId, BodyError> {
        def.check()?;
        if shapes.is_empty() {
            return Err(BodyError::NoShape);
        }
        for (_, material) in &shapes {
            material.check()?;
        }
        let id = self.bodies.next_id()?;
        let now = self.clock.now;
        let state = BodyState::new(id, &def, &shapes, now)?;
        let centroid = state.mass.centroid;
        self.bodies.insert(state);
        for (shape, material) in shapes {
            self.add_collider(id.index, shape, material, centroid);
        }
        let (kinetic, potential) = self.bodies.energy_of(id.index, now);
        self.bodies.book.external.add(kinetic + potential);
        self.arrive(id.index);
        Ok(id)
    }

    /// Takes a body out.
    ///
    /// # Errors
    /// If it is not there.
    pub fn remove(&mut self, id: BodyId) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let now = self.clock.now;
        self.bodies.change(index, now, |_| {});
        let (kinetic, potential) = self.bodies.energy_of(index, now);
        self.bodies.book.external.add(-(kinetic + potential));
        wake_around(&mut self.bodies, &self.pairs, index, now, &mut self.events);
        for place in self.bodies.get(index).pairs.clone() {
            self.part(place, now);
        }
        for at in core::mem::take(&mut self.bodies.get_mut(index).colliders) {
            if let Some(node) = self.colliders[at as usize].node.take() {
                self.broad.tree.remove(node);
            }
            self.free_colliders.push(at);
        }
        self.forced.retain(|i| *i != index);
        self.broad
            .overrides
            .retain(|(a, b), _| *a != id && *b != id);
        self.bodies.remove(index);
        Ok(())
    }

    /// A body, read at the world's time; `None` if it is not there.
    #[must_use]
    pub fn body(&self, id: BodyId) -> Option<Body<'_>> {
        let index = self.bodies.find(id).ok()?;
        Some(self.view(self.bodies.get(index)))
    }

    /// All bodies, in order of their places.
    pub fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        self.bodies.iter().map(|state| self.view(state))
    }

    /// All pairs that touch, as of the last sub-step, in order of their shapes.
    pub fn contacts(&self) -> impl Iterator<Item = Contact> + use<'_> {
        let touching = self.pairs.iter().filter(|pair| pair.touching);
        touching.flat_map(|pair| Contact::of(&self.bodies, pair))
    }

    /// Frame of a body's shapes at `time`; `None` if it was not there or the log does not reach.
    ///
    /// Without [`Settings::history`] only instants since the body's last change are known.
    #[must_use]
    pub fn pose_at(&self, id: BodyId, time: SimTime) -> Option<Pose> {
        let state = self.bodies.get(self.bodies.find(id).ok()?);
        if time > self.clock.now {
            return None;
        }
        if time >= state.motion.start {
            return Some(state.pose(time));
        }
        let motion = self.bodies.history.at(id.index, time)?;
        Some(frame_of(motion, state.mass.centroid, time))
    }

    /// Frames of all bodies in the order of [`Self::bodies`]; `poses` is cleared first.
    pub fn poses_into(&self, poses: &mut Vec<Pose>) {
        poses.clear();
        poses.extend(self.bodies.iter().map(|state| state.pose(self.clock.now)));
    }

    /// Box around all bodies, in m; empty if there are none.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bodies()
            .fold(Aabb::EMPTY, |all, body| all.union(body.aabb()))
    }

    /// Places a body's frame anew; its velocity stays.
    ///
    /// # Errors
    /// If the body is not there or a number is not finite.
    pub fn teleport(&mut self, id: BodyId, pose: Pose) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_vec2("position.x", "position.y", pose.position)?;
        check_finite("rotation", pose.rotation.angle())?;
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
        self.disturb(index, |state| {
            if state.kind != BodyKind::Fixed {
                state.motion.velocity = velocity;
                state.motion.spin = if state.locked_rotation { 0.0 } else { spin };
            }
        });
        Ok(())
    }

    /// Changes what moves a body.
    ///
    /// # Errors
    /// If the body is not there, or it would move by forces but has no mass.
    pub fn set_kind(&mut self, id: BodyId, kind: BodyKind) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let state = self.bodies.get(index);
        if kind == BodyKind::Dynamic {
            for (field, value) in [("mass", state.mass.mass), ("inertia", state.mass.inertia)] {
                if value <= 0.0 && !(field == "inertia" && state.locked_rotation) {
                    return Err(BodyError::NotPositive { field, value });
                }
            }
        }
        for place in state.pairs.clone() {
            self.part(place, self.clock.now);
        }
        self.disturb(index, |state| state.set_kind(kind));
        // Pairs are made by kind: boxes that are new find them anew.
        self.forget_boxes(index);
        self.arrive(index);
        Ok(())
    }

    /// Applies an impulse at once: `v += J/m`, `ω += (r × J)/I`. No effect on infinite masses.
    ///
    /// # Errors
    /// If the body is not there or a number is not finite.
    pub fn apply(&mut self, id: BodyId, impulse: Impulse) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        impulse.check()?;
        self.disturb(index, |state| {
            let angular = impulse.about(state.motion.centre);
            state.motion.velocity += impulse.linear * state.inverse_mass;
            state.motion.spin += angular * state.inverse_inertia;
        });
        Ok(())
    }

    /// Adds a force that acts during the next step (of any length above 0) and is gone after it.
    ///
    /// # Errors
    /// If the body is not there or a number is not finite.
    pub fn apply_force(&mut self, id: BodyId, force: Force) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        force.check()?;
        let now = self.clock.now;
        wake_around(&mut self.bodies, &self.pairs, index, now, &mut self.events);
        let state = self.bodies.get_mut(index);
        let torque = force.about(state.motion.centre_at(now));
        state.pending.0 += force.linear;
        state.pending.1 += torque;
        if !self.forced.contains(&index) {
            self.forced.push(index);
        }
        Ok(())
    }

    /// Gives two bodies a friction and restitution of their own, instead of the mixed ones.
    ///
    /// # Errors
    /// If a body is not there, both are one, or a number is out of its range.
    pub fn set_pair_material(
        &mut self,
        a: BodyId,
        b: BodyId,
        material: PairMaterial,
    ) -> Result<(), BodyError> {
        material.check()?;
        let first = self.bodies.find(a)?;
        self.bodies.find(b)?;
        if a == b {
            return Err(BodyError::SameBody(a));
        }
        let key = if a < b { (a, b) } else { (b, a) };
        self.broad.overrides.insert(key, material);
        for place in self.bodies.get(first).pairs.clone() {
            let pair = self.pairs.get_mut(place);
            if pair.bodies == (key.0.index, key.1.index) {
                pair.material = material;
            }
        }
        Ok(())
    }

    /// Adds a field that all dynamic bodies feel from now on.
    pub fn add_field(&mut self, field: impl Field + 'static) {
        let now = self.clock.now;
        let before = self.bodies.ledger(now).potential;
        for index in self.bodies.indices().collect::<Vec<_>>() {
            self.bodies.change(index, now, |_| {});
        }
        self.bodies.pull.fields.push(Arc::new(field));
        let after = self.bodies.ledger(now).potential;
        self.bodies.book.external.add(after - before);
        for index in self.bodies.indices().collect::<Vec<_>>() {
            self.arrive(index);
        }
    }

    /// Where the energy is and where it went.
    #[must_use]
    pub fn energy(&self) -> EnergyLedger {
        self.bodies.ledger(self.clock.now)
    }

    /// Momentum of all dynamic bodies.
    #[must_use]
    pub fn momentum(&self) -> Momentum {
        let mut sums = [Sum::ZERO; 3];
        for body in self
            .bodies()
            .filter(|body| body.kind() == BodyKind::Dynamic)
        {
            let linear = body.mass() * body.velocity();
            let turning = body.state.turning_inertia() * body.angular_velocity();
            sums[0].add(linear.x);
            sums[1].add(linear.y);
            sums[2].add(cross(body.centre(), linear) + turning);
        }
        Momentum {
            linear: Vec2::new(sums[0].value(), sums[1].value()),
            angular: sums[2].value(),
        }
    }

    /// What happened during the last step.
    #[must_use]
    pub const fn events(&self) -> &Events {
        &self.events
    }

    /// Fingerprint of time and all bodies' states: equal runs have equal numbers.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        let mut hash = StateHash::default();
        hash.write_time(self.clock.now);
        for body in self.bodies() {
            let id = body.id();
            hash.write_u64(u64::from(id.index) << 32 | u64::from(id.generation));
            hash.write_vec2(body.centre());
            hash.write_vec2(body.state.motion.rotation_at(self.clock.now).x_axis());
            hash.write_vec2(body.velocity());
            hash.write(body.angular_velocity());
        }
        hash.finish()
    }

    pub(crate) fn view<'w>(&'w self, state: &'w BodyState) -> Body<'w> {
        Body {
            state,
            colliders: &self.colliders,
            now: self.clock.now,
        }
    }

    fn add_collider(&mut self, body: u32, shape: Shape, material: Material, centroid: Vec2) {
        let drawn = Arc::new(shape);
        // A shape drawn about its centre is its own solid.
        let solid = if centroid == Vec2::ZERO {
            Arc::clone(&drawn)
        } else {
            Arc::new(drawn.translated(-centroid))
        };
        let collider = Collider {
            body,
            drawn,
            solid,
            material,
            node: None,
            fat: Aabb::EMPTY,
        };
        let at = if let Some(at) = self.free_colliders.pop() {
            self.colliders[at as usize] = collider;
            at
        } else {
            self.colliders.push(collider);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "fewer than 2^32 fit in memory"
            )]
            let at = (self.colliders.len() - 1) as u32;
            at
        };
        self.bodies.get_mut(body).colliders.push(at);
    }

    /// A caller's change of a body: its energy counts as brought in from outside, sleepers that
    /// touch it wake, and what was predicted for it is predicted anew.
    fn disturb(&mut self, index: u32, change: impl FnOnce(&mut BodyState)) {
        let now = self.clock.now;
        wake_around(&mut self.bodies, &self.pairs, index, now, &mut self.events);
        let before = self.bodies.energy_of(index, now);
        self.bodies.change(index, now, |_| {});
        change(self.bodies.get_mut(index));
        let after = self.bodies.energy_of(index, now);
        self.bodies
            .book
            .external
            .add((after.0 + after.1) - (before.0 + before.1));
        self.deflected(index, now);
    }

    /// A body that is new where it is: it gets its flight, its boxes and its pairs.
    fn arrive(&mut self, index: u32) {
        let now = self.clock.now;
        let left = self.clock.next() - now;
        if left > 0.0 && self.bodies.get(index).is_dynamic() {
            fly(&mut self.bodies, index, now, left);
        }
        self.deflected(index, now);
    }

    fn forget_boxes(&mut self, index: u32) {
        for at in self.bodies.get(index).colliders.clone() {
            if let Some(node) = self.colliders[at as usize].node.take() {
                self.broad.tree.remove(node);
            }
        }
    }

    /// Takes a pair out and says so if it touched.
    pub(crate) fn part(&mut self, place: u32, time: SimTime) {
        let Some(pair) = part(&mut self.bodies, &mut self.pairs, place) else {
            return;
        };
        if pair.touching {
            let (a, b) = (
                self.bodies.get(pair.bodies.0).id,
                self.bodies.get(pair.bodies.1).id,
            );
            self.events.push(time, EventKind::End { a, b });
        }
    }

    /// Stops a body whose numbers are no longer finite where it was last known.
    pub(crate) fn stop(&mut self, index: u32, time: SimTime) {
        let state = self.bodies.get_mut(index);
        let motion = &mut state.motion;
        motion.start = time;
        motion.velocity = Vec2::ZERO;
        motion.acceleration = Vec2::ZERO;
        motion.spin = 0.0;
        motion.angular_acceleration = 0.0;
        if !motion.centre.is_finite() {
            motion.centre = Vec2::ZERO;
        }
        if !motion.rotation.x_axis().is_finite() {
            motion.rotation = carom_math::Rot::IDENTITY;
        }
        state.gravity_scale = 0.0;
        state.version = state.version.wrapping_add(1);
    }

    /// Forces of the step that begins.
    pub(crate) fn begin_forces(&mut self) {
        let now = self.clock.now;
        for &index in &self.forced {
            self.bodies.change(index, now, |_| {});
            let state = self.bodies.get_mut(index);
            (state.force, state.torque) = core::mem::take(&mut state.pending);
            state.motion.acceleration += state.force * state.inverse_mass;
            state.motion.angular_acceleration += state.torque * state.inverse_inertia;
        }
        for index in self.forced.clone() {
            self.deflected(index, now);
        }
    }

    /// Forces last one step.
    pub(crate) fn end_forces(&mut self) {
        let now = self.clock.now;
        let forced = core::mem::take(&mut self.forced);
        for &index in &forced {
            self.bodies.change(index, now, |_| {});
            let state = self.bodies.get_mut(index);
            let (force, torque) = (state.force, state.torque);
            (state.force, state.torque) = (Vec2::ZERO, 0.0);
            state.motion.acceleration -= force * state.inverse_mass;
            state.motion.angular_acceleration -= torque * state.inverse_inertia;
        }
        for index in forced {
            self.deflected(index, now);
        }
    }
}
