//! Circles.

use carom_math::Vec2;

use crate::error::{COORDINATE_LIMIT, LENGTH_LIMIT};
use crate::{AreaProperties, ShapeError};

/// A disc.
///
/// # Examples
/// ```
/// use carom_geometry::Circle;
/// let disc = Circle::new(2.0)?.area_properties().with_mass(3.0);
/// assert_eq!(disc.inertia, 6.0);                                   // kg·m², m r² / 2
/// # Ok::<(), carom_geometry::ShapeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "crate::wire::CircleData", into = "crate::wire::CircleData")
)]
pub struct Circle {
    centre: [Vec2; 1],
    radius: f64,
}

impl Circle {
    /// A circle about the origin; `radius` in m.
    ///
    /// # Errors
    /// If the radius is not finite, not above 0 or out of range.
    pub fn new(radius: f64) -> Result<Self, ShapeError> {
        Self::at(Vec2::ZERO, radius)
    }

    /// A circle about `centre`; both in m.
    ///
    /// # Errors
    /// If a number is not finite, the radius is not above 0, or one is out of range.
    pub fn at(centre: Vec2, radius: f64) -> Result<Self, ShapeError> {
        check_point(["centre.x", "centre.y"], centre)?;
        if !radius.is_finite() {
            return Err(ShapeError::NotFinite {
                name: "radius",
                value: radius,
            });
        }
        if radius <= 0.0 {
            return Err(ShapeError::NotPositive {
                name: "radius",
                value: radius,
            });
        }
        if !(LENGTH_LIMIT..=COORDINATE_LIMIT).contains(&radius) {
            return Err(ShapeError::OutOfRange {
                name: "radius",
                value: radius,
                low: LENGTH_LIMIT,
                high: COORDINATE_LIMIT,
            });
        }
        Ok(Self {
            centre: [centre],
            radius,
        })
    }

    /// Centre, in m.
    #[must_use]
    pub const fn centre(&self) -> Vec2 {
        self.centre[0]
    }

    /// Radius, in m.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// The centre as a list of one vertex, for algorithms over vertices and a radius.
    #[must_use]
    pub const fn vertices(&self) -> &[Vec2; 1] {
        &self.centre
    }

    /// Area and its moments: π r², and a quarter of r² times it about any diameter.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        let square = self.radius * self.radius;
        let area = core::f64::consts::PI * square;
        AreaProperties {
            area,
            centroid: self.centre[0],
            polar: 0.5 * area * square,
            ixx: 0.25 * area * square,
            iyy: 0.25 * area * square,
            ixy: 0.0,
        }
    }

    /// The same circle moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        Self {
            centre: [self.centre[0] + offset],
            radius: self.radius,
        }
    }
}

/// Finite and within the limit.
pub(crate) fn check_point(names: [&'static str; 2], p: Vec2) -> Result<(), ShapeError> {
    for (name, value) in names.into_iter().zip([p.x, p.y]) {
        if !value.is_finite() {
            return Err(ShapeError::NotFinite { name, value });
        }
        if value.abs() > COORDINATE_LIMIT {
            return Err(ShapeError::OutOfRange {
                name,
                value,
                low: 0.0,
                high: COORDINATE_LIMIT,
            });
        }
    }
    Ok(())
}
