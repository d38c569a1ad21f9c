//! Mass, centre of mass and moment of inertia.

use core::iter::Sum;
use core::ops::{Add, Sub};

use carom_math::{Pose, Vec2};

use crate::AreaProperties;

/// Mass properties of a body or a part of one; they add up.
///
/// # Examples
/// ```
/// use carom_geometry::{Circle, ConvexPolygon};
/// use carom_math::vec2;
/// # fn main() -> Result<(), carom_geometry::ShapeError> {
/// // A square plate with a disc riveted to its right edge.
/// let plate = ConvexPolygon::square(2.0)?.area_properties().with_mass(3.0);
/// let disc = Circle::at(vec2(1.0, 0.0), 0.5)?.area_properties().with_mass(1.0);
/// let whole = plate + disc;
/// assert_eq!(whole.centroid, vec2(0.25, 0.0));                     // m
/// assert!((whole.inertia - (2.0 + 0.125 + 0.75)).abs() < 1e-15);   // kg·m²: own parts and Steiner
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct MassProperties {
    /// Mass, in kg.
    pub mass: f64,
    /// Centre of mass, in m.
    pub centroid: Vec2,
    /// Moment of inertia about the centre of mass, in kg·m².
    pub inertia: f64,
}

impl MassProperties {
    /// Nothing.
    pub const ZERO: Self = Self {
        mass: 0.0,
        centroid: Vec2::ZERO,
        inertia: 0.0,
    };

    /// Moment of inertia about `point`, in kg·m²: Steiner's parallel axis theorem.
    #[must_use]
    pub fn inertia_about(self, point: Vec2) -> f64 {
        self.inertia + self.mass * (self.centroid - point).length_squared()
    }

    /// The same mass moved by `offset`, in m.
    #[must_use]
    pub fn translated(self, offset: Vec2) -> Self {
        Self {
            centroid: self.centroid + offset,
            ..self
        }
    }

    /// The same mass, given in a frame at `pose`, seen from the parent.
    #[must_use]
    pub fn transformed(self, pose: Pose) -> Self {
        Self {
            centroid: pose.point(self.centroid),
            ..self
        }
    }
}

/// Both masses as one body.
impl Add for MassProperties {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Self::ZERO;
        }
        let between = other.centroid - self.centroid;
        let share = other.mass / mass;
        Self {
            mass,
            centroid: self.centroid + between * share,
            // Steiner about the common centre: reduced mass × distance².
            inertia: self.inertia + other.inertia + self.mass * share * between.length_squared(),
        }
    }
}

/// What is left of a body when a part of it is cut out; [`MassProperties::ZERO`] if nothing is.
///
/// # Examples
/// ```
/// use carom_geometry::ConvexPolygon;
/// # fn main() -> Result<(), carom_geometry::ShapeError> {
/// // A square of 2 m with a square hole of 1 m, 1 kg/m².
/// let whole = ConvexPolygon::square(2.0)?.area_properties().with_density(1.0);
/// let hole = ConvexPolygon::square(1.0)?.area_properties().with_density(1.0);
/// let frame = whole - hole;
/// assert_eq!(frame.mass, 3.0);                                       // kg
/// assert!((frame.inertia - (16.0 - 1.0) / 6.0).abs() < 1e-15);       // kg·m², a⁴/6 of each
/// # Ok(())
/// # }
/// ```
impl Sub for MassProperties {
    type Output = Self;

    fn sub(self, part: Self) -> Self {
        let mass = self.mass - part.mass;
        if mass == 0.0 {
            return Self::ZERO;
        }
        // The whole's centre parts those of the rest and of the part in the ratio of their masses.
        let between = self.centroid - part.centroid;
        let away = between * (part.mass / mass);
        Self {
            mass,
            centroid: self.centroid + away,
            inertia: self.inertia
                - part.inertia
                - mass * away.length_squared()
                - part.mass * between.length_squared(),
        }
    }
}

/// All masses as one body, right to a few roundings however many they are.
impl Sum for MassProperties {
    fn sum<I: Iterator<Item = Self>>(masses: I) -> Self {
        // Mass is to inertia what area is to the polar moment.
        let areas = masses.map(|part| AreaProperties {
            area: part.mass,
            centroid: part.centroid,
            ixx: part.inertia,
            ..AreaProperties::ZERO
        });
        let all: AreaProperties = areas.sum();
        Self {
            mass: all.area,
            centroid: all.centroid,
            inertia: all.polar,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;

    #[test]
    fn many_masses_add_up_as_they_do_one_by_one() {
        let part = |i: i32| MassProperties {
            mass: f64::from(i + 1),
            centroid: vec2(f64::from(i * i), f64::from(-i)),
            inertia: 0.5 * f64::from(i),
        };
        let one_by_one = (0..20)
            .map(part)
            .fold(MassProperties::ZERO, |all, next| all + next);
        let sum: MassProperties = (0..20).map(part).sum();
        assert_eq!(sum.mass, 210.0);
        assert!((sum.centroid - one_by_one.centroid).length() < 1e-13);
        assert!((sum.inertia / one_by_one.inertia - 1.0).abs() < 1e-14);
        assert_eq!([].into_iter().sum::<MassProperties>(), MassProperties::ZERO);
    }
}
