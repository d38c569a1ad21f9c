//! Answers where a point of one frame lies in another, and on which side of a line it lies.
//!
//! Vectors, rotations, poses, instants, exact predicates, roots, elliptic functions and compensated sums.
//! Everything is `f64`, SI and radians; x points right, y up, and counter-clockwise is positive.
//! The same input gives the same bits on every platform: trigonometry goes through [`trig`],
//! nothing fuses a multiplication with an addition.
//!
//! # Examples
//! ```
//! use carom_math::{Pose, Rot, vec2};
//!
//! let crane = Pose::new(vec2(1.0, 0.0), Rot::from_degrees(90.0)); // at (1, 0) m, a quarter turn to the left
//! let hook = crane.point(vec2(2.0, 0.0)); // 2 m out on the crane's arm
//! assert!((hook - vec2(1.0, 2.0)).length() < 1e-15); // m
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod cross;
mod elliptic;
mod hash;
mod pose;
mod predicate;
mod roots;
mod rot;
mod sum;
mod time;
pub mod trig;
#[cfg(feature = "serde")]
mod wire;
mod within;

pub use cross::{cross, cross_scalar, perp};
pub use elliptic::Elliptic;
pub use glam;
pub use glam::{DVec2 as Vec2, dvec2 as vec2};
pub use hash::StateHash;
pub use pose::Pose;
pub use predicate::orient2d;
pub use roots::falling_root;
pub use rot::Rot;
pub use sum::{Sum, two_product, two_sum};
pub use time::SimTime;
pub use within::within;

#[cfg(test)]
mod conversions;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
