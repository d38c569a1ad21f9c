//! Sort-and-sweep in strips: which boxes of movers overlap.
//!
//! A strip is as high as the highest of the usual boxes, so two boxes that overlap begin in the same strip or in
//! neighbouring ones. Within a strip boxes lie in order of their left ends. Boxes of unusual size (planks, walls that are
//! driven, bullets) are in no strip, and ask all strips that they cross. Everything here decides what is found at which
//! cost, and nothing what comes of it: pairs are sorted before they are used.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_geometry::Aabb;
use carom_math::vec2;
use fearless_simd::{Level, Simd, SimdBase, SimdMask, dispatch, f64x4};

use super::keys::{Key, ordered, rounded};

/// A box more than so many times the median is unusual. Less: many boxes ask one by one; more: strips so high that
/// everything in them is compared.
const UNUSUAL: f64 = 2.0;

/// Strips are so many times as high as the highest of the usual boxes, so that they stay while boxes grow: all keys change with them.
/// 1: what falls gets new strips in each tick.
const ROOM: f64 = 1.05;

/// Of boxes of unusual size, behind all strips: there is no order from below among them.
const NO_STRIP: u32 = u32::MAX;

/// Strips get lower once no usual box is this part as high.
const LOW: f64 = 0.8;

/// Boxes tested at once.
const LANES: usize = 4;

/// Boxes side by side, and as many more at the end as fill a register: these overlap nothing.
#[derive(Clone, Debug, Default)]
struct Boxes {
    left: Vec<f64>,
    right: Vec<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
}

/// All movers in order of their strips.
#[derive(Clone, Debug)]
pub(crate) struct Sweep {
    /// Instructions that the processor has: they change no bit.
    level: Level,
    keys: Vec<Key>,
    /// Where movers of unusual size begin, in order of their left ends.
    unusual: usize,
    /// Number of each strip that is not empty, and where it begins.
    strips: Vec<(u32, usize)>,
    /// In the order of the keys.
    boxes: Boxes,
    height: f64,
    /// How many movers were too high for the strips when these were made.
    too_high: usize,
    sizes: Vec<f64>,
}

impl Default for Sweep {
    fn default() -> Self {
        Self {
            level: Level::new(),
            keys: Vec::new(),
            unusual: 0,
            strips: Vec::new(),
            boxes: Boxes::default(),
            height: 0.0,
            too_high: 0,
            sizes: Vec::new(),
        }
    }
}

impl Sweep {
    /// Makes the order of these movers, each piece once, with boxes by piece.
    pub(crate) fn sort(&mut self, movers: impl Iterator<Item = u32> + Clone, boxes: &[Aabb]) {
        let size = |piece: u32| {
            let size = boxes[piece as usize].max - boxes[piece as usize].min;
            if size.x > size.y { size.x } else { size.y }
        };
        self.sizes.clear();
        self.sizes.extend(movers.clone().map(size));
        self.choose_height();
        self.keys.clear();
        for piece in movers {
            let corner = boxes[piece as usize].min;
            let strip = if size(piece) <= self.height {
                self.strip(corner.y)
            } else {
                NO_STRIP
            };
            self.keys.push(Key::new(strip, corner.x, piece));
        }
        self.keys.sort_unstable();
        self.unusual = self.keys.partition_point(|key| key.strip() < NO_STRIP);
        self.strips.clear();
        for (k, key) in self.keys[..self.unusual].iter().enumerate() {
            let strip = key.strip();
            if self.strips.last().is_none_or(|last| last.0 != strip) {
                self.strips.push((strip, k));
            }
        }
        self.fill(boxes);
    }

    /// How high strips are for boxes of these sizes: as before, if the highest box that fits is nearly so high, no more boxes are higher,
    /// and half of them are not so low that it would be unusual.
    fn choose_height(&mut self) {
        let (mut highest, mut too_high, mut low) = (0.0_f64, 0, 0);
        let lowest = self.height / (ROOM * UNUSUAL);
        for size in &self.sizes {
            if *size <= self.height {
                highest = highest.max(*size);
            } else {
                too_high += 1;
            }
            low += usize::from(*size < lowest);
        }
        let stays =
            too_high <= self.too_high && highest > LOW * self.height && 2 * low <= self.sizes.len();
        if stays || self.sizes.is_empty() {
            return;
        }
        let middle = self.sizes.len() / 2;
        let mut sizes = self.sizes.clone();
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        let usual = UNUSUAL * *median;
        let usual = self.sizes.iter().filter(|size| **size <= usual);
        let highest = usual.fold(0.0, |most: f64, size| most.max(*size));
        self.height = (ROOM * highest).max(f64::MIN_POSITIVE);
        let too_high = self.sizes.iter().filter(|size| **size > self.height);
        self.too_high = too_high.count();
    }

    /// How many movers it knows.
    pub(crate) const fn len(&self) -> usize {
        self.keys.len()
    }

    /// Copies the boxes into the order of the keys.
    fn fill(&mut self, boxes: &[Aabb]) {
        let keys = &self.keys;
        let Boxes {
            left,
            right,
            low,
            high,
        } = &mut self.boxes;
        let last = Aabb::EMPTY;
        for (column, end) in [
            (&mut *left, last.min.x),
            (&mut *right, last.max.x),
            (&mut *low, last.min.y),
            (&mut *high, last.max.y),
        ] {
            column.truncate(keys.len());
            column.resize(keys.len() + LANES, end);
            column[keys.len()..].fill(end);
        }
        let columns = left.iter_mut().zip(right).zip(low.iter_mut().zip(high));
        for (key, ((left, right), (low, high))) in keys.iter().zip(columns) {
            let bounds = boxes[key.piece as usize];
            (*left, *right) = (bounds.min.x, bounds.max.x);
            (*low, *high) = (bounds.min.y, bounds.max.y);
        }
    }

    /// Number of the strip that holds a height; what is beyond all numbers is in the first or last one.
    fn strip(&self, y: f64) -> u32 {
        let strip = (y / self.height).floor() + f64::from(1u32 << 31);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates"
        )]
        let strip = strip as u32;
        strip
    }

    /// Finds all pairs with boxes that overlap.
    pub(crate) fn pairs(&self, mut found: impl FnMut(u32, u32)) {
        dispatch!(self.level, simd => self.all_pairs(simd, &mut found));
    }

    #[inline(always)]
    fn all_pairs<S: Simd>(&self, simd: S, found: &mut impl FnMut(u32, u32)) {
        for (n, &(strip, first)) in self.strips.iter().enumerate() {
            let end = self.end(n);
            // The next strip is swept by a second finger, which only goes forward.
            let next = self
                .strips
                .get(n + 1)
                .filter(|next| next.0 == strip.wrapping_add(1));
            let (mut finger, beyond) = next.map_or((0, 0), |next| (next.1, self.end(n + 1)));
            for k in first..end {
                let (piece, bounds) = (self.keys[k].piece, self.bounds(k));
                let mut tell = |other: u32| found(piece, other);
                self.forward(simd, k + 1, end, bounds, &mut tell);
                // In order with the keys, and no farther right than what rounding left of the box.
                let left = f64::from(rounded(bounds.min.x).next_down()) - self.height;
                while finger < beyond && self.boxes.left[finger] < left {
                    finger += 1;
                }
                self.forward(simd, finger, beyond, bounds, &mut tell);
            }
        }
        for k in self.unusual..self.len() {
            let (piece, bounds) = (self.keys[k].piece, self.bounds(k));
            let mut tell = |other: u32| found(piece, other);
            self.usual_in(simd, bounds, &mut tell);
            self.forward(simd, k + 1, self.len(), bounds, &mut tell);
        }
    }

    fn bounds(&self, k: usize) -> Aabb {
        let boxes = &self.boxes;
        let min = vec2(boxes.left[k], boxes.low[k]);
        Aabb::new(min, vec2(boxes.right[k], boxes.high[k]))
    }

    /// Finds all movers with a box that overlaps `bounds`.
    pub(crate) fn all_in(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        dispatch!(self.level, simd => {
            self.usual_in(simd, bounds, &mut found);
            self.forward(simd, self.unusual, self.len(), bounds, &mut found);
        });
    }

    /// Finds what lies in the strips.
    #[inline(always)]
    fn usual_in<S: Simd>(&self, simd: S, bounds: Aabb, found: &mut impl FnMut(u32)) {
        let lowest = self.strip(bounds.min.y).saturating_sub(1);
        let highest = self.strip(bounds.max.y);
        let first = self.strips.partition_point(|strip| strip.0 < lowest);
        for (n, strip) in self.strips.iter().enumerate().skip(first) {
            if strip.0 > highest {
                break;
            }
            let end = self.end(n);
            let left = bounds.min.x - self.height;
            let begin = self.boxes.left[strip.1..end]
                .partition_point(|theirs| ordered(*theirs) < ordered(left));
            self.forward(simd, strip.1 + begin, end, bounds, found);
        }
    }

    /// Tells of the boxes in `from..end`, in order of their left ends, that overlap `bounds`.
    #[inline(always)]
    fn forward<S: Simd>(
        &self,
        simd: S,
        from: usize,
        end: usize,
        bounds: Aabb,
        found: &mut impl FnMut(u32),
    ) {
        let boxes = &self.boxes;
        let x = fours(&boxes.left, from, end).zip(fours(&boxes.right, from, end));
        let y = fours(&boxes.low, from, end).zip(fours(&boxes.high, from, end));
        // Order is that of left ends rounded to f32: what is beyond the right end so rounded is beyond it.
        let last = rounded(bounds.max.x);
        let (min_x, max_x) = (
            f64x4::splat(simd, bounds.min.x),
            f64x4::splat(simd, bounds.max.x),
        );
        let (min_y, max_y) = (
            f64x4::splat(simd, bounds.min.y),
            f64x4::splat(simd, bounds.max.y),
        );
        for (k, ((left, right), (low, high))) in (from..).step_by(LANES).zip(x.zip(y)) {
            if rounded(left[0]) > last {
                break;
            }
            let overlap = f64x4::from_slice(simd, left).simd_le(max_x)
                & f64x4::from_slice(simd, right).simd_ge(min_x)
                & f64x4::from_slice(simd, low).simd_le(max_y)
                & f64x4::from_slice(simd, high).simd_ge(min_y);
            let mut bits = overlap.to_bitmask();
            while bits != 0 {
                let other = k + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                if other < end {
                    found(self.keys[other].piece);
                }
            }
        }
    }

    /// Where strip `n` of the list ends.
    fn end(&self, n: usize) -> usize {
        self.strips.get(n + 1).map_or(self.unusual, |next| next.1)
    }
}

/// Numbers in `from..end` of a column, four at once, and some that are behind.
fn fours(column: &[f64], from: usize, end: usize) -> impl Iterator<Item = &[f64; LANES]> {
    let count = (end - from).next_multiple_of(LANES);
    column[from..from + count].as_chunks().0.iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_pairs_that_asking_all_finds() {
        let mut random = 3u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(random >> 8) / f64::from(1u32 << 24)
        };
        let mut sweep = Sweep::default();
        let mut boxes: Vec<Aabb> = Vec::new();
        for round in 0..80 {
            let spread = [5.0, 20.0, 1e3, 1e7][round / 2 % 4];
            if round % 2 == 0 {
                let anywhere = |k| {
                    let min = vec2(next() - 0.5, next() - 0.5) * spread;
                    let long = if k % 17 == 0 { 20.0 } else { 1.0 };
                    Aabb::new(min, min + vec2(next() * long, next()))
                };
                boxes = (0..200).map(anywhere).collect();
            } else {
                // The order of before nearly is that of now.
                for bounds in &mut boxes {
                    let by = vec2(next() - 0.5, next() - 0.5) * 0.1;
                    *bounds = Aabb::new(bounds.min + by, bounds.max + by);
                }
            }
            sweep.sort(0..200, &boxes);
            let mut found = Vec::new();
            sweep.pairs(|a, b| {
                found.push((a.min(b), a.max(b)));
            });
            found.sort_unstable();
            let mut all = Vec::new();
            for a in 0..200u32 {
                for b in a + 1..200 {
                    if boxes[a as usize].overlaps(boxes[b as usize]) {
                        all.push((a, b));
                    }
                }
                let mut near = Vec::new();
                sweep.all_in(boxes[a as usize], |b| near.push(b));
                near.sort_unstable();
                let meets = |b: &u32| boxes[*b as usize].overlaps(boxes[a as usize]);
                assert_eq!(near, (0..200).filter(meets).collect::<Vec<_>>());
            }
            assert_eq!(found, all);
        }
    }
}
