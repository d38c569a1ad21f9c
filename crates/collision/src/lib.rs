//! Answers whether two shapes in the plane touch, where, how deep, and when.
//!
//! Two shapes and the pose of B in A's frame go in; what comes out is in A's frame, too. A normal is
//! a unit vector from A to B, a separation below zero is an overlap, lengths are in metres.
//!
//! ```text
//! Shape ─► Hull (vertices, normals, radius) ─► separating axis ─► manifold, distance, cast, time of impact
//! ```
//!
//! A circle, a segment or a convex polygon is one [`Hull`]; a concave polygon is several, with
//! marked cuts: a cut separates, but it is never touched. [`vertex_edge_contacts`] works on whole
//! outlines and shares nothing with the hulls.
//!
//! # Examples
//! ```
//! use carom_collision::{contacts, shape_distance};
//! use carom_geometry::{Circle, ConvexPolygon, Shape};
//! use carom_math::{Pose, vec2};
//! let wall: Shape = ConvexPolygon::rectangle(2.0, 6.0)?.into();                // m
//! let ball: Shape = Circle::new(0.5)?.into();
//! let apart = Pose::at(vec2(4.0, 1.0));                                        // of the ball, seen from the wall
//! assert_eq!(shape_distance(&wall, &ball, apart).distance, 2.5);
//!
//! let mut found = Vec::new();
//! contacts(&wall, &ball, Pose::at(vec2(1.25, 1.0)), 0.0, &mut found);
//! assert_eq!(found[0].manifold.normal, vec2(1.0, 0.0));
//! assert_eq!(found[0].manifold.points[0].separation, -0.25);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod cast;
mod contacts;
mod distance;
mod features;
mod four;
mod hull;
mod lanes;
mod manifold;
mod motion;
mod nearest;
mod outline;
mod overlap;
mod parts;
mod sat;
mod shape_tree;
mod swept;
mod toi;
mod tree;
mod vertex_edge;
mod way_out;

pub use carom_geometry as geometry;
pub use cast::{CastHit, cast};
pub use contacts::{PartManifold, contacts, contacts_and_gap};
pub use distance::{Distance, distance, shape_distance};
pub use hull::{Convex, Hull, hulls, part, part_count};
pub use manifold::{FeatureId, Gap, Manifold, ManifoldPoint, collide, collide_within};
pub use motion::Motion;
pub use overlap::{intersection, overlap_area};
pub use sat::{Axis, AxisFeature, Side, minimum_push, separating_axis};
pub use shape_tree::{ShapeTree, roundable};
pub use toi::{
    Impact, ImpactFeature, TimeOfImpact, earlier, time_of_impact, time_of_impact_beside,
    time_of_impact_from, time_of_impact_of_parts,
};
pub use tree::{BoxTree, NodeId};
pub use vertex_edge::{VertexEdge, VertexEdgeKind, vertex_edge_contacts};
pub use way_out::shape_push;

/// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
