//! What a surface is made of.

use carom_math::Vec2;

use super::error::{BodyError, check_finite, check_not_negative};
use crate::impact::ImpactContact;

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
///
/// A conveyor belt: what lies on it is carried to the right.
/// ```
/// use carom_dynamics::{BodyDef, Material, Settings, World};
/// use carom_geometry::ConvexPolygon;
/// use carom_math::vec2;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = World::new(Settings::default())?;
/// let belt = Material { tangent_speed: -2.0, ..Material::default() };          // m/s, clockwise
/// world.insert(BodyDef::fixed(), ConvexPolygon::rectangle(20.0, 1.0)?, belt)?;
/// let load = BodyDef::dynamic().at(vec2(-5.0, 1.0));
/// let load = world.insert(load, ConvexPolygon::square(1.0)?, Material::default())?;
/// world.step(2.0);
/// let speed = world.body(load).ok_or("it is there")?.velocity().x;
/// assert!((speed - 2.0).abs() < 1e-3);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", default, deny_unknown_fields)
)]
pub struct Material {
    /// Mass per area, in kg/m². Above 0 for a moving body without a given mass.
    pub density: f64,
    /// Coefficient of Coulomb friction, ≥ 0.
    pub friction: f64,
    /// Coefficient of restitution: 0 sticks, 1 returns all normal speed.
    pub restitution: f64,
    /// How fast the surface runs along its outline while the body stays, in m/s: a belt. Above 0 counter-clockwise
    /// around the shape, as the rim of a wheel of positive spin does: the upper side of a floor to the left.
    pub tangent_speed: f64,
}

impl Default for Material {
    /// 1 kg/m², friction 0.6, no restitution, no belt.
    fn default() -> Self {
        Self {
            density: 1.0,
            friction: 0.6,
            restitution: 0.0,
            tangent_speed: 0.0,
        }
    }
}

impl Material {
    /// How this surface and `other` meet: friction √(`µ_a` `µ_b`), restitution `max(e_a`, `e_b`).
    ///
    /// Both rules are idempotent: a pair of equal surfaces has their values. Speeds of surfaces add up: both
    /// run counter-clockwise, so where they meet they run against each other.
    #[must_use]
    pub fn against(&self, other: &Self) -> PairMaterial {
        PairMaterial {
            friction: (self.friction * other.friction).sqrt(),
            restitution: if self.restitution > other.restitution {
                self.restitution
            } else {
                other.restitution
            },
            tangent_speed: self.tangent_speed + other.tangent_speed,
        }
    }

    /// Whether a world takes it, as it asks on insertion.
    ///
    /// # Errors
    /// If density or friction is below 0, restitution outside 0..1, or a number is not finite or beyond [`WORLD_LIMIT`](crate::WORLD_LIMIT).
    pub fn check(&self) -> Result<(), BodyError> {
        check_not_negative("density", self.density)?;
        PairMaterial {
            friction: self.friction,
            restitution: self.restitution,
            tangent_speed: self.tangent_speed,
        }
        .check()
    }
}

/// How two surfaces meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(remote = "Self", default, deny_unknown_fields)
)]
pub struct PairMaterial {
    /// Coefficient of Coulomb friction of the pair, ≥ 0.
    pub friction: f64,
    /// Coefficient of restitution of the pair, 0..1.
    pub restitution: f64,
    /// How fast the surfaces of both run, together, in m/s: see [`Material::tangent_speed`].
    pub tangent_speed: f64,
}

impl PairMaterial {
    /// A contact of such surfaces for the impact laws.
    pub(crate) const fn contact(self, point: Vec2, normal: Vec2) -> ImpactContact {
        ImpactContact {
            point,
            normal,
            restitution: self.restitution,
            friction: self.friction,
        }
    }

    pub(crate) fn check(self) -> Result<(), BodyError> {
        check_not_negative("friction", self.friction)?;
        check_finite("restitution", self.restitution)?;
        check_finite("tangent_speed", self.tangent_speed)?;
        if !(0.0..=1.0).contains(&self.restitution) {
            return Err(BodyError::Restitution {
                value: self.restitution,
            });
        }
        Ok(())
    }
}
