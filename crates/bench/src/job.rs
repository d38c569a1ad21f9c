//! A job for a process of its own, and what it answers.

use serde::{Deserialize, Serialize};

use crate::callgrind::Instructions;
use crate::cases::{CASES, Trial};
use crate::engine::{EngineError, Mode};
use crate::engines::EngineName;
use crate::speed::{SpeedJob, SpeedReading, StageReading};

/// What a process is asked to do.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Job {
    /// Time an engine on a scene.
    Speed(SpeedJob),
    /// Step an engine through a scene with no clock and no assessment, for [`count_instructions`](crate::count_instructions).
    Bare(SpeedJob),
    /// Ask an engine where the time of its steps goes.
    Profile(SpeedJob),
    /// Measure an engine's error in a case.
    Accuracy(Point),
}

impl Job {
    /// The engine.
    #[must_use]
    pub const fn engine(&self) -> EngineName {
        match self {
            Self::Speed(job) | Self::Bare(job) | Self::Profile(job) => job.engine,
            Self::Accuracy(point) => point.engine,
        }
    }

    /// With which settings.
    #[must_use]
    pub const fn mode(&self) -> Mode {
        match self {
            Self::Speed(job) | Self::Bare(job) | Self::Profile(job) => job.mode,
            Self::Accuracy(point) => point.mode,
        }
    }

    /// On how many threads.
    #[must_use]
    pub const fn threads(&self) -> u32 {
        match self {
            Self::Speed(job) | Self::Bare(job) | Self::Profile(job) => job.threads,
            Self::Accuracy(_) => 1,
        }
    }
}

/// One point of a work–precision curve.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Point {
    /// The engine.
    pub engine: EngineName,
    /// With which settings.
    pub mode: Mode,
    /// Name of the case.
    pub case: String,
    /// Steps per simulated second.
    pub hz: u32,
    /// Sub-steps, or solver iterations, of a step; `None`: the engine's default.
    pub substeps: Option<u32>,
}

/// What a process answers: one line of JSON.
#[expect(
    clippy::large_enum_variant,
    reason = "there are as many as there were processes"
)]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Reading {
    /// Of a speed job.
    Speed(SpeedReading),
    /// Of a bare job.
    Bare {
        /// Steps before the counted ones.
        warm_up_steps: u32,
        /// Steps that were counted.
        measured_steps: u32,
    },
    /// Of a bare job, by [`count_instructions`](crate::count_instructions).
    Instructions(Instructions),
    /// Of a profile job.
    Profile(StageReading),
    /// Of an accuracy job.
    Accuracy {
        /// A number for each of the case's metrics that the run has one for, in the order of the case; NaN or infinite
        /// if the run blew up.
        #[serde(with = "crate::number::named")]
        values: Vec<(String, f64)>,
        /// CPU seconds inside steps per simulated second.
        #[serde(with = "crate::number")]
        cpu_s_per_s: f64,
        /// As the engine was set in the first world.
        #[serde(default)]
        settings: String,
    },
    /// The run could not be made, or did not come to its end.
    Failed {
        /// In a line.
        reason: String,
    },
}

/// Does a job.
#[must_use]
pub fn run(job: &Job) -> Reading {
    let answer = match job {
        Job::Speed(job) => crate::speed::run(job).map(Reading::Speed),
        Job::Bare(job) => crate::speed::run_bare(job),
        Job::Profile(job) => crate::speed::run_profile(job).map(Reading::Profile),
        Job::Accuracy(point) => accuracy(point),
    };
    answer.unwrap_or_else(|error| Reading::Failed {
        reason: error.to_string(),
    })
}

fn accuracy(point: &Point) -> Result<Reading, EngineError> {
    let Some(case) = CASES.iter().find(|case| case.name == point.case) else {
        return Ok(Reading::Failed {
            reason: format!("{}: unknown case", point.case),
        });
    };
    let mut trial = Trial::new(point);
    let values = (case.measure)(&mut trial)?;
    Ok(Reading::Accuracy {
        values,
        cpu_s_per_s: trial.cpu_per_second(),
        settings: trial.settings().to_owned(),
    })
}
