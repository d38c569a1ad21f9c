//! Case 4: two discs meet, head-on and aslant.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{dynamic, rms, worst};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "04_two_discs",
    about: "two smooth discs of different mass meet, e = 1, from 16 distances: velocities, energy, momentum",
    metrics: &[
        Metric::error("oblique_vel_err_rel_rms", "1"),
        Metric::error("oblique_vel_err_rel_max", "1"),
        Metric::error("oblique_energy_err_max", "1"),
        Metric::error("oblique_momentum_err_max", "kg m/s"),
        Metric::error("headon_vel_err_rel_rms", "1"),
        Metric::error("headon_vel_err_rel_max", "1"),
        Metric::error("headon_energy_err_max", "1"),
        Metric::error("headon_momentum_err_max", "kg m/s"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

#[derive(Clone, Copy, Debug)]
struct Disc {
    radius: f64,
    density: f64,
    velocity: Vec2,
}

impl Disc {
    fn mass(self) -> f64 {
        self.density * std::f64::consts::PI * self.radius * self.radius
    }
}

const A: Disc = Disc {
    radius: 0.5,
    density: 1.0,
    velocity: vec2(4.0, 0.0),
};

const B: Disc = Disc {
    radius: 0.7,
    density: 2.0,
    velocity: vec2(-1.0, 0.0),
};

/// In m/s.
const CLOSING: f64 = 5.0;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    for (kind, aside) in [("headon", 0.0), ("oblique", 0.5)] {
        let exact = exact(aside);
        let (mut velocity, mut energy, mut momentum) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..16 {
            let end = meet(trial, 2.0 + 0.0173 * f64::from(k), aside)?;
            let [a, b] = [end[0] - exact[0], end[1] - exact[1]];
            velocity.push((a.length_squared() + b.length_squared()).sqrt() / CLOSING);
            let start = [A.velocity, B.velocity];
            energy.push((twice_energy(end) / twice_energy(start) - 1.0).abs());
            momentum.push((total(end) - total(start)).length());
        }
        values.push((format!("{kind}_vel_err_rel_rms"), rms(&velocity)));
        values.push((format!("{kind}_vel_err_rel_max"), worst(&velocity)));
        values.push((format!("{kind}_energy_err_max"), worst(&energy)));
        values.push((format!("{kind}_momentum_err_max"), worst(&momentum)));
    }
    Ok(values)
}

/// The velocities after 1.5 s, with A starting at (−x, aside).
fn meet(trial: &mut Trial, x: f64, aside: f64) -> Result<[Vec2; 2], EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let mut bodies = [0; 2];
    for (i, (disc, at)) in [(A, vec2(-x, aside)), (B, vec2(0.5, 0.0))]
        .into_iter()
        .enumerate()
    {
        let material = scene.material(disc.density, 0.0, 1.0);
        let circle = PlainShape::Circle {
            radius: disc.radius,
        };
        bodies[i] = scene.add(dynamic(at, material).moving(disc.velocity), circle);
    }
    let mut run = trial.open(&scene)?;
    run.until(1.5);
    Ok(bodies.map(|body| run.state(body).velocity))
}

/// The velocities after the impulse along the line of centres at first touch.
fn exact(aside: f64) -> [Vec2; 2] {
    let s = A.radius + B.radius;
    // From B to A.
    let n = vec2(-(s * s - aside * aside).sqrt(), aside) / s;
    let j = -2.0 * (A.velocity - B.velocity).dot(n) / (A.mass().recip() + B.mass().recip());
    [
        A.velocity + n * (j / A.mass()),
        B.velocity - n * (j / B.mass()),
    ]
}

fn twice_energy([a, b]: [Vec2; 2]) -> f64 {
    A.mass() * a.length_squared() + B.mass() * b.length_squared()
}

fn total([a, b]: [Vec2; 2]) -> Vec2 {
    a * A.mass() + b * B.mass()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_answer_keeps_energy_and_momentum() {
        let start = [A.velocity, B.velocity];
        for aside in [0.0, 0.5] {
            let end = exact(aside);
            assert!((twice_energy(end) / twice_energy(start) - 1.0).abs() < 1e-15);
            assert!((total(end) - total(start)).length() < 1e-15);
            assert!(end[0].x < end[1].x, "they part");
        }
    }
}
