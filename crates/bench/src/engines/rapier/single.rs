//! Rapier in `f32`: 4 lanes, or 8 with the feature `rapier-8` on a processor with AVX2.

use carom_scenes::PlainScene;

use crate::engine::{Engine, EngineError, Setup};

#[allow(
    clippy::duplicate_mod,
    reason = "one source, two precisions: the library is two crates"
)]
#[path = "world.rs"]
mod world;

use rapier2d as library;

const LANES: u32 = if cfg!(feature = "rapier-8") { 8 } else { 4 };

#[expect(
    clippy::cast_possible_truncation,
    reason = "this is where the precision is lost"
)]
const fn narrow(x: f64) -> f32 {
    x as f32
}

fn widen(x: f32) -> f64 {
    x.into()
}

pub(in crate::engines) fn open(
    name: &str,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    world::open(name, scene, setup)
}
