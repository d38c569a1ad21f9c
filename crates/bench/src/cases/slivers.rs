//! Case 16: slivers fall.

use carom_math::{Rot, Vec2, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{GRAVITY, centred, dynamic, floor, larger};
use super::{Case, Metric, RATES, Run, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "16_slivers",
    about: "a box and a needle 1 m long and 1 mm thick fall flat, tilted and upright: whether they rest, overlap",
    metrics: &[
        Metric::error("box_flat_deepest_m", "m"),
        Metric::error("box_tilt30_deepest_m", "m"),
        Metric::error("box_upright_deepest_m", "m"),
        Metric::error("needle_flat_deepest_m", "m").or("refused"),
        Metric::error("needle_tilt30_deepest_m", "m").or("refused"),
        Metric::error("needle_upright_deepest_m", "m").or("refused"),
        Metric::value("box_flat_rests", "1"),
        Metric::value("box_tilt30_rests", "1"),
        Metric::value("box_upright_rests", "1"),
        Metric::value("needle_flat_rests", "1").or("refused"),
        Metric::value("needle_tilt30_rests", "1").or("refused"),
        Metric::value("needle_upright_rests", "1").or("refused"),
    ],
    rates: RATES,
    sweeps_substeps: true,
    quick: QUICK,
    measure,
};

const NEEDLE: [Vec2; 3] = [vec2(-0.5, 0.0), vec2(0.5, -0.0005), vec2(0.5, 0.0005)];

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let box_corners = [
        vec2(-0.5, -0.0005),
        vec2(0.5, -0.0005),
        vec2(0.5, 0.0005),
        vec2(-0.5, 0.0005),
    ];
    let slivers = [
        (
            "box",
            PlainShape::rectangle(0.5, 0.0005),
            box_corners.to_vec(),
        ),
        {
            let corners = centred(&NEEDLE).0;
            ("needle", PlainShape::Polygon(corners.clone()), corners)
        },
    ];
    let mut values = Values::new();
    for (shape_name, shape, corners) in slivers {
        for (angle_name, degrees) in [("flat", 0.0), ("tilt30", 30.0), ("upright", 89.0)] {
            match fall(trial, shape.clone(), &corners, degrees) {
                Ok((rests, deepest)) => {
                    let name = format!("{shape_name}_{angle_name}");
                    values.push((format!("{name}_rests"), f64::from(u8::from(rests))));
                    values.push((format!("{name}_deepest_m"), deepest));
                }
                // An engine that takes the box alone is assessed by the box.
                Err(EngineError::Body { .. }) if shape_name == "needle" => {}
                Err(error) => return Err(error),
            }
        }
    }
    Ok(values)
}

/// Whether a sliver rests after 5 s, and how far a corner of it was below the floor, in m.
fn fall(
    trial: &mut Trial,
    shape: PlainShape,
    corners: &[Vec2],
    degrees: f64,
) -> Result<(bool, f64), EngineError> {
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1000.0, 0.5, 0.0);
    floor(&mut scene, material);
    let body = dynamic(vec2(0.0, 1.2), material).turned(degrees.to_radians());
    let sliver = scene.add(body, shape);
    let mut run = trial.open(&scene)?;
    let mut deepest = 0.0;
    while run.goes_on(5.0) {
        run.step();
        deepest = larger(deepest, -lowest(&run, sliver, corners));
    }
    let end = run.state(sliver);
    let rests = (-0.01 < end.position.y && end.position.y < 0.02)
        && end.position.x.abs() < 2.0
        && end.velocity.length() < 0.05;
    Ok((rests, deepest))
}

/// Height of the lowest corner, in m.
fn lowest(run: &Run<'_>, body: usize, corners: &[Vec2]) -> f64 {
    let state = run.state(body);
    let turn = Rot::from_angle(state.angle);
    let heights = corners.iter().map(|corner| (turn * *corner).y);
    state.position.y - heights.fold(f64::NEG_INFINITY, |high, y| larger(high, -y))
}
