//! Exact areas: how much of every pixel of a row lies to the right of an edge.
//!
//! A cell holds by how much the covered part of its pixel exceeds that of the pixel to its left, so the running sum
//! along a row is the coverage. An edge that runs down through a row by dy at a mean distance m from the left side of
//! one pixel covers dy (1 − m) of that pixel and dy of every pixel after it: it adds dy (1 − m) to its cell
//! and dy m to the next. An edge that runs up takes as much away. Sums of areas are exact, whatever the order of edges
//! (Levien's font-rs and `stb_truetype` have it the same way). On an arc, the area between the arc and its chord is added.

use carom_math::Vec2;

/// Up to this many cells a row is summed from its first edge to its last, without a list of what lies between.
const SHORT: usize = 24;

/// Where the edges of a row begin and end.
type Hull = (u32, u32);

/// Stretches of a row that edges touch, kept apart so that what lies between is filled at once.
#[derive(Clone, Copy, Debug, Default)]
struct Touched {
    count: usize,
    stretches: [(u32, u32); Self::MOST],
}

impl Touched {
    const MOST: usize = 4;

    #[expect(clippy::cast_possible_truncation, reason = "at most 16390")]
    fn push(&mut self, first: usize, end: usize) {
        let (mut first, mut end) = (first as u32, end as u32);
        // One that overlaps the new one grows by it; a full list joins all to one, which is slower and as exact.
        let full = self.count == Self::MOST;
        let mut kept = 0;
        for i in 0..self.count {
            let (a, b) = self.stretches[i];
            if full || (a <= end && first <= b) {
                first = first.min(a);
                end = end.max(b);
            } else {
                self.stretches[kept] = (a, b);
                kept += 1;
            }
        }
        // Sorted by place: few, so by insertion.
        let mut at = kept;
        while at > 0 && self.stretches[at - 1].0 > first {
            self.stretches[at] = self.stretches[at - 1];
            at -= 1;
        }
        self.stretches[at] = (first, end);
        self.count = kept + 1;
    }
}

/// Some rows of a shape: what its edges add to their pixels.
///
/// Columns count from the shape's own left side, rows from the top of the canvas: a row comes out the same
/// whichever rows it is drawn with.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    sums: Vec<f32>,
    hulls: Vec<Hull>,
    touched: Vec<Touched>,
    /// Cells a row.
    stride: usize,
    top: usize,
    bottom: usize,
    short: bool,
}

impl Cells {
    /// Rows `top..bottom` of a shape `columns` wide. Cells are zero on entry; reading a row resets it.
    pub(crate) fn start(&mut self, columns: usize, top: usize, bottom: usize) {
        self.stride = columns + 2;
        self.short = self.stride <= SHORT;
        self.top = top;
        self.bottom = bottom;
        let rows = bottom - top;
        if self.sums.len() < rows * self.stride {
            self.sums.resize(rows * self.stride, 0.0);
        }
        self.hulls.clear();
        self.hulls.resize(rows, (u32::MAX, 0));
        if !self.short {
            self.touched.clear();
            self.touched.resize(rows, Touched::default());
        }
    }

    /// Hands over the stretches of a row where coverage varies, from the left, with their sums, which are to be made zero.
    #[inline]
    pub(crate) fn take(&mut self, row: usize, mut each: impl FnMut(usize, &mut [f32])) {
        let row = row - self.top;
        let sums = &mut self.sums[row * self.stride..(row + 1) * self.stride];
        if self.short {
            let (first, end) = self.hulls[row];
            each(first as usize, &mut sums[first as usize..end as usize]);
            return;
        }
        let touched = &self.touched[row];
        for &(first, end) in &touched.stretches[..touched.count] {
            each(first as usize, &mut sums[first as usize..end as usize]);
        }
    }

    /// Where the first stretch of a row begins and the last one ends; `None` if no edge touches it.
    #[inline]
    pub(crate) fn reach(&self, row: usize) -> Option<(usize, usize)> {
        let (first, end) = self.hulls[row - self.top];
        (first < end).then_some((first as usize, end as usize))
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "at most 16390")]
    fn touch(&mut self, row: usize, first: usize, end: usize) {
        let hull = &mut self.hulls[row - self.top];
        *hull = (hull.0.min(first as u32), hull.1.max(end as u32));
        if !self.short {
            self.touched[row - self.top].push(first, end);
        }
    }

    /// An edge from `a` to `b`; x from the left side of the shape, y from the top of the canvas.
    #[inline]
    pub(crate) fn line(&mut self, a: Vec2, b: Vec2) {
        let (sign, a, b) = if a.y < b.y { (1.0, a, b) } else { (-1.0, b, a) };
        let mut y = greater(a.y, number(self.top));
        let end = lesser(b.y, number(self.bottom));
        if y >= end {
            return;
        }
        let slope = (b.x - a.x) / (b.y - a.y);
        let (low, high) = if a.x < b.x { (a.x, b.x) } else { (b.x, a.x) };
        // From the upper end each time, so that a row does not depend on where the walk began.
        let at = |y: f64| lesser(greater(a.x + (y - a.y) * slope, low), high);
        let mut row = floor(y);
        let mut below = number(row);
        let mut x = at(y);
        while y < end {
            below += 1.0;
            let next_y = lesser(below, end);
            let next = at(next_y);
            self.edge(row, x, next, sign * (next_y - y));
            (x, y) = (next, next_y);
            row += 1;
        }
    }

    /// An edge from x to `next` within one row, down by `dy` (up if negative).
    #[inline]
    fn edge(&mut self, row: usize, x: f64, next: f64, dy: f64) {
        let (x0, x1) = if x < next { (x, next) } else { (next, x) };
        let (first, last) = (whole(x0), whole(x1));
        let at = (row - self.top) * self.stride;
        let sums = &mut self.sums[at..at + self.stride];
        let sums = &mut sums[first..last + 2];
        if let [one, two] = sums {
            let middle = 0.5 * (x0 + x1) - number(first);
            *one += small(dy - dy * middle);
            *two += small(dy * middle);
        } else if let [one, between @ .., last_but_one, end] = sums {
            // Height per pixel of width; then the coverage of each pixel less that of the one before.
            let per = dy / (x1 - x0);
            let into = number(first + 1) - x0;
            let over = x1 - number(last);
            let (begin, rest) = (0.5 * per * into * into, 0.5 * per * over * over);
            *one += small(begin);
            *end += small(rest);
            if let [two, between @ ..] = between {
                *two += small(per * (into + 0.5) - begin);
                for sum in &mut *between {
                    *sum += small(per);
                }
                let before = per * (into + number(between.len()) + 0.5);
                *last_but_one += small(dy - rest - before);
            } else {
                *last_but_one += small(dy - rest - begin);
            }
        }
        self.touch(row, first, last + 2);
    }

    /// A whole circle, around from inside (`sign` 1) or from outside (−1), of which columns `0..=limit` are kept.
    pub(crate) fn circle(&mut self, centre: Vec2, radius: f64, sign: f64, limit: f64) {
        let circle = Circle::new(centre, radius, sign, limit);
        let mut y = greater(centre.y - radius, number(self.top));
        let end = lesser(centre.y + radius, number(self.bottom));
        if y >= end {
            return;
        }
        let mut row = floor(y);
        let mut half = circle.half(y - centre.y);
        while y < end {
            let below = lesser(number(row + 1), end);
            // Both sides turn around at the height of the centre.
            if y < centre.y && centre.y < below {
                self.arcs(&circle, row, (y, half), (centre.y, radius));
                y = centre.y;
                half = radius;
            }
            let next = circle.half(below - centre.y);
            self.arcs(&circle, row, (y, half), (below, next));
            (y, half) = (below, next);
            row += 1;
        }
    }

    /// The left (`side` −1) or right (1) side of a circle between two of its heights.
    pub(super) fn rim(&mut self, circle: &Circle, side: f64, from: f64, to: f64) {
        let centre = circle.centre;
        let mut y = greater(from, number(self.top));
        let end = lesser(to, number(self.bottom));
        if y >= end {
            return;
        }
        let at = |y: f64| Vec2::new(centre.x + side * circle.half(y - centre.y), y);
        let mut row = floor(y);
        while y < end {
            let below = lesser(number(row + 1), end);
            // It turns around at the height of the centre.
            if y < centre.y && centre.y < below {
                self.arc(circle, row, -side, at(y), at(centre.y));
                y = centre.y;
            }
            self.arc(circle, row, -side, at(y), at(below));
            y = below;
            row += 1;
        }
    }

    /// Left and right arc of a circle between two heights of one row, given with half the chord there.
    fn arcs(&mut self, circle: &Circle, row: usize, upper: (f64, f64), lower: (f64, f64)) {
        for side in [-1.0, 1.0] {
            let a = Vec2::new(circle.centre.x + side * upper.1, upper.0);
            let b = Vec2::new(circle.centre.x + side * lower.1, lower.0);
            self.arc(circle, row, -side, a, b);
        }
    }

    /// An arc of one row between `a` and, below it, `b`, that turns left or right all the way; `down` is 1 on the
    /// left side of the circle.
    fn arc(&mut self, circle: &Circle, row: usize, down: f64, a: Vec2, b: Vec2) {
        let sign = down * circle.sign;
        let at = (row - self.top) * self.stride;
        let sums = &mut self.sums[at..at + self.stride];
        // From left to right; `dy` stays what it is when both ends are swapped.
        let ((mut p, q), turn) = if a.x <= b.x {
            ((a, b), 1.0)
        } else {
            ((b, a), -1.0)
        };
        let sign = sign * turn;
        let above = lesser(p.y, q.y) < circle.centre.y;
        if p.x < 0.0 {
            // What lies left of the canvas covers its first column.
            let on = if q.x > 0.0 {
                Vec2::new(0.0, circle.height(0.0, above, p.y, q.y))
            } else {
                q
            };
            sums[0] += small(sign * (on.y - p.y));
            p = on;
        }
        if p.x >= circle.limit {
            // Right of the canvas it takes nothing away: what is covered is so up to there.
            self.touch(row, whole(circle.limit), whole(circle.limit) + 1);
            return;
        }
        let first = whole(greater(p.x, 0.0));
        let last = whole(lesser(greater(q.x, 0.0), circle.limit));
        let mut column = first;
        loop {
            let next = if column >= last && q.x <= circle.limit {
                q
            } else {
                let x = number(column + 1);
                Vec2::new(x, circle.height(x, above, p.y, q.y))
            };
            let dy = sign * (next.y - p.y);
            let middle = 0.5 * (p.x + next.x) - number(column);
            let bulge = circle.sign * circle.segment((next - p).length_squared());
            sums[column] += small(dy - dy * middle + bulge);
            sums[column + 1] += small(dy * middle - bulge);
            p = next;
            if column >= last {
                break;
            }
            column += 1;
        }
        self.touch(row, first, last + 2);
    }
}

/// A circle of which some columns are kept.
pub(super) struct Circle {
    centre: Vec2,
    radius: f64,
    /// 1 / (12 r) and 1 / (4 r²).
    twelfth: f64,
    quarter: f64,
    sign: f64,
    limit: f64,
}

impl Circle {
    pub(super) fn new(centre: Vec2, radius: f64, sign: f64, limit: f64) -> Self {
        Self {
            centre,
            radius,
            twelfth: 1.0 / (12.0 * radius),
            quarter: 1.0 / (4.0 * radius * radius),
            sign,
            limit,
        }
    }

    /// Half the chord at a distance from the centre. As a product, which keeps its digits beside the rim.
    fn half(&self, away: f64) -> f64 {
        ((self.radius - away) * (self.radius + away))
            .max(0.0)
            .sqrt()
    }

    /// Where the upper or lower half crosses the column line x, between two heights.
    fn height(&self, x: f64, above: bool, from: f64, to: f64) -> f64 {
        let half = self.half(x - self.centre.x);
        let y = if above {
            self.centre.y - half
        } else {
            self.centre.y + half
        };
        let (low, high) = if from < to { (from, to) } else { (to, from) };
        lesser(greater(y, low), high)
    }

    /// Area between an arc and its chord, from the square of the chord c.
    ///
    /// With s = c / 2r it is r² (asin s − s √(1 − s²)) = c³ / 12r (1 + 3/10 s² + 9/56 s⁴ + …). Within a pixel and a
    /// quadrant s² ≤ 1/2; below r = 2 the series is followed to 1e-4 of the segment there, since four of them may lie in one
    /// pixel; from r = 2 on s² ≤ 1/8.
    #[inline]
    fn segment(&self, square: f64) -> f64 {
        let t = square * self.quarter;
        let series = if self.radius < 2.0 {
            let last = 0.056_791 + t * (0.045_117 + t * (0.036_965 + t * 0.031_008));
            1.0 + t * (0.3 + t * (0.160_714 + t * (0.104_167 + t * (0.074_574 + t * last))))
        } else {
            1.0 + t * (0.3 + t * 0.160_714)
        };
        // Seven digits of a fraction of a pixel are enough for the chord, and sooner there.
        square * f64::from(small(square).sqrt()) * self.twelfth * series
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 16390")]
const fn number(count: usize) -> f64 {
    count as f64
}

/// The whole part of a number that is not negative and at most 16390.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, at most 16390; by way of i32, which processors convert to"
)]
#[inline]
const fn floor(x: f64) -> usize {
    x as i32 as usize
}

/// The same; a whole number may count as the end of the pixel
/// before it.
///
/// By addition: a cast would look for what is not a number first.
#[inline]
const fn whole(x: f64) -> usize {
    /// 3 · 2^51: what is added to it is rounded to a whole number, in the lowest bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    ((x - 0.5 + ROUND).to_bits() & 0xFFFF) as usize
}

/// As one instruction: what is not a number never comes here.
#[inline]
pub(crate) const fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline]
pub(crate) const fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A part of a pixel, narrowed.
#[expect(clippy::cast_possible_truncation, reason = "right to 2^-24 of a pixel")]
const fn small(part: f64) -> f32 {
    part as f32
}
