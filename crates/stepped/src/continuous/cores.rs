//! Core polygons: shapes a little smaller than their bodies, which must not pass through anything.

use std::borrow::Cow;

use carom_collision::{Hull, hulls, shape_distance};
use carom_geometry::Shape;
use carom_math::Pose;

use crate::pieces::Piece;

/// The core lies so deep inside, as a part of the least half width: 2.5 mm in a box of 1 m, deeper than resting contacts.
const CORE: f64 = 0.005;

/// The same where that is met already: what was pressed in by a millimetre went 84 mm through a spinning ring. 0.05 alone does not
/// stop it there, 0.25 does, as both do; what is pressed in by less is stopped sooner by 0.05.
const DEEPER: [f64; 2] = [0.05, 0.25];

/// How much deeper a piece may go, in m, into what its core touches already: what a caller moves, by as much as its core lies inside; what
/// its rows hold, by as much as the deepest of all.
pub(super) fn depth(piece: &Piece, carried: bool) -> f64 {
    let part = if carried { CORE } else { DEEPER[1] };
    part * 0.5 * piece.extent
}

/// A convex part of the shape of a piece.
pub(super) struct Part<'p> {
    piece: &'p Piece,
    hull: Hull<'p>,
}

impl Part<'_> {
    /// The largest core that does not touch a shape at this pose of it, or the largest of all.
    pub(super) fn core(&self, target: &Shape, pose: Pose) -> Cow<'_, Shape> {
        let is_free = |core: &Shape| shape_distance(core, target, pose).distance > 0.0;
        let largest = self.inset(CORE);
        if is_free(&largest) {
            return largest;
        }
        let mut deeper = DEEPER.into_iter().map(|part| self.inset(part));
        let free = deeper.find(|core| is_free(core));
        free.unwrap_or(largest)
    }

    /// What cannot be shrunk, a segment, is all core.
    fn inset(&self, part: f64) -> Cow<'_, Shape> {
        let core = self.hull.inset(part * 0.5 * self.piece.extent);
        core.map_or_else(|| self.whole(), Cow::Owned)
    }

    pub(super) fn whole(&self) -> Cow<'_, Shape> {
        let shape = self.piece.shape();
        let single = hulls(shape).len() == 1;
        let whole = if single { None } else { self.hull.inset(0.0) };
        whole.map_or(Cow::Borrowed(shape), Cow::Owned)
    }
}

/// The convex parts of the shape of a piece.
pub(super) fn parts(piece: &Piece) -> impl Iterator<Item = Part<'_>> {
    hulls(piece.shape()).map(move |hull| Part { piece, hull })
}
