//! What two lists of marks do not have in common.

use core::ops::Range;

use crate::tiles::Tiles;
use crate::{Frame, Mark, PixelBox, Style};

/// How far ahead a body is sought that is missing in the other list.
const AHEAD: usize = 64;

/// Marks looked at between two looks at how much is marked.
const OFTEN: usize = 64;

/// What a comparison found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    /// Marks of the new list that are not as those in their places of the old one.
    places: Vec<usize>,
    /// Whether marks stand in other places than they did, or were not all looked at.
    shifted: bool,
    /// How many first marks both lists are known to have in common.
    pub(crate) common: usize,
}

impl Found {
    /// Begins with lists that are known to have their first `common` marks in common.
    pub(crate) fn start(&mut self, common: usize) {
        self.common = common;
        self.places.clear();
        self.shifted = false;
    }

    /// Whether both lists are the same.
    pub(crate) const fn is_same(&self) -> bool {
        self.places.is_empty() && !self.shifted
    }

    /// Makes the old frame a copy of the new one.
    pub(crate) fn renew(&self, old: &mut Frame, new: &Frame) {
        if self.shifted {
            old.copy(new, self.common);
        } else {
            for &place in &self.places {
                old.copy_mark(place, new);
            }
        }
        old.stand_as(new);
    }
}

/// Marks the tiles that differ between marks of two frames of one size, and adds to what was found.
///
/// Equal marks are paired in order; what finds no partner is marked where it was and where it is. Elsewhere both lists
/// have the same marks in the same order, and so the same pixels, however well the pairs were found. Once most tiles
/// are marked, all are.
pub(crate) fn mark(
    (old, olds): (&Frame, Range<usize>),
    (new, news): (&Frame, Range<usize>),
    style: &Style,
    tiles: &mut Tiles,
    found: &mut Found,
) {
    let size = new.size();
    found.shifted |= olds != news;
    // What stands is passed over.
    let known = |range: &Range<usize>| range.start.max(found.common.min(range.end));
    let (mut i, mut j) = (known(&olds), known(&news));
    let mut looks = 0;
    while i < olds.end && j < news.end {
        looks += 1;
        if looks % OFTEN == 0 && tiles.most() {
            tiles.add(PixelBox::of(size));
            found.shifted = true;
            return;
        }
        let mut changed = |mark: Mark<'_>| tiles.add(mark.pixels(style, size));
        let (a, b) = (old.mark(i), new.mark(j));
        if a.op == b.op {
            // The source does not change the appearance.
            if a.source != b.source {
                found.places.push(j);
            }
            (i, j) = (i + 1, j + 1);
            continue;
        }
        found.places.push(j);
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
        found.shifted |= gone != come;
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
}
