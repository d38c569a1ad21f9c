//! Case 15: bullets against a thin wall.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{dynamic, worst};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::{EngineError, State};

pub(super) const CASE: Case = Case {
    name: "15_bullets",
    about: "16 discs of 2 cm fly at a wall of 1 cm at 1e2 … 1e5 m/s: how many get through, and the rebound with e = 1",
    metrics: &[
        Metric::error("static_e1_bullet_v1000_rebound_err_rel", "1"),
        Metric::error("static_e1_bullet_v100_rebound_err_rel", "1"),
        Metric::error("static_e1_bullet_v10000_rebound_err_rel", "1"),
        Metric::error("static_e1_bullet_v100000_rebound_err_rel", "1"),
        Metric::value("static_v100_tunnelled_of_16", "1"),
        Metric::value("static_v1000_tunnelled_of_16", "1"),
        Metric::value("static_v10000_tunnelled_of_16", "1"),
        Metric::value("static_v100000_tunnelled_of_16", "1"),
        Metric::value("static_bullet_v100_tunnelled_of_16", "1"),
        Metric::value("static_bullet_v1000_tunnelled_of_16", "1"),
        Metric::value("static_bullet_v10000_tunnelled_of_16", "1"),
        Metric::value("static_bullet_v100000_tunnelled_of_16", "1"),
        Metric::value("static_e1_bullet_v100_tunnelled_of_16", "1"),
        Metric::value("static_e1_bullet_v1000_tunnelled_of_16", "1"),
        Metric::value("static_e1_bullet_v10000_tunnelled_of_16", "1"),
        Metric::value("static_e1_bullet_v100000_tunnelled_of_16", "1"),
        Metric::value("free_bullet_v100_tunnelled_of_16", "1"),
        Metric::value("free_bullet_v1000_tunnelled_of_16", "1"),
        Metric::value("free_bullet_v10000_tunnelled_of_16", "1"),
        Metric::value("free_bullet_v100000_tunnelled_of_16", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// Wall and bullet of one part of the case.
#[derive(Clone, Copy, Debug)]
struct Kind {
    name: &'static str,
    wall: PlainKind,
    bullet: bool,
    restitution: f64,
}

const KINDS: [Kind; 4] = [
    Kind {
        name: "static",
        wall: PlainKind::Fixed,
        bullet: false,
        restitution: 0.0,
    },
    Kind {
        name: "static_bullet",
        wall: PlainKind::Fixed,
        bullet: true,
        restitution: 0.0,
    },
    Kind {
        name: "static_e1_bullet",
        wall: PlainKind::Fixed,
        bullet: true,
        restitution: 1.0,
    },
    Kind {
        name: "free_bullet",
        wall: PlainKind::Dynamic,
        bullet: true,
        restitution: 0.0,
    },
];

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    for kind in KINDS {
        for speed in [1e2, 1e3, 1e4, 1e5] {
            let (mut tunnelled, mut rebounds) = (0, Vec::new());
            for k in 0..16 {
                let start = vec2(-5.0 - 0.0713 * f64::from(k), 0.01 * f64::from(k));
                let [wall, disc] = shoot(trial, kind, start, speed)?;
                // A position that is no number did not stay in front of the wall either.
                let in_front = disc.position.x < wall.position.x;
                tunnelled += u32::from(!in_front);
                rebounds.push((disc.velocity.x + speed).abs() / speed);
            }
            let name = format!("{}_v{speed}", kind.name);
            values.push((format!("{name}_tunnelled_of_16"), f64::from(tunnelled)));
            if kind.restitution > 0.0 {
                values.push((format!("{name}_rebound_err_rel"), worst(&rebounds)));
            }
        }
    }
    Ok(values)
}

/// Wall and disc at the end.
fn shoot(
    trial: &mut Trial,
    kind: Kind,
    start: Vec2,
    speed: f64,
) -> Result<[State; 2], EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    // 4000 kg where it is free.
    let heavy = scene.material(1e5, 0.0, kind.restitution);
    let light = scene.material(1.0, 0.0, kind.restitution);
    let wall = PlainBody::new(kind.wall, Vec2::ZERO, heavy);
    let wall = scene.add(wall, PlainShape::rectangle(0.005, 2.0));
    let mut disc = dynamic(start, light).moving(vec2(speed, 0.0));
    disc.bullet = kind.bullet;
    let disc = scene.add(disc, PlainShape::Circle { radius: 0.02 });
    let time = (20.0 / speed).max(4.0 * trial.dt());
    let mut run = trial.open(&scene)?;
    run.until(time);
    Ok([wall, disc].map(|body| run.state(body)))
}
