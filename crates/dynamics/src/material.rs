//! What a surface is made of.

use crate::error::{BodyError, check_finite};

/// Density and surface of a shape.
///
/// # Examples
/// ```
/// use carom_dynamics::Material;
/// let ice = Material { friction: 0.02, ..Material::default() };
/// let rubber = Material { friction: 0.9, restitution: 0.8, ..Material::default() };
/// let pair = ice.against(&rubber);
/// assert!((pair.friction - (0.02_f64 * 0.9).sqrt()).abs() < 1e-15);    // √(µ_a µ_b)
/// assert_eq!(pair.restitution, 0.8);                                   // max(e_a, e_b)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Mass per area, in kg/m². Above 0 for a moving body whose mass is not given.
    pub density: f64,
    /// Coefficient of Coulomb friction, ≥ 0.
    pub friction: f64,
    /// Coefficient of restitution: 0 sticks, 1 returns all normal speed.
    pub restitution: f64,
}

impl Default for Material {
    /// 1 kg/m², friction 0.6, no restitution.
    fn default() -> Self {
        Self {
            density: 1.0,
            friction: 0.6,
            restitution: 0.0,
        }
    }
}

impl Material {
    /// How this surface and `other` meet: friction √(`µ_a` `µ_b`), restitution `max(e_a`, `e_b`).
    ///
    /// Both rules are idempotent: a pair of equal surfaces has their values.
    #[must_use]
    pub fn against(&self, other: &Self) -> PairMaterial {
        PairMaterial {
            friction: (self.friction * other.friction).sqrt(),
            restitution: if self.restitution > other.restitution {
                self.restitution
            } else {
                other.restitution
            },
        }
    }

    pub(crate) fn check(&self) -> Result<(), BodyError> {
        check_finite("density", self.density)?;
        if self.density < 0.0 {
            return Err(BodyError::Negative {
                field: "density",
                value: self.density,
            });
        }
        PairMaterial {
            friction: self.friction,
            restitution: self.restitution,
        }
        .check()
    }
}

/// How two surfaces meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMaterial {
    /// Coefficient of Coulomb friction of the pair, ≥ 0.
    pub friction: f64,
    /// Coefficient of restitution of the pair, 0..1.
    pub restitution: f64,
}

impl PairMaterial {
    pub(crate) fn check(self) -> Result<(), BodyError> {
        check_finite("friction", self.friction)?;
        check_finite("restitution", self.restitution)?;
        if self.friction < 0.0 {
            return Err(BodyError::Negative {
                field: "friction",
                value: self.friction,
            });
        }
        if !(0.0..=1.0).contains(&self.restitution) {
            return Err(BodyError::Restitution {
                value: self.restitution,
            });
        }
        Ok(())
    }
}
