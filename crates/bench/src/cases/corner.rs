//! Case 5: a square meets a floor with a corner.

use carom_math::{Vec2, trig, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{dynamic, floor, rms, worst};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::{EngineError, State};

pub(super) const CASE: Case = Case {
    name: "05_corner",
    about: "a smooth square meets a floor with a corner, e = 1, at 4 angles from 8 heights: velocity, spin, energy",
    metrics: &[
        Metric::error("exit_err_rel_rms", "1"),
        Metric::error("exit_err_rel_max", "1"),
        Metric::error("energy_err_max", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// At the start, in m/s; its mass is 1 kg.
const VELOCITY: Vec2 = vec2(1.0, -5.0);

/// In kg m²: a square of 1 kg and 1 m.
const INERTIA: f64 = 1.0 / 6.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let (mut exit, mut energy) = (Vec::new(), Vec::new());
    for degrees in [27.0, 30.0, 35.0, 40.0] {
        for k in 0..8 {
            let fall = 0.5 + 0.0107 * f64::from(k);
            let corner = lowest_corner(degrees);
            let end = land(trial, degrees, corner, fall)?;
            let (velocity, spin) = exact(corner.x);
            let error = weighted(end.velocity - velocity, end.spin - spin);
            exit.push(error.sqrt() / -VELOCITY.y);
            // E0 = (1 + 25)/2 = 13 J
            let ratio = weighted(end.velocity, end.spin) / VELOCITY.length_squared();
            energy.push((ratio - 1.0).abs());
        }
    }
    Ok(vec![
        ("exit_err_rel_rms".into(), rms(&exit)),
        ("exit_err_rel_max".into(), worst(&exit)),
        ("energy_err_max".into(), worst(&energy)),
    ])
}

/// Relative to the centre, in m.
fn lowest_corner(degrees: f64) -> Vec2 {
    let (sin, cos) = trig::sin_cos((225.0 + degrees).to_radians());
    vec2(cos, sin) * 0.5_f64.sqrt()
}

/// The state 0.07 s after the corner has fallen through `fall`.
fn land(trial: &mut Trial, degrees: f64, corner: Vec2, fall: f64) -> Result<State, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let material = scene.material(1.0, 0.0, 1.0);
    floor(&mut scene, material);
    let body = dynamic(vec2(0.0, fall - corner.y), material)
        .turned(degrees.to_radians())
        .moving(VELOCITY);
    let square = scene.add(body, PlainShape::rectangle(0.5, 0.5));
    let mut run = trial.open(&scene)?;
    run.until(fall / -VELOCITY.y + 0.07);
    Ok(run.state(square))
}

/// Velocity and spin after the upward impulse j = 2 · 5 / (1/m + rx²/I) at the corner.
fn exact(rx: f64) -> (Vec2, f64) {
    let j = -2.0 * VELOCITY.y / (1.0 + rx * rx / INERTIA);
    (VELOCITY + vec2(0.0, j), rx * j / INERTIA)
}

/// Twice the energy of this velocity and spin, in J.
fn weighted(velocity: Vec2, spin: f64) -> f64 {
    velocity.length_squared() + INERTIA * spin * spin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_answer_keeps_energy_and_turns_the_corner_round() {
        for degrees in [27.0, 30.0, 35.0, 40.0] {
            let rx = lowest_corner(degrees).x;
            let (velocity, spin) = exact(rx);
            assert!((weighted(velocity, spin) / 26.0 - 1.0).abs() < 1e-15);
            let corner = velocity.y + spin * rx;
            assert!((corner - 5.0).abs() < 1e-14, "{corner}");
        }
    }
}
