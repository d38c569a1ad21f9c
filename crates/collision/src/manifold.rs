//! Where two convex hulls touch: a normal and up to two points.

use arrayvec::ArrayVec;
use carom_math::{Pose, Vec2};

use crate::{Convex, Hull};

/// What touches at a contact point; the same from step to step while the contact persists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FeatureId(pub u32);

/// One point of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldPoint {
    /// Midway between the two surfaces, in A's frame, in metres.
    pub point: Vec2,
    /// Gap along the normal in metres; below zero the shapes overlap.
    pub separation: f64,
    /// What touches here.
    pub feature: FeatureId,
}

/// How two convex shapes touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Manifold {
    /// Unit normal in A's frame, from A to B; zero if there is no point.
    pub normal: Vec2,
    /// One point, two for edge on edge, none if the shapes are apart.
    pub points: ArrayVec<ManifoldPoint, 2>,
}

/// The contact of two convex shapes that overlap or touch; no points if they are apart.
#[must_use]
pub fn collide(a: &impl Convex, b: &impl Convex, b_in_a: Pose) -> Manifold {
    collide_within(&a.hull(), &b.hull(), b_in_a, 0.0)
}

/// The contact of two convex hulls, with every point whose separation is at most `margin` (metres).
#[must_use]
pub fn collide_within(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, margin: f64) -> Manifold {
    let _ = (a, b, b_in_a, margin);
    todo!()
}
