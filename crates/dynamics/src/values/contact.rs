//! A contact as a caller sees it.

use carom_math::Vec2;

use crate::BodyId;

/// Where two bodies touch: one normal, up to two points.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The body that the normal points away from.
    pub a: BodyId,
    /// The body that the normal points to.
    pub b: BodyId,
    /// Unit normal from A to B.
    pub normal: Vec2,
    /// One or two points.
    pub points: Vec<ContactPoint>,
    /// Friction impulse of the last sub-step on B along the normal turned by +90 degrees, in N·s.
    pub tangent_impulse: f64,
}

/// One point of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactPoint {
    /// Midway between the two surfaces, in m.
    pub position: Vec2,
    /// Gap along the normal, in m; negative is overlap.
    pub separation: f64,
    /// Normal impulse of the last sub-step on B, in N·s.
    pub normal_impulse: f64,
}
