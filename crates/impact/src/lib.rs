//! What an impact does: pure functions from velocities before to velocities after. No shapes, no world, no time.
//!
//! One contact follows a law ([`resolve`]: Stronge's, Poisson's or Newton's restitution, with Coulomb friction along
//! Routh's path); several at one instant share it ([`several`]). Beneath are the methods that other contact problems
//! ask for, too: faces that are held at velocity level ([`held_faces`]), projected Gauss–Seidel sweeps ([`Sweeper`]), linear
//! complementarity ([`lemke`]), projection on cones ([`project`]) and small dense systems ([`dense`]).
//!
//! SI units; a normal points from A to B; impulses act on B, and on A with the opposite sign.
//!
//! # Examples
//! An elastic blow between equal masses passes the whole velocity on.
//! ```
//! use carom_impact::{ImpactBody, ImpactContact, ImpactLaw, resolve};
//! use carom_math::{Vec2, vec2};
//! let disc = |x: f64, v: f64| ImpactBody {
//!     inverse_mass: 1.0,
//!     inverse_inertia: 2.0,
//!     centre: vec2(x, 0.0),
//!     velocity: vec2(v, 0.0),
//!     spin: 0.0,
//! };
//! let contact = ImpactContact { point: vec2(0.5, 0.0), normal: Vec2::X, restitution: 1.0, friction: 0.0 };
//! let after = resolve(ImpactLaw::Stronge, &disc(0.0, 3.0), &disc(1.0, 0.0), &contact);
//! assert_eq!((after.a.velocity.x, after.b.velocity.x, after.normal_impulse), (0.0, 3.0, 3.0));    // m/s, N·s
//! ```
#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod body;
mod coulomb;
pub mod dense;
mod equations;
mod held;
mod law;
pub mod lemke;
mod pivots;
pub mod project;
mod restitution;
mod rough;
#[cfg(test)]
mod rough_tests;
mod routh;
mod rows;
mod scaled;
mod several;
#[cfg(test)]
mod several_tests;
mod sweeps;
mod swept_faces;
#[cfg(test)]
mod tests;

pub use body::{ImpactBody, ImpactContact, Outcome, is_driven};
pub use held::{Friction, HeldFace, HeldFaces, HeldPoint, held_faces};
pub use law::{ImpactLaw, newton, poisson, resolve, stronge};
pub use several::{
    Several, SharedContact, SharedOutcome, blend, generalised_reflections, newton_lcp, several,
};
pub use sweeps::{Growth, Sweeper};
pub use swept_faces::swept_faces;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
