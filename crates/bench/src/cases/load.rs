//! Case 14: a heavy box on light ones.

use super::stack::{deepest_until, world};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "14_heavy_load",
    about: "five boxes of 1 kg carry one of 1e3 or 1e5 kg for 10 s: whether they stand, height, overlap",
    metrics: &[
        Metric::error("r1000_deepest_m", "m"),
        Metric::error("r100000_deepest_m", "m"),
        Metric::value("r1000_survives", "1"),
        Metric::value("r1000_top_height", "m"),
        Metric::value("r100000_survives", "1"),
        Metric::value("r100000_top_height", "m"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: &[60],
    measure,
};

/// Of the load's centre, in m.
const TOP: f64 = 5.5;

/// How far off its place a box may be and still stand, in m.
const NEAR: f64 = 0.05;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    for ratio in [1e3, 1e5] {
        let (scene, boxes) = world(CASE.name, &[1.0, 1.0, 1.0, 1.0, 1.0, ratio]);
        let mut run = trial.open(&scene)?;
        let deepest = deepest_until(&mut run, &boxes, 10.0);
        let top = run.state(boxes[5]).position.y;
        let upright = |body: &usize| run.state(*body).position.x.abs() < NEAR;
        let survives = (top - TOP).abs() < NEAR && boxes.iter().all(upright);
        let survives = f64::from(u8::from(survives));
        values.push((format!("r{ratio}_survives"), survives));
        values.push((format!("r{ratio}_top_height"), top));
        values.push((format!("r{ratio}_deepest_m"), deepest));
    }
    Ok(values)
}
