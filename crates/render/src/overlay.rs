//! What is drawn over, beneath and beside the bodies.

mod bodies;
mod contact;
mod corners;
mod field;
mod groups;
mod overlap;
mod trace;

use carom_dynamics::{RadialField, World};
use carom_math::Vec2;

use crate::{Camera, Frame, Look};

pub(crate) use groups::Groups;
pub use trace::Trace;

/// Marks over, beneath and beside the bodies; all off by default.
///
/// # Examples
/// ```
/// use carom_render::Overlay;
/// let overlay = Overlay { velocities: Some(0.25), trails: Some(2.0), time: true, ..Overlay::default() };    // s, s
/// assert!(!overlay.contacts);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// A dot at every centre of mass.
    pub centroids: bool,
    /// An arrow from every moving centre of mass: the way it would go in so many seconds.
    pub velocities: Option<f64>,
    /// Where every moving centre of mass was during so many seconds; a [`Trace`] remembers it.
    pub trails: Option<f64>,
    /// Contact points with their normals: contacts that last, and impacts of the last step.
    pub contacts: bool,
    /// An arrow at every contact point along the impulse there: the way that the lighter body would go in so many seconds
    /// with the change of velocity that it gets from an impact, or from a lasting contact in a tenth of a second.
    pub impulses: Option<f64>,
    /// A burst at every impact, the larger the faster it was, that fades; a [`Trace`] remembers it.
    pub flashes: bool,
    /// Bodies that touch each other have one colour, all others are pale.
    pub groups: bool,
    /// Where bodies lie in each other is shaded; the deepest place is ringed, and its depth written.
    pub overlaps: bool,
    /// Dashed bounding boxes.
    pub bounds: bool,
    /// Bodies asleep are paler.
    pub asleep: bool,
    /// An arrow in the upper right corner that points along gravity.
    pub gravity: bool,
    /// The simulated time in the upper left corner.
    pub time: bool,
    /// Bodies, sleepers, contacts, impacts and energy in the upper left corner, below the time.
    pub counters: bool,
    /// A bar in the lower left corner, filled to this coefficient of restitution.
    pub restitution: Option<f64>,
    /// The circle of a field.
    pub field: Option<FieldMark>,
    /// Lines along gravity and these fields, beneath everything.
    pub field_lines: Option<Vec<RadialField>>,
    /// A line of text in the lower right corner.
    pub caption: String,
}

impl Overlay {
    /// Whether it shows something of the time before.
    #[must_use]
    pub const fn needs_trace(&self) -> bool {
        self.trails.is_some() || self.flashes || self.counters
    }
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
    trace: &'a Trace,
    /// Pixels that one pixel of the overlay's sizes takes.
    unit: f64,
}

/// Sizes of the overlay hold on a picture with a shorter side of 600 px; others in proportion, within limits.
pub(crate) fn unit(camera: &Camera) -> f64 {
    (camera.size().corner().min_element() / 600.0).clamp(0.7, 3.0)
}

impl<'a> Overlaid<'a> {
    pub(crate) fn new(
        frame: &'a mut Frame,
        world: &'a World,
        look: &'a Look,
        camera: &'a Camera,
        trace: &'a Trace,
    ) -> Self {
        let unit = unit(camera);
        Self {
            frame,
            world,
            look,
            camera,
            trace,
            unit,
        }
    }

    /// What lies beneath the bodies.
    pub(crate) fn beneath(&mut self) {
        self.field_lines();
        self.field();
        self.trails();
    }

    /// What lies over them.
    pub(crate) fn above(&mut self) {
        self.overlaps();
        self.bodies();
        self.contacts();
        self.impulses();
        self.flashes();
        self.field_label();
        self.corners();
    }
}
