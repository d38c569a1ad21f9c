//! Sort-and-sweep in strips: which boxes of movers overlap.
//!
//! A strip is as high as the highest of the usual boxes, so two boxes that overlap begin in the same strip or in
//! neighbouring ones. Within a strip boxes lie in order of their left ends. Boxes of unusual size (planks, walls that are
//! driven, bullets) are in no strip, and ask all strips that they cross. Everything here decides what is found at which
//! cost, and nothing what comes of it: pairs are sorted before they are used.

use carom_geometry::Aabb;

/// A box more than so many times the median is unusual. Less: many boxes ask one by one; more: strips so high that
/// everything in them is compared.
const UNUSUAL: f64 = 2.0;

/// A mover and its place in the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    /// Strip above the order of the left end, rounded down to f32.
    place: u64,
    piece: u32,
}

/// All movers in order of their strips.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    keys: Vec<Key>,
    unusual: Vec<u32>,
    /// Number of each strip that is not empty, and where it begins.
    strips: Vec<(u32, usize)>,
    /// Boxes in the order of the keys.
    boxes: Vec<Aabb>,
    height: f64,
    widest: f64,
    scratch: Vec<f64>,
}

impl Sweep {
    /// Makes the order anew for these movers, each piece once.
    pub(crate) fn sort(&mut self, movers: impl Iterator<Item = u32> + Clone, boxes: &[Aabb]) {
        let longest = |piece: u32| {
            let size = boxes[piece as usize].max - boxes[piece as usize].min;
            if size.x > size.y { size.x } else { size.y }
        };
        self.scratch.clear();
        self.scratch.extend(movers.clone().map(longest));
        if self.scratch.is_empty() {
            self.keys.clear();
            self.unusual.clear();
            self.strips.clear();
            self.boxes.clear();
            return;
        }
        let middle = self.scratch.len() / 2;
        let (_, median, _) = self.scratch.select_nth_unstable_by(middle, f64::total_cmp);
        let usual = UNUSUAL * *median;
        let sizes = self.scratch.iter().filter(|size| **size <= usual);
        self.height = sizes
            .fold(0.0, |most: f64, size| most.max(*size))
            .max(f64::MIN_POSITIVE);
        self.widest = self.height;
        self.keys.clear();
        self.unusual.clear();
        for piece in movers {
            let min = boxes[piece as usize].min;
            if longest(piece) <= self.height {
                let place = u64::from(self.strip(min.y)) << 32 | u64::from(ordered(min.x));
                self.keys.push(Key { place, piece });
            } else {
                self.unusual.push(piece);
            }
        }
        self.keys.sort_unstable();
        self.boxes.clear();
        self.strips.clear();
        for (k, key) in self.keys.iter().enumerate() {
            self.boxes.push(boxes[key.piece as usize]);
            let strip = key.strip();
            if self.strips.last().is_none_or(|last| last.0 != strip) {
                self.strips.push((strip, k));
            }
        }
        let by_left = |a: &u32, b: &u32| {
            let left = |piece: u32| boxes[piece as usize].min.x;
            left(*a).total_cmp(&left(*b)).then(a.cmp(b))
        };
        self.unusual.sort_unstable_by(by_left);
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

    /// Finds all overlapping pairs of which at least one piece moved.
    pub(crate) fn pairs(
        &self,
        boxes: &[Aabb],
        moved: impl Fn(u32) -> bool,
        mut found: impl FnMut(u32, u32),
    ) {
        for (n, &(strip, first)) in self.strips.iter().enumerate() {
            let end = self.end(n);
            // The next strip is swept by a second finger, which only goes forward.
            let next = self
                .strips
                .get(n + 1)
                .filter(|next| next.0 == strip.wrapping_add(1));
            let (mut finger, beyond) = next.map_or((0, 0), |next| (next.1, self.end(n + 1)));
            for k in first..end {
                let (key, bounds) = (self.keys[k], self.boxes[k]);
                let it = moved(key.piece);
                self.forward(k + 1, end, bounds, |other| {
                    if it || moved(other) {
                        found(key.piece, other);
                    }
                });
                // In order with the keys, and no farther right than what rounding left of the box.
                let left = f64::from(rounded(bounds.min.x).next_down()) - self.widest;
                while finger < beyond && self.boxes[finger].min.x < left {
                    finger += 1;
                }
                self.forward(finger, beyond, bounds, |other| {
                    if it || moved(other) {
                        found(key.piece, other);
                    }
                });
            }
        }
        for (k, &piece) in self.unusual.iter().enumerate() {
            let (bounds, it) = (boxes[piece as usize], moved(piece));
            self.query(bounds, |other| {
                if it || moved(other) {
                    found(piece, other);
                }
            });
            for &other in &self.unusual[k + 1..] {
                let theirs = boxes[other as usize];
                if theirs.min.x > bounds.max.x {
                    break;
                }
                if (it || moved(other)) && theirs.overlaps(bounds) {
                    found(piece, other);
                }
            }
        }
    }

    /// Finds all movers whose boxes overlap `bounds`.
    pub(crate) fn all_in(&self, boxes: &[Aabb], bounds: Aabb, mut found: impl FnMut(u32)) {
        self.query(bounds, &mut found);
        for &piece in &self.unusual {
            if boxes[piece as usize].overlaps(bounds) {
                found(piece);
            }
        }
    }

    /// Finds what lies in the strips.
    fn query(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        let lowest = self.strip(bounds.min.y).saturating_sub(1);
        let highest = self.strip(bounds.max.y);
        let first = self.strips.partition_point(|strip| strip.0 < lowest);
        for (n, strip) in self.strips.iter().enumerate().skip(first) {
            if strip.0 > highest {
                break;
            }
            let end = self.end(n);
            let left = bounds.min.x - self.widest;
            let begin = self.boxes[strip.1..end]
                .partition_point(|theirs| ordered(theirs.min.x) < ordered(left));
            self.forward(strip.1 + begin, end, bounds, &mut found);
        }
    }

    /// Tells of the boxes in `from..end`, in order of their left ends, that overlap `bounds`.
    fn forward(&self, from: usize, end: usize, bounds: Aabb, mut found: impl FnMut(u32)) {
        // Order is that of left ends rounded down: what is beyond the right end so rounded is beyond it.
        let right = ordered(bounds.max.x);
        for k in from..end {
            let theirs = self.boxes[k];
            if self.keys[k].left() > right {
                break;
            }
            if theirs.overlaps(bounds) {
                found(self.keys[k].piece);
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

impl Key {
    const fn strip(self) -> u32 {
        (self.place >> 32) as u32
    }

    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    const fn left(self) -> u32 {
        self.place as u32
    }
}

/// Bits that are in the order of the numbers, rounded to f32: equal numbers may get equal bits, and none change places.
fn ordered(x: f64) -> u32 {
    let bits = rounded(x).to_bits();
    if bits >> 31 == 0 {
        bits | 1 << 31
    } else {
        !bits
    }
}

fn rounded(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is monotone")]
    let rounded = x as f32;
    rounded
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
        for round in 0..40 {
            let spread = [5.0, 20.0, 1e3, 1e7][round % 4];
            let boxes: Vec<_> = (0..200)
                .map(|k| {
                    let min = vec2(next() - 0.5, next() - 0.5) * spread;
                    let long = if k % 17 == 0 { 20.0 } else { 1.0 };
                    Aabb::new(min, min + vec2(next() * long, next()))
                })
                .collect();
            let moved = |piece: u32| piece.is_multiple_of(3);
            let mut sweep = Sweep::default();
            sweep.sort(0..200, &boxes);
            let mut found = Vec::new();
            sweep.pairs(&boxes, moved, |a, b| found.push((a.min(b), a.max(b))));
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
                sweep.all_in(&boxes, boxes[a as usize], |b| near.push(b));
                near.sort_unstable();
                let meets = |b: &u32| boxes[*b as usize].overlaps(boxes[a as usize]);
                assert_eq!(near, (0..200).filter(meets).collect::<Vec<_>>());
            }
            assert_eq!(found, all);
        }
    }
}
