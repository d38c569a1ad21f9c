//! The bodies of a scene before a world exists: what generators make and what is written out look the same here.

use std::sync::Arc;

use carom_dynamics::BodyKind;
use carom_geometry::{Outline, Shape};
use carom_math::{Pose, Rot, Vec2};

use super::material::{Resolved, filter, resolve};
use crate::document::Document;
use crate::error::{Problem, SceneError};
use crate::model::{FilterTable, MaterialChoice, SceneFile};
use crate::path::FieldPath;

/// Most bodies of a scene.
pub(crate) const MAX_BODIES: u64 = 1_000_000;

/// Most vertices of all bodies of a scene together, a circle as one: a million boxes, or one outline of four million
/// corners, which are half a gigabyte. A shape that bodies share counts for each of them, since each is moved and drawn.
pub(crate) const MAX_VERTICES: u64 = 1 << 22;

/// One body.
#[derive(Clone, Debug)]
pub(crate) struct Planned {
    pub(crate) name: String,
    /// Where in the file it comes from.
    pub(crate) field: FieldPath,
    pub(crate) kind: BodyKind,
    /// Where the shapes' own origin is, in m.
    pub(crate) position: Vec2,
    /// How they are turned about it, in rad.
    pub(crate) angle: f64,
    pub(crate) velocity: Vec2,
    pub(crate) spin: f64,
    pub(crate) shapes: Vec<(Arc<Shape>, Resolved)>,
    pub(crate) mass: Option<f64>,
    pub(crate) inertia: Option<f64>,
    pub(crate) locked_rotation: bool,
    pub(crate) gravity_scale: f64,
    /// Of velocity and spin, in 1/s.
    pub(crate) damping: (f64, f64),
    pub(crate) asleep: bool,
    pub(crate) sleep_allowed: bool,
    /// Point and impulse.
    pub(crate) impulse: Option<(Vec2, Vec2)>,
    pub(crate) colour: Option<String>,
    pub(crate) face: Option<String>,
}

impl Planned {
    /// A dynamic body at rest at the origin, without shapes.
    pub(crate) fn new(name: String, field: FieldPath) -> Self {
        Self {
            name,
            field,
            kind: BodyKind::Dynamic,
            position: Vec2::ZERO,
            angle: 0.0,
            velocity: Vec2::ZERO,
            spin: 0.0,
            shapes: Vec::new(),
            mass: None,
            inertia: None,
            locked_rotation: false,
            gravity_scale: 1.0,
            damping: (0.0, 0.0),
            asleep: false,
            sleep_allowed: true,
            impulse: None,
            colour: None,
            face: None,
        }
    }

    /// The frame of the shapes.
    pub(crate) fn pose(&self) -> Pose {
        Pose::new(self.position, Rot::from_angle(self.angle))
    }
}

/// Collects the bodies of a file.
pub(crate) struct Planner<'a> {
    pub(crate) document: &'a Document,
    pub(crate) file: &'a SceneFile,
    pub(crate) bodies: Vec<Planned>,
    /// Vertices of these, by which the scene is bounded.
    pub(crate) vertices: u64,
}

impl Planner<'_> {
    /// A material as it is written.
    pub(crate) fn material(
        &self,
        choice: &MaterialChoice,
        field: FieldPath,
    ) -> Result<Resolved, SceneError> {
        resolve(self.document, self.file, choice, field)
    }

    /// Material and filter of walls and generated bodies; a parameter may set the restitution; `field` has both.
    pub(crate) fn surface(
        &self,
        choice: &MaterialChoice,
        filter_table: &FilterTable,
        field: &FieldPath,
    ) -> Result<Resolved, SceneError> {
        let mut resolved = self.material(choice, field.key("material"))?;
        resolved.filter = filter(self.document, filter_table, &field.key("filter"))?;
        if let Some(restitution) = self.file.parameters.restitution {
            resolved.material.restitution = restitution;
            resolved.by_parameter = true;
        }
        Ok(resolved)
    }

    pub(crate) fn add(&mut self, body: Planned) -> Result<(), SceneError> {
        if self.bodies.len() as u64 >= MAX_BODIES {
            let reason = format!("a scene holds at most {MAX_BODIES} bodies");
            return Err(self.refuse(&body.field, reason));
        }
        let shapes = body.shapes.iter();
        let vertices: u64 = shapes.map(|(shape, _)| count(shape)).sum();
        self.room_for(&body.field, vertices)?;
        self.vertices += vertices;
        self.bodies.push(body);
        Ok(())
    }

    /// Refuses more vertices than the scene has room for; asked for a whole batch before the first one is made.
    pub(crate) fn room_for(&self, field: &FieldPath, vertices: u64) -> Result<(), SceneError> {
        let all = self.vertices.saturating_add(vertices);
        if all <= MAX_VERTICES {
            return Ok(());
        }
        let reason =
            format!("the scene has {all} vertices with this, over the limit of {MAX_VERTICES}");
        Err(self.refuse(field, reason))
    }

    pub(crate) fn refuse(&self, field: &FieldPath, reason: String) -> SceneError {
        self.document.error(field, Problem::Refused(reason))
    }
}

/// Vertices of a shape, all parts together; a circle and a half-plane are one.
pub(crate) fn count(shape: &Shape) -> u64 {
    match shape.outline() {
        Outline::Open(points) | Outline::Closed(points) => points.len() as u64,
        Outline::Rings(rings) => rings.iter().map(|ring| ring.len() as u64).sum(),
        Outline::Parts(parts) => parts.iter().map(count).sum(),
        _ => 1,
    }
}
