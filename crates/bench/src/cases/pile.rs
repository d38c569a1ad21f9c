//! Case 21: a pile of polygons falls together, against the engine's own run at a fine step.

use std::f64::consts::TAU;

use carom_math::{Vec2, trig, vec2};
use carom_scenes::{PlainScene, PlainShape};

use super::plan::QUICK;
use super::worlds::{GRAVITY, dynamic, floor};
use super::{Case, refined};

pub(super) const CASE: Case = Case {
    name: "21_pile_self_convergence",
    about: "20 polygons falling on each other: places against the engine's own run at 7680 Hz",
    metrics: refined::METRICS,
    rates: refined::RATES,
    sweeps_substeps: false,
    quick: QUICK,
    measure: |trial| refined::measure(trial, &world(), TIME),
};

/// The places are compared here, in s, soon after the first contacts.
///
/// At twice this time the runs part by centimetres however small the step, though a shift of the start does not grow:
/// the first pair to touch differs from rate to rate.
const TIME: f64 = 0.25;

/// Four rows of five regular polygons, none turned as its neighbours, 0.1 m and more above what is below them.
fn world() -> PlainScene {
    let mut scene = PlainScene::empty(CASE.name, GRAVITY);
    let material = scene.material(1.0, 0.5, 0.2);
    floor(&mut scene, material);
    for i in 0..20_u32 {
        let (column, row) = (f64::from(i % 5), f64::from(i / 5));
        let shape = PlainShape::Polygon(regular(3 + i % 6, 0.3 + 0.02 * f64::from(i % 4)));
        let at = vec2(0.8 * column + 0.15 * row, 0.5 + 0.82 * row);
        scene.add(dynamic(at, material).turned(0.7 * f64::from(i)), shape);
    }
    scene
}

fn regular(corners: u32, radius: f64) -> Vec<Vec2> {
    let corner = |i| {
        let (sin, cos) = trig::sin_cos(TAU * f64::from(i) / f64::from(corners));
        vec2(cos, sin) * radius
    };
    (0..corners).map(corner).collect()
}
