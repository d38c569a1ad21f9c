//! The thesis's own method: vertices of one polygon inside the other, concave ones too.

use carom_geometry::Polygon;
use carom_math::{Pose, Vec2};

use crate::Side;

/// How two polygons meet at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexEdgeKind {
    /// A vertex of one is behind an edge of the other.
    VertexOnEdge,
    /// Two edges lie along each other.
    ParallelEdges,
    /// A corner of each is inside the other.
    VertexOnVertex,
}

/// A place where two polygons meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexEdge {
    /// How they meet.
    pub kind: VertexEdgeKind,
    /// Impact point, in A's frame, in metres.
    pub point: Vec2,
    /// Unit normal in A's frame, from A to B.
    pub normal: Vec2,
    /// How far the vertex is behind the edge, in metres, never below 0.
    pub overlap: f64,
    /// Which polygon owns the vertex; the other one owns the edge.
    pub owner: Side,
    /// Index of the vertex in its polygon.
    pub vertex: usize,
    /// Index of the edge in the other polygon.
    pub edge: usize,
}

/// Every place where two simple polygons meet.
#[must_use]
pub fn vertex_edge_contacts(a: &Polygon, b: &Polygon, b_in_a: Pose) -> Vec<VertexEdge> {
    let _ = (a, b, b_in_a);
    todo!()
}
