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

use super::keys::{Key, ordered, put_in_order, rounded};
use crate::pieces::{Disc, Pieces};

/// A box more than so many times the median is unusual. Less: many boxes ask one by one; more: strips so high that
/// everything in them is compared.
const UNUSUAL: f64 = 2.0;

/// Strips are so many times as high as the highest of the usual boxes, so that they stay while boxes grow: all keys change with them.
/// 1: what falls gets new strips in each tick.
const ROOM: f64 = 1.05;

/// Strips get lower once no usual box is this part as high.
const LOW: f64 = 0.8;

/// Boxes tested at once.
const LANES: usize = 4;

/// A mover as the sweep asks about it.
#[derive(Clone, Copy, Debug)]
struct Mover {
    disc: Disc,
    piece: u32,
    body: u32,
    moved: bool,
}

impl Mover {
    fn new(pieces: &Pieces, piece: u32, moved: bool) -> Self {
        Self {
            disc: pieces.discs[piece as usize],
            piece,
            body: pieces.owners[piece as usize].body,
            moved,
        }
    }

    /// Whether contacts of two are to be looked for.
    fn may_meet(&self, other: &Self, tick: f64) -> bool {
        (self.moved || other.moved)
            && self.body != other.body
            && self.disc.may_meet(&other.disc, tick)
    }
}

/// Boxes side by side, and as many more at the end as fill a register: these overlap nothing.
#[derive(Clone, Debug, Default)]
struct Boxes {
    left: Vec<f64>,
    right: Vec<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
}

/// All movers in order of their strips.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    keys: Vec<Key>,
    unusual: Vec<Mover>,
    /// Number of each strip that is not empty, and where it begins.
    strips: Vec<(u32, usize)>,
    /// Boxes and movers in the order of the keys.
    boxes: Boxes,
    movers: Vec<Mover>,
    height: f64,
    /// How many movers were too high for the strips when these were made.
    too_high: usize,
    sizes: Vec<f64>,
    /// Keys in the order of the movers, and the place of each piece there while the order is made: scratch.
    fresh: Vec<Key>,
    places: Vec<u32>,
}

impl Sweep {
    /// Makes the order anew for these movers, each piece once, and whether it moved.
    pub(crate) fn sort(
        &mut self,
        movers: impl Iterator<Item = (u32, bool)> + Clone,
        pieces: &Pieces,
    ) {
        let boxes = &pieces.boxes;
        self.fresh.clear();
        self.fresh.extend(movers.map(|(piece, moved)| Key {
            place: 0,
            piece,
            moved,
        }));
        self.sizes.clear();
        self.sizes.extend(self.fresh.iter().map(|key| {
            let size = boxes[key.piece as usize].max - boxes[key.piece as usize].min;
            if size.x > size.y { size.x } else { size.y }
        }));
        self.choose_height();
        self.unusual.clear();
        let (mut fresh, sizes) = (
            core::mem::take(&mut self.fresh),
            core::mem::take(&mut self.sizes),
        );
        let mut each = sizes.iter();
        fresh.retain_mut(|key| {
            let is_usual = each.next().is_some_and(|size| *size <= self.height);
            if is_usual {
                let min = boxes[key.piece as usize].min;
                key.place = u64::from(self.strip(min.y)) << 32 | u64::from(ordered(min.x));
            } else {
                self.unusual.push(Mover::new(pieces, key.piece, key.moved));
            }
            is_usual
        });
        (self.fresh, self.sizes) = (fresh, sizes);
        put_in_order(&mut self.keys, &self.fresh, &mut self.places);
        self.strips.clear();
        for (k, key) in self.keys.iter().enumerate() {
            let strip = key.strip();
            if self.strips.last().is_none_or(|last| last.0 != strip) {
                self.strips.push((strip, k));
            }
        }
        self.fill(pieces);
        self.unusual.sort_unstable_by(|a, b| {
            let left = |piece: u32| boxes[piece as usize].min.x;
            let order = left(a.piece).total_cmp(&left(b.piece));
            order.then(a.piece.cmp(&b.piece))
        });
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
        self.keys.len() + self.unusual.len()
    }

    /// How many of them have an unusual size.
    pub(crate) const fn unusual(&self) -> usize {
        self.unusual.len()
    }

    /// Copies what is asked about into the order of the keys.
    fn fill(&mut self, pieces: &Pieces) {
        let (keys, boxes) = (&self.keys, &mut self.boxes);
        self.movers.clear();
        let movers = keys.iter();
        self.movers
            .extend(movers.map(|key| Mover::new(pieces, key.piece, key.moved)));
        let Boxes {
            left,
            right,
            low,
            high,
        } = boxes;
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
            let bounds = pieces.boxes[key.piece as usize];
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

    /// Finds all pairs that may meet within the tick, and of which at least one piece moved.
    pub(crate) fn pairs(
        &self,
        level: Level,
        pieces: &Pieces,
        tick: f64,
        mut found: impl FnMut(u32, u32),
    ) {
        dispatch!(level, simd => self.usual_pairs(simd, tick, &mut found));
        for (k, mover) in self.unusual.iter().enumerate() {
            let bounds = pieces.boxes[mover.piece as usize];
            self.query(bounds, |other| {
                if mover.may_meet(other, tick) {
                    found(mover.piece, other.piece);
                }
            });
            for other in &self.unusual[k + 1..] {
                let theirs = pieces.boxes[other.piece as usize];
                if theirs.min.x > bounds.max.x {
                    break;
                }
                if theirs.overlaps(bounds) && mover.may_meet(other, tick) {
                    found(mover.piece, other.piece);
                }
            }
        }
    }

    #[inline(always)]
    fn usual_pairs<S: Simd>(&self, simd: S, tick: f64, found: &mut impl FnMut(u32, u32)) {
        for (n, &(strip, first)) in self.strips.iter().enumerate() {
            let end = self.end(n);
            // The next strip is swept by a second finger, which only goes forward.
            let next = self
                .strips
                .get(n + 1)
                .filter(|next| next.0 == strip.wrapping_add(1));
            let (mut finger, beyond) = next.map_or((0, 0), |next| (next.1, self.end(n + 1)));
            for k in first..end {
                let mover = &self.movers[k];
                let bounds = self.bounds(k);
                let mut tell = |other: &Mover| {
                    if mover.may_meet(other, tick) {
                        found(mover.piece, other.piece);
                    }
                };
                self.forward(simd, k + 1, end, bounds, &mut tell);
                // In order with the keys, and no farther right than what rounding left of the box.
                let left = f64::from(rounded(bounds.min.x).next_down()) - self.height;
                while finger < beyond && self.boxes.left[finger] < left {
                    finger += 1;
                }
                self.forward(simd, finger, beyond, bounds, &mut tell);
            }
        }
    }

    fn bounds(&self, k: usize) -> Aabb {
        let boxes = &self.boxes;
        let min = vec2(boxes.left[k], boxes.low[k]);
        Aabb::new(min, vec2(boxes.right[k], boxes.high[k]))
    }

    /// Finds all movers with a box that overlaps `bounds`.
    pub(crate) fn all_in(&self, pieces: &Pieces, bounds: Aabb, mut found: impl FnMut(u32)) {
        self.query(bounds, |mover| found(mover.piece));
        for mover in &self.unusual {
            if pieces.boxes[mover.piece as usize].overlaps(bounds) {
                found(mover.piece);
            }
        }
    }

    /// Finds what lies in the strips.
    fn query(&self, bounds: Aabb, mut found: impl FnMut(&Mover)) {
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
            let right = ordered(bounds.max.x);
            for k in strip.1 + begin..end {
                if self.keys[k].left() > right {
                    break;
                }
                if self.bounds(k).overlaps(bounds) {
                    found(&self.movers[k]);
                }
            }
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
        found: &mut impl FnMut(&Mover),
    ) {
        let boxes = &self.boxes;
        // Order is that of left ends rounded down: what is beyond the right end so rounded is beyond it.
        let right = ordered(bounds.max.x);
        let (min_x, max_x) = (
            f64x4::splat(simd, bounds.min.x),
            f64x4::splat(simd, bounds.max.x),
        );
        let (min_y, max_y) = (
            f64x4::splat(simd, bounds.min.y),
            f64x4::splat(simd, bounds.max.y),
        );
        for k in (from..end).step_by(LANES) {
            if self.keys[k].left() > right {
                break;
            }
            let overlap = f64x4::from_slice(simd, &boxes.left[k..k + LANES]).simd_le(max_x)
                & f64x4::from_slice(simd, &boxes.right[k..k + LANES]).simd_ge(min_x)
                & f64x4::from_slice(simd, &boxes.low[k..k + LANES]).simd_le(max_y)
                & f64x4::from_slice(simd, &boxes.high[k..k + LANES]).simd_ge(min_y);
            let mut bits = overlap.to_bitmask();
            while bits != 0 {
                let other = k + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                if other < end {
                    found(&self.movers[other]);
                }
            }
        }
    }

    /// Where strip `n` of the list ends.
    fn end(&self, n: usize) -> usize {
        self.strips
            .get(n + 1)
            .map_or(self.keys.len(), |next| next.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::Owner;

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
            let moved = |piece: u32| piece.is_multiple_of(3);
            let mut pieces = Pieces::default();
            pieces.discs = vec![Disc::ENDLESS; 200];
            pieces.owners = (0..200)
                .map(|body| Owner {
                    body,
                    ordinal: 0,
                    several: false,
                })
                .collect();
            pieces.boxes.clone_from(&boxes);
            sweep.sort((0..200).map(|piece| (piece, moved(piece))), &pieces);
            let mut found = Vec::new();
            sweep.pairs(Level::new(), &pieces, 1.0, |a, b| {
                found.push((a.min(b), a.max(b)));
            });
            found.sort_unstable();
            let mut all = Vec::new();
            for a in 0..200u32 {
                for b in a + 1..200 {
                    let meet = boxes[a as usize].overlaps(boxes[b as usize]);
                    if (moved(a) || moved(b)) && meet {
                        all.push((a, b));
                    }
                }
                let mut near = Vec::new();
                sweep.all_in(&pieces, boxes[a as usize], |b| near.push(b));
                near.sort_unstable();
                let meets = |b: &u32| boxes[*b as usize].overlaps(boxes[a as usize]);
                assert_eq!(near, (0..200).filter(meets).collect::<Vec<_>>());
            }
            assert_eq!(found, all);
        }
    }
}
