//! The engines that were built in, by name.

#[cfg(feature = "box2d")]
mod box2d;
#[cfg(all(test, any(feature = "box2d", feature = "chipmunk")))]
mod c_peers_tests;
mod carom;
#[cfg(feature = "chipmunk")]
mod chipmunk;
#[cfg(any(feature = "rapier", feature = "rapier-f64"))]
mod rapier;

use std::fmt;
use std::str::FromStr;

use carom_scenes::PlainScene;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::engine::{Engine, EngineError, Mode, Setup};

/// An engine, and its width where there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EngineName {
    /// This workspace's engine, `f64`.
    Carom,
    /// Box2D v3, `f32`, 4 lanes.
    #[serde(rename = "box2d-sse2")]
    Box2dSse2,
    /// Box2D v3, `f32`, 8 lanes.
    #[serde(rename = "box2d-avx2")]
    Box2dAvx2,
    /// Rapier, `f32`, 4 lanes.
    Rapier,
    /// Rapier, `f32`, 8 lanes.
    #[serde(rename = "rapier-8")]
    Rapier8,
    /// Rapier, `f64`.
    #[serde(rename = "rapier-f64")]
    RapierF64,
    /// Chipmunk, `f64`.
    Chipmunk,
}

impl EngineName {
    /// In the order of the tables.
    pub const ALL: [Self; 7] = [
        Self::Carom,
        Self::Box2dSse2,
        Self::Box2dAvx2,
        Self::Rapier,
        Self::Rapier8,
        Self::RapierF64,
        Self::Chipmunk,
    ];

    /// As tables, files and the command line write it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Carom => "carom",
            Self::Box2dSse2 => "box2d-sse2",
            Self::Box2dAvx2 => "box2d-avx2",
            Self::Rapier => "rapier",
            Self::Rapier8 => "rapier-8",
            Self::RapierF64 => "rapier-f64",
            Self::Chipmunk => "chipmunk",
        }
    }

    /// Whether it computes in single precision.
    #[must_use]
    pub const fn is_single(self) -> bool {
        matches!(
            self,
            Self::Box2dSse2 | Self::Box2dAvx2 | Self::Rapier | Self::Rapier8
        )
    }

    /// The settings that it has: its default first.
    #[must_use]
    pub const fn modes(self) -> &'static [Mode] {
        match self {
            Self::Carom => &[
                Mode::Hybrid,
                Mode::Exact,
                Mode::Stepped,
                Mode::Fast,
                Mode::SteppedFast,
                Mode::Accurate,
                Mode::SteppedAccurate,
            ],
            _ => &[Mode::Stock, Mode::Tuned],
        }
    }
}

impl fmt::Display for EngineName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that no engine has.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{name}: unknown engine; there are {}", EngineName::ALL.map(EngineName::name).join(", "))]
pub struct UnknownEngine {
    name: String,
}

impl FromStr for EngineName {
    type Err = UnknownEngine;

    fn from_str(name: &str) -> Result<Self, UnknownEngine> {
        let found = Self::ALL.into_iter().find(|engine| engine.name() == name);
        found.ok_or_else(|| UnknownEngine {
            name: name.to_owned(),
        })
    }
}

/// The engines that this executable was built with.
#[must_use]
pub fn built() -> Vec<EngineName> {
    EngineName::ALL
        .into_iter()
        .filter(|engine| match engine {
            EngineName::Carom => true,
            EngineName::Box2dSse2 => cfg!(feature = "box2d") && !cfg!(feature = "box2d-avx2"),
            EngineName::Box2dAvx2 => cfg!(feature = "box2d-avx2"),
            EngineName::Rapier => cfg!(feature = "rapier") && !cfg!(feature = "rapier-8"),
            EngineName::Rapier8 => cfg!(feature = "rapier-8"),
            EngineName::RapierF64 => cfg!(feature = "rapier-f64"),
            EngineName::Chipmunk => cfg!(feature = "chipmunk"),
        })
        .collect()
}

/// Builds a scene in an engine.
///
/// # Errors
/// If the engine is not built in, has no such mode or threads, or refuses a body.
pub fn open(
    engine: EngineName,
    scene: &PlainScene,
    setup: &Setup,
) -> Result<Box<dyn Engine>, EngineError> {
    let name = engine.name().to_owned();
    if !built().contains(&engine) {
        return Err(EngineError::NotBuilt { engine: name });
    }
    if !engine.modes().contains(&setup.mode) {
        return Err(EngineError::NoMode {
            engine: name,
            mode: setup.mode,
        });
    }
    match engine {
        EngineName::Carom => carom::open(scene, setup),
        #[cfg(feature = "box2d")]
        EngineName::Box2dSse2 | EngineName::Box2dAvx2 => box2d::open(engine, scene, setup),
        #[cfg(feature = "chipmunk")]
        EngineName::Chipmunk => chipmunk::open(scene, setup),
        #[cfg(feature = "rapier")]
        EngineName::Rapier | EngineName::Rapier8 => rapier::open_single(&name, scene, setup),
        #[cfg(feature = "rapier-f64")]
        EngineName::RapierF64 => rapier::open_double(&name, scene, setup),
        #[allow(
            unreachable_patterns,
            reason = "an executable may have been built with all engines"
        )]
        _ => Err(EngineError::NotBuilt { engine: name }),
    }
}

#[cfg(any(feature = "box2d", feature = "chipmunk"))]
impl From<carom_c_peers::State> for crate::engine::State {
    fn from(state: carom_c_peers::State) -> Self {
        Self {
            position: state.centre,
            angle: state.angle,
            velocity: state.velocity,
            spin: state.spin,
        }
    }
}
