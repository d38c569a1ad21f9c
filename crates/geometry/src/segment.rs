//! Segments: walls without thickness.

use carom_math::Vec2;

use crate::ShapeError;
use crate::circle::check_point;
use crate::convex::outward_normal;

/// A straight wall from `a` to `b`, solid from both sides; it has no area and no mass.
///
/// # Examples
/// ```
/// use carom_geometry::Segment;
/// use carom_math::{Vec2, vec2};
/// let floor = Segment::new(vec2(-5.0, 0.0), vec2(5.0, 0.0))?;
/// assert_eq!(floor.normals(), &[-Vec2::Y, Vec2::Y]);
/// # Ok::<(), carom_geometry::ShapeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "crate::wire::SegmentData",
        into = "crate::wire::SegmentData"
    )
)]
pub struct Segment {
    vertices: [Vec2; 2],
    normals: [Vec2; 2],
}

impl Segment {
    /// The segment from `a` to `b`, in m.
    ///
    /// # Errors
    /// If a number is not finite or too large, or both ends are at one place.
    pub fn new(a: Vec2, b: Vec2) -> Result<Self, ShapeError> {
        check_point(["a.x", "a.y"], a)?;
        check_point(["b.x", "b.y"], b)?;
        if a == b {
            return Err(ShapeError::NoLength { x: a.x, y: a.y });
        }
        let normal = outward_normal(a, b);
        Ok(Self {
            vertices: [a, b],
            normals: [normal, -normal],
        })
    }

    /// One end, in m.
    #[must_use]
    pub const fn a(&self) -> Vec2 {
        self.vertices[0]
    }

    /// The other end, in m.
    #[must_use]
    pub const fn b(&self) -> Vec2 {
        self.vertices[1]
    }

    /// Where along the segment its point nearest to `point` lies: 0 at a, 1 at b.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::Segment;
    /// use carom_math::vec2;
    /// let segment = Segment::new(vec2(0.0, 0.0), vec2(4.0, 0.0))?;
    /// assert_eq!(segment.fraction(vec2(1.0, 7.0)), 0.25);
    /// assert_eq!(segment.fraction(vec2(9.0, 0.0)), 1.0);
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn fraction(&self, point: Vec2) -> f64 {
        let [a, b] = self.vertices;
        // Halved, so that the square of the longest one does not overflow.
        let (way, to) = ((b - a) * 0.5, (point - a) * 0.5);
        (to.dot(way) / way.length_squared()).clamp(0.0, 1.0)
    }

    /// Both ends, in m.
    #[must_use]
    pub const fn vertices(&self) -> &[Vec2; 2] {
        &self.vertices
    }

    /// Unit normals of the two sides: of `a → b` and of `b → a`.
    #[must_use]
    pub const fn normals(&self) -> &[Vec2; 2] {
        &self.normals
    }

    /// The same segment moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        Self {
            vertices: self.vertices.map(|v| v + offset),
            normals: self.normals,
        }
    }
}
