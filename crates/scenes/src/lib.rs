//! Answers which world a scene file describes, and holds the built-in scenes that tests, benchmarks and pictures share.
//!
//! A scene file is TOML: settings, gravity or a field, bodies written out or made by generators (walls, stacks, pyramids,
//! grids, random populations), a camera and the appearance of bodies. [`Scene::load`] reads one, [`find`] returns a built-in one;
//! [`Scene::set`] overrides values of it, and [`Scene::build`] makes the world and all that its pictures need. An error in
//! a file is a [`SceneError`]: one line with file, line, column and field. The crate's README is the
//! reference of the format.
//!
//! Same file and seed, same bits, on every machine.
//!
//! # Examples
//! ```
//! use carom_scenes::find;
//!
//! let mut scene = find("flying-balls")?;
//! scene.set("n", "5")?;                                        // the original program's name
//! scene.set("camera.size", "[640, 480]")?;                     // any path of the file
//! let built = scene.build()?;
//! let balls = built.names.iter().filter(|(name, _)| name.starts_with("balls/"));
//! assert_eq!(balls.count(), 5);
//! assert_eq!(built.camera.size().to_string(), "640 x 480");
//! let error = scene.set("parameters.radios", "1").unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "flying-balls: --set parameters.radios=1: parameters.radios: unknown field, did you mean \"radius\"?"
//! );
//! # Ok::<(), carom_scenes::SceneError>(())
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

#[cfg(test)]
mod broken_tests;
mod build;
#[cfg(test)]
mod build_tests;
mod built;
mod builtin;
#[cfg(test)]
mod builtin_tests;
mod document;
mod error;
mod model;
mod overlay;
mod path;
mod plain;
#[cfg(test)]
mod populate_tests;
mod random;
#[cfg(test)]
mod reference_tests;
mod scene;
mod words;

pub use built::Built;
pub use builtin::{SceneInfo, find, list, load, open};
pub use document::{MAX_BYTES, VERSION};
pub use error::{Place, Problem, SceneError};
pub use plain::{
    GrowthKind, MAX_GROWTH, PlainBody, PlainError, PlainInfo, PlainKind, PlainMaterial, PlainScene,
    PlainShape, growth_scene, lively_scenes, plain_scene, plain_scenes, spaced_scene,
};
pub use scene::Scene;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDocTests;
