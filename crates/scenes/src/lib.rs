//! Scene files, and the built-in scenes that tests, benches and pictures share.

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod document;
mod error;
mod model;
mod path;
mod random;
mod scene;

pub use document::{MAX_BYTES, VERSION};
pub use error::{Place, Problem, SceneError};
pub use scene::Scene;
