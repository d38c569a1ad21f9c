//! Which parts of a canvas are to be painted again.

use crate::painter::BAND;
use crate::{PixelBox, Size};

/// Width of a tile, in pixels; it is as high as a band.
const WIDE: u32 = 32;

/// Tiles of a canvas, some of them marked.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tiles {
    size: Option<Size>,
    columns: usize,
    marked: Vec<bool>,
    count: usize,
}

impl Tiles {
    /// All tiles of a canvas, none of them marked.
    pub(crate) fn start(&mut self, size: Size) {
        self.size = Some(size);
        self.columns = size.width().div_ceil(WIDE) as usize;
        self.count = 0;
        self.marked.clear();
        self.marked
            .resize(self.columns * size.height().div_ceil(BAND) as usize, false);
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether so many are marked that all might as well be.
    pub(crate) fn most(&self) -> bool {
        10 * self.count > 6 * self.marked.len()
    }

    /// Marks the tiles that a box touches.
    pub(crate) fn add(&mut self, pixels: PixelBox) {
        let (columns, rows) = spans(pixels);
        for row in rows {
            let at = row * self.columns;
            for tile in &mut self.marked[at + columns.start..at + columns.end] {
                self.count += usize::from(!*tile);
                *tile = true;
            }
        }
    }

    /// Marks what is marked in tiles of the same canvas.
    pub(crate) fn unite(&mut self, other: &Self) {
        for (tile, &too) in self.marked.iter_mut().zip(&other.marked) {
            self.count += usize::from(too && !*tile);
            *tile |= too;
        }
    }

    /// Whether a box touches a marked tile.
    pub(crate) fn touch(&self, pixels: PixelBox) -> bool {
        let (columns, mut rows) = spans(pixels);
        rows.any(|row| {
            let at = row * self.columns;
            self.marked[at + columns.start..at + columns.end].contains(&true)
        })
    }

    /// Hands over rectangles that together are the marked tiles of a box, each as wide as can be; at once if all are.
    pub(crate) fn each(&self, pixels: PixelBox, mut each: impl FnMut(PixelBox)) {
        let Some(size) = self.size.filter(|_| !pixels.is_empty() && self.count > 0) else {
            return;
        };
        let (columns, rows) = spans(pixels);
        let line = |row: usize| {
            let at = row * self.columns;
            &self.marked[at + columns.start..at + columns.end]
        };
        let mut row = rows.start;
        while row < rows.end {
            // Rows of tiles that are marked alike are taken together.
            let first = row;
            row += 1;
            while row < rows.end && line(row) == line(first) {
                row += 1;
            }
            let mut column = 0;
            let marked = line(first);
            while column < marked.len() {
                let run = marked[column..].iter().take_while(|&&tile| tile).count();
                if run > 0 {
                    let from = columns.start + column;
                    each(pixels_of(from..from + run, first..row, size));
                }
                column += run.max(1);
            }
        }
    }

    /// Whether each row of tiles has a marked one, and the box around all of them.
    pub(crate) fn bands(&self, bands: &mut Vec<bool>) -> Option<PixelBox> {
        let size = self.size?;
        bands.clear();
        let rows = self.marked.chunks_exact(self.columns);
        bands.extend(rows.map(|row| row.contains(&true)));
        let mut all = PixelBox::EMPTY;
        self.each(PixelBox::of(size), |run| all = all.united(run));
        (!all.is_empty()).then_some(all)
    }
}

/// Columns and rows of the tiles that a box touches.
fn spans(pixels: PixelBox) -> (core::ops::Range<usize>, core::ops::Range<usize>) {
    if pixels.is_empty() {
        return (0..0, 0..0);
    }
    let columns = (pixels.left / WIDE) as usize..pixels.right.div_ceil(WIDE) as usize;
    let rows = (pixels.top / BAND) as usize..pixels.bottom.div_ceil(BAND) as usize;
    (columns, rows)
}

/// Pixels of some columns and rows of tiles.
fn pixels_of(
    columns: core::ops::Range<usize>,
    rows: core::ops::Range<usize>,
    size: Size,
) -> PixelBox {
    let place = |tiles: usize, side: u32, most: u32| {
        u32::try_from(tiles).map_or(most, |tiles| most.min(tiles * side))
    };
    PixelBox {
        left: place(columns.start, WIDE, size.width()),
        top: place(rows.start, BAND, size.height()),
        right: place(columns.end, WIDE, size.width()),
        bottom: place(rows.end, BAND, size.height()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = PixelBox> {
        (0..200_u32, 0..100_u32, 0..90_u32, 0..50_u32).prop_map(|(left, top, wide, high)| {
            let whole = PixelBox {
                left,
                top,
                right: left + wide,
                bottom: top + high,
            };
            whole.common(PixelBox::of(size()))
        })
    }

    fn size() -> Size {
        Size::new(210, 105).unwrap()
    }

    proptest! {
        #[test]
        fn runs_are_the_marked_tiles_once_each(marked in prop::collection::vec(boxes(), 0..6), asked in boxes()) {
            let mut tiles = Tiles::default();
            tiles.start(size());
            for &one in &marked {
                tiles.add(one);
            }
            let mut painted = vec![0; size().pixels()];
            tiles.each(asked, |run| {
                for y in run.top..run.bottom {
                    for x in run.left..run.right {
                        painted[(y * 210 + x) as usize] += 1;
                    }
                }
            });
            prop_assert!(painted.iter().all(|&times| times <= 1));
            for &one in &marked {
                let both = one.common(asked);
                for y in both.top..both.bottom {
                    for x in both.left..both.right {
                        prop_assert_eq!(painted[(y * 210 + x) as usize], 1, "{}, {}", x, y);
                    }
                }
            }
            prop_assert_eq!(tiles.is_empty(), marked.iter().all(|one| one.is_empty()));
        }
    }
}
