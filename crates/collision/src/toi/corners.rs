//! A polygon of at most eight corners as two registers of four edges: what is asked of its corners, without a branch.
//!
//! Where a minimum or maximum is looked for together with its place, the place is written into the last bits of
//! the number, so that one comparison finds both. What differs by less than 16 units in the last place is taken as equal.
//! Everything is inlined into the dispatched search, and no fused multiply-add is used: every width gives the same bits.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_geometry::{EdgeBlock, Shape};
use carom_math::{Rot, Vec2, vec2};
use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f64x4};

use crate::Hull;
use crate::lanes::{larger, smaller};

/// Bits of a number that hold a place.
const PLACE: u64 = 15;

/// The centre of a disc.
static POINT: EdgeBlock = EdgeBlock {
    x: [0.0; 4],
    y: [0.0; 4],
    normal_x: [0.0; 4],
    normal_y: [0.0; 4],
};

/// Corners and edges in two blocks, which are one where that is enough; or a disc about the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners<'a> {
    first: &'a EdgeBlock,
    last: &'a EdgeBlock,
    /// Corners before those of the last block.
    before: usize,
    /// How many there are; one of a disc.
    count: usize,
    /// 0 of a polygon.
    pub(super) radius: f64,
}

impl<'a> Corners<'a> {
    /// The polygon or disc that a hull is; none of a piece, of many corners, of what is grown, and of what is neither.
    #[inline(always)]
    pub(super) fn of(hull: &Hull<'a>) -> Option<Self> {
        let grown = hull.radius != 0.0 && !hull.is_disc();
        if grown || hull.boundary.is_some() {
            return None;
        }
        if hull.is_disc() {
            return (hull.vertices[0] == Vec2::ZERO).then(|| Self::of_disc(hull.radius));
        }
        Self::of_polygon(hull.blocks, hull.vertices.len())
    }

    /// The same of a shape.
    #[inline(always)]
    pub(super) fn of_shape(shape: &'a Shape) -> Option<Self> {
        match shape {
            Shape::Convex(polygon) => Self::of_polygon(polygon.blocks(), polygon.vertices().len()),
            Shape::Circle(disc) if disc.centre() == Vec2::ZERO => {
                Some(Self::of_disc(disc.radius()))
            }
            _ => None,
        }
    }

    #[inline(always)]
    const fn of_polygon(blocks: &'a [EdgeBlock], count: usize) -> Option<Self> {
        let (first, last, before) = match blocks {
            [one] => (one, one, 0),
            [one, two] => (one, two, 4),
            _ => return None,
        };
        Some(Self {
            first,
            last,
            before,
            count,
            radius: 0.0,
        })
    }

    /// A disc about the origin.
    #[inline(always)]
    const fn of_disc(radius: f64) -> Self {
        Self {
            first: &POINT,
            last: &POINT,
            before: 0,
            count: 1,
            radius,
        }
    }

    /// Whether it is a disc.
    #[inline(always)]
    pub(super) const fn is_disc(&self) -> bool {
        self.count == 1
    }

    /// The corner at a place that was found: its number, below the count.
    #[inline(always)]
    const fn number(&self, place: u64) -> usize {
        let lane = (place % 4) as usize;
        let number = if place < 4 { lane } else { self.before + lane };
        if number < self.count {
            number
        } else {
            self.count - 1
        }
    }

    #[inline(always)]
    const fn block(&self, number: usize) -> &'a EdgeBlock {
        if number < 4 { self.first } else { self.last }
    }

    /// Corner by number.
    #[inline(always)]
    pub(super) const fn corner(&self, number: usize) -> Vec2 {
        let block = self.block(number);
        vec2(block.x[number % 4], block.y[number % 4])
    }

    /// Outward normal of the edge that begins at a corner.
    #[inline(always)]
    pub(super) const fn normal(&self, number: usize) -> Vec2 {
        let block = self.block(number);
        vec2(block.normal_x[number % 4], block.normal_y[number % 4])
    }

    /// Number of the corner after one.
    #[inline(always)]
    pub(super) const fn next(&self, number: usize) -> usize {
        if number + 1 == self.count {
            0
        } else {
            number + 1
        }
    }

    /// Largest distance of a corner from the origin, in m.
    #[inline(always)]
    pub(super) fn arm<S: Simd>(&self, simd: S) -> f64 {
        let first = squares(simd, self.first);
        let last = squares(simd, self.last);
        greatest(first.max(last)).sqrt()
    }

    /// The corner least far along a direction.
    #[inline(always)]
    pub(super) fn lowest<S: Simd>(&self, simd: S, direction: Vec2) -> usize {
        let first = placed(simd, along(simd, self.first, direction), 0);
        let last = placed(simd, along(simd, self.last, direction), 4);
        let low = least(first.min(last));
        self.number(low.to_bits() & PLACE)
    }

    /// How far along a direction the lowest of all corners but one is.
    #[inline(always)]
    pub(super) fn lowest_but<S: Simd>(&self, simd: S, direction: Vec2, but: Vec2) -> f64 {
        let first = along(simd, self.first, direction);
        let last = along(simd, self.last, direction);
        let (first, last) = self.without(simd, but, (first, last), f64::INFINITY);
        least(first.min(last))
    }

    /// The largest height of a point over the lines of all edges but that which begins at a corner.
    #[inline(always)]
    pub(super) fn highest_but<S: Simd>(&self, simd: S, point: Vec2, but: Vec2) -> f64 {
        let first = over(simd, self.first, point);
        let last = over(simd, self.last, point);
        let (first, last) = self.without(simd, but, (first, last), f64::NEG_INFINITY);
        greatest(first.max(last))
    }

    /// Numbers of all corners, with `none` for that of the corner at `but`.
    #[inline(always)]
    fn without<S: Simd>(
        &self,
        simd: S,
        but: Vec2,
        (first, last): (f64x4<S>, f64x4<S>),
        none: f64,
    ) -> (f64x4<S>, f64x4<S>) {
        let none = f64x4::splat(simd, none);
        (
            except(simd, self.first, but, first, none),
            except(simd, self.last, but, last, none),
        )
    }

    /// The edge with the line that a point is highest over.
    #[inline(always)]
    pub(super) fn highest<S: Simd>(&self, simd: S, point: Vec2) -> usize {
        let first = placed(simd, over(simd, self.first, point), 0);
        let last = placed(simd, over(simd, self.last, point), 4);
        let high = greatest(first.max(last));
        self.number(high.to_bits() & PLACE)
    }

    /// The largest over all edges of the height of the lower of two points.
    #[inline(always)]
    pub(super) fn highest_of<S: Simd>(&self, simd: S, p: Vec2, q: Vec2) -> f64 {
        let first = over(simd, self.first, p).min(over(simd, self.first, q));
        let last = over(simd, self.last, p).min(over(simd, self.last, q));
        greatest(first.max(last))
    }

    /// Which edge is farthest below `facing`, and how far (in m, to 16 units in the last place).
    ///
    /// `turn` and `offset` are the pose of `facing` in this frame.
    #[inline(always)]
    pub(super) fn widest<S: Simd>(
        &self,
        simd: S,
        facing: &Self,
        turn: Rot,
        offset: Vec2,
    ) -> (usize, f64) {
        let (x0, y0) = turned_back(simd, self.first, turn);
        let (x1, y1) = turned_back(simd, self.last, turn);
        let mut low0 = f64x4::splat(simd, f64::INFINITY);
        let mut low1 = low0;
        // n·(R q + d − p) = (R⁻¹ n)·q + n·(d − p)
        let mut block = facing.first;
        loop {
            // One after the other, since a loop over lanes stays one.
            (low0, low1) = lower::<S, 0>(simd, block, (x0, y0, low0), (x1, y1, low1));
            (low0, low1) = lower::<S, 1>(simd, block, (x0, y0, low0), (x1, y1, low1));
            (low0, low1) = lower::<S, 2>(simd, block, (x0, y0, low0), (x1, y1, low1));
            (low0, low1) = lower::<S, 3>(simd, block, (x0, y0, low0), (x1, y1, low1));
            if core::ptr::eq(block, facing.last) {
                break;
            }
            block = facing.last;
        }
        let first = placed(simd, low0 + over(simd, self.first, offset), 0);
        let last = placed(simd, low1 + over(simd, self.last, offset), 4);
        let high = greatest(first.max(last));
        (self.number(high.to_bits() & PLACE), high)
    }
}

/// The least of four numbers.
#[inline(always)]
fn least<S: Simd>(four: f64x4<S>) -> f64 {
    let [a, b, c, d] = four.to_array();
    smaller(smaller(a, b), smaller(c, d))
}

/// The greatest of four numbers.
#[inline(always)]
fn greatest<S: Simd>(four: f64x4<S>) -> f64 {
    let [a, b, c, d] = four.to_array();
    larger(larger(a, b), larger(c, d))
}

#[inline(always)]
fn squares<S: Simd>(simd: S, block: &EdgeBlock) -> f64x4<S> {
    let x = f64x4::from_slice(simd, &block.x);
    let y = f64x4::from_slice(simd, &block.y);
    x * x + y * y
}

#[inline(always)]
fn along<S: Simd>(simd: S, block: &EdgeBlock, direction: Vec2) -> f64x4<S> {
    f64x4::from_slice(simd, &block.x) * f64x4::splat(simd, direction.x)
        + f64x4::from_slice(simd, &block.y) * f64x4::splat(simd, direction.y)
}

/// How far a point is over the lines of four edges.
#[inline(always)]
fn over<S: Simd>(simd: S, block: &EdgeBlock, p: Vec2) -> f64x4<S> {
    let x = f64x4::splat(simd, p.x) - f64x4::from_slice(simd, &block.x);
    let y = f64x4::splat(simd, p.y) - f64x4::from_slice(simd, &block.y);
    f64x4::from_slice(simd, &block.normal_x) * x + f64x4::from_slice(simd, &block.normal_y) * y
}

/// Normals of four edges in a frame that is turned.
#[inline(always)]
fn turned_back<S: Simd>(simd: S, block: &EdgeBlock, turn: Rot) -> (f64x4<S>, f64x4<S>) {
    let (cos, sin) = (
        f64x4::splat(simd, turn.cos()),
        f64x4::splat(simd, turn.sin()),
    );
    let x = f64x4::from_slice(simd, &block.normal_x);
    let y = f64x4::from_slice(simd, &block.normal_y);
    (cos * x + sin * y, cos * y - sin * x)
}

/// The least height of a corner over the lines of eight edges, with one corner more.
#[inline(always)]
fn lower<S: Simd, const LANE: usize>(
    simd: S,
    block: &EdgeBlock,
    (x0, y0, low0): (f64x4<S>, f64x4<S>, f64x4<S>),
    (x1, y1, low1): (f64x4<S>, f64x4<S>, f64x4<S>),
) -> (f64x4<S>, f64x4<S>) {
    let x = f64x4::splat(simd, block.x[LANE]);
    let y = f64x4::splat(simd, block.y[LANE]);
    (low0.min(x0 * x + y0 * y), low1.min(x1 * x + y1 * y))
}

/// Four numbers, each with its place from `from` on in its last bits.
#[inline(always)]
fn placed<S: Simd>(simd: S, four: f64x4<S>, from: u64) -> f64x4<S> {
    let clear = fearless_simd::u64x4::splat(simd, !PLACE);
    let places = fearless_simd::u64x4::load_array(simd, [from, from + 1, from + 2, from + 3]);
    f64x4::from_bits(four.to_bits() & clear | places)
}

/// Four numbers, without that of the corner at `but`.
#[inline(always)]
fn except<S: Simd>(
    simd: S,
    block: &EdgeBlock,
    but: Vec2,
    four: f64x4<S>,
    none: f64x4<S>,
) -> f64x4<S> {
    let x = f64x4::from_slice(simd, &block.x).simd_eq(f64x4::splat(simd, but.x));
    let y = f64x4::from_slice(simd, &block.y).simd_eq(f64x4::splat(simd, but.y));
    (x & y).select(none, four)
}
