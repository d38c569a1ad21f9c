//! Cases 12 and 18: a gas in a box, chaotic from its first second on.

use carom_scenes::{PlainKind, PlainScene, plain_scene};

use super::horizon::{dynamic_bodies, horizon};
use super::worlds::larger;
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;
use crate::quality::assess;

const METRICS: &[Metric] = &[
    Metric::error("energy_dev_worst", "1"),
    Metric::value("energy_ratio_60s", "1"),
    Metric::error("pen_max_m", "m"),
    Metric::error("escaped", "1"),
    Metric::value("horizon_s", "s"),
];

pub(super) const POLYGONS: Case = Case {
    name: "12_polygon_gas",
    about: "100 smooth polygons in a box for 60 s, e = 1: energy, overlap, escapes; horizon of prediction",
    metrics: METRICS,
    rates: RATES,
    sweeps_substeps: true,
    quick: &[60],
    measure: |trial| measure(trial, "case12_polygon_gas"),
};

pub(super) const DISCS: Case = Case {
    name: "18_disc_gas",
    about: "100 smooth discs in a box for 60 s, e = 1: energy, overlap, escapes; horizon of prediction",
    metrics: METRICS,
    rates: RATES,
    sweeps_substeps: true,
    quick: &[60],
    measure: |trial| measure(trial, "case18_disc_gas"),
};

/// Of the run, in s.
const RUN: f64 = 60.0;

/// Half of the box's side, in m.
const INNER: f64 = 6.0;

fn measure(trial: &mut Trial, name: &str) -> Result<Values, EngineError> {
    let scene = plain_scene(name).expect("a built-in scene");
    let horizon = horizon(trial, &scene, RUN)?;
    // Overlap with the walls does not count.
    let mut reduced = scene.clone();
    for body in &mut reduced.bodies {
        if body.kind == PlainKind::Fixed {
            body.shapes.clear();
        }
    }

    let looks = looks(trial.hz());
    let mut run = trial.open(&scene)?;
    run.step();
    let start = energy(&run, &scene);
    let (mut worst, mut overlap, mut steps) = (0.0, 0.0, 1_u32);
    while run.goes_on(RUN) {
        run.step();
        steps += 1;
        if steps.is_multiple_of(looks) {
            worst = larger(worst, (energy(&run, &scene) / start - 1.0).abs());
            overlap = larger(overlap, assess(&reduced, run.engine()).overlap_max);
        }
    }
    let inside = |body: &usize| {
        let at = run.state(*body).position;
        at.x.abs() < INNER && at.y.abs() < INNER
    };
    #[expect(clippy::cast_precision_loss, reason = "at most 100 bodies")]
    let escaped = dynamic_bodies(&scene).filter(|body| !inside(body)).count() as f64;
    Ok(vec![
        ("energy_dev_worst".into(), worst),
        ("energy_ratio_60s".into(), energy(&run, &scene) / start),
        ("pen_max_m".into(), overlap),
        ("escaped".into(), escaped),
        ("horizon_s".into(), horizon),
    ])
}

/// Steps from one look to the next: floor(0.25/dt).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rate is a small positive number"
)]
fn looks(hz: f64) -> u32 {
    ((0.25 * hz) as u32).max(1)
}

/// Of all motion, with the engine's masses, in J.
pub(super) fn energy(run: &Run<'_>, scene: &PlainScene) -> f64 {
    let energies = dynamic_bodies(scene).map(|body| {
        let (state, weight) = (run.state(body), run.body(body));
        let turning = weight.inertia * state.spin * state.spin;
        0.5 * (weight.mass * state.velocity.length_squared() + turning)
    });
    energies.sum()
}
