//! Core polygons: shapes a little smaller than their bodies, which must not pass through anything.

use carom_collision::{hulls, shape_distance};
use carom_geometry::Shape;
use carom_math::Pose;

use crate::pieces::Piece;

/// The core lies so deep inside, as a part of the least half width: 2.5 mm in a box of 1 m, deeper than resting contacts.
const CORE: f64 = 0.005;

/// Where that is met already, so much deeper: what was pressed in by a millimetre may go through in the next sub-step.
const DEEPER: [f64; 3] = [1.0, 10.0, 50.0];

/// How deep inside a piece its core lies, in m.
pub(super) fn depth(piece: &Piece) -> f64 {
    CORE * 0.5 * piece.extent
}

/// A convex part of the shape of a piece, and its cores.
pub(super) struct Part {
    pub(super) whole: Shape,
    pub(super) cores: Vec<Shape>,
}

impl Part {
    /// The largest core that does not touch a shape at this pose of it, or the largest of all.
    pub(super) fn core(&self, target: &Shape, pose: Pose) -> &Shape {
        let mut cores = self.cores.iter();
        let free = cores.find(|core| shape_distance(core, target, pose).distance > 0.0);
        free.unwrap_or(&self.cores[0])
    }
}

/// The convex parts of the shape of a piece.
pub(super) fn parts(piece: &Piece) -> Vec<Part> {
    let shape = piece.shape();
    let single = hulls(shape).len() == 1;
    let parts = hulls(shape).map(|hull| {
        // What cannot be shrunk, a segment, is all core.
        let whole = if single { None } else { hull.inset(0.0) };
        let whole = whole.unwrap_or_else(|| shape.clone());
        let inset = |deep: f64| hull.inset(deep * depth(piece));
        let cores = DEEPER.map(|deep| inset(deep).unwrap_or_else(|| whole.clone()));
        Part {
            whole,
            cores: cores.into(),
        }
    });
    parts.collect()
}
