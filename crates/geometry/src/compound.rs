//! Compounds: several shapes that move as one.

use carom_math::{Pose, Vec2};

use crate::part_tree::TREE_ABOVE;
use crate::seams::{ConvexPart, weld};
use crate::{AreaProperties, ConvexPiece, PartTree, Shape, ShapeError};

/// Several shapes in one frame, each put where it belongs.
///
/// What the compound covers is what any of its parts covers. Areas and moments are those of the
/// parts, added: exact where parts are disjoint or share edges, and counted twice where they
/// overlap, as two plates that lie on each other weigh twice.
///
/// # Examples
/// ```
/// use carom_geometry::{Circle, Compound, ConvexPolygon, Shape};
/// use carom_math::{Pose, vec2};
/// // A dumbbell: two discs on a bar.
/// let disc = Shape::from(Circle::new(0.5)?);
/// let dumbbell = Compound::new([
///     (ConvexPolygon::rectangle(2.0, 0.2)?.into(), Pose::IDENTITY),
///     (disc.clone(), Pose::at(vec2(-1.5, 0.0))),
///     (disc, Pose::at(vec2(1.5, 0.0))),
/// ])?;
/// let area = Shape::from(dumbbell).area_properties()?;
/// assert!((area.area - (0.4 + std::f64::consts::FRAC_PI_2)).abs() < 1e-15);    // m²
/// assert!(area.centroid.length() < 1e-15);
/// # Ok::<(), carom_geometry::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<Shape>", into = "Vec<Shape>")
)]
pub struct Compound {
    parts: Box<[Shape]>,
    vertices: Box<[Vec2]>,
    convex: Box<[ConvexPart]>,
    tree: Option<Box<PartTree>>,
}

impl Compound {
    /// The compound of shapes at their poses in its frame (positions in m).
    ///
    /// A compound among them is replaced by its parts.
    ///
    /// # Errors
    /// If there is no part, one is a half-plane, or a pose leads out of range or is so far out that
    /// rounding spoils a polygon.
    pub fn new(parts: impl IntoIterator<Item = (Shape, Pose)>) -> Result<Self, ShapeError> {
        let mut placed = Vec::new();
        for (part, pose) in parts {
            match part.placed(pose)? {
                Shape::HalfPlane(_) => return Err(ShapeError::Unbounded),
                Shape::Compound(inner) => placed.extend(inner.parts),
                single => placed.push(single),
            }
        }
        if placed.is_empty() {
            return Err(ShapeError::NoParts);
        }
        Ok(Self::from_checked(placed))
    }

    fn from_checked(parts: Vec<Shape>) -> Self {
        let corners = parts.iter().flat_map(Shape::vertices);
        let vertices: Vec<Vec2> = corners.copied().collect();
        let mut convex: Vec<ConvexPart> = parts.iter().flat_map(convex_parts).collect();
        weld(&mut convex);
        let many = vertices.len() > TREE_ABOVE && convex.len() > 1;
        Self {
            tree: many.then(|| Box::new(PartTree::new(convex.iter().map(ConvexPart::aabb)))),
            parts: parts.into(),
            vertices: vertices.into(),
            convex: convex.into(),
        }
    }

    /// The parts where they are, in the order they were given; none is a compound or a half-plane.
    #[must_use]
    pub fn parts(&self) -> &[Shape] {
        &self.parts
    }

    /// The convex parts of all parts, one part after the other; each knows where others hide it.
    #[must_use]
    pub fn convex_parts(&self) -> &[ConvexPart] {
        &self.convex
    }

    /// The box tree over the convex parts, if there are several with more than 32 corners together.
    #[must_use]
    pub fn part_tree(&self) -> Option<&PartTree> {
        self.tree.as_deref()
    }

    /// Corners of all parts, one part after the other, in m; of a circle its centre.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// Areas and moments of all parts together.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        // Bounded parts all have them.
        let areas = self
            .parts
            .iter()
            .filter_map(|part| part.area_properties().ok());
        areas.sum()
    }

    /// The same compound with every part moved to `pose`.
    pub(crate) fn placed(&self, pose: Pose) -> Result<Self, ShapeError> {
        let parts = self.parts.iter().map(|part| part.placed(pose));
        Ok(Self::from_checked(parts.collect::<Result<_, _>>()?))
    }

    /// The same compound moved by `offset`, in m.
    ///
    /// Vertices are rounded to where they come to lie, and not checked again.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        let parts = self.parts.iter().map(|part| part.translated(offset));
        Self::from_checked(parts.collect())
    }
}

/// The convex parts of one part.
fn convex_parts(part: &Shape) -> Vec<ConvexPart> {
    match part {
        Shape::Circle(circle) => vec![ConvexPart::Disc(*circle)],
        Shape::Segment(segment) => vec![ConvexPart::Piece(ConvexPiece::wall(segment))],
        Shape::Convex(polygon) => vec![ConvexPart::Piece(ConvexPiece::whole(polygon))],
        Shape::Polygon(polygon) => {
            let pieces = polygon.pieces().iter().cloned();
            pieces.map(ConvexPart::Piece).collect()
        }
        Shape::Compound(compound) => compound.convex.to_vec(),
        // No part of a compound is one.
        Shape::HalfPlane(_) => Vec::new(),
    }
}
