//! Case 1: a throw.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{G, GRAVITY, dynamic};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "01_projectile",
    about: "a disc thrown at (3, 5) m/s, after 1 s: distance from the parabola",
    metrics: &[Metric::error("pos_error_m", "m")],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, 0.6, 0.0);
    let thrown = dynamic(Vec2::ZERO, material).moving(vec2(3.0, 5.0));
    let disc = scene.add(thrown, PlainShape::Circle { radius: 0.1 });

    let mut run = trial.open(&scene)?;
    run.until(1.0);
    let t = run.time();
    let exact = vec2(3.0 * t, 5.0 * t - G * t * t / 2.0);
    let error = run.state(disc).position.distance(exact);
    Ok(vec![("pos_error_m".into(), error)])
}
