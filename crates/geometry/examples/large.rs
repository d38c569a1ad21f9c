//! How long large outlines take: checked, cut into convex pieces, weighed.
//!
//! `cargo run --release -p carom-geometry --example large [vertices]`
#![expect(
    clippy::disallowed_methods,
    reason = "an example that measures has a clock"
)]
#![allow(clippy::cast_precision_loss, reason = "counts")]

use std::time::Instant;

use carom_geometry::{AreaProperties, Polygon, PolygonError, ring_properties};
use carom_math::{Rot, Vec2, vec2};

/// Least of three runs, in ms.
fn least<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let mut best = f64::INFINITY;
    let mut answer = None;
    for _ in 0..3 {
        let start = Instant::now();
        answer = Some(run());
        best = best.min(start.elapsed().as_secs_f64());
    }
    (answer.expect("three runs"), 1e3 * best)
}

fn outlines(count: usize) -> Result<Vec<(&'static str, Vec<Vec2>)>, PolygonError> {
    let mut state = 1_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let half = count / 2;
    let spiral = |i: usize, r: f64| {
        let turn = i as f64 * 0.02;
        Rot::from_angle(turn) * vec2(r + turn, 0.0)
    };
    let there = (0..half).map(|i| spiral(i, 10.0));
    let back = (0..half).rev().map(|i| spiral(i, 14.0));
    // Teeth as long as the comb.
    let teeth = count / 4;
    let long = 2.0 * teeth as f64;
    let mut comb = vec![vec2(long, -1.0), vec2(long, 0.0)];
    for i in (0..teeth).rev() {
        let x = 2.0 * i as f64;
        comb.extend([
            vec2(x + 1.0, 0.0),
            vec2(x + 1.0, long),
            vec2(x, long),
            vec2(x, 0.0),
        ]);
    }
    comb.push(vec2(-1.0, -1.0));
    // On its side, a sweep along x crosses all teeth at once.
    let lying: Vec<Vec2> = comb.iter().map(|p| vec2(-p.y, p.x)).collect();
    let saw = |i: usize| vec2(i as f64, if i.is_multiple_of(2) { 0.0 } else { 1000.0 });
    let below = (0..half).map(|i| saw(i) - vec2(0.0, 1.0));
    let above = (0..half).rev().map(saw);
    let staircase =
        (0..half).flat_map(|i| [vec2(i as f64, i as f64), vec2(i as f64 + 1.0, i as f64)]);
    Ok(vec![
        (
            "circle",
            (0..count)
                .map(|i| Rot::from_degrees(360.0 * i as f64 / count as f64).x_axis())
                .collect(),
        ),
        ("star", Polygon::star(half, 1.0, 0.5)?.vertices().to_vec()),
        (
            "needle star",
            Polygon::star(half, 1.0, 1e-3)?.vertices().to_vec(),
        ),
        ("comb", comb),
        ("lying comb", lying),
        ("saw", below.chain(above).collect()),
        (
            "stairs",
            staircase.chain([vec2(0.0, half as f64)]).collect(),
        ),
        ("spiral", there.chain(back).collect()),
        (
            "random star",
            Polygon::random_star(count, 0.5, 1.0, &mut next)?
                .vertices()
                .to_vec(),
        ),
        (
            "random simple",
            Polygon::random(count, 1.0, 1.0, &mut next)?
                .vertices()
                .to_vec(),
        ),
    ])
}

fn main() -> Result<(), PolygonError> {
    let count = std::env::args()
        .nth(1)
        .and_then(|n| n.parse().ok())
        .unwrap_or(100_000);
    println!(
        "{:14} {:>8} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9}",
        "outline", "vertices", "check ms", "all ms", "mass ms", "pieces", "area", "polar"
    );
    for (name, ring) in outlines(count)? {
        let (checked, check) = least(|| Polygon::check(&ring));
        checked?;
        let (polygon, all) = least(|| Polygon::new(ring.as_slice()));
        let polygon = polygon?;
        let (whole, mass) = least(|| polygon.area_properties());
        let pieces = polygon.pieces().iter();
        let sum = pieces
            .map(|piece| ring_properties(piece.vertices()))
            .sum::<Result<AreaProperties, _>>()?;
        println!(
            "{name:14} {:8} {check:9.1} {all:9.1} {mass:9.2} {:8} {:9.1e} {:9.1e}",
            polygon.vertices().len(),
            polygon.pieces().len(),
            (sum.area / whole.area - 1.0).abs(),
            (sum.polar / whole.polar - 1.0).abs(),
        );
    }
    Ok(())
}
