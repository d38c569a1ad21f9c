//! Cores of shapes: what must not pass through anything.

use carom_collision::{Hull, hulls};
use carom_geometry::{Circle, ConvexPolygon, Shape};
use carom_math::Vec2;

use crate::pieces::Piece;

/// The core lies so deep inside, as a part of the least half width: deeper than contacts of a pile sink in.
const CORE: f64 = 0.005;

/// The convex parts of the shape of a piece: core and whole of each.
pub(super) fn cores(piece: &Piece) -> Vec<(Shape, Shape)> {
    let shape = piece.shape();
    let single = hulls(shape).len() == 1;
    let parts = hulls(shape).map(|hull| {
        let within = |depth: f64| {
            if hull.normals.is_empty() {
                let smaller = Circle::at(hull.vertices[0], hull.radius - depth);
                return smaller.ok().map(Shape::from);
            }
            let corners = (0..hull.vertices.len()).map(|i| shrunk_corner(&hull, i, depth));
            let polygon = ConvexPolygon::new(corners.collect::<Vec<_>>());
            polygon.ok().map(Shape::from)
        };
        // What cannot be shrunk, a segment, is all core.
        let whole = if single { None } else { within(0.0) };
        let whole = whole.unwrap_or_else(|| shape.clone());
        let core = within(CORE * 0.5 * piece.extent).unwrap_or_else(|| whole.clone());
        (core, whole)
    });
    parts.collect()
}

/// A corner after both of its edges moved inwards by `depth`; a sharp tip by twice that at most.
fn shrunk_corner(hull: &Hull<'_>, i: usize, depth: f64) -> Vec2 {
    let before = if i == 0 { hull.normals.len() } else { i } - 1;
    let (m, n) = (hull.normals[before], hull.normals[i]);
    // p + w with w·m = w·n = −depth: w = −depth (m + n)/(1 + m·n).
    let way = (m + n) / (1.0 + m.dot(n)).max(0.5 * (m + n).length());
    hull.vertices[i] - way * depth
}
