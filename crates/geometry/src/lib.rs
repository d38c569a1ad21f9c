//! Answers which area, centroid and moment of inertia a polygon has.
//!
//! Shapes are circles, segments, half-planes, convex polygons, any simple polygon, polygons with
//! holes, and compounds. Mass properties are right to 2e-13, for slivers and far from the origin
//! too; convex pieces have no new vertices. Constructors check once, by exact predicates: a shape
//! that exists is valid, and an error names the vertex.
//!
//! Metres, radians, counter-clockwise. A shape has no motion, and the crate knows no pairs of shapes.
//!
//! # Examples
//! ```
//! use carom_geometry::Polygon;
//! use carom_math::vec2;
//! // An arrowhead of 2 kg, given clockwise.
//! let arrow = Polygon::new([vec2(0.0, 0.0), vec2(-1.0, 1.0), vec2(2.0, 0.0), vec2(-1.0, -1.0)])?;
//! let mass = arrow.area_properties().with_mass(2.0);
//! assert!((mass.centroid - vec2(1.0 / 3.0, 0.0)).length() < 1e-15);    // m
//! assert_eq!(arrow.area_properties().area, 2.0);                        // m²
//! # Ok::<(), carom_geometry::PolygonError>(())
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod aabb;
mod area;
mod blocks;
mod circle;
mod compound;
mod convex;
mod ears;
mod error;
mod generate;
mod grid;
mod half_plane;
mod hull;
pub mod inertia;
mod mass;
mod merge;
mod moments;
mod monotone;
mod part_tree;
mod pieces;
mod polygon;
mod query;
mod random;
mod region;
mod ring;
mod seams;
mod segment;
mod shape;
mod simple;
mod wide;
#[cfg(feature = "serde")]
mod wire;

pub use aabb::Aabb;
pub use area::{AreaProperties, ring_properties};
pub use blocks::EdgeBlock;
pub use carom_math as math;
pub use circle::Circle;
pub use compound::Compound;
pub use convex::ConvexPolygon;
pub use error::{
    COORDINATE_LIMIT, LENGTH_LIMIT, PolygonError, RegionError, ShapeError, VERTEX_LIMIT,
};
pub use half_plane::HalfPlane;
pub use mass::MassProperties;
pub use part_tree::{PartBranch, PartTree};
pub use pieces::{Cone, ConvexPiece};
pub use polygon::Polygon;
pub use query::RayHit;
pub use region::Region;
pub use seams::ConvexPart;
pub use segment::Segment;
pub use shape::{Outline, Shape};

/// Runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;

#[cfg(test)]
mod tests;
