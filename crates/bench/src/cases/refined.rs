//! Self-convergence: an engine against its own run at a fine step, where no exact answer is known.

use carom_math::{Vec2, trig};
use carom_scenes::PlainScene;

use super::horizon::{dynamic_bodies, horizon};
use super::worlds::larger;
use super::{Metric, Trial, Values};
use crate::engine::EngineError;

pub(super) const METRICS: &[Metric] = &[
    Metric::error("self_error_m", "m"),
    Metric::value("observed_order", "1").or("exact"),
    Metric::value("horizon_s", "s"),
];

/// Steps per simulated second at which the scenes are run: the finest is a quarter of the reference's.
pub(super) const RATES: &[u32] = &[30, 60, 120, 240, 480, 960, 1920];

/// Steps per simulated second of the run that counts as right, with the same mode and sub-steps.
const FINEST: f64 = 7680.0;

/// Compares the places of the moving bodies after `time` seconds, which must lie before the horizon.
///
/// - `self_error_m`: the largest distance of a body from where it is at 7680 Hz.
/// - `observed_order`: log2 (|x(h) − x(h/2)| / |x(h/2) − x(h/4)|), each the largest distance of a body (Richardson);
///   no number where the finer difference is 0.
/// - `horizon_s`: how long the scene can be predicted at this rate, see [`horizon`]; at most `time`.
///
/// # Errors
/// If the engine is not built in or refuses the scene.
pub(super) fn measure(
    trial: &mut Trial,
    scene: &PlainScene,
    time: f64,
) -> Result<Values, EngineError> {
    let places = |trial: &Trial, hz: f64| -> Result<Vec<Vec2>, EngineError> {
        let mut run = trial.reference(scene, hz)?;
        run.until(time);
        Ok(dynamic_bodies(scene)
            .map(|body| run.state(body).position)
            .collect())
    };
    let hz = trial.hz();
    let finest = places(trial, FINEST)?;
    let [half, quarter] = [places(trial, 2.0 * hz)?, places(trial, 4.0 * hz)?];
    let horizon = horizon(trial, scene, time)?;
    let mut run = trial.open(scene)?;
    run.until(time);
    let coarse: Vec<Vec2> = dynamic_bodies(scene)
        .map(|body| run.state(body).position)
        .collect();
    let mut values: Values = vec![
        ("self_error_m".into(), distance(&coarse, &finest)),
        ("horizon_s".into(), horizon),
    ];
    let (first, second) = (distance(&coarse, &half), distance(&half, &quarter));
    if first > 0.0 && second > 0.0 {
        let order = trig::ln(first / second) / std::f64::consts::LN_2;
        values.push(("observed_order".into(), order));
    }
    Ok(values)
}

fn distance(a: &[Vec2], b: &[Vec2]) -> f64 {
    let distances = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    distances.fold(0.0, larger)
}
