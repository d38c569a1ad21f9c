//! The convex pieces of a polygon, without new vertices.
//!
//! Pieces serve for distances and separating axes. Contact belongs to the outline alone, so that a
//! piece knows which of its edges are cuts and in which directions its corners can be touched.

use std::sync::Arc;

use carom_math::{Vec2, cross, orient2d};

use crate::blocks::{Blocks, EdgeBlock};
use crate::convex::outward_normals;
use crate::ears::triangulate;
use crate::merge::{PieceEdge, merge};
use crate::ring::corners;
use crate::{ConvexPolygon, Segment};

/// A convex piece of a polygon: which edges are true, and where its corners can be touched.
///
/// # Examples
/// ```
/// use carom_geometry::Polygon;
/// use carom_math::vec2;
/// // A V: two slabs that meet in a cut from the notch to the tip.
/// let v = Polygon::new([vec2(0.0, 0.0), vec2(2.0, 2.0), vec2(0.0, 1.0), vec2(-2.0, 2.0)])?;
/// for piece in v.pieces() {
///     let cuts = (0..piece.vertices().len()).filter(|edge| !piece.is_boundary(*edge));
///     assert_eq!(cuts.count(), 1);
///     let notch = piece.vertices().iter().position(|p| *p == vec2(0.0, 1.0)).unwrap();
///     assert!(piece.cones()[notch].is_empty());                    // nothing convex gets there
/// }
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPiece {
    vertices: Box<[Vec2]>,
    /// Shared with the same piece elsewhere.
    rim: Arc<Rim>,
    blocks: Blocks,
}

/// What a piece keeps where it is moved.
#[derive(Clone, Debug, PartialEq)]
struct Rim {
    normals: Box<[Vec2]>,
    boundary: Box<[bool]>,
    cones: Box<[Cone]>,
}

impl ConvexPiece {
    fn new(vertices: Vec<Vec2>, normals: Vec<Vec2>, boundary: Vec<bool>, cones: Vec<Cone>) -> Self {
        Self {
            vertices: vertices.into(),
            rim: Arc::new(Rim {
                normals: normals.into(),
                boundary: boundary.into(),
                cones: cones.into(),
            }),
            blocks: Blocks::default(),
        }
    }

    /// Corners, strictly convex and counter-clockwise, in m.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// Outward unit normals; number `i` belongs to the edge from vertex `i` to the next.
    #[must_use]
    pub fn normals(&self) -> &[Vec2] {
        &self.rim.normals
    }

    /// The edges in order, four at a time: corners and normals.
    #[must_use]
    pub fn blocks(&self) -> &[EdgeBlock] {
        self.blocks.of(&self.vertices, &self.rim.normals)
    }

    /// Whether edge `i` belongs to the outline; else it is a cut.
    ///
    /// # Panics
    /// If there is no edge `i`.
    #[must_use]
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.rim.boundary[edge]
    }

    /// Outward normal cone of the *outline* at each corner.
    #[must_use]
    pub fn cones(&self) -> &[Cone] {
        &self.rim.cones
    }

    /// A convex polygon as its own piece.
    pub(crate) fn whole(polygon: &ConvexPolygon) -> Self {
        let normals = polygon.normals();
        let before = normals.last().into_iter().chain(normals);
        let cones = before.zip(normals).map(|(from, to)| Cone {
            from: *from,
            to: *to,
        });
        Self::new(
            polygon.vertices().to_vec(),
            normals.to_vec(),
            vec![true; normals.len()],
            cones.collect(),
        )
    }

    /// A wall without thickness: two vertices, a normal for each side, half a turn at either end.
    pub(crate) fn wall(segment: &Segment) -> Self {
        let [right, left] = *segment.normals();
        let cone = |from, to| Cone { from, to };
        let (vertices, normals) = (segment.vertices().to_vec(), vec![right, left]);
        let cones = vec![cone(left, right), cone(right, left)];
        Self::new(vertices, normals, vec![true; 2], cones)
    }

    pub(crate) fn hide_edge(&mut self, edge: usize) {
        Arc::make_mut(&mut self.rim).boundary[edge] = false;
    }

    pub(crate) fn set_cone(&mut self, corner: usize, cone: Cone) {
        Arc::make_mut(&mut self.rim).cones[corner] = cone;
    }

    /// The same piece moved by `offset`, in m.
    pub(crate) fn translated(&self, offset: Vec2) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| *v + offset).collect(),
            rim: Arc::clone(&self.rim),
            blocks: Blocks::default(),
        }
    }
}

/// The directions in which an outline can be touched at a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Outward unit normal of the outline's edge before the corner; zero in [`Cone::NONE`].
    pub from: Vec2,
    /// Outward unit normal of the outline's edge after the corner; zero in [`Cone::NONE`].
    pub to: Vec2,
}

/// Slack of a cone, as the sine of an angle.
///
/// A normal that is computed along an edge must be found inside: below 1e-14 rounding would lose
/// contacts at random. Above 1e-6 a corner would answer for directions that are visibly an edge's.
const CONE_SLACK: f64 = 1e-9;

impl Cone {
    /// No direction at all, as at a reflex corner.
    pub const NONE: Self = Self {
        from: Vec2::ZERO,
        to: Vec2::ZERO,
    };

    /// Whether the unit `direction`, pointing away from the polygon, lies in the cone, with a slack
    /// of 1e-9 rad.
    #[must_use]
    pub fn contains(&self, direction: Vec2) -> bool {
        !self.is_empty()
            && cross(self.from, direction) >= -CONE_SLACK
            && cross(direction, self.to) >= -CONE_SLACK
            // At a nearly straight corner both sines are about zero behind it, too.
            && (self.from + self.to).dot(direction) >= -CONE_SLACK
    }

    /// Whether no direction lies in the cone.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::NONE
    }
}

/// Convex pieces of a simple counter-clockwise ring without straight corners.
pub(crate) fn decompose(ring: &[Vec2]) -> Vec<ConvexPiece> {
    let outline = Outline::new(ring);
    if outline.cones.iter().all(|cone| !cone.is_empty()) {
        let boundary = vec![true; ring.len()];
        let whole = ConvexPiece::new(ring.to_vec(), outline.normals, boundary, outline.cones);
        return vec![whole];
    }
    let parts = merge(ring, &triangulate(ring));
    parts.iter().map(|part| outline.piece(part)).collect()
}

/// What a piece has to know of the whole.
struct Outline<'a> {
    ring: &'a [Vec2],
    normals: Vec<Vec2>,
    cones: Vec<Cone>,
}

impl<'a> Outline<'a> {
    fn new(ring: &'a [Vec2]) -> Self {
        let normals = outward_normals(ring);
        let before = normals.last().into_iter().chain(&normals);
        let cones = corners(ring)
            .zip(before.zip(&normals))
            .map(|((before, here, after), (from, to))| {
                if orient2d(before, here, after) > 0.0 {
                    Cone {
                        from: *from,
                        to: *to,
                    }
                } else {
                    Cone::NONE
                }
            })
            .collect();
        Self {
            ring,
            normals,
            cones,
        }
    }

    fn piece(&self, part: &[PieceEdge]) -> ConvexPiece {
        let vertices: Vec<Vec2> = part.iter().map(|edge| self.ring[edge.origin]).collect();
        let normals = outward_normals(&vertices);
        let boundary = part.iter().map(|edge| edge.is_boundary).collect();
        let cones = part.iter().map(|edge| self.cones[edge.origin]).collect();
        ConvexPiece::new(vertices, normals, boundary, cones)
    }
}
