//! What is drawn over, beneath and beside the bodies.

mod bodies;
mod contact;
mod corners;
mod field;

use carom_dynamics::World;
use carom_math::Vec2;

use crate::{Camera, Frame, Look};

/// Marks over and beside the bodies; all off by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// A dot at every centre of mass.
    pub centroids: bool,
    /// An arrow from every moving centre of mass: the way it would go in so many seconds.
    pub velocities: Option<f64>,
    /// Contact points with their normals.
    pub contacts: bool,
    /// Dashed bounding boxes.
    pub bounds: bool,
    /// Bodies asleep are paler.
    pub asleep: bool,
    /// An arrow in the upper right corner that points along gravity.
    pub gravity: bool,
    /// The simulated time in the upper left corner.
    pub time: bool,
    /// A bar in the lower left corner, filled to this coefficient of restitution.
    pub restitution: Option<f64>,
    /// The circle of a field.
    pub field: Option<FieldMark>,
    /// A line of text in the lower right corner.
    pub caption: String,
}

/// A circle around the core of a radial field.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldMark {
    /// Centre, in metres.
    pub centre: Vec2,
    /// Radius, in metres.
    pub radius: f64,
    /// What is written above it; empty for nothing.
    pub label: String,
}

/// Height of a text, in pixels of the overlay.
const TEXT: f64 = 10.0;

/// One frame's overlay under way.
pub(crate) struct Overlaid<'a> {
    frame: &'a mut Frame,
    world: &'a World,
    look: &'a Look,
    camera: &'a Camera,
    /// Pixels that one pixel of the overlay's sizes takes.
    unit: f64,
}

/// Sizes of the overlay hold on a picture whose shorter side is 600 px; others in proportion, within limits.
pub(crate) fn unit(camera: &Camera) -> f64 {
    (camera.size().corner().min_element() / 600.0).clamp(0.7, 3.0)
}

impl<'a> Overlaid<'a> {
    pub(crate) fn new(
        frame: &'a mut Frame,
        world: &'a World,
        look: &'a Look,
        camera: &'a Camera,
    ) -> Self {
        let unit = unit(camera);
        Self {
            frame,
            world,
            look,
            camera,
            unit,
        }
    }

    /// What lies beneath the bodies.
    pub(crate) fn beneath(&mut self) {
        self.field();
    }

    /// What lies over them.
    pub(crate) fn above(&mut self) {
        self.bodies();
        self.contacts();
        self.field_label();
        self.corners();
    }
}
