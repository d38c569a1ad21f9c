//! Mass, centre of mass and moment of inertia.

use core::ops::Add;

use carom_math::{Pose, Vec2};

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
