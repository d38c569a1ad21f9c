//! What an engine must be able to do to stand in a table.

use std::fmt;

use carom_math::Vec2;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A world of one engine, built from a scene.
///
/// Bodies keep the scene's order. Nothing is read between measured steps but what a job asks for.
pub trait Engine {
    /// Advances by `1 / Setup::hz`.
    fn step(&mut self);

    /// The state of a body of the scene.
    fn state(&self, body: usize) -> State;

    /// Mass and inertia of a body, as the engine has them; 0 where it counts as infinite.
    fn body(&self, body: usize) -> Body;

    /// Centre and angle of every body, as a caller that draws would read them: the engine's cheapest way.
    ///
    /// Gives a sum over what was read, so that no compiler leaves the reading out.
    fn read_poses(&mut self) -> f64;

    /// What the engine says about its work.
    fn counters(&self) -> Counters;

    /// Impacts since the start, where the engine counts them one by one.
    fn impacts(&self) -> Option<u64> {
        None
    }

    /// Seconds that each stage of the last step took, where the engine tells.
    ///
    /// The first call turns the engine's own profile on; it costs a few clock readings a step.
    fn profile(&mut self) -> Option<Vec<(&'static str, f64)>> {
        None
    }

    /// Settings that are not the engine's defaults and those that matter for error, in its own terms: `key=value …`.
    fn settings(&self) -> String;
}

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Centre of mass, in m.
    pub position: Vec2,
    /// In rad, as the engine counts it: unwrapped or within ±π.
    pub angle: f64,
    /// Of the centre of mass, in m/s.
    pub velocity: Vec2,
    /// Angular velocity, in rad/s.
    pub spin: f64,
}

/// What a body weighs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// In kg.
    pub mass: f64,
    /// About the centre of mass, in kg m².
    pub inertia: f64,
}

/// What an engine says about its last step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Dynamic bodies awake.
    pub awake: usize,
    /// Pairs in contact, as the engine counts them.
    pub touching: usize,
}

/// How an engine is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// A peer's defaults.
    Stock,
    /// A peer's best settings for accuracy.
    Tuned,
    /// carom's defaults: each group the cheapest method that is right.
    Hybrid,
    /// carom: closed forms.
    Exact,
    /// carom: every moving body sub-stepped.
    Stepped,
    /// carom's defaults with the sub-steps of its preset `fast`.
    Fast,
    /// Every moving body sub-stepped, with the preset `fast`.
    SteppedFast,
    /// carom's defaults with the sub-steps of its preset `accurate`.
    Accurate,
    /// Every moving body sub-stepped, with the preset `accurate`.
    SteppedAccurate,
}

impl Mode {
    /// Whether it is another mode at fewer or more sub-steps.
    #[must_use]
    pub const fn is_preset(self) -> bool {
        matches!(
            self,
            Self::Fast | Self::SteppedFast | Self::Accurate | Self::SteppedAccurate
        )
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stock => "stock",
            Self::Tuned => "tuned",
            Self::Hybrid => "hybrid",
            Self::Exact => "exact",
            Self::Stepped => "stepped",
            Self::Fast => "fast",
            Self::SteppedFast => "stepped-fast",
            Self::Accurate => "accurate",
            Self::SteppedAccurate => "stepped-accurate",
        })
    }
}

/// How a world is to be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Which settings.
    pub mode: Mode,
    /// Steps per simulated second.
    pub hz: f64,
    /// Sub-steps, or solver iterations, of a step; `None`: the engine's default.
    pub substeps: Option<u32>,
    /// Threads that may work.
    pub threads: u32,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// Overlap that Chipmunk's solver leaves alone, in m; `None`: its default of 0.1 m, or 1 mm tuned.
    ///
    /// The other peers leave 5 mm; where times are compared, it is given the same.
    pub slop: Option<f64>,
}

/// Why an engine does not run a scene. A row says so; it is no hole in the table.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum EngineError {
    /// This executable was built without it.
    #[error("{engine} is not built into this executable")]
    NotBuilt {
        /// The engine.
        engine: String,
    },
    /// The engine has no such settings.
    #[error("{engine} has no mode {mode}")]
    NoMode {
        /// The engine.
        engine: String,
        /// What was asked for.
        mode: Mode,
    },
    /// The engine has no second thread.
    #[error("{engine} does not run on {threads} threads")]
    Threads {
        /// The engine.
        engine: String,
        /// What was asked for.
        threads: u32,
    },
    /// The engine refused a body.
    #[error("{engine} refuses body {body}: {reason}")]
    Body {
        /// The engine.
        engine: String,
        /// Index in the scene.
        body: usize,
        /// In the engine's words.
        reason: String,
    },
    /// No scene has this name.
    #[error("{scene}: unknown scene; there are {known}")]
    Scene {
        /// What was asked for.
        scene: String,
        /// The names that exist.
        known: String,
    },
    /// The engine does not say where its time goes.
    #[error("{engine} tells no stages of a step")]
    NoStages {
        /// The engine.
        engine: String,
    },
    /// The job's time ran out before a step was measured.
    #[error(
        "{engine} was stopped after {steps} steps, the first of {ms_first:.0} ms: none could be measured"
    )]
    OutOfTime {
        /// The engine.
        engine: String,
        /// Steps that were made.
        steps: u32,
        /// First step, in ms.
        ms_first: f64,
    },
    /// The engine refused its settings.
    #[error("{engine} refuses its settings: {reason}")]
    Settings {
        /// The engine.
        engine: String,
        /// In the engine's words.
        reason: String,
    },
}
