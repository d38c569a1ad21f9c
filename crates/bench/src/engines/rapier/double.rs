//! Rapier in `f64`: 4 lanes.

use carom_scenes::PlainScene;

use crate::engine::{Engine, EngineError, Setup};

#[allow(
    clippy::duplicate_mod,
    reason = "one source, two precisions: the library is two crates"
)]
#[path = "world.rs"]
mod world;

use rapier2d_f64 as library;

const LANES: u32 = 4;

const fn narrow(x: f64) -> f64 {
    x
}

const fn widen(x: f64) -> f64 {
    x
}

pub(in crate::engines) fn open(
    name: &str,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    world::open(name, scene, setup)
}
