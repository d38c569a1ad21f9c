//! Case 13: twenty boxes on top of each other.

use carom_math::vec2;
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{GRAVITY, dynamic, larger};
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "13_stack",
    about: "20 boxes stand on each other for 30 s: overlap, height, drift, tilt, speed; when they fall asleep",
    metrics: &[
        Metric::error("deepest_m", "m"),
        Metric::error("depth_30s_m", "m"),
        Metric::error("top_height_m", "m"),
        Metric::error("lateral_drift_m", "m"),
        Metric::error("tilt_rad", "rad"),
        Metric::error("residual_speed", "m/s"),
        Metric::value("time_to_sleep_s", "s").or("never"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// In s.
const RUN: f64 = 30.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let (mut scene, boxes) = world(CASE.name, &[1.0; 20]);
    let mut run = trial.open(&scene)?;
    let deepest = deepest_until(&mut run, &boxes, RUN);
    let states: Vec<_> = boxes.iter().map(|&body| run.state(body)).collect();
    let (mut drift, mut tilt, mut speed) = (0.0, 0.0, 0.0);
    for state in &states {
        drift = larger(drift, state.position.x.abs());
        tilt = larger(tilt, state.angle.abs());
        speed = larger(speed, state.velocity.length());
    }
    let mut values: Values = vec![
        ("deepest_m".into(), deepest),
        ("depth_30s_m".into(), larger(depth(&run, &boxes), 0.0)),
        ("top_height_m".into(), (states[19].position.y - 19.5).abs()),
        ("lateral_drift_m".into(), drift),
        ("tilt_rad".into(), tilt),
        ("residual_speed".into(), speed),
    ];
    drop(run);

    scene.sleeping = true;
    let mut run = trial.open(&scene)?;
    while run.goes_on(RUN) {
        run.step();
        if run.counters().awake == 0 {
            values.push(("time_to_sleep_s".into(), run.time()));
            break;
        }
    }
    Ok(values)
}

/// Boxes of 1 m on top of each other, from the floor upwards, with the densities given.
pub(super) fn world(name: &str, densities: &[f64]) -> (PlainScene, Vec<usize>) {
    let mut scene = PlainScene::empty(name, GRAVITY);
    let floor = scene.material(1.0, 0.6, 0.0);
    let body = PlainBody::new(PlainKind::Fixed, vec2(0.0, -1.0), floor);
    scene.add(body, PlainShape::rectangle(100.0, 1.0));
    let shape = scene.shape(PlainShape::rectangle(0.5, 0.5));
    let (mut boxes, mut y) = (Vec::new(), 0.5);
    for &density in densities {
        let material = scene.material(density, 0.6, 0.0);
        boxes.push(scene.place(dynamic(vec2(0.0, y), material), shape));
        y += 1.0;
    }
    (scene, boxes)
}

/// Runs, and gives the largest overlap of neighbours seen after any step, in m, ≥ 0.
pub(super) fn deepest_until(run: &mut Run<'_>, boxes: &[usize], time: f64) -> f64 {
    let mut deepest = 0.0;
    while run.goes_on(time) {
        run.step();
        deepest = larger(deepest, depth(run, boxes));
    }
    deepest
}

/// The largest of 1 m less the distance of two neighbours, in m; the floor counts as a box at y = −0.5.
fn depth(run: &Run<'_>, boxes: &[usize]) -> f64 {
    let (mut below, mut deepest) = (-0.5, f64::NEG_INFINITY);
    for &body in boxes {
        let y = run.state(body).position.y;
        deepest = larger(deepest, 1.0 - (y - below));
        below = y;
    }
    deepest
}
