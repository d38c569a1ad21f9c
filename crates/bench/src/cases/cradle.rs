//! Case 10: Newton's cradle.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::dynamic;
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "10_cradle",
    about: "a disc at 2 m/s runs into four at rest with gaps of 0, 1 and 50 mm, e = 1: only the last should leave",
    metrics: &[
        Metric::error("gap0.001_velocity_error", "1"),
        Metric::error("gap0_velocity_error", "1"),
        Metric::error("gap0.05_velocity_error", "1"),
        Metric::value("gap0_last_speed", "m/s"),
        Metric::value("gap0_energy", "1"),
        Metric::value("gap0.001_last_speed", "m/s"),
        Metric::value("gap0.001_energy", "1"),
        Metric::value("gap0.05_last_speed", "m/s"),
        Metric::value("gap0.05_energy", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// Of the striker, in m/s.
const SPEED: f64 = 2.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    for gap in [0.0, 0.001, 0.05] {
        let ends = strike(trial, gap)?;
        let last = ends[ends.len() - 1];
        let energy: f64 = ends.iter().map(|v| v.length_squared()).sum();
        let exact = (0..ends.len()).map(|i| if i + 1 == ends.len() { SPEED } else { 0.0 });
        let squares = ends.iter().zip(exact);
        let error: f64 = squares
            .map(|(v, exact)| (*v - vec2(exact, 0.0)).length_squared())
            .sum();
        values.push((format!("gap{gap}_velocity_error"), error.sqrt() / SPEED));
        values.push((format!("gap{gap}_last_speed"), last.x));
        values.push((format!("gap{gap}_energy"), energy / (SPEED * SPEED)));
    }
    Ok(values)
}

/// The five velocities after 3 s, from left to right at the start.
fn strike(trial: &mut Trial, gap: f64) -> Result<Vec<Vec2>, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let material = scene.material(1.0, 0.0, 1.0);
    let disc = scene.shape(PlainShape::Circle { radius: 0.5 });
    let striker = dynamic(vec2(-2.0, 0.0), material).moving(vec2(SPEED, 0.0));
    scene.place(striker, disc);
    for i in 0..4 {
        let at = vec2(f64::from(i) * (1.0 + gap), 0.0);
        scene.place(dynamic(at, material), disc);
    }
    let mut run = trial.open(&scene)?;
    run.until(3.0);
    Ok((0..5).map(|body| run.state(body).velocity).collect())
}
