//! What two lists of marks do not have in common.

use core::ops::Range;

use crate::tiles::Tiles;
use crate::{Frame, Mark, PixelBox, Style};

/// How far ahead a body is sought that is missing in the other list.
const AHEAD: usize = 64;

/// Marks looked at between two looks at how much is marked.
const OFTEN: usize = 64;

/// Marks the tiles that differ between marks of two frames of one size; whether the lists are the same.
///
/// Equal marks are paired in order; what finds no partner is marked where it was and where it is. Elsewhere both lists
/// have the same marks in the same order, and so the same pixels, however well the pairs were found. Once most tiles
/// are marked, all are.
pub(crate) fn mark(
    (old, olds): (&Frame, Range<usize>),
    (new, news): (&Frame, Range<usize>),
    style: &Style,
    tiles: &mut Tiles,
) -> bool {
    let size = new.size();
    let mut same = olds.len() == news.len();
    let (mut i, mut j) = (olds.start, news.start);
    let mut looks = 0;
    while i < olds.end && j < news.end {
        looks += 1;
        if looks % OFTEN == 0 && tiles.most() {
            tiles.add(PixelBox::of(size));
            return false;
        }
        let mut changed = |mark: Mark<'_>| tiles.add(mark.pixels(style, size));
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
    for mark in (i..olds.end)
        .map(|k| old.mark(k))
        .chain((j..news.end).map(|k| new.mark(k)))
    {
        tiles.add(mark.pixels(style, size));
    }
    same
}
