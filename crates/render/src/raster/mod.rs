//! The crate's own scan converter: shapes to pixels by exact areas.
//!
//! A shape is drawn in strips of rows. Its edges add to the cells of a strip ([`cells`]); then every row is summed from
//! the left: pixel by pixel where coverage varies, at once in between. Pixels are the same whatever part of the
//! canvas is asked for, and on every processor: every sum has a fixed order.

mod cells;
mod outline;
mod shade;
mod stick;
#[cfg(test)]
mod tests;

use carom_math::Vec2;

use crate::PixelBox;
pub(crate) use cells::{Cells, greater, lesser};
pub(crate) use outline::{Outliner, is_convex, is_simple};
pub(crate) use shade::{Flat, Pixel, Radial, Shade, Textured};

/// Cells of a strip: 64 KiB.
const STRIP: usize = 16_384;

/// Pixels to paint on, row by row, and the part of them that may change.
#[derive(Debug)]
pub(crate) struct Canvas<'a> {
    pub(crate) pixels: &'a mut [Pixel],
    pub(crate) width: usize,
    pub(crate) clip: PixelBox,
}

/// Columns and rows in which a shape is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Column of the canvas at which the shape's own columns begin; −1 at least.
    left: i32,
    columns: usize,
    top: usize,
    bottom: usize,
    /// Columns of the shape that may change.
    first: usize,
    end: usize,
}

impl Place {
    /// Of a shape between two corners; `None` if nothing of it can be seen.
    ///
    /// Columns depend on the shape and the canvas, rows also on the clip.
    #[inline]
    pub(crate) fn new(canvas: &Canvas<'_>, min: Vec2, max: Vec2) -> Option<Self> {
        let clip = canvas.clip;
        let [top, bottom] = [clip.top, clip.bottom].map(f64::from);
        // Written so that a NaN is nowhere.
        let seen = max.x > f64::from(clip.left)
            && min.x < f64::from(clip.right)
            && max.y > top
            && min.y < bottom;
        if !seen {
            return None;
        }
        let width = i32::try_from(canvas.width).ok()?;
        let left = if min.x > 0.0 {
            whole(min.x)
        } else {
            -i32::from(min.x < 0.0)
        };
        let right = if max.x < f64::from(width) {
            ceil(max.x)
        } else {
            width + 1
        };
        let top = if min.y > top {
            whole(min.y)
        } else {
            clip.top.cast_signed()
        };
        let bottom = if max.y < bottom {
            ceil(max.y)
        } else {
            clip.bottom.cast_signed()
        };
        let column = |x: u32| usize::try_from(x.cast_signed() - left).unwrap_or(0);
        let columns = usize::try_from(right - left).ok()?;
        Some(Self {
            left,
            columns,
            top: usize::try_from(top).ok()?,
            bottom: usize::try_from(bottom).ok()?,
            first: column(clip.left),
            end: columns.min(column(clip.right)),
        })
    }

    /// Column of the canvas from which the shape's own x are counted.
    #[inline]
    pub(crate) fn left(&self) -> f64 {
        f64::from(self.left)
    }

    /// The largest x, counted so, that edges may have.
    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "at most 16386")]
    pub(crate) const fn limit(&self) -> f64 {
        self.columns as f64
    }
}

/// Memory of the scan converter, used from shape to shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Raster {
    cells: Cells,
}

impl Raster {
    /// Paints the shape at a place; `edges` adds its edges.
    #[inline]
    pub(crate) fn draw(
        &mut self,
        canvas: &mut Canvas<'_>,
        place: Place,
        edges: impl Fn(&mut Cells),
        shade: &mut impl Shade,
    ) {
        let mut top = place.top;
        // No division for what is small.
        let rows = if (place.bottom - top) * place.columns <= STRIP {
            place.bottom - top
        } else {
            (STRIP / place.columns).max(1)
        };
        while top < place.bottom {
            let bottom = place.bottom.min(top + rows);
            self.cells.start(place.columns, top, bottom);
            edges(&mut self.cells);
            for row in top..bottom {
                let line = &mut canvas.pixels[row * canvas.width..(row + 1) * canvas.width];
                sweep(&mut self.cells, row, place, line, shade);
            }
            top = bottom;
        }
    }
}

/// Sums a row up and paints it.
#[inline]
fn sweep(cells: &mut Cells, row: usize, place: Place, line: &mut [Pixel], shade: &mut impl Shade) {
    let Some((begin, end)) = cells.reach(row) else {
        return;
    };
    let Place {
        first, end: last, ..
    } = place;
    let (begin, end) = (begin.max(first), end.min(last));
    if begin < end {
        shade.row(row, begin, end);
    }
    // Where column `first` lies on the canvas.
    let shift = first.saturating_add_signed(place.left as isize);
    let line = &mut line[shift..shift + (last - first)];
    let mut sum = 0.0_f32;
    let mut done = 0;
    cells.take(row, |start, sums| {
        let from = done.max(first);
        if start > from && from < last {
            let coverage = quantised(sum);
            if coverage > 0 {
                let to = start.min(last);
                shade.span(&mut line[from - first..to - first], from, coverage);
            }
        }
        done = start + sums.len();
        let cut = |column: usize| column.clamp(start, done) - start;
        let (before, after) = (cut(first), cut(last));
        for cell in &mut sums[..before] {
            sum += *cell;
            *cell = 0.0;
        }
        if before < after {
            let column = start + before;
            let pixels = &mut line[column - first..start + after - first];
            let seen = sums[before..after].iter_mut().zip(pixels);
            for (column, (cell, pixel)) in (column..).zip(seen) {
                sum += *cell;
                *cell = 0.0;
                // What is not covered comes out as it was: cheaper than to ask.
                shade.pixel(pixel, column, quantised(sum));
            }
        }
        for cell in &mut sums[after..] {
            sum += *cell;
            *cell = 0.0;
        }
    });
}

/// Coverage in 256ths, rounded to the nearest; what is covered twice is covered.
#[inline]
fn quantised(sum: f32) -> u32 {
    /// Added to a number below 2^22 it leaves its nearest integer in the lowest bits.
    const ROUND: f32 = 8_388_608.0;
    let sum = sum.abs();
    let sum = if sum < 1.0 { sum } else { 1.0 };
    (sum * 256.0 + ROUND).to_bits() & 0x1FF
}

/// The whole part of a number between 0 and 16384.
#[expect(clippy::cast_possible_truncation, reason = "at most 16384")]
#[inline]
const fn whole(x: f64) -> i32 {
    x as i32
}

#[inline]
fn ceil(x: f64) -> i32 {
    let whole = whole(x);
    whole + i32::from(f64::from(whole) < x)
}
