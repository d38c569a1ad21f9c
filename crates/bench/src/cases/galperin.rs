//! Case 7: a large disc throws a small one against a wall, and the collisions count the digits of π (Galperin 2003).

use std::f64::consts::FRAC_PI_4;

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{dynamic, larger};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "07_galperin",
    about: "masses 1 and 100^k kg between each other and a wall, e = 1: 3, 31, 314, 3141, 31415 collisions",
    metrics: &[
        Metric::error("k2_final_vel", "1"),
        Metric::error("k0_final_vel", "1"),
        Metric::error("k1_final_vel", "1"),
        Metric::error("k3_final_vel", "1"),
        Metric::error("k4_final_vel", "1"),
        Metric::value("k0_events", "1"),
        Metric::value("k1_events", "1"),
        Metric::value("k2_events", "1"),
        Metric::value("k3_events", "1"),
        Metric::value("k4_events", "1"),
        Metric::error("k0_energy", "1"),
        Metric::error("k1_energy", "1"),
        Metric::error("k2_energy", "1"),
        Metric::error("k3_energy", "1"),
        Metric::error("k4_energy", "1"),
        Metric::error("k0_deepest_m", "m"),
        Metric::error("k1_deepest_m", "m"),
        Metric::error("k2_deepest_m", "m"),
        Metric::error("k3_deepest_m", "m"),
        Metric::error("k4_deepest_m", "m"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

/// Of both discs, in m.
const RADIUS: f64 = 0.5;

/// A change of speed that counts as a collision, in m/s.
const EVENT: f64 = 1e-6;

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    let mut mass = 1.0;
    for k in 0..5 {
        values.extend(collide(trial, k, mass)?);
        mass *= 100.0;
    }
    Ok(values)
}

fn collide(trial: &mut Trial, k: u32, mass: f64) -> Result<Values, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let light = scene.material(1.0 / FRAC_PI_4, 0.0, 1.0);
    let heavy = scene.material(mass / FRAC_PI_4, 0.0, 1.0);
    let wall = PlainBody::new(PlainKind::Fixed, vec2(-1.0, 0.0), light);
    scene.add(wall, PlainShape::rectangle(1.0, 5.0));
    let disc = PlainShape::Circle { radius: RADIUS };
    let small = scene.add(dynamic(vec2(1.5, 0.0), light), disc.clone());
    let moving = dynamic(vec2(3.0, 0.0), heavy).moving(vec2(-1.0, 0.0));
    let large = scene.add(moving, disc);

    let mut run = trial.open(&scene)?;
    let (mut events, mut deepest) = (0, 0.0);
    let speeds = |run: &super::Run<'_>| [small, large].map(|body| run.state(body).velocity.x);
    let mut before = speeds(&run);
    while run.goes_on(12.0) {
        run.step();
        let now = speeds(&run);
        if (now[0] - before[0]).abs() + (now[1] - before[1]).abs() > EVENT {
            events += 1;
        }
        before = now;
        let [near, far] = [small, large].map(|body| run.state(body).position.x);
        let overlap = larger(RADIUS - near, 2.0 * RADIUS - (far - near));
        deepest = larger(deepest, overlap);
    }
    let end = exact(mass).velocities;
    let (small_error, large_error) = (before[0] - end[0], before[1] - end[1]);
    let error = (small_error * small_error + mass * large_error * large_error).sqrt();
    // E0 = m/2
    let energy = (before[0] * before[0] + mass * before[1] * before[1]) / mass;
    Ok(vec![
        (format!("k{k}_events"), f64::from(events)),
        (format!("k{k}_final_vel"), error / mass.sqrt()),
        (format!("k{k}_energy"), (energy - 1.0).abs()),
        (format!("k{k}_deepest_m"), deepest),
    ])
}

#[derive(Clone, Copy, Debug)]
struct End {
    /// Of the small and the large disc, in m/s.
    velocities: [f64; 2],
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "what the tests know the answer of")
    )]
    collisions: u32,
}

/// Collision by collision: the small disc meets the large one while it is the faster of the two, else the wall while it
/// goes there.
fn exact(mass: f64) -> End {
    let [mut small, mut large] = [0.0, -1.0];
    let mut collisions = 0;
    loop {
        if small > large {
            // Elastic: the closing speed u turns round about the centre of mass.
            let u = small - large;
            small -= 2.0 * mass / (1.0 + mass) * u;
            large += 2.0 / (1.0 + mass) * u;
        } else if small < 0.0 {
            small = -small;
        } else {
            let velocities = [small, large];
            return End {
                velocities,
                collisions,
            };
        }
        collisions += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collisions_count_the_digits_of_pi() {
        let masses = [1.0, 1e2, 1e4, 1e6, 1e8];
        let counts = masses.map(|mass| exact(mass).collisions);
        assert_eq!(counts, [3, 31, 314, 3141, 31415]);
    }

    #[test]
    fn energy_is_kept() {
        for mass in [1.0, 1e4, 1e8] {
            let [small, large] = exact(mass).velocities;
            let ratio = (small * small + mass * large * large) / mass;
            assert!((ratio - 1.0).abs() < 1e-11, "{mass}: {ratio}");
        }
    }
}
