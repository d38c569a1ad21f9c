//! What a caller does to a body: impulses now, forces for one step.

use carom_math::{Vec2, cross};

use super::error::{BodyError, check_finite, check_vec2};

/// What acts on a body: an impulse in N·s and N·m·s, or a force in N and N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Push {
    pub(crate) linear: Vec2,
    angular: f64,
    /// Where it acts; `None`: at the centre of mass.
    point: Option<Vec2>,
}

impl Push {
    const fn new(linear: Vec2, angular: f64, point: Option<Vec2>) -> Self {
        Self {
            linear,
            angular,
            point,
        }
    }

    /// Angular part about `centre`.
    pub(crate) fn about(&self, centre: Vec2) -> f64 {
        self.angular
            + self
                .point
                .map_or(0.0, |point| cross(point - centre, self.linear))
    }

    fn checked(self, [x, y, angular]: [&'static str; 3]) -> Result<Self, BodyError> {
        check_vec2(x, y, self.linear)?;
        check_finite(angular, self.angular)?;
        check_vec2("point.x", "point.y", self.point.unwrap_or_default())?;
        Ok(self)
    }
}

/// A change of momentum, acting at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse(Push);

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
        Self(Push::new(impulse, 0.0, Some(point)))
    }

    /// `impulse` in N·s at the centre of mass.
    #[must_use]
    pub const fn central(impulse: Vec2) -> Self {
        Self(Push::new(impulse, 0.0, None))
    }

    /// An angular impulse in N·m·s, counter-clockwise.
    #[must_use]
    pub const fn angular(impulse: f64) -> Self {
        Self(Push::new(Vec2::ZERO, impulse, None))
    }

    pub(crate) fn checked(self) -> Result<Push, BodyError> {
        let names = ["impulse.x", "impulse.y", "angular impulse"];
        self.0.checked(names)
    }
}

/// A force or torque that acts during the next step and is gone after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force(Push);

impl Force {
    /// `force` in N at the world point `point` in m: adds the torque `r × F` of this instant.
    #[must_use]
    pub const fn at(point: Vec2, force: Vec2) -> Self {
        Self(Push::new(force, 0.0, Some(point)))
    }

    /// `force` in N at the centre of mass.
    #[must_use]
    pub const fn central(force: Vec2) -> Self {
        Self(Push::new(force, 0.0, None))
    }

    /// A torque in N·m, counter-clockwise.
    #[must_use]
    pub const fn torque(torque: f64) -> Self {
        Self(Push::new(Vec2::ZERO, torque, None))
    }

    pub(crate) fn checked(self) -> Result<Push, BodyError> {
        self.0.checked(["force.x", "force.y", "torque"])
    }
}
