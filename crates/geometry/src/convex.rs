//! Convex polygons: what the separating axis theorem takes.

use carom_math::{Vec2, orient2d, vec2};

use crate::moments::ring_moments;
use crate::ring::Ring;
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
pub struct ConvexPolygon {
    vertices: Vec<Vec2>,
    normals: Vec<Vec2>,
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
        let n = ring.points.len();
        let bent = ring.without_straight();
        let m = bent.points.len();
        for i in 0..m {
            let (before, after) = (bent.points[(i + m - 1) % m], bent.points[(i + 1) % m]);
            if orient2d(before, bent.points[i], after) < 0.0 {
                // Wound around more than once it turns the right way everywhere and is not simple.
                return Err(PolygonError::NotConvex {
                    index: bent.given[i],
                });
            }
        }
        if winds_twice(&bent.points) || (m < n && folds(&ring.points)) {
            ring.check_simple()?;
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
        let normals = outward_normals(&vertices);
        Self { vertices, normals }
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

    /// Area and its moments.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        ring_moments(&self.vertices)
    }

    /// The same polygon moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| *v + offset).collect(),
            normals: self.normals.clone(),
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
    let ends = vertices.iter().zip(vertices.iter().cycle().skip(1));
    ends.map(|(from, to)| {
        let along = *to - *from;
        vec2(along.y, -along.x).normalize_or(Vec2::X)
    })
    .collect()
}

/// A ring that always turns left closes after one turn if x rises once and falls once.
fn winds_twice(points: &[Vec2]) -> bool {
    let n = points.len();
    let rises = |i: usize| {
        let (from, to) = (points[i % n], points[(i + 1) % n]);
        (to.x, to.y) > (from.x, from.y)
    };
    (0..n).filter(|i| rises(*i) && !rises(*i + n - 1)).count() > 1
}

/// Some edge runs straight back over the one before.
fn folds(points: &[Vec2]) -> bool {
    let n = points.len();
    (0..n).any(|i| {
        let (before, here, after) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        orient2d(before, here, after) == 0.0 && (after - here).dot(before - here) > 0.0
    })
}
