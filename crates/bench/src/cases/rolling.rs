//! Case 9: a disc rolls down a slope.

use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{G, GRAVITY, Incline, dynamic};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "09_rolling",
    about: "a disc rolls down 20 degrees for 2 s without slipping: distance, slip at the end",
    metrics: &[
        Metric::error("roll_dist_2s", "1"),
        Metric::error("slip_speed", "m/s"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let (incline, radius) = (Incline::new(), 0.5);
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, 1.0, 0.0);
    incline.add(&mut scene, material);
    let start = incline.above(radius);
    let disc = scene.add(dynamic(start, material), PlainShape::Circle { radius });

    let mut run = trial.open(&scene)?;
    run.until(2.0);
    let (t, end) = (run.time(), run.state(disc));
    let moved = (end.position - start).dot(incline.downhill());
    // I = m r²/2: two thirds of the pull go into the motion, one into the spin.
    let exact = 2.0 / 3.0 * G * incline.sin * t * t / 2.0;
    // Downhill is to the left: the disc turns counter-clockwise.
    let slip = end.velocity.dot(incline.downhill()) - end.spin * radius;
    Ok(vec![
        ("roll_dist_2s".into(), (moved / exact - 1.0).abs()),
        ("slip_speed".into(), slip.abs()),
    ])
}
