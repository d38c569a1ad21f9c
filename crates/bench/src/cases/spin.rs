//! Case 11: a polygon spins freely for a long time.

use std::f64::consts::{PI, TAU};

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{centred, dynamic};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "11_free_spin",
    about: "an uneven polygon spins at 2 rad/s for 1000 s: angle, angular momentum, drift of the centre",
    metrics: &[
        Metric::error("angle_err_rad_1000s", "rad"),
        Metric::error("ang_momentum_rel", "1"),
        Metric::error("centre_drift_m", "m"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

const CORNERS: [Vec2; 5] = [
    vec2(1.3, 0.1),
    vec2(0.2, 0.9),
    vec2(-0.8, 0.3),
    vec2(-0.4, -0.7),
    vec2(0.6, -0.5),
];

/// In rad/s.
const SPIN: f64 = 2.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let material = scene.material(1.0, 0.6, 0.0);
    let body = dynamic(Vec2::ZERO, material).spinning(SPIN);
    let polygon = scene.add(body, PlainShape::Polygon(centred(&CORNERS).0));

    let mut run = trial.open(&scene)?;
    run.until(1000.0);
    let end = run.state(polygon);
    let angle = within_half_a_turn(end.angle - SPIN * run.time());
    Ok(vec![
        ("angle_err_rad_1000s".into(), angle.abs()),
        ("ang_momentum_rel".into(), (end.spin / SPIN - 1.0).abs()),
        ("centre_drift_m".into(), end.position.length()),
    ])
}

/// The same direction within ±π.
fn within_half_a_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}
