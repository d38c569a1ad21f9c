//! The contacts of any two shapes, part by part.

use carom_geometry::Shape;
use carom_math::Pose;

use crate::Manifold;

/// The contact of one convex part of A with one of B.
#[derive(Clone, Debug, PartialEq)]
pub struct PartManifold {
    /// Index of A's part.
    pub part_a: u32,
    /// Index of B's part.
    pub part_b: u32,
    /// Where they touch, in A's frame; never without a point.
    pub manifold: Manifold,
}

/// Appends every contact of two shapes whose separation is at most `margin` (metres) to `out`.
pub fn contacts(a: &Shape, b: &Shape, b_in_a: Pose, margin: f64, out: &mut Vec<PartManifold>) {
    let _ = (a, b, b_in_a, margin, out);
    todo!()
}
