//! The ground floor of carom: vectors, rotations, poses, time, exact predicates and careful sums.
//!
//! Everything is `f64`, SI and radians; x points right, y up, and counter-clockwise is positive.
//! The same input gives the same bits on every platform: trigonometry goes through [`trig`],
//! nothing fuses a multiplication with an addition.
//!
//! # Examples
//! ```
//! use carom_math::{Pose, Rot, vec2};
//!
//! // A quarter turn about (1, 0) takes the frame's own x axis to the world's y axis.
//! let pose = Pose::new(vec2(1.0, 0.0), Rot::from_degrees(90.0));
//! assert!((pose.point(vec2(2.0, 0.0)) - vec2(1.0, 2.0)).length() < 1e-15);
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod cross;
mod hash;
mod pose;
mod predicate;
mod rot;
mod sum;
mod time;
pub mod trig;
#[cfg(feature = "serde")]
mod wire;

pub use cross::{cross, cross_scalar, perp};
pub use glam;
pub use glam::{DVec2 as Vec2, dvec2 as vec2};
pub use hash::StateHash;
pub use pose::Pose;
pub use predicate::orient2d;
pub use rot::Rot;
pub use sum::{Sum, two_product, two_sum};
pub use time::SimTime;

#[cfg(test)]
mod conversions;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
