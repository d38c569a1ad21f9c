//! A body as a caller tells of it.

use carom_math::{Pose, Vec2};

use crate::error::{finite, finite_pose, not_negative, positive};
use crate::{BodyIx, EngineError};

/// Name of a body in its engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    pub(crate) slot: BodyIx,
    pub(crate) generation: u32,
}

/// What moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// Nothing.
    Fixed,
    /// Its velocity alone; it pushes and is not pushed.
    Kinematic,
    /// Gravity and contacts.
    Dynamic,
}

/// A body to insert. Its frame has the centre of mass for origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInput {
    /// What moves it.
    pub kind: BodyKind,
    /// Where the centre of mass is, in m, and how the body is turned.
    pub pose: Pose,
    /// Velocity of the centre of mass, in m/s.
    pub velocity: Vec2,
    /// Angular velocity, in rad/s, counter-clockwise.
    pub spin: f64,
    /// Angle by which it has turned so far, in rad: [`State::turned`](crate::State::turned) counts on from it.
    pub turned: f64,
    /// Of a dynamic body, in kg.
    pub mass: f64,
    /// Of a dynamic body about its centre of mass, in kg·m²; infinite: it never turns.
    pub inertia: f64,
    /// Part of gravity that acts on it.
    pub gravity_scale: f64,
    /// What velocity and spin of a dynamic body lose by themselves, in 1/s.
    pub damping: [f64; 2],
    /// Whether a dynamic body may fall asleep; one that may not keeps its island awake.
    pub sleep_allowed: bool,
    /// The caller's own: [`State`](crate::State) names bodies by it.
    pub tag: u64,
    /// Its place among all bodies, where these may be inserted in any order with equal bits: all have one then, and no two the same.
    /// `None`: by the order of insertion.
    pub order: Option<u64>,
}

impl BodyInput {
    /// At the origin, at rest, of 1 kg and 1 kg·m².
    #[must_use]
    pub const fn new(kind: BodyKind) -> Self {
        Self {
            kind,
            pose: Pose::IDENTITY,
            velocity: Vec2::ZERO,
            spin: 0.0,
            turned: 0.0,
            mass: 1.0,
            inertia: 1.0,
            gravity_scale: 1.0,
            damping: [0.0; 2],
            sleep_allowed: true,
            tag: 0,
            order: None,
        }
    }

    /// A body that nothing moves.
    #[must_use]
    pub const fn fixed() -> Self {
        Self::new(BodyKind::Fixed)
    }

    /// A body that its velocity moves.
    #[must_use]
    pub const fn kinematic() -> Self {
        Self::new(BodyKind::Kinematic)
    }

    /// A body of `mass` kg and `inertia` kg·m² that contacts move.
    #[must_use]
    pub const fn dynamic(mass: f64, inertia: f64) -> Self {
        let mut input = Self::new(BodyKind::Dynamic);
        (input.mass, input.inertia) = (mass, inertia);
        input
    }

    /// The same with its centre of mass at `position`, in m.
    #[must_use]
    pub const fn at(mut self, position: Vec2) -> Self {
        self.pose.position = position;
        self
    }

    /// The same at this velocity, in m/s, and spin, in rad/s.
    #[must_use]
    pub const fn moving(mut self, velocity: Vec2, spin: f64) -> Self {
        (self.velocity, self.spin) = (velocity, spin);
        self
    }

    pub(crate) fn check(&self) -> Result<(), EngineError> {
        let fields = [
            "BodyInput::pose.position.x",
            "BodyInput::pose.position.y",
            "BodyInput::pose.rotation.cos",
            "BodyInput::pose.rotation.sin",
        ];
        finite_pose(fields, self.pose)?;
        finite("BodyInput::velocity.x", self.velocity.x)?;
        finite("BodyInput::velocity.y", self.velocity.y)?;
        finite("BodyInput::spin", self.spin)?;
        finite("BodyInput::turned", self.turned)?;
        finite("BodyInput::gravity_scale", self.gravity_scale)?;
        not_negative("BodyInput::damping[0]", self.damping[0])?;
        not_negative("BodyInput::damping[1]", self.damping[1])?;
        if self.kind == BodyKind::Dynamic {
            positive("BodyInput::mass", self.mass)?;
            if self.inertia != f64::INFINITY {
                positive("BodyInput::inertia", self.inertia)?;
            }
        }
        Ok(())
    }
}
