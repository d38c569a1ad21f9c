//! A body as a caller sees it.

use carom_collision::Motion;
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, SimTime, Vec2};

use crate::store::slots::List;
use crate::store::state::{BodyState, Collider};
use crate::{BodyId, BodyKind, ColliderIx, Filter, Material, World};

/// A body of a world, read at the world's time.
#[derive(Clone, Copy, Debug)]
pub struct Body<'w> {
    pub(crate) state: &'w BodyState,
    pub(crate) colliders: &'w List<ColliderIx, Collider>,
    pub(crate) version: u32,
    pub(crate) now: SimTime,
}

impl<'w> Body<'w> {
    /// Name of the body.
    #[must_use]
    pub fn id(&self) -> BodyId {
        self.state.id
    }

    /// What moves the body.
    #[must_use]
    pub fn kind(&self) -> BodyKind {
        self.state.kind
    }

    /// Frame of the shapes as they were given: origin in m, and rotation.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.state.pose(self.now)
    }

    /// Centre of mass, in m.
    #[must_use]
    pub fn centre(&self) -> Vec2 {
        self.state.centre_at(self.now)
    }

    /// Velocity of the centre of mass, in m/s.
    #[must_use]
    pub fn velocity(&self) -> Vec2 {
        self.state.velocity_at(self.now)
    }

    /// Angular velocity, in rad/s, counter-clockwise.
    #[must_use]
    pub fn angular_velocity(&self) -> f64 {
        self.state.spin_at(self.now)
    }

    /// Angle since the definition's zero with all whole turns, in rad.
    #[must_use]
    pub fn angle(&self) -> f64 {
        const TURN: f64 = 2.0 * core::f64::consts::PI;
        let counted = self.state.turned_at(self.now);
        let principal = self.state.rotation_at(self.now).angle();
        principal + TURN * ((counted - principal) / TURN).round()
    }

    /// Mass in kg; infinite for fixed and kinematic bodies.
    #[must_use]
    pub fn mass(&self) -> f64 {
        if self.state.is_dynamic() {
            self.state.mass.mass
        } else {
            f64::INFINITY
        }
    }

    /// Moment of inertia about the centre of mass, in kg·m²; infinite if the body cannot be turned.
    #[must_use]
    pub fn inertia(&self) -> f64 {
        if self.state.inverse_inertia > 0.0 {
            self.state.mass.inertia
        } else {
            f64::INFINITY
        }
    }

    /// Centre of mass in the frame of the shapes, in m.
    #[must_use]
    pub fn local_centre(&self) -> Vec2 {
        self.state.mass.centroid
    }

    /// The shapes with their materials, in the frame of [`Self::pose`].
    pub fn shapes(&self) -> impl Iterator<Item = (&'w Shape, &'w Material)> + use<'w> {
        let colliders = self.colliders;
        self.state.colliders.iter().map(move |&i| {
            let collider = &colliders[i];
            (&*collider.drawn, &collider.surface.material)
        })
    }

    /// Collision filters of the shapes, in their order.
    pub fn filters(&self) -> impl Iterator<Item = Filter> + use<'w> {
        let colliders = self.colliders;
        let shapes = self.state.colliders.iter();
        shapes.map(move |&i| colliders[i].surface.filter)
    }

    /// The motion from its last change on, about the centre of mass; in a field and with damping a parabola near it.
    #[must_use]
    pub fn motion(&self) -> &'w Motion {
        &self.state.motion
    }

    /// Raised by every change of the motion.
    #[must_use]
    pub fn version(&self) -> u32 {
        self.version
    }

    /// Factor on gravity and fields.
    #[must_use]
    pub fn gravity_scale(&self) -> f64 {
        self.state.gravity_scale()
    }

    /// What the caller wanted to find again.
    #[must_use]
    pub fn tag(&self) -> u64 {
        self.state.tag
    }

    /// Whether the body sleeps with its group.
    #[must_use]
    pub fn is_asleep(&self) -> bool {
        self.state.is_asleep() && !self.state.rests_analytically()
    }

    /// Whether it may fall asleep: see [`BodyDef::sleep_allowed`](crate::BodyDef::sleep_allowed).
    #[must_use]
    pub fn is_sleep_allowed(&self) -> bool {
        self.state.sleep_allowed()
    }

    /// ½ m v² + ½ I ω², in J; 0 for fixed and kinematic bodies.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        self.state.kinetic_energy(self.now)
    }

    /// Box around all shapes, in m.
    #[must_use]
    pub fn aabb(&self) -> Aabb {
        let pose = self.pose();
        self.shapes()
            .fold(Aabb::EMPTY, |all, (shape, _)| all.union(shape.aabb(pose)))
    }
}

impl World {
    /// Bodies that the last step may have left elsewhere than the one before did: all that move, and those that came to rest
    /// in it or were put elsewhere since that one; every other body has the pose that it had. In an order that is the same after the
    /// same calls; none before the first step. A body that was removed since is not among them.
    ///
    /// A viewer that knows all poses after one step needs to read only these after the next.
    pub fn moved(&self) -> impl Iterator<Item = Body<'_>> {
        self.bodies.moved().map(|state| self.view(state))
    }
}
