//! Case 3: bounces that die out.

use super::bounce::{RADIUS, world};
use super::plan::QUICK;
use super::worlds::{G, larger};
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "03_bounce_e08",
    about: "a disc falls 1 m onto a floor with e = 0.8: heights and times of ten apexes, time of rest",
    metrics: &[
        Metric::error("apex_err_rel_h0", "1"),
        Metric::error("apex_time_err_s", "s"),
        Metric::error("rest_time_s", "s"),
        Metric::value("bounces_seen", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// Of the fall, in m.
const HEIGHT: f64 = 1.0;

/// Restitution.
const E: f64 = 0.8;

/// Below this a disc no longer rises, in m/s.
const RISES: f64 = 1e-6;

/// Below this it rests, in m/s.
const RESTS: f64 = 0.02;

/// A highest point: height of the disc's lowest point in m, time in s.
type Apex = (f64, f64);

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let (scene, disc) = world(CASE.name, E);
    let mut run = trial.open(&scene)?;
    let (seen, rest) = watch(&mut run, disc);

    let (mut height, mut time) = (0.0, 0.0);
    for (k, exact) in exact_apexes().into_iter().enumerate() {
        let apex = seen.get(k).copied().unwrap_or_default();
        height = larger(height, (apex.0 - exact.0).abs() / HEIGHT);
        time = larger(time, (apex.1 - exact.1).abs());
    }
    // t0 (1 + 2 (e + e² + …))
    let exact_rest = fall_time() * (1.0 + 2.0 * E / (1.0 - E));
    #[expect(clippy::cast_precision_loss, reason = "at most one apex a step")]
    let bounces = seen.len() as f64;
    Ok(vec![
        ("apex_err_rel_h0".into(), height),
        ("apex_time_err_s".into(), time),
        ("rest_time_s".into(), (rest - exact_rest).abs()),
        ("bounces_seen".into(), bounces),
    ])
}

/// The apexes of 8 s, and the last time at which the disc moved.
fn watch(run: &mut Run<'_>, disc: usize) -> (Vec<Apex>, f64) {
    let (mut seen, mut rest) = (Vec::new(), 0.0);
    let mut before = (run.state(disc), run.time());
    while run.goes_on(8.0) {
        run.step();
        let now = (run.state(disc), run.time());
        let (v0, v1) = (before.0.velocity.y, now.0.velocity.y);
        if v0 > RISES && v1 <= RISES {
            let height = before.0.position.y.max(now.0.position.y) - RADIUS;
            // v0 + (v1 − v0) s = 0
            let time = before.1 + (now.1 - before.1) * v0 / (v0 - v1);
            seen.push((height, time));
        }
        if v1.abs() > RESTS {
            rest = now.1;
        }
        before = now;
    }
    (seen, rest)
}

fn fall_time() -> f64 {
    (2.0 * HEIGHT / G).sqrt()
}

/// Apex k = 1 … 10: h e^2k at t0 + 2 t0 (e + … + e^(k−1)) + t0 e^k.
fn exact_apexes() -> Vec<Apex> {
    let t0 = fall_time();
    let (mut power, mut landing) = (1.0, t0);
    let apexes = (1..=10).map(|_| {
        power *= E;
        let apex = (HEIGHT * power * power, landing + t0 * power);
        landing += 2.0 * t0 * power;
        apex
    });
    apexes.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_apex_is_where_the_speed_is_used_up() {
        let apexes = exact_apexes();
        assert_eq!(apexes.len(), 10);
        // e v0 = 0.8 √20 m/s upwards from the landing at t0 = √0.2 s
        let v = 0.8 * 20.0_f64.sqrt();
        assert!((apexes[0].0 - v * v / 20.0).abs() < 1e-15);
        assert!((apexes[0].1 - (0.2_f64.sqrt() + v / 10.0)).abs() < 1e-15);
    }

    #[test]
    fn it_rests_after_four_seconds() {
        let rest = fall_time() * (1.0 + 2.0 * E / (1.0 - E));
        assert!((rest - 4.0249).abs() < 5e-5, "{rest}");
    }
}
