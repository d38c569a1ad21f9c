//! Accelerations that depend on the place.

use core::fmt;

use carom_math::Vec2;

use super::error::{BodyError, check_finite, check_positive, check_vec2};

/// A conservative field: every body feels its acceleration at its centre of mass.
///
/// Uniform gravity is not a field but [`crate::Settings::gravity`]: it has a closed form.
pub trait Field: fmt::Debug + Send + Sync {
    /// Acceleration at `position`, in m/s².
    fn acceleration(&self, position: Vec2) -> Vec2;

    /// Potential at `position`, in J/kg, with `acceleration = −∇ potential`.
    fn potential(&self, position: Vec2) -> f64;

    /// A bound on |∇ acceleration| within `radius` metres of `position`, in 1/s².
    ///
    /// It says how far a piece of the path may go before the acceleration must be asked again.
    fn gradient_bound(&self, position: Vec2, radius: f64) -> f64;

    /// The Newtonian centre that the field is outside a core, if it is one: flights about it are conics,
    /// in closed form.
    fn newtonian(&self) -> Option<NewtonianCentre> {
        None
    }
}

/// A centre that pulls with `strength / r²` outside its core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonianCentre {
    /// Where it is, in m.
    pub centre: Vec2,
    /// GM in m³/s², positive attracts.
    pub strength: f64,
    /// Radius of the core, in m, within which the field is another.
    pub core: f64,
}

/// Newton's gravity of a solid core: 1/r² outside, linear inside.
///
/// Inside the core the field is that of a homogeneous ball, so that it is continuous and finite
/// everywhere, whatever shape comes near: one rule for all bodies.
///
/// # Examples
/// ```
/// use carom_dynamics::{Field, RadialField};
/// use carom_math::{Vec2, vec2};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let planet = RadialField::new(Vec2::ZERO, 90.0, 1.0)?;               // m, m³/s², m
/// assert_eq!(planet.acceleration(vec2(3.0, 0.0)), vec2(-10.0, 0.0));   // GM / r²
/// assert_eq!(planet.potential(vec2(3.0, 0.0)), -30.0);                 // −GM / r
/// assert_eq!(planet.acceleration(Vec2::ZERO), Vec2::ZERO);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialField {
    centre: Vec2,
    strength: f64,
    core: f64,
}

impl RadialField {
    /// A field about `centre` (m) of strength GM (m³/s², positive attracts) with a core of radius `core` (m).
    ///
    /// # Errors
    /// If a number is not finite, or the core's radius is not above 0.
    pub fn new(centre: Vec2, strength: f64, core: f64) -> Result<Self, BodyError> {
        check_vec2("field.centre.x", "field.centre.y", centre)?;
        check_finite("field.strength", strength)?;
        check_finite("field.core", core)?;
        check_positive("field.core", core)?;
        Ok(Self {
            centre,
            strength,
            core,
        })
    }

    /// Centre of the field, in m.
    #[must_use]
    pub const fn centre(&self) -> Vec2 {
        self.centre
    }

    /// Radius of the core, in m.
    #[must_use]
    pub const fn core(&self) -> f64 {
        self.core
    }
}

impl Field for RadialField {
    fn acceleration(&self, position: Vec2) -> Vec2 {
        let r = position - self.centre;
        let distance = r.length();
        let d = if distance > self.core {
            distance
        } else {
            self.core
        };
        r * (-self.strength / (d * d * d))
    }

    fn potential(&self, position: Vec2) -> f64 {
        let distance = (position - self.centre).length();
        if distance > self.core {
            -self.strength / distance
        } else {
            // From −GM/R at the rim, less ∫ GM r/R³ dr on the way in.
            let ratio = distance / self.core;
            -self.strength / self.core * (1.5 - 0.5 * ratio * ratio)
        }
    }

    fn gradient_bound(&self, position: Vec2, radius: f64) -> f64 {
        let near = (position - self.centre).length() - radius;
        let d = if near > self.core { near } else { self.core };
        2.0 * self.strength.abs() / (d * d * d)
    }

    fn newtonian(&self) -> Option<NewtonianCentre> {
        Some(NewtonianCentre {
            centre: self.centre,
            strength: self.strength,
            core: self.core,
        })
    }
}
