//! Case 6: a pentagon meets a slab off its centre.

use carom_math::{Rot, Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{centred, dynamic, rms, worst};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::{EngineError, State};

pub(super) const CASE: Case = Case {
    name: "06_eccentric",
    about: "a pentagon's corner meets a slab off its centre, e = 0, 0.5 and 1, from 16 gaps: velocities and spins",
    metrics: &[
        Metric::error("e1_err_rel_rms", "1"),
        Metric::error("e1_err_rel_max", "1"),
        Metric::error("e1_momentum_err", "1"),
        Metric::error("e0.5_err_rel_rms", "1"),
        Metric::error("e0.5_err_rel_max", "1"),
        Metric::error("e0.5_momentum_err", "1"),
        Metric::error("e0_err_rel_rms", "1"),
        Metric::error("e0_err_rel_max", "1"),
        Metric::error("e0_momentum_err", "1"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

const CORNERS: [Vec2; 5] = [
    vec2(0.9, 0.0),
    vec2(0.3, 0.6),
    vec2(-0.6, 0.5),
    vec2(-0.7, -0.4),
    vec2(0.2, -0.5),
];

/// Of the pentagon, in rad.
const ANGLE: f64 = 0.25;

/// Of the pentagon, along x, in m/s.
const SPEED: f64 = 6.0;

/// Half of the slab's sides, in m: 3 kg.
const SLAB: Vec2 = vec2(0.5, 1.5);

#[derive(Clone, Debug)]
struct Bodies {
    corners: Vec<Vec2>,
    /// From the pentagon's centre to the corner that meets the slab, in m.
    arm: Vec2,
    /// Pentagon and slab, in kg.
    mass: [f64; 2],
    /// In kg m².
    inertia: [f64; 2],
}

impl Bodies {
    fn new() -> Self {
        let (corners, area) = centred(&CORNERS);
        let slab = 4.0 * SLAB.x * SLAB.y;
        Self {
            arm: Rot::from_angle(ANGLE) * corners[0],
            corners,
            mass: [area.area, slab],
            inertia: [area.polar, slab * SLAB.length_squared() / 3.0],
        }
    }
}

/// Along x in m/s, spin in rad/s.
type Motion = [(f64, f64); 2];

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let bodies = Bodies::new();
    let mut values = Values::new();
    for e in [0.0, 0.5, 1.0] {
        let (mut errors, mut momenta) = (Vec::new(), Vec::new());
        for k in 0..16 {
            let gap = 0.4 + 0.0131 * f64::from(k);
            let off = 0.2 + 0.05 * f64::from(k % 4);
            let end = meet(trial, &bodies, e, gap, off)?;
            errors.push(error(&bodies, &end, &exact(&bodies, e, off)));
            let momentum = end[0].velocity * bodies.mass[0] + end[1].velocity * bodies.mass[1];
            let start = vec2(SPEED * bodies.mass[0], 0.0);
            momenta.push((momentum - start).length() / start.x);
        }
        values.push((format!("e{e}_err_rel_rms"), rms(&errors)));
        values.push((format!("e{e}_err_rel_max"), worst(&errors)));
        values.push((format!("e{e}_momentum_err"), worst(&momenta)));
    }
    Ok(values)
}

/// Pentagon and slab after they met.
fn meet(
    trial: &mut Trial,
    bodies: &Bodies,
    e: f64,
    gap: f64,
    off: f64,
) -> Result<[State; 2], EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let material = scene.material(1.0, 0.0, e);
    let pentagon = dynamic(vec2(-gap, off) - bodies.arm, material)
        .turned(ANGLE)
        .moving(vec2(SPEED, 0.0));
    let pentagon = scene.add(pentagon, PlainShape::Polygon(bodies.corners.clone()));
    let slab = dynamic(vec2(SLAB.x, 0.0), material);
    let slab = scene.add(slab, PlainShape::rectangle(SLAB.x, SLAB.y));
    // Without a bounce they stay together and turn on: read at once.
    let after = if e > 0.0 {
        0.08
    } else {
        0.0001 + 2.0 * trial.dt()
    };
    let mut run = trial.open(&scene)?;
    run.until(gap / SPEED + after);
    Ok([pentagon, slab].map(|body| run.state(body)))
}

/// The impulse j = u (1 + e)/K along x at the corner.
fn exact(bodies: &Bodies, e: f64, off: f64) -> Motion {
    let [m_a, m_b] = bodies.mass;
    let [i_a, i_b] = bodies.inertia;
    let r_a = bodies.arm.y;
    let k = 1.0 / m_a + 1.0 / m_b + r_a * r_a / i_a + off * off / i_b;
    let j = SPEED * (1.0 + e) / k;
    [(SPEED - j / m_a, r_a * j / i_a), (j / m_b, -off * j / i_b)]
}

/// Velocities, and spins as the speeds that they stand for, against the approach.
fn error(bodies: &Bodies, end: &[State; 2], exact: &Motion) -> f64 {
    let mut sum = 0.0;
    for (i, (v, w)) in exact.iter().enumerate() {
        let spin = end[i].spin - w;
        sum += (end[i].velocity - vec2(*v, 0.0)).length_squared();
        sum += bodies.inertia[i] / bodies.mass[i] * spin * spin;
    }
    sum.sqrt() / SPEED
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slab_is_as_described() {
        let bodies = Bodies::new();
        assert!((bodies.mass[1] - 3.0).abs() < 1e-15);
        assert!((bodies.inertia[1] - 2.5).abs() < 1e-15);
    }

    #[test]
    fn the_first_corner_is_the_rightmost() {
        let bodies = Bodies::new();
        let turned = bodies
            .corners
            .iter()
            .map(|p| (Rot::from_angle(ANGLE) * *p).x);
        assert!(turned.skip(1).all(|x| x < bodies.arm.x));
    }

    #[test]
    fn the_exact_answer_turns_the_approach_round_and_keeps_energy() {
        let bodies = Bodies::new();
        let off = 0.3;
        let [(v_a, w_a), (v_b, w_b)] = exact(&bodies, 1.0, off);
        let approach = (v_a - w_a * bodies.arm.y) - (v_b - w_b * off);
        assert!((approach + SPEED).abs() < 1e-14, "{approach}");
        let energy = bodies.mass[0] * v_a * v_a
            + bodies.inertia[0] * w_a * w_a
            + bodies.mass[1] * v_b * v_b
            + bodies.inertia[1] * w_b * w_b;
        let start = bodies.mass[0] * SPEED * SPEED;
        assert!((energy / start - 1.0).abs() < 1e-15);
    }
}
