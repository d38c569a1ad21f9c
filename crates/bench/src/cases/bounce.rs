//! Case 2: a disc that should bounce for ever.

use carom_math::vec2;
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{GRAVITY, dynamic, floor, larger};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

/// In m.
pub(super) const RADIUS: f64 = 0.25;

pub(super) const CASE: Case = Case {
    name: "02_perfect_bounce",
    about: "a disc falls 1 m onto a floor with e = 1, for 100 s: 111 bounces, every apex at 1 m",
    metrics: &[
        Metric::error("last_apex_m", "m"),
        Metric::error("worst_apex_m", "m"),
        Metric::value("half_height_at_s", "s").or("never"),
        Metric::value("bounces", "1"),
        Metric::error("deepest_m", "m"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let (scene, disc) = world(CASE.name, 1.0);
    let mut run = trial.open(&scene)?;
    let (mut bounces, mut last, mut worst, mut deepest) = (0, 0.0, 0.0, 0.0);
    let mut half_height = None;
    let mut before = run.state(disc);
    while run.goes_on(100.0) {
        run.step();
        let now = run.state(disc);
        if before.velocity.y > 0.0 && now.velocity.y <= 0.0 {
            last = before.position.y.max(now.position.y) - RADIUS;
            worst = larger(worst, (last - 1.0).abs());
            bounces += 1;
            if last < 0.5 && half_height.is_none() {
                half_height = Some(run.time());
            }
        }
        deepest = larger(deepest, RADIUS - now.position.y);
        before = now;
    }
    let last = if bounces < 20 { 0.0 } else { last };
    let mut values: Values = vec![
        ("last_apex_m".into(), (last - 1.0).abs()),
        ("worst_apex_m".into(), worst),
        ("bounces".into(), f64::from(bounces)),
        ("deepest_m".into(), deepest),
    ];
    values.extend(half_height.map(|t| ("half_height_at_s".into(), t)));
    Ok(values)
}

/// A smooth disc with its lowest point 1 m above a floor, both of restitution `e`.
pub(super) fn world(name: &str, e: f64) -> (PlainScene, usize) {
    let mut scene = PlainScene::empty(name, GRAVITY);
    let material = scene.material(1.0, 0.0, e);
    floor(&mut scene, material);
    let body = dynamic(vec2(0.0, 1.0 + RADIUS), material);
    let disc = scene.add(body, PlainShape::Circle { radius: RADIUS });
    (scene, disc)
}
