//! The separating axis theorem on two convex hulls.

use carom_math::{Pose, Vec2};

use crate::Hull;

/// One of the two shapes of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The first shape.
    A,
    /// The second shape.
    B,
}

/// What of the two hulls an axis comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisFeature {
    /// The normal of an edge, against the vertex of the other hull that is deepest behind it.
    Edge {
        /// The hull that owns the edge.
        owner: Side,
        /// Index of the edge.
        edge: usize,
        /// Index of the vertex of the other hull.
        vertex: usize,
    },
    /// The line through a vertex of each hull.
    Vertices {
        /// Index of A's vertex.
        a: usize,
        /// Index of B's vertex.
        b: usize,
    },
}

/// A direction and how far apart two hulls are along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Gap along the normal in metres; below zero the hulls overlap by as much.
    pub separation: f64,
    /// Unit normal in A's frame, from A to B.
    pub normal: Vec2,
    /// Where the axis comes from.
    pub feature: AxisFeature,
}

/// The axis along which two hulls are farthest apart, or overlap least.
#[must_use]
pub fn separating_axis(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Axis {
    let _ = (a, b, b_in_a);
    todo!()
}

/// The shortest translation of B, in A's frame and metres, that ends the overlap; `None` if apart.
#[must_use]
pub fn minimum_push(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Option<Vec2> {
    let axis = separating_axis(a, b, b_in_a);
    (axis.separation <= 0.0).then(|| axis.normal * -axis.separation)
}
