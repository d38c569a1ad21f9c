//! Case 19: 400 pairs of polygons, each in a world of its own.

use carom_math::{Vec2, cross};
use carom_scenes::{PlainScene, plain_scene};

use super::gas::energy;
use super::plan::QUICK;
use super::worlds::{larger, worst};
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;
use crate::quality::assess;

pub(super) const CASE: Case = Case {
    name: "19_polygon_pairs",
    about: "400 pairs of smooth polygons fly at each other, e = 1, for 3 s: energy, momenta, overlap",
    metrics: &[
        Metric::error("pair_energy_mean_change", "1"),
        Metric::error("pair_energy_max_gain", "1"),
        Metric::error("pair_energy_max_loss", "1"),
        Metric::error("pair_share_gain_over_1pct", "1"),
        Metric::error("pair_share_loss_over_1pct", "1"),
        Metric::error("pair_momentum_err_max", "kg m/s"),
        Metric::error("pair_ang_momentum_err_max", "kg m²/s"),
        Metric::error("pair_pen_max_m", "m"),
    ],
    rates: RATES,
    sweeps_substeps: false,
    quick: QUICK,
    measure,
};

/// Of each pair, in s.
const RUN: f64 = 3.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let all = plain_scene("case19_polygon_pairs").expect("a built-in scene");
    let mut ends = Vec::new();
    for pair in all.bodies.chunks(2) {
        let bodies = pair.to_vec();
        let scene = PlainScene {
            bodies,
            ..all.clone()
        };
        ends.push(meet(trial, &scene)?);
    }
    let gains: Vec<f64> = ends.iter().map(|end| end.energy).collect();
    let losses: Vec<f64> = gains.iter().map(|gain| -gain).collect();
    #[expect(clippy::cast_precision_loss, reason = "hundreds of numbers")]
    let mean = gains.iter().map(|gain| gain.abs()).sum::<f64>() / gains.len() as f64;
    let of = |part: fn(&Change) -> f64| worst(&ends.iter().map(part).collect::<Vec<_>>());
    Ok(vec![
        ("pair_energy_mean_change".into(), mean),
        ("pair_energy_max_gain".into(), worst(&gains)),
        ("pair_energy_max_loss".into(), worst(&losses)),
        ("pair_share_gain_over_1pct".into(), over_1_percent(&gains)),
        ("pair_share_loss_over_1pct".into(), over_1_percent(&losses)),
        ("pair_momentum_err_max".into(), of(|end| end.momentum)),
        ("pair_ang_momentum_err_max".into(), of(|end| end.angular)),
        ("pair_pen_max_m".into(), of(|end| end.overlap)),
    ])
}

/// What a pair lost or won between its first step and its end.
#[derive(Clone, Copy, Debug)]
struct Change {
    /// E/E0 − 1.
    energy: f64,
    /// In kg m/s.
    momentum: f64,
    /// About the origin, in kg m²/s.
    angular: f64,
    /// Deepest, in m.
    overlap: f64,
}

fn meet(trial: &mut Trial, scene: &PlainScene) -> Result<Change, EngineError> {
    let looks = looks(trial.hz());
    let mut run = trial.open(scene)?;
    run.step();
    let (e0, (p0, l0)) = (energy(&run, scene), momenta(&run));
    let (mut overlap, mut steps) = (0.0, 1_u32);
    while run.goes_on(RUN) {
        run.step();
        steps += 1;
        if steps.is_multiple_of(looks) {
            overlap = larger(overlap, assess(scene, run.engine()).overlap_max);
        }
    }
    let (p, l) = momenta(&run);
    Ok(Change {
        energy: energy(&run, scene) / e0 - 1.0,
        momentum: (p - p0).length(),
        angular: (l - l0).abs(),
        overlap,
    })
}

/// Momentum, and angular momentum about the origin.
fn momenta(run: &Run<'_>) -> (Vec2, f64) {
    let (mut momentum, mut angular) = (Vec2::ZERO, 0.0);
    for body in 0..2 {
        let (state, weight) = (run.state(body), run.body(body));
        let p = weight.mass * state.velocity;
        momentum += p;
        angular += cross(state.position, p) + weight.inertia * state.spin;
    }
    (momentum, angular)
}

/// Steps from one look to the next: about 60 looks a second.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rate is a small positive number"
)]
fn looks(hz: f64) -> u32 {
    ((hz / 60.0) as u32).max(1)
}

/// The share of the numbers above 0.01.
#[expect(clippy::cast_precision_loss, reason = "hundreds of numbers")]
fn over_1_percent(changes: &[f64]) -> f64 {
    let above = changes
        .iter()
        .filter(|change| **change > 0.01 || change.is_nan());
    above.count() as f64 / changes.len() as f64
}
