//! Core polygons: shapes a little smaller than their bodies, which must not pass through anything.

use carom_collision::hulls;
use carom_geometry::Shape;

use crate::pieces::Piece;

/// The core lies so deep inside, as a part of the least half width: 2.5 mm in a box of 1 m, deeper than resting contacts.
const CORE: f64 = 0.005;

/// How deep inside a piece its core lies, in m.
pub(super) fn depth(piece: &Piece) -> f64 {
    CORE * 0.5 * piece.extent
}

/// The convex parts of the shape of a piece: core and whole of each.
pub(super) fn cores(piece: &Piece) -> Vec<(Shape, Shape)> {
    let shape = piece.shape();
    let single = hulls(shape).len() == 1;
    let parts = hulls(shape).map(|hull| {
        // What cannot be shrunk, a segment, is all core.
        let whole = if single { None } else { hull.inset(0.0) };
        let whole = whole.unwrap_or_else(|| shape.clone());
        let core = hull.inset(depth(piece)).unwrap_or_else(|| whole.clone());
        (core, whole)
    });
    parts.collect()
}
