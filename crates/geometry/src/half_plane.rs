//! Half-planes: everything behind a line.

use carom_math::{Pose, Vec2};

use crate::circle::check_point;
use crate::{Aabb, ShapeError};

/// Everything behind a straight line, without end: ground, or the wall of a room.
///
/// It has no mass and no finite box, so that only a body that never moves can wear it.
///
/// # Examples
/// ```
/// use carom_geometry::HalfPlane;
/// use carom_math::{Vec2, vec2};
/// let ground = HalfPlane::new(vec2(0.0, -1.0), Vec2::Y)?;          // everything below y = −1 m
/// assert_eq!(ground.height_of(vec2(7.0, 2.0)), 3.0);               // m
/// assert!(ground.contains(vec2(1e9, -5.0)));
/// # Ok::<(), carom_geometry::ShapeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "crate::wire::HalfPlaneData",
        into = "crate::wire::HalfPlaneData"
    )
)]
pub struct HalfPlane {
    point: [Vec2; 1],
    normal: [Vec2; 1],
}

impl HalfPlane {
    /// The same with a normal that is of unit length already.
    #[cfg(feature = "serde")]
    pub(crate) const fn with_unit(self, normal: Vec2) -> Self {
        Self {
            normal: [normal],
            ..self
        }
    }

    /// All that lies behind the line through `point` (in m) across `outward`, of any length above 0.
    ///
    /// # Errors
    /// If a number is not finite, the point is too far out, or the normal has no direction.
    pub fn new(point: Vec2, outward: Vec2) -> Result<Self, ShapeError> {
        check_point(["point.x", "point.y"], point)?;
        for (name, value) in [("normal.x", outward.x), ("normal.y", outward.y)] {
            if !value.is_finite() {
                return Err(ShapeError::NotFinite { name, value });
            }
        }
        // By the larger coordinate first: the square of a short normal underflows.
        let scaled = outward / outward.abs().max_element();
        let Some(normal) = scaled.try_normalize() else {
            return Err(ShapeError::NoDirection { name: "normal" });
        };
        Ok(Self {
            point: [point],
            normal: [normal],
        })
    }

    /// A point of the line, in m: the one that was given.
    #[must_use]
    pub const fn point(&self) -> Vec2 {
        self.point[0]
    }

    /// Outward unit normal.
    #[must_use]
    pub const fn normal(&self) -> Vec2 {
        self.normal[0]
    }

    /// The point of the line as a list of one vertex.
    #[must_use]
    pub const fn vertices(&self) -> &[Vec2; 1] {
        &self.point
    }

    /// The normal as a list of one.
    #[must_use]
    pub const fn normals(&self) -> &[Vec2; 1] {
        &self.normal
    }

    /// How far `point` lies in front of the line, in m; negative behind it.
    #[must_use]
    pub fn height_of(&self, point: Vec2) -> f64 {
        self.normal[0].dot(point - self.point[0])
    }

    /// Whether `point` (in m) lies behind the line or on it, up to the rounding of the normal.
    #[must_use]
    pub fn contains(&self, point: Vec2) -> bool {
        self.height_of(point) <= 0.0
    }

    /// The box around it when its frame is at `pose`: without end, but for the side that a line
    /// along an axis closes.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::HalfPlane;
    /// use carom_math::{Pose, Vec2};
    /// let ground = HalfPlane::new(Vec2::ZERO, Vec2::Y)?.aabb(Pose::IDENTITY);
    /// assert_eq!((ground.min.y, ground.max.y), (f64::NEG_INFINITY, 0.0));
    /// assert_eq!(ground.max.x, f64::INFINITY);
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn aabb(&self, pose: Pose) -> Aabb {
        let (point, normal) = (pose.point(self.point[0]), pose.vector(self.normal[0]));
        let mut all = Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
        if normal.x == 0.0 {
            if normal.y > 0.0 {
                all.max.y = point.y;
            } else {
                all.min.y = point.y;
            }
        } else if normal.y == 0.0 {
            if normal.x > 0.0 {
                all.max.x = point.x;
            } else {
                all.min.x = point.x;
            }
        }
        all
    }

    /// The same half-plane moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        Self {
            point: [self.point[0] + offset],
            normal: self.normal,
        }
    }
}
