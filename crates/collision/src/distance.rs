//! How far two shapes are apart, and where they are closest.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2};

use crate::{AxisFeature, Hull};

/// The shortest way between two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Metres between the shapes; 0 exactly when they touch or overlap.
    pub distance: f64,
    /// Closest point of A, in A's frame; a common point if they overlap.
    pub point_a: Vec2,
    /// Closest point of B, in A's frame; a common point if they overlap.
    pub point_b: Vec2,
    /// Unit normal in A's frame, from A to B; of the least overlap if they overlap.
    pub normal: Vec2,
    /// What is closest.
    pub feature: AxisFeature,
}

/// The distance of two hulls with its witness points.
#[must_use]
pub fn distance(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Distance {
    let _ = (a, b, b_in_a);
    todo!()
}

/// The distance of any two shapes: the least over their parts.
#[must_use]
pub fn shape_distance(a: &Shape, b: &Shape, b_in_a: Pose) -> Distance {
    let _ = (a, b, b_in_a);
    todo!()
}
