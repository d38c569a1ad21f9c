//! Rings that are simple by construction: spiky, thin, nearly straight, far away.

use std::f64::consts::TAU;

use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

/// Coordinates are whole multiples of this, so that shifts by whole metres are exact.
const GRID: f64 = 1.0 / (1 << 20) as f64;

fn on_grid(p: Vec2) -> Vec2 {
    (p / GRID).round() * GRID
}

/// Star-shaped about the origin, up to 2 m across: simple whatever the radii are.
pub(super) fn star() -> impl Strategy<Value = Vec<Vec2>> {
    let spoke = (0.0..0.9_f64, 0.05..1.0_f64);
    prop::collection::vec(spoke, 4..40).prop_map(|spokes| {
        let count = spokes.len() as f64;
        let place = |(i, (late, radius)): (usize, &(f64, f64))| {
            let turn = Rot::from_angle(TAU * (i as f64 + late) / count);
            on_grid(turn * vec2(*radius, 0.0))
        };
        spokes.iter().enumerate().map(place).collect()
    })
}

/// A star with edges cut in halves, by a point exactly on them or a hair beside.
fn nearly_straight() -> impl Strategy<Value = Vec<Vec2>> {
    let hair = prop_oneof![
        Just(0.0),
        Just(1e-13),
        Just(-1e-13),
        Just(1e-9),
        Just(-1e-9)
    ];
    (star(), prop::collection::vec(hair, 40)).prop_map(|(ring, hairs)| {
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        ends.zip(hairs)
            .flat_map(|((a, b), hair)| [*a, (*a + *b) * 0.5 + vec2(hair, hair)])
            .collect()
    })
}

/// A zigzag band, down to 1e-12 m thin.
fn band() -> impl Strategy<Value = Vec<Vec2>> {
    (3..30_usize, 0..13_i32).prop_map(|(count, digits)| {
        let thin = (0..digits).fold(0.25, |thin, _| thin * 0.1);
        let point =
            |i: usize, up: f64| vec2(i as f64, if i.is_multiple_of(2) { up } else { 0.5 + up });
        let there = (0..count).map(|i| point(i, 0.0));
        there
            .chain((0..count).rev().map(|i| point(i, thin)))
            .collect()
    })
}

/// Teeth of many lengths on a thin bar: many reflex corners, many straight ones.
fn comb() -> impl Strategy<Value = Vec<Vec2>> {
    prop::collection::vec(1..100_u32, 2..30).prop_map(|teeth| {
        let mut ring = vec![vec2(2.0 * teeth.len() as f64 - 1.0, -1.0)];
        for (i, length) in teeth.iter().enumerate().rev() {
            let (x, y) = (2.0 * i as f64, f64::from(*length) * 0.125);
            ring.extend([
                vec2(x + 1.0, 0.0),
                vec2(x + 1.0, y),
                vec2(x, y),
                vec2(x, 0.0),
            ]);
        }
        ring.push(vec2(0.0, -1.0));
        ring
    })
}

/// A star pressed flat, exactly, to as little as 2⁻⁴⁰ of its height.
fn sliver() -> impl Strategy<Value = Vec<Vec2>> {
    (star(), 0..=40_u32, any::<bool>()).prop_map(|(ring, power, upright)| {
        let flat = 1.0 / (1_u64 << power) as f64;
        let press = |p: Vec2| {
            if upright {
                vec2(p.x * flat, p.y)
            } else {
                vec2(p.x, p.y * flat)
            }
        };
        ring.into_iter().map(press).collect()
    })
}

/// Any simple ring near the origin, counter-clockwise.
pub(super) fn ring() -> impl Strategy<Value = Vec<Vec2>> {
    prop_oneof![star(), nearly_straight(), band(), comb(), sliver()]
}

/// Whole metres up to 2³⁰ m: exact to add to what lies on the grid.
pub(super) fn shift() -> impl Strategy<Value = Vec2> {
    let metres = -(1_i32 << 30)..(1 << 30);
    (metres.clone(), metres).prop_map(|(x, y)| vec2(f64::from(x), f64::from(y)))
}

/// Points of all kinds: in a cloud, on a small grid (many on one line), nearly on one line.
pub(super) fn cloud() -> impl Strategy<Value = Vec<Vec2>> {
    let free = (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| vec2(x, y));
    let grid = (-3..=3_i32, -3..=3_i32).prop_map(|(x, y)| vec2(f64::from(x), f64::from(y)));
    let line = (-1.0..1.0_f64, -2..=2_i32)
        .prop_map(|(x, hair)| vec2(x, x / 3.0 + f64::from(hair) * f64::EPSILON));
    prop_oneof![
        prop::collection::vec(free, 3..60),
        prop::collection::vec(grid, 3..60),
        prop::collection::vec(line, 3..60),
    ]
}
