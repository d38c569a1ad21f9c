//! A classic engine for rigid bodies in the plane: whatever touches moves at once, one sub-step after the other.
//!
//! Bodies of convex pieces go in; [`Engine::tick`] finds their contacts and solves for them in sub-steps with a soft law. It
//! knows no world, no queue of events and no law of free flight. Lengths are in metres, angles in radians, counter-clockwise.
//!
//! # Examples
//! ```
//! use carom_geometry::{ConvexPolygon, HalfPlane};
//! use carom_math::{Vec2, vec2};
//! use carom_stepped::{BodyInput, Engine, PieceInput, Settings};
//! let mut engine = Engine::new(Settings::default())?;
//! let floor = PieceInput::new(HalfPlane::new(Vec2::ZERO, Vec2::Y)?);
//! engine.insert(BodyInput::fixed(), &[floor])?;
//! let square = PieceInput::new(ConvexPolygon::square(1.0)?);                   // m
//! let body = BodyInput::dynamic(1.0, 1.0 / 6.0).at(vec2(0.0, 2.0));            // kg, kg·m², m
//! let body = engine.insert(body, &[square])?;
//! for _ in 0..120 {
//!     engine.tick();                                                           // 1/60 s
//! }
//! let at = engine.pose(body)?.position;
//! assert!((at - vec2(0.0, 0.5)).length() < 1e-3);                              // m: it lies on the floor
//! assert_eq!(engine.contacts_of(body)?.count(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bodies;
mod broad;
mod change;
mod continuous;
mod engine;
mod enough;
mod error;
mod finite;
mod ghost;
mod groups;
mod hard;
mod impact;
mod input;
mod insert;
mod ix;
#[cfg(test)]
mod naive;
mod narrow;
mod outline;
mod overlap;
mod pieces;
mod read;
mod record;
mod rows;
mod rules;
mod settings;
mod sleep;
#[cfg(test)]
mod tests;
mod touch;
mod update;
mod whole;

pub use engine::Engine;
pub use error::EngineError;
pub use impact::Impact;
pub use input::{BodyId, BodyInput, BodyKind};
pub(crate) use ix::{BodyIx, ContactIx, Entry, IslandIx, LineIx, PieceIx};
pub use pieces::{Material, PieceInput};
pub use read::{Contact, State};
pub use rules::{Mixed, PairRules, Surface};
pub use settings::{Settings, Sleep, Softness};
pub use touch::Touch;

/// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
