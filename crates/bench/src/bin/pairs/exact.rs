//! Area and moments in whole numbers: nothing is rounded but the answer.
//!
//! `cargo xtask stress` compiles the same file.

use carom_math::{Vec2, vec2};

/// Corners are multiples of this, in m, and within 2 m of their centre.
pub(crate) const GRID: f64 = 1.0 / 65536.0;

/// A point of the grid, in steps.
pub(crate) type Point = [i128; 2];

/// The nearest point of the grid.
pub(crate) fn on_grid(p: Vec2) -> Point {
    #[expect(clippy::cast_possible_truncation, reason = "a few thousand steps")]
    let steps = |x: f64| (x / GRID).round() as i128;
    [steps(p.x), steps(p.y)]
}

/// A point of the grid, moved by `offset`: exact where the sum is a double.
pub(crate) fn placed(p: Point, offset: Vec2) -> Vec2 {
    vec2(p[0] as f64, p[1] as f64) * GRID + offset
}

/// Twice the area of the triangle p, q, r; above zero if counter-clockwise.
pub(crate) fn turn(p: Point, q: Point, r: Point) -> i128 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// Twice the area of a ring, in steps squared.
pub(crate) fn twice_area(ring: &[Point]) -> i128 {
    edges(ring).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum()
}

/// Area in m², centroid in m, and polar moment about it in m⁴.
pub(crate) fn moments(ring: &[Point]) -> (f64, Vec2, f64) {
    let (mut twice, mut cx, mut cy, mut second) = (0, 0, 0, 0);
    for ([x, y], [u, v]) in edges(ring) {
        let k = x * v - y * u;
        twice += k;
        cx += k * (x + u);
        cy += k * (y + v);
        second += k * (x * x + x * u + u * u + y * y + y * v + v * v);
    }
    // Below 2^36 and 2^54 and 2^72: the products of two of them fit.
    let area = twice as f64 / 2.0 * GRID * GRID;
    let thrice = 3.0 * twice as f64;
    let centroid = vec2(cx as f64 / thrice, cy as f64 / thrice) * GRID;
    let about_centroid = 3 * second * twice - 2 * (cx * cx + cy * cy);
    let grid4 = GRID * GRID * GRID * GRID;
    (
        area,
        centroid,
        about_centroid as f64 / (12.0 * thrice) * grid4,
    )
}

fn edges(ring: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    let ends = ring.iter().cycle().skip(1);
    ring.iter().zip(ends).map(|(p, q)| (*p, *q))
}
