//! What a caller changes of a body that is there, beside where and how it moves: all that it was inserted with; and of the world's
//! settings.
//!
//! Each change of a body goes one way: the body leaves what holds it and all its pairs, is altered, and arrives as if it were new.

use carom_geometry::Shape;
use carom_math::Vec2;

use super::world::check_shapes;
use crate::store::mass::{mass_of, reach_of};
use crate::store::state::BodyState;
use crate::values::error::{check_finite, check_positive, check_vec2};
use crate::{
    BodyDef, BodyError, BodyId, BodyIx, ColliderIx, Material, Settings, SettingsError, World,
};

impl World {
    /// Changes the surface of one shape: friction, restitution, speed of its belt. Shapes count from 0 in the order of insertion.
    ///
    /// The body's mass stays, whatever the density: see [`Self::set_mass`].
    ///
    /// # Errors
    /// If the body or the shape is not there, or a number is out of its range.
    pub fn set_material(
        &mut self,
        id: BodyId,
        shape: usize,
        material: Material,
    ) -> Result<(), BodyError> {
        material.check()?;
        let at = self.collider_of(id, shape)?;
        self.bodies.colliders[at].set_material(material);
        self.remake(id.index, |_| {});
        Ok(())
    }

    /// Changes a body's mass (kg) and moment of inertia about its centre of mass (kg·m²); that centre and the velocities stay.
    ///
    /// # Errors
    /// If the body is not there, or a number is not finite, not above 0 or too large.
    pub fn set_mass(&mut self, id: BodyId, mass: f64, inertia: f64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        BodyDef::dynamic()
            .with_mass(mass)
            .with_inertia(inertia)
            .check()?;
        self.remake(index, |state| {
            (state.mass.mass, state.mass.inertia) = (mass, inertia);
            state.set_kind(state.kind);
        });
        Ok(())
    }

    /// Changes how gravity and fields act on a body, as a factor.
    ///
    /// # Errors
    /// If the body is not there or the number is not finite.
    pub fn set_gravity_scale(&mut self, id: BodyId, scale: f64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_finite("gravity_scale", scale)?;
        self.remake(index, |state| state.uncommon_mut().gravity_scale = scale);
        Ok(())
    }

    /// Locks or frees a body's rotation; one that is locked stops turning.
    ///
    /// # Errors
    /// If the body is not there, or a dynamic one without a moment of inertia would turn.
    pub fn set_locked_rotation(&mut self, id: BodyId, locked: bool) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        let state = self.bodies.get(index);
        if !locked && state.is_dynamic() {
            check_positive("inertia", state.mass.inertia)?;
        }
        self.remake(index, |state| {
            state.locked_rotation = locked;
            if locked {
                state.motion.spin = 0.0;
            }
            state.set_kind(state.kind);
        });
        Ok(())
    }

    /// Allows or forbids a body to fall asleep: see [`BodyDef::sleep_allowed`]. Where it is forbidden, a sleeper wakes with all that
    /// sleeps in touch with it. What is so already changes nothing.
    ///
    /// # Errors
    /// If the body is not there.
    pub fn set_sleep_allowed(&mut self, id: BodyId, allowed: bool) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        if self.bodies.get(index).sleep_allowed() != allowed {
            self.remake(index, |state| state.uncommon_mut().sleep_allowed = allowed);
        }
        Ok(())
    }

    /// Changes a body's tag, which is the caller's own.
    ///
    /// # Errors
    /// If the body is not there.
    pub fn set_tag(&mut self, id: BodyId, tag: u64) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        self.bodies.get_mut(index).tag = tag;
        Ok(())
    }

    /// Gives a body other shapes. Its frame stays where it is and its motion as a rigid body stays; mass, centre of mass and
    /// moment of inertia are those of the new shapes, whatever [`BodyDef`] said of the old ones. All of them get the filter of
    /// the first old one.
    ///
    /// # Errors
    /// As [`World::insert_compound`], and if the body is not there. The body keeps its shapes then.
    pub fn set_shapes(
        &mut self,
        id: BodyId,
        shapes: Vec<(Shape, Material)>,
    ) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        check_shapes(&shapes)?;
        let state = self.bodies.get(index);
        let mut def = BodyDef::new(state.kind);
        def.locked_rotation = state.locked_rotation;
        let mass = mass_of(&def, &shapes)?;
        let reach = reach_of(&shapes, mass.centroid);
        let filter = self.bodies.colliders[state.colliders[0]].surface.filter;
        self.leave_all(index);
        self.broad.forget(&mut self.bodies, index);
        self.free_shapes(index);
        self.add_shapes(index, shapes, filter, mass.centroid);
        self.remake(index, |state| {
            let moved = state.motion.rotation * (mass.centroid - state.mass.centroid);
            state.motion.centre += moved;
            state.motion.velocity += state.motion.spin * carom_math::perp(moved);
            (state.mass, state.reach) = (mass, reach);
            state.set_kind(state.kind);
        });
        Ok(())
    }

    /// Changes all settings at once. Where bodies may move otherwise by it, whatever sleeps wakes, and motions are predicted anew from
    /// now on. A change of `work`, `history`, `events` and `threads` alone moves nothing; but in stepped mode last digits depend on
    /// whether there is a history. Equal settings change nothing.
    ///
    /// `mode`, `tick`, `substep` and `pair_search` are those that the world was made with.
    ///
    /// # Errors
    /// As [`World::new`], and [`SettingsError::Fixed`] with the names of all fields that differ and cannot. The world is as it was
    /// then.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{Mode, Settings, SettingsError, World};
    /// use carom_math::vec2;
    /// let mut world = World::new(Settings::default())?;
    /// let moon = vec2(0.0, -1.62);                                 // m/s²
    /// world.set_settings(Settings { gravity: moon, sleep: None, ..*world.settings() })?;
    /// assert_eq!(world.settings().gravity, moon);
    /// let refused = world.set_settings(Settings { mode: Mode::Exact, ..*world.settings() });
    /// assert_eq!(refused, Err(SettingsError::Fixed { fields: vec!["mode"] }));
    /// # Ok::<(), SettingsError>(())
    /// ```
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check()?;
        let fields = self.settings.fixed_in(&settings);
        if !fields.is_empty() {
            return Err(SettingsError::Fixed { fields });
        }
        let old = core::mem::replace(&mut self.settings, settings);
        self.events.set_capacity(settings.events);
        if settings.history != old.history {
            self.bodies
                .history
                .set_capacity(settings.history, self.clock.now);
        }
        if !settings.moves_as(&old) {
            self.change_pull(|pull| {
                pull.gravity = settings.gravity;
                pull.error = settings.field_error;
            });
        }
        // All that slept is awake, and was told of.
        if let Some(stepping) = &mut self.stepping {
            stepping.set_settings(&old, &settings);
        }
        Ok(())
    }

    /// Changes the gravity of the whole world, in m/s². Whatever sleeps wakes.
    ///
    /// # Errors
    /// If a component is not finite or beyond [`WORLD_LIMIT`](crate::WORLD_LIMIT).
    pub fn set_gravity(&mut self, gravity: Vec2) -> Result<(), BodyError> {
        check_vec2("gravity.x", "gravity.y", gravity)?;
        self.settings.gravity = gravity;
        self.change_pull(|pull| pull.gravity = gravity);
        Ok(())
    }

    /// Wakes a body and all that sleeps in touch with it; one that rests falls asleep again in its time.
    ///
    /// # Errors
    /// If the body is not there.
    pub fn wake_up(&mut self, id: BodyId) -> Result<(), BodyError> {
        let index = self.bodies.find(id)?;
        if self.bodies.get(index).is_asleep() {
            self.wake_around(index, self.clock.now);
        }
        Ok(())
    }

    /// Takes a body out of all that holds it, alters it, and lets it arrive as if it were new.
    pub(crate) fn remake(&mut self, index: BodyIx, change: impl FnOnce(&mut BodyState)) {
        self.leave_all(index);
        self.alter(index, change);
        // Pairs are made by kind and surface: boxes that are new find them anew.
        self.broad.forget(&mut self.bodies, index);
        self.arrive(index);
        self.unsettle_on(index, self.clock.now);
        self.bodies.check_regime(index, self.settings.mode);
    }

    /// Takes a body out of the engine and all its pairs.
    fn leave_all(&mut self, index: BodyIx) {
        let now = self.clock.now;
        self.leave(index, now);
        self.wake_around(index, now);
        for place in self.bodies.get(index).pairs.clone() {
            self.part(place, now);
        }
    }

    /// Place of a body's shape among all shapes.
    pub(crate) fn collider_of(&self, id: BodyId, shape: usize) -> Result<ColliderIx, BodyError> {
        let index = self.bodies.find(id)?;
        let shapes = &self.bodies.get(index).colliders;
        shapes.get(shape).copied().ok_or(BodyError::NoSuchShape {
            body: id,
            shape,
            count: shapes.len(),
        })
    }
}
