//! What two lists of marks do not have in common.

use core::ops::Range;

use crate::tiles::Tiles;
use crate::{Frame, Mark, Style};

/// How far ahead a body is sought that is missing in the other list.
const AHEAD: usize = 64;

/// Marks the tiles that differ between marks of two frames of one size; whether the lists are the same.
///
/// Equal marks are paired in order; what finds no partner is marked where it was and where it is. Elsewhere both lists
/// have the same marks in the same order, and so the same pixels, however well the pairs were found.
pub(crate) fn mark(
    (old, olds): (&Frame, Range<usize>),
    (new, news): (&Frame, Range<usize>),
    style: &Style,
    tiles: &mut Tiles,
) -> bool {
    let size = new.size();
    let mut same = olds.len() == news.len();
    let mut changed = |mark: Mark<'_>| tiles.add(mark.pixels(style, size));
    let (mut i, mut j) = (olds.start, news.start);
    while i < olds.end && j < news.end {
        let (a, b) = (old.mark(i), new.mark(j));
        if a.op == b.op {
            // Who moves is no matter of looks.
            same &= a.source == b.source;
            (i, j) = (i + 1, j + 1);
            continue;
        }
        same = false;
        let (gone, come) = if a.source.body == b.source.body {
            (1, 1)
        } else {
            let seek = |frame: &Frame, range: Range<usize>, mark: Mark<'_>| {
                let end = range.end.min(range.start + AHEAD);
                (range.start..end).position(|k| frame.mark(k).source.body == mark.source.body)
            };
            match (seek(new, j..news.end, a), seek(old, i..olds.end, b)) {
                (Some(come), _) => (0, come),
                (None, Some(gone)) => (gone, 0),
                (None, None) => (1, 1),
            }
        };
        for k in i..i + gone {
            changed(old.mark(k));
        }
        for k in j..j + come {
            changed(new.mark(k));
        }
        (i, j) = (i + gone, j + come);
    }
    for k in i..olds.end {
        changed(old.mark(k));
    }
    for k in j..news.end {
        changed(new.mark(k));
    }
    same
}
