//! Stress cases without a world: mass properties and convex pieces.

use carom_geometry::{ConvexPiece, Polygon, ring_properties};
use carom_math::{Rot, Vec2, orient2d, vec2};

use super::Finding;
use crate::exit::Failure;

/// Case 1: five vertices far from the origin. 1126 m is an exact shift, so the answer is that at the origin.
pub(super) fn far_polygon() -> Result<Finding, Failure> {
    let near = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.5, 0.75),
        (0.5, 1.25),
        (-0.25, 0.5),
    ];
    let near = near.map(|(x, y)| vec2(x, y));
    let far = near.map(|p| p + vec2(1126.0, -1126.0));
    let expected = ring_properties(&near)?.polar;
    let found = Polygon::new(far.to_vec())?.area_properties().polar;
    let error = (found / expected - 1.0).abs();
    let mut finding = Finding::at_most(
        1e-13,
        error,
        "relative",
        "inertia above 0, error at most 1e-13",
    );
    finding.passed &= found > 0.0;
    Ok(finding)
}

/// Case 5: collinear points are refused by name, near-collinear fans get the exact answer.
pub(super) fn collinear() -> Result<Finding, Failure> {
    let line = [(0.0, 0.0), (10.0, 10.0), (5.0, 5.0), (3.0, 3.0)];
    let refused = Polygon::new(line.map(|(x, y)| vec2(x, y)).to_vec());
    // A fan over a shallow parabola: the area under y = d x (n − x) has a closed form.
    let (n, d) = (100_u32, 1e-9);
    let arc = |k: u32| vec2(f64::from(k), -d * f64::from(k) * f64::from(n - k));
    let fan: Vec<Vec2> = (0..=n).map(arc).collect();
    let found = Polygon::new(fan)?.area_properties().area;
    let count = f64::from(n);
    let expected = d * (count * count * count - count) / 6.0;
    let error = (found / expected - 1.0).abs();
    let measured = match &refused {
        Ok(_) => "a line was accepted".to_owned(),
        Err(_) => format!("line refused; fan's area off by {error:.1e} relative"),
    };
    Ok(Finding {
        passed: refused.is_err() && error <= 1e-12,
        measured,
        wanted: "line refused, area within 1e-12",
    })
}

/// Case 7: a polygon around its origin, run through both ways.
pub(super) fn windings() -> Result<Finding, Failure> {
    let mut points: Vec<Vec2> = [(-1.0, -0.5), (0.5, -1.0), (1.5, 0.25), (0.25, 1.0)]
        .map(|(x, y)| vec2(x, y))
        .to_vec();
    let forwards = Polygon::new(points.clone())?.area_properties().area;
    points.reverse();
    let backwards = Polygon::new(points)?.area_properties().area;
    Ok(Finding {
        passed: forwards > 0.0 && backwards > 0.0 && (forwards - backwards).abs() <= 1e-15,
        measured: format!("{forwards} and {backwards} m²"),
        wanted: "the same area above 0 for both",
    })
}

/// Case 29: the pieces of an outline add to its area, and every one is convex.
pub(super) fn pieces() -> Result<Finding, Failure> {
    let mut worst = 0.0_f64;
    let mut concave = 0;
    let circles = (3..=64)
        .chain([100, 240, 256, 333, 500, 777, 1000])
        .map(circle);
    let slivers = [1e-3, 1e-6, 1e-9].map(|width| sliver(width, 40));
    for points in circles.chain(slivers) {
        let polygon = Polygon::new(points)?;
        let whole = polygon.area_properties().area;
        let mut sum = 0.0;
        for piece in polygon.pieces() {
            sum += ring_properties(piece.vertices())?.area;
            concave += usize::from(!is_convex(piece));
        }
        worst = worst.max((sum / whole - 1.0).abs());
    }
    Ok(Finding {
        passed: worst <= 1e-13 && concave == 0,
        measured: format!("areas off by {worst:.1e} relative, {concave} concave pieces"),
        wanted: "within 1e-13, all convex",
    })
}

fn circle(corners: u32) -> Vec<Vec2> {
    let turn = 360.0 / f64::from(corners);
    (0..corners)
        .map(|k| Rot::from_degrees(turn * f64::from(k)).x_axis())
        .collect()
}

/// A zigzag band of the given width: concave at every second corner.
fn sliver(width: f64, corners: u32) -> Vec<Vec2> {
    let zigzag = |k: u32| vec2(f64::from(k), if k.is_multiple_of(2) { 0.0 } else { 0.5 });
    let below = (0..corners).map(zigzag);
    let above = (0..corners).rev().map(|k| zigzag(k) + vec2(0.0, width));
    below.chain(above).collect()
}

fn is_convex(piece: &ConvexPiece) -> bool {
    let vertices = piece.vertices();
    let corner = |k: usize| vertices[k % vertices.len()];
    (0..vertices.len()).all(|k| orient2d(corner(k), corner(k + 1), corner(k + 2)) > 0.0)
}
