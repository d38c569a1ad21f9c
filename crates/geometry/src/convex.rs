//! Convex polygons: what the separating axis theorem takes.

use std::sync::Arc;

use carom_math::{Vec2, orient2d, vec2};

use crate::blocks::{Blocks, EdgeBlock};
use crate::moments::polygon_moments;
use crate::query::winds_around;
use crate::ring::{Ring, corners};
use crate::{AreaProperties, PolygonError, hull};

/// A strictly convex polygon, counter-clockwise, with any number of vertices.
///
/// # Examples
/// ```
/// use carom_geometry::ConvexPolygon;
/// let square = ConvexPolygon::rectangle(2.0, 2.0)?;               // m
/// let mass = square.area_properties().with_density(3.0);          // kg/m²
/// assert!((mass.mass - 12.0).abs() < 1e-14);                      // kg
/// assert!((mass.inertia - 8.0).abs() < 1e-14);                    // kg·m², m (w² + h²) / 12
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<Vec2>", into = "Vec<Vec2>")
)]
pub struct ConvexPolygon {
    vertices: Box<[Vec2]>,
    /// Shared with the same polygon elsewhere.
    normals: Arc<[Vec2]>,
    blocks: Blocks,
}

impl ConvexPolygon {
    /// The convex polygon with the given vertices, in m, in either order of turn.
    ///
    /// Points that repeat their neighbour or lie exactly between two others are dropped.
    ///
    /// # Errors
    /// If the points make no polygon, or one that is not convex: the error names the vertex.
    pub fn new(points: impl Into<Vec<Vec2>>) -> Result<Self, PolygonError> {
        let ring = Ring::new(&points.into())?;
        let bent = ring.without_straight().counter_clockwise();
        let dent = corners(&bent.points)
            .position(|(before, here, after)| orient2d(before, here, after) < 0.0);
        let straight = bent.points.len() < ring.points.len();
        // A ring that turns left everywhere may still go around twice, or straight back.
        if dent.is_some() || winds_twice(&bent.points) || (straight && ring.folds()) {
            ring.check_simple()?;
            return Err(PolygonError::NotConvex {
                index: dent.map_or(0, |at| bent.given[at]),
            });
        }
        Ok(Self::from_checked(bent.points))
    }

    /// The convex hull of points in any order, in m.
    ///
    /// # Errors
    /// If there are fewer than three points off one line, or one is not finite or too large.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// use carom_math::vec2;
    /// let points = [vec2(0.0, 0.0), vec2(1.0, 1.0), vec2(2.0, 0.0), vec2(1.0, 0.2), vec2(2.0, 2.0)];
    /// assert_eq!(ConvexPolygon::hull(points)?.vertices(), [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(2.0, 2.0)]);
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn hull(points: impl Into<Vec<Vec2>>) -> Result<Self, PolygonError> {
        Ok(Self::from_checked(hull::convex_hull(&points.into())?))
    }

    /// Vertices that are known to be strictly convex and counter-clockwise.
    pub(crate) fn from_checked(vertices: Vec<Vec2>) -> Self {
        Self {
            normals: outward_normals(&vertices).into(),
            vertices: vertices.into(),
            blocks: Blocks::default(),
        }
    }

    /// Corners, counter-clockwise, in m.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// Outward unit normals; number `i` belongs to the edge from vertex `i` to the next.
    #[must_use]
    pub fn normals(&self) -> &[Vec2] {
        &self.normals
    }

    /// The edges in order, four at a time: corners and normals.
    #[must_use]
    pub fn blocks(&self) -> &[EdgeBlock] {
        self.blocks.of(&self.vertices, &self.normals)
    }

    /// Area and its moments.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        polygon_moments(&self.vertices, [&*self.vertices])
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
        Self {
            vertices: self.vertices.iter().map(|v| *v + offset).collect(),
            normals: Arc::clone(&self.normals),
            blocks: Blocks::default(),
        }
    }

    /// The same polygon moved so that its centroid is at the origin.
    #[must_use]
    pub fn centred(&self) -> Self {
        self.translated(-self.area_properties().centroid)
    }
}

/// Normal of each edge: the edge turned by −90 degrees.
pub(crate) fn outward_normals(vertices: &[Vec2]) -> Vec<Vec2> {
    let ends = vertices.iter().skip(1).chain(vertices.first());
    vertices
        .iter()
        .zip(ends)
        .map(|(from, to)| outward_normal(*from, *to))
        .collect()
}

/// Unit normal on the right of the way `from → to`, of any length: its square may underflow.
pub(crate) fn outward_normal(from: Vec2, to: Vec2) -> Vec2 {
    let along = to - from;
    let along = along / along.abs().max_element();
    vec2(along.y, -along.x).normalize_or(Vec2::X)
}

/// A ring that always turns left closes after one turn if x rises once and falls once.
fn winds_twice(points: &[Vec2]) -> bool {
    let turns_back = |(before, here, after): &(Vec2, Vec2, Vec2)| {
        let key = |p: &Vec2| (p.x, p.y);
        key(here) < key(before) && key(here) < key(after)
    };
    corners(points).filter(turns_back).count() > 1
}
