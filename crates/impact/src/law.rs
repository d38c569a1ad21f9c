//! The three laws of a single impact with friction.

use carom_math::within;

use super::body::{ImpactBody, ImpactContact, Outcome, Response};
use super::routh::{EndRule, follow};

/// Which law turns the velocities before an impact into those after.
///
/// All agree without friction and for discs. With friction and a lever arm only [`Self::Stronge`]
/// and [`Self::Poisson`] never gain energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum ImpactLaw {
    /// Energetic restitution along the Routh path: work given back = e² × work taken in.
    #[default]
    Stronge,
    /// Kinetic restitution along the Routh path: impulse given back = e × impulse taken in.
    Poisson,
    /// Kinematic restitution at the end point: normal speed after = e × normal speed before.
    Newton,
}

/// What the impact of `a` and `b` at `contact` does under `law`.
///
/// Where a number is NaN or infinite the answer means nothing.
#[must_use]
pub fn resolve(law: ImpactLaw, a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Outcome {
    if contact.friction == 0.0 {
        return Outcome::smooth(a, b, contact);
    }
    match law {
        ImpactLaw::Stronge => stronge(a, b, contact),
        ImpactLaw::Poisson => poisson(a, b, contact),
        ImpactLaw::Newton => newton(a, b, contact),
    }
}

/// Newton's law with end-point Coulomb friction.
///
/// `v_n⁺ = −e v_n⁻`, and the tangential impulse either stops the slip or is µ times the normal one
/// and opposes what slip is left. Can gain energy when friction reverses the slip (Kane 1984).
///
/// # Examples
/// ```
/// use carom_impact::{newton, ImpactBody, ImpactContact};
/// use carom_geometry::Circle;
/// use carom_math::{Vec2, vec2};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A disc falls on a floor at 2 m/s with e = 0.5: it leaves with 1 m/s.
/// let mass = Circle::new(1.0)?.area_properties().with_mass(3.0);
/// let floor = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
/// let disc = ImpactBody::free(mass, vec2(0.0, 1.0), vec2(0.0, -2.0), 0.0);
/// let contact = ImpactContact { point: Vec2::ZERO, normal: Vec2::Y, restitution: 0.5, friction: 0.0 };
/// let after = newton(&floor, &disc, &contact);
/// assert_eq!(after.b.velocity, vec2(0.0, 1.0));                // m/s
/// assert_eq!(after.normal_impulse, 9.0);                       // N·s, (1 + e) m v
/// assert_eq!(after.loss, 4.5);                                 // J, (1 − e²) m v²/2
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn newton(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Outcome {
    let k = Response::of(a, b, contact);
    Outcome::of(a, b, contact, newton_impulses(&k, contact))
}

/// Poisson's law along the Routh path.
///
/// # Examples
/// A slender rod that hits a rough floor slips, sticks or slips back; no energy is gained.
/// ```
/// use carom_impact::{poisson, ImpactBody, ImpactContact};
/// use carom_geometry::ConvexPolygon;
/// use carom_math::{Vec2, vec2};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mass = ConvexPolygon::rectangle(2.0, 0.1)?.area_properties().with_density(1.0);
/// let floor = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
/// let rod = ImpactBody::free(mass, vec2(0.7, 0.7), vec2(1.0, -2.0), 0.3);
/// let contact = ImpactContact { point: Vec2::ZERO, normal: Vec2::Y, restitution: 1.0, friction: 0.5 };
/// assert!(poisson(&floor, &rod, &contact).loss >= 0.0);
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn poisson(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Outcome {
    let k = Response::of(a, b, contact);
    Outcome::of(a, b, contact, follow(&k, contact, EndRule::Impulse))
}

/// Stronge's law along the Routh path: the work of the normal impulse in restitution is e² times
/// that in compression, so no impact gains energy.
///
/// Source: W. J. Stronge, *Impact Mechanics*, 2000, chapter 5.
///
/// # Examples
/// ```
/// use carom_impact::{stronge, ImpactBody, ImpactContact};
/// use carom_geometry::Circle;
/// use carom_math::{Vec2, vec2};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // Two equal discs, head on, e = 1: they swap velocities.
/// let mass = Circle::new(0.5)?.area_properties().with_density(1.0);
/// let left = ImpactBody::free(mass, vec2(-0.5, 0.0), vec2(2.0, 0.0), 0.0);
/// let right = ImpactBody::free(mass, vec2(0.5, 0.0), vec2(0.0, 0.0), 0.0);
/// let contact = ImpactContact { point: Vec2::ZERO, normal: Vec2::X, restitution: 1.0, friction: 0.2 };
/// let after = stronge(&left, &right, &contact);
/// assert!(after.a.velocity.length() < 1e-15 && (after.b.velocity.x - 2.0).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn stronge(a: &ImpactBody, b: &ImpactBody, contact: &ImpactContact) -> Outcome {
    let k = Response::of(a, b, contact);
    Outcome::of(a, b, contact, follow(&k, contact, EndRule::Work))
}

/// Stick if the cone allows it, else the slip in the direction that its own friction opposes.
fn newton_impulses(k: &Response, contact: &ImpactContact) -> (f64, f64) {
    if k.u_n >= 0.0 || k.k_nn == 0.0 {
        return (0.0, 0.0);
    }
    let rise = -(1.0 + contact.restitution) * k.u_n;
    let mu = contact.friction;
    if mu == 0.0 {
        return (rise / k.k_nn, 0.0);
    }
    // Stick: K j = (rise, −u_t).
    let determinant = k.k_nn * k.k_tt - k.k_nt * k.k_nt;
    let jn = (rise * k.k_tt + k.u_t * k.k_nt) / determinant;
    let jt = (-k.u_t * k.k_nn - rise * k.k_nt) / determinant;
    if jn >= 0.0 && jt.abs() <= mu * jn {
        return (jn, jt);
    }
    // Slip in direction s: j_t = −s µ j_n. Both can be consistent (Painlevé); the slip that is
    // there before the impact goes first.
    let before = if k.u_t < 0.0 { -1.0 } else { 1.0 };
    for s in [before, -before] {
        let slope = k.k_nn - s * mu * k.k_nt;
        let jn = rise / slope;
        let slip = k.u_t + jn * (k.k_nt - s * mu * k.k_tt);
        if slope > 0.0 && slip * s >= 0.0 {
            return (jn, -s * mu * jn);
        }
    }
    // Neither holds only where rounding blurs the border of the cone: there slip and stick agree.
    let jn = jn.max(0.0);
    (jn, within(jt, -mu * jn, mu * jn))
}
