//! Core polygons: shapes a little smaller than their bodies, which must not pass through anything.

use carom_collision::{Hull, hulls, shape_distance};
use carom_geometry::Shape;
use carom_math::Pose;

use crate::pieces::Piece;

/// The core lies so deep inside, as a part of the least half width: 2.5 mm in a box of 1 m, deeper than resting contacts.
const CORE: f64 = 0.005;

/// Where that is met already, so much deeper: what was pressed in by a millimetre may go through in the next sub-step.
const DEEPER: [f64; 2] = [10.0, 50.0];

/// How deep inside a piece its core lies, in m.
pub(super) fn depth(piece: &Piece) -> f64 {
    CORE * 0.5 * piece.extent
}

/// A convex part of the shape of a piece.
pub(super) struct Part<'p> {
    hull: Hull<'p>,
    depth: f64,
    pub(super) whole: Shape,
}

impl Part<'_> {
    /// The largest core that does not touch a shape at this pose of it, or the largest of all.
    pub(super) fn core(&self, target: &Shape, pose: Pose) -> Shape {
        let largest = self.inset(1.0);
        if is_free(&largest, target, pose) {
            return largest;
        }
        let mut deeper = DEEPER.into_iter().map(|deep| self.inset(deep));
        let free = deeper.find(|core| is_free(core, target, pose));
        free.unwrap_or(largest)
    }

    /// What cannot be shrunk, a segment, is all core.
    fn inset(&self, deep: f64) -> Shape {
        let core = self.hull.inset(deep * self.depth);
        core.unwrap_or_else(|| self.whole.clone())
    }
}

fn is_free(core: &Shape, target: &Shape, pose: Pose) -> bool {
    shape_distance(core, target, pose).distance > 0.0
}

/// The convex parts of the shape of a piece.
pub(super) fn parts(piece: &Piece) -> impl Iterator<Item = Part<'_>> {
    let shape = piece.shape();
    let single = hulls(shape).len() == 1;
    hulls(shape).map(move |hull| {
        let whole = if single { None } else { hull.inset(0.0) };
        Part {
            whole: whole.unwrap_or_else(|| shape.clone()),
            depth: depth(piece),
            hull,
        }
    })
}
