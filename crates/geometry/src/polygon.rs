//! Polygons: any simple ring, concave ones too.

use carom_math::Vec2;

use crate::moments::polygon_moments;
use crate::part_tree::{PartTree, TREE_ABOVE};
use crate::pieces::{ConvexPiece, decompose};
use crate::query::winds_around;
use crate::ring::Ring;
use crate::{Aabb, AreaProperties, ConvexPolygon, PolygonError};

/// A simple polygon, with a ring that does not touch itself: convex or concave, counter-clockwise.
///
/// Its convex pieces are made with it; they add no vertices, and record which edges are cuts. Above
/// 32 edges a box tree over them is made, too.
///
/// # Examples
/// ```
/// use carom_geometry::Polygon;
/// use carom_math::vec2;
/// let l = Polygon::new([
///     vec2(0.0, 0.0), vec2(3.0, 0.0), vec2(3.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 2.0), vec2(0.0, 2.0),
/// ])?;
/// assert_eq!(l.area_properties().area, 4.0);                       // m²
/// assert_eq!(l.pieces().len(), 2);
/// assert!(l.contains(vec2(0.5, 1.5)) && !l.contains(vec2(2.0, 1.5)));
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<Vec2>", into = "Vec<Vec2>")
)]
pub struct Polygon {
    vertices: Box<[Vec2]>,
    pieces: Box<[ConvexPiece]>,
    tree: Option<Box<PartTree>>,
}

impl Polygon {
    /// The polygon with the given vertices, in m, in either order of turn.
    ///
    /// Points that repeat their neighbour are dropped; points on a straight edge stay.
    ///
    /// # Errors
    /// If a point is not finite or too large, fewer than three differ, all lie on one line, or two
    /// edges cross, touch or overlap: the error names the vertex or both edges.
    pub fn new(points: impl Into<Vec<Vec2>>) -> Result<Self, PolygonError> {
        let ring = Ring::new(&points.into())?;
        ring.check_simple()?;
        let ring = ring.counter_clockwise();
        let pieces = decompose(&ring.without_straight().points);
        Ok(Self::from_pieces(ring.points, pieces))
    }

    fn from_pieces(vertices: Vec<Vec2>, pieces: Vec<ConvexPiece>) -> Self {
        let boxes = || {
            let corners = pieces.iter().map(|piece| piece.vertices().iter().copied());
            corners.map(Aabb::from_points)
        };
        let many = vertices.len() > TREE_ABOVE && pieces.len() > 1;
        Self {
            tree: many.then(|| Box::new(PartTree::new(boxes()))),
            vertices: vertices.into(),
            pieces: pieces.into(),
        }
    }

    /// Checks the points as [`Self::new`] does, in O(n log n), without cutting the polygon into pieces.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn check(points: &[Vec2]) -> Result<(), PolygonError> {
        Ring::new(points)?.check_simple()
    }

    /// The outline, counter-clockwise, in m.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// Convex pieces that cover the polygon without overlap.
    #[must_use]
    pub fn pieces(&self) -> &[ConvexPiece] {
        &self.pieces
    }

    /// The box tree over the pieces, if there are more than 32 edges and several pieces.
    #[must_use]
    pub fn part_tree(&self) -> Option<&PartTree> {
        self.tree.as_deref()
    }

    /// Area and its moments.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        polygon_moments(
            &self.vertices,
            self.pieces.iter().map(ConvexPiece::vertices),
        )
    }

    /// Whether `point` (in m) lies inside or on the outline; exact.
    #[must_use]
    pub fn contains(&self, point: Vec2) -> bool {
        winds_around(&self.vertices, point)
    }

    /// The same polygon moved by `offset`, in m.
    ///
    /// Vertices are rounded to where they come to lie, and not checked again.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        let pieces = self.pieces.iter().map(|piece| piece.translated(offset));
        Self::from_pieces(
            self.vertices.iter().map(|v| *v + offset).collect(),
            pieces.collect(),
        )
    }
}

/// A convex polygon is a polygon of one piece.
impl From<ConvexPolygon> for Polygon {
    fn from(convex: ConvexPolygon) -> Self {
        let vertices = convex.vertices().to_vec();
        let pieces = decompose(&vertices);
        Self::from_pieces(vertices, pieces)
    }
}
