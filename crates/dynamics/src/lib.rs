//! Answers where rigid bodies in the plane are at a later instant, and where their energy went.
//!
//! A body's state is a [`Motion`]: a closed form in time. Free flight is evaluated from it and never
//! stepped; impacts happen at their instants, by one of the laws in [`impact`]; lasting contacts
//! move in closed form while their contact modes allow it, else the engine moves them in sub-steps.
//! [`World::step`] asks where everything is `dt` later: `dt` only observes.
//!
//! # Examples
//! An elastic ball is back where it was dropped.
//! ```
//! use carom_dynamics::{BodyDef, Material, Settings, World};
//! use carom_geometry::{Circle, ConvexPolygon};
//! use carom_math::vec2;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut world = World::new(Settings { gravity: vec2(0.0, -10.0), ..Settings::default() })?;
//! let elastic = Material { restitution: 1.0, friction: 0.0, ..Material::default() };
//! world.insert(BodyDef::fixed().at(vec2(0.0, -1.0)), ConvexPolygon::rectangle(20.0, 2.0)?, elastic)?;
//! let drop = BodyDef::dynamic().at(vec2(0.0, 5.5));            // 5 m below the ball's rim
//! let ball = world.insert(drop, Circle::new(0.5)?, elastic)?;
//! world.step(2.0);                                             // 1 s down, 1 s up
//! let height = world.body(ball).ok_or("it is there")?.centre().y;
//! assert!((height - 5.5).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod analytic;
mod analytic_motion;
mod api;
mod broad;
mod changed;
mod engine;
mod events;
mod forces;
mod island_ends;
mod islands;
mod law;
mod members;
mod model;
mod motion;
mod paths;
mod step;
mod stepping;
mod store;
mod substep;
mod values;
mod waiting;
mod work;
mod world;

pub use api::body::Body;
pub use api::query::{Filtered, Nearest, RayHit, ShapeHit};
pub use carom_collision::Motion;
pub use carom_geometry as geometry;
pub use carom_impact as impact;
pub use carom_impact::{ImpactLaw, Several};
pub use carom_math as math;
pub use values::body_def::{BodyDef, BodyKind};
pub use values::contact::{Contact, ContactPoint};
pub use values::error::{BodyError, SettingsError, WORLD_LIMIT};
pub use values::event::{ContactMode, Event, EventKind, Events};
pub use values::field::{Field, NewtonianCentre, RadialField};
pub use values::filter::Filter;
pub use values::force::{Force, Impulse};
pub use values::id::BodyId;
pub use values::ledger::{EnergyLedger, Momentum};
pub use values::material::{Material, PairMaterial};
pub use values::profile::StepProfile;
pub use values::report::{Refusal, StepReport};
pub use values::settings::{Mode, PairSearch, Settings, Sleep, Softness};
pub use world::World;

pub(crate) use values::ix::{BodyIx, ColliderIx, ImpactIx, IslandIx, Ix, MoverIx, PairIx, Two};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
