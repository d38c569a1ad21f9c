//! Sort-and-sweep in strips: which boxes of movers overlap.
//!
//! A strip is as high as the highest of the usual boxes, so two boxes that overlap begin in the same strip or in
//! neighbouring ones. Within a strip boxes lie in order of their left ends. Boxes of unusual size (planks, walls that are
//! driven, bullets) are in no strip, and ask all strips that they cross. Everything here decides what is found at which
//! cost, and nothing what comes of it: pairs are sorted before they are used.

use crate::PieceIx;
use carom_geometry::Aabb;

/// A box more than so many times the median is unusual. Less: many boxes ask one by one; more: strips so high that
/// everything in them is compared.
const UNUSUAL: f64 = 2.0;

/// Strips are so many times as high as the highest of the usual boxes: sizes are rounded.
const ROOM: f64 = 1.0 + 1e-9;

/// Of boxes of unusual size, behind all strips: there is no order from below among them.
const NO_STRIP: u32 = u32::MAX;

/// A mover, its strip and its box.
#[derive(Clone, Copy, Debug)]
struct Mover {
    strip: u32,
    piece: PieceIx,
    bounds: Aabb,
}

/// All movers in order of their strips.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    /// In order of their strips, then of their left ends.
    movers: Vec<Mover>,
    /// Where movers of unusual size begin, in order of their left ends.
    unusual: usize,
    /// Number of each strip that is not empty, and where it begins.
    strips: Vec<(u32, usize)>,
    height: f64,
}

impl Sweep {
    /// Makes the order of these movers, each piece once, with boxes by piece.
    pub(crate) fn sort(&mut self, pieces: impl Iterator<Item = PieceIx> + Clone, boxes: &[Aabb]) {
        let size = |piece: PieceIx| boxes[piece.at()].extents().max_element();
        self.height = usual_height(pieces.clone().map(size).collect());
        self.movers.clear();
        for piece in pieces {
            let bounds = boxes[piece.at()];
            let strip = if size(piece) <= self.height {
                self.strip(bounds.min.y)
            } else {
                NO_STRIP
            };
            self.movers.push(Mover {
                strip,
                piece,
                bounds,
            });
        }
        self.movers.sort_unstable_by(|a, b| {
            let left = |mover: &Mover| mover.bounds.min.x;
            a.strip.cmp(&b.strip).then(left(a).total_cmp(&left(b)))
        });
        self.unusual = self.movers.partition_point(|mover| mover.strip < NO_STRIP);
        self.strips.clear();
        for (k, mover) in self.movers[..self.unusual].iter().enumerate() {
            if self.strips.last().is_none_or(|last| last.0 != mover.strip) {
                self.strips.push((mover.strip, k));
            }
        }
    }

    /// How many movers it knows.
    pub(crate) const fn len(&self) -> usize {
        self.movers.len()
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
    pub(crate) fn pairs(&self, mut found: impl FnMut(PieceIx, PieceIx)) {
        for (n, &(strip, first)) in self.strips.iter().enumerate() {
            let end = self.end(n);
            // The next strip is swept by a second finger, which only goes forward.
            let next = self
                .strips
                .get(n + 1)
                .filter(|next| next.0 == strip.wrapping_add(1));
            let (mut finger, beyond) = next.map_or((0, 0), |next| (next.1, self.end(n + 1)));
            for k in first..end {
                let Mover { piece, bounds, .. } = self.movers[k];
                let mut tell = |other: PieceIx| found(piece, other);
                forward(&self.movers[k + 1..end], bounds, &mut tell);
                let left = self.leftmost(bounds);
                while finger < beyond && self.movers[finger].bounds.min.x < left {
                    finger += 1;
                }
                forward(&self.movers[finger..beyond], bounds, &mut tell);
            }
        }
        for k in self.unusual..self.len() {
            let Mover { piece, bounds, .. } = self.movers[k];
            let mut tell = |other: PieceIx| found(piece, other);
            self.usual_in(bounds, &mut tell);
            forward(&self.movers[k + 1..], bounds, &mut tell);
        }
    }

    /// Finds all movers with a box that overlaps `bounds`.
    pub(crate) fn all_in(&self, bounds: Aabb, mut found: impl FnMut(PieceIx)) {
        self.usual_in(bounds, &mut found);
        forward(&self.movers[self.unusual..], bounds, &mut found);
    }

    /// Finds what lies in the strips.
    fn usual_in(&self, bounds: Aabb, found: &mut impl FnMut(PieceIx)) {
        let lowest = self.strip(bounds.min.y).saturating_sub(1);
        let highest = self.strip(bounds.max.y);
        let left = self.leftmost(bounds);
        let first = self.strips.partition_point(|strip| strip.0 < lowest);
        for (n, strip) in self.strips.iter().enumerate().skip(first) {
            if strip.0 > highest {
                break;
            }
            let movers = &self.movers[strip.1..self.end(n)];
            let begin = movers.partition_point(|mover| mover.bounds.min.x < left);
            forward(&movers[begin..], bounds, found);
        }
    }

    /// No usual box that overlaps `bounds` has its left end farther left, however the difference is rounded.
    fn leftmost(&self, bounds: Aabb) -> f64 {
        (bounds.min.x - self.height).next_down()
    }

    /// Where strip `n` of the list ends.
    fn end(&self, n: usize) -> usize {
        self.strips.get(n + 1).map_or(self.unusual, |next| next.1)
    }
}

/// The size of the largest of the usual ones among boxes of these sizes, and [`ROOM`].
fn usual_height(mut sizes: Vec<f64>) -> f64 {
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return f64::MIN_POSITIVE;
    }
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    let usual = UNUSUAL * *median;
    let usual = sizes.into_iter().filter(|size| *size <= usual);
    ROOM * usual.fold(f64::MIN_POSITIVE, f64::max)
}

/// Tells of the movers, in order of their left ends, with boxes that overlap `bounds`.
fn forward(movers: &[Mover], bounds: Aabb, found: &mut impl FnMut(PieceIx)) {
    for mover in movers {
        if mover.bounds.min.x > bounds.max.x {
            break;
        }
        // One branch: any of the three holds of about half of the boxes.
        let Aabb { min, max } = mover.bounds;
        if (max.x >= bounds.min.x) & (min.y <= bounds.max.y) & (max.y >= bounds.min.y) {
            found(mover.piece);
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_math::vec2;

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
            let pieces = PieceIx(0).run(200);
            sweep.sort(pieces.clone(), &boxes);
            let mut found = Vec::new();
            sweep.pairs(|a, b| {
                found.push((a.min(b).at(), a.max(b).at()));
            });
            found.sort_unstable();
            let mut all = Vec::new();
            for a in 0..200 {
                for b in a + 1..200 {
                    if boxes[a].overlaps(boxes[b]) {
                        all.push((a, b));
                    }
                }
                let mut near = Vec::new();
                sweep.all_in(boxes[a], |b| near.push(b));
                near.sort_unstable();
                let meets = |b: &PieceIx| boxes[*b].overlaps(boxes[a]);
                assert_eq!(near, pieces.clone().filter(meets).collect::<Vec<_>>());
            }
            assert_eq!(found, all);
        }
    }
}
