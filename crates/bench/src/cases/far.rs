//! Case 17: far from the origin.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{GRAVITY, dynamic, larger};
use super::{Case, Metric, RATES, Trial, Values};
use crate::engine::EngineError;

pub(super) const CASE: Case = Case {
    name: "17_far_out",
    about: "a free box, a stopping box and a stack of five, 0 … 1e6 m from the origin: distances, speed, drift",
    metrics: &[
        Metric::error("x1e6_stop_dist", "1"),
        Metric::error("x0e0_stop_dist", "1"),
        Metric::error("x1e4_stop_dist", "1"),
        Metric::error("x1e5_stop_dist", "1"),
        Metric::error("x0e0_free_dist", "1"),
        Metric::error("x1e4_free_dist", "1"),
        Metric::error("x1e5_free_dist", "1"),
        Metric::error("x1e6_free_dist", "1"),
        Metric::error("x0e0_stack_max_speed", "m/s"),
        Metric::error("x1e4_stack_max_speed", "m/s"),
        Metric::error("x1e5_stack_max_speed", "m/s"),
        Metric::error("x1e6_stack_max_speed", "m/s"),
        Metric::error("x0e0_stack_move_m", "m"),
        Metric::error("x1e4_stack_move_m", "m"),
        Metric::error("x1e5_stack_move_m", "m"),
        Metric::error("x1e6_stack_move_m", "m"),
        Metric::error("x0e0_stack_top_m", "m"),
        Metric::error("x1e4_stack_top_m", "m"),
        Metric::error("x1e5_stack_top_m", "m"),
        Metric::error("x1e6_stack_top_m", "m"),
    ],
    rates: RATES,
    sweeps_substeps: false,
    quick: QUICK,
    measure,
};

fn measure(trial: &mut Trial) -> Result<Values, EngineError> {
    let mut values = Values::new();
    for (name, x) in [("x0e0", 0.0), ("x1e4", 1e4), ("x1e5", 1e5), ("x1e6", 1e6)] {
        values.push((format!("{name}_free_dist"), free(trial, x)?));
        values.push((format!("{name}_stop_dist"), stop(trial, x)?));
        let stack = stack(trial, x)?;
        values.push((format!("{name}_stack_max_speed"), stack.speed));
        values.push((format!("{name}_stack_move_m"), stack.moved));
        values.push((format!("{name}_stack_top_m"), stack.top));
    }
    Ok(values)
}

/// 0.05 m/s for 10 s, against 0.5 m, relative.
fn free(trial: &mut Trial, x: f64) -> Result<f64, EngineError> {
    let mut scene = PlainScene::empty(CASE.name, Vec2::ZERO);
    let material = scene.material(1.0, 0.6, 0.0);
    let start = vec2(x + 0.3, 0.0);
    push(trial, scene, material, (start, 0.05), 10.0, 0.5)
}

/// 3 m/s on a floor with mu 0.3, against v²/(2 mu g) = 1.5 m, relative.
fn stop(trial: &mut Trial, x: f64) -> Result<f64, EngineError> {
    let (scene, material) = floor(x, 0.3);
    let start = vec2(x + 0.3, 0.5);
    push(trial, scene, material, (start, 3.0), 3.0, 1.5)
}

/// Adds a box with a speed along x, runs, and compares its way with `exact`.
fn push(
    trial: &mut Trial,
    mut scene: PlainScene,
    material: usize,
    (start, speed): (Vec2, f64),
    time: f64,
    exact: f64,
) -> Result<f64, EngineError> {
    let body = dynamic(start, material).moving(vec2(speed, 0.0));
    let body = scene.add(body, PlainShape::rectangle(0.5, 0.5));
    let mut run = trial.open(&scene)?;
    // As the engine holds it: single precision moved it when it was made.
    let start = run.state(body).position.x;
    run.until(time);
    let way = run.state(body).position.x - start;
    Ok((way / exact - 1.0).abs())
}

struct Stack {
    /// Largest between 2 and 10 s, in m/s.
    speed: f64,
    /// Largest distance from the place at 2 s, in m.
    moved: f64,
    /// Height of the top box against 4.5 m.
    top: f64,
}

fn stack(trial: &mut Trial, x: f64) -> Result<Stack, EngineError> {
    let (mut scene, material) = floor(x, 0.6);
    let shape = scene.shape(PlainShape::rectangle(0.5, 0.5));
    let boxes = [0.0, 1.0, 2.0, 3.0, 4.0].map(|i| {
        let at = vec2(x + 0.3 + 0.03 * i, 0.5 + i);
        scene.place(dynamic(at, material), shape)
    });
    let mut run = trial.open(&scene)?;
    run.until(2.0);
    let places = boxes.map(|body| run.state(body).position);
    let (mut speed, mut moved) = (0.0, 0.0);
    while run.goes_on(10.0) {
        run.step();
        for (body, place) in boxes.iter().zip(places) {
            let state = run.state(*body);
            speed = larger(speed, state.velocity.length());
            moved = larger(moved, state.position.distance(place));
        }
    }
    let top = (run.state(boxes[4]).position.y - 4.5).abs();
    Ok(Stack { speed, moved, top })
}

fn floor(x: f64, friction: f64) -> (PlainScene, usize) {
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, friction, 0.0);
    let body = PlainBody::new(PlainKind::Fixed, vec2(x, -1.0), material);
    scene.add(body, PlainShape::rectangle(100.0, 1.0));
    (scene, material)
}
