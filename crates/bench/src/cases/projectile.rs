//! Case 1: a throw.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::{Case, Kind, Metric, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "01_projectile",
    about: "a disc thrown at (3, 5) m/s, after 1 s: distance from the parabola",
    metrics: &[Metric {
        name: "position_m",
        unit: "m",
        kind: Kind::Error,
    }],
    measure,
};

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, vec2(0.0, -10.0));
    let material = scene.material(1.0, 0.6, 0.0);
    let thrown = PlainBody::new(PlainKind::Dynamic, Vec2::ZERO, material).moving(vec2(3.0, 5.0));
    let disc = scene.add(thrown, PlainShape::Circle { radius: 0.1 });

    let mut run = trial.open(&scene)?;
    run.until(1.0);
    let t = run.time();
    let exact = vec2(3.0 * t, 5.0 * t - 5.0 * t * t);
    Ok(vec![(
        "position_m",
        run.state(disc).position.distance(exact),
    )])
}
