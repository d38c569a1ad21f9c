//! What a caller does to a body: impulses now, forces for one step.

use carom_math::{Vec2, cross};

use super::error::{BodyError, check_finite, check_vec2};

/// A change of momentum, acting at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    pub(crate) linear: Vec2,
    pub(crate) angular: f64,
    pub(crate) point: Option<Vec2>,
}

impl Impulse {
    /// `impulse` in N·s at the world point `point` in m: `v += J/m`, `ω += (r × J)/I`.
    ///
    /// # Examples
    /// ```
    /// use carom_dynamics::{BodyDef, Impulse, Material, Settings, World};
    /// use carom_geometry::ConvexPolygon;
    /// use carom_math::{Vec2, vec2};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut world = World::new(Settings { gravity: Vec2::ZERO, ..Settings::default() })?;
    /// let square = ConvexPolygon::square(2.0)?;                        // 4 kg, I = 8/3 kg·m²
    /// let id = world.insert(BodyDef::dynamic(), square, Material::default())?;
    /// world.apply(id, Impulse::at(vec2(1.0, 0.0), vec2(0.0, 8.0)))?;   // N·s
    /// let body = world.body(id).ok_or("just inserted")?;
    /// assert!((body.velocity() - vec2(0.0, 2.0)).length() < 1e-14);    // m/s
    /// assert!((body.angular_velocity() - 3.0).abs() < 1e-14);          // rad/s
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub const fn at(point: Vec2, impulse: Vec2) -> Self {
        Self {
            linear: impulse,
            angular: 0.0,
            point: Some(point),
        }
    }

    /// `impulse` in N·s at the centre of mass.
    #[must_use]
    pub const fn central(impulse: Vec2) -> Self {
        Self {
            linear: impulse,
            angular: 0.0,
            point: None,
        }
    }

    /// An angular impulse in N·m·s, counter-clockwise.
    #[must_use]
    pub const fn angular(impulse: f64) -> Self {
        Self {
            linear: Vec2::ZERO,
            angular: impulse,
            point: None,
        }
    }

    /// Angular part about `centre`, in N·m·s.
    pub(crate) fn about(&self, centre: Vec2) -> f64 {
        self.angular
            + self
                .point
                .map_or(0.0, |point| cross(point - centre, self.linear))
    }

    pub(crate) fn check(&self) -> Result<(), BodyError> {
        check_vec2("impulse.x", "impulse.y", self.linear)?;
        check_finite("angular impulse", self.angular)?;
        check_vec2("point.x", "point.y", self.point.unwrap_or_default())
    }
}

/// A force or torque that acts during the next step and is gone after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force {
    pub(crate) linear: Vec2,
    pub(crate) torque: f64,
    pub(crate) point: Option<Vec2>,
}

impl Force {
    /// `force` in N at the world point `point` in m: adds the torque `r × F` of this instant.
    #[must_use]
    pub const fn at(point: Vec2, force: Vec2) -> Self {
        Self {
            linear: force,
            torque: 0.0,
            point: Some(point),
        }
    }

    /// `force` in N at the centre of mass.
    #[must_use]
    pub const fn central(force: Vec2) -> Self {
        Self {
            linear: force,
            torque: 0.0,
            point: None,
        }
    }

    /// A torque in N·m, counter-clockwise.
    #[must_use]
    pub const fn torque(torque: f64) -> Self {
        Self {
            linear: Vec2::ZERO,
            torque,
            point: None,
        }
    }

    /// Torque about `centre`, in N·m.
    pub(crate) fn about(&self, centre: Vec2) -> f64 {
        self.torque
            + self
                .point
                .map_or(0.0, |point| cross(point - centre, self.linear))
    }

    pub(crate) fn check(&self) -> Result<(), BodyError> {
        check_vec2("force.x", "force.y", self.linear)?;
        check_finite("torque", self.torque)?;
        check_vec2("point.x", "point.y", self.point.unwrap_or_default())
    }
}
