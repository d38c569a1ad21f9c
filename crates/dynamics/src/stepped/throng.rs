//! Bodies on their courses, laid out for a search by many of them at once.
//!
//! Their boxes lie in square cells, each in that of its lower left corner, and cells share as many places as there are
//! boxes: what overlaps a box lies in the cells that it reaches into and those before them, as far as the largest
//! box goes, or was put in the same place as one of these. Boxes that are much larger than the mean have cells of their
//! own: a few quick ones would make all cells large.

use carom_geometry::Aabb;
use carom_math::Vec2;

use super::courses::Goer;

/// Boxes of more than so many times the mean size have no cell.
const LARGE: f64 = 4.0;

/// Boxes of more than so many times the mean size have wider cells.
const WIDE: f64 = 1.5;

/// Cells across the largest box that lies in them.
const ACROSS: f64 = 2.0;

/// All who are on their courses.
#[derive(Clone, Debug)]
pub(super) struct Throng {
    members: Vec<Member>,
    /// Small boxes, and wide ones.
    cells: [Cells; 2],
    /// Largest box that has a cell.
    limit: f64,
    /// Member of each slot, of bodies with one shape; `u32::MAX`: none.
    by_slot: Vec<u32>,
}

/// A shape of a body on its course.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) fat: Aabb,
    pub(super) goer: Goer,
}

impl Default for Throng {
    fn default() -> Self {
        Self {
            members: Vec::new(),
            cells: [Cells::default(), Cells::default()],
            limit: f64::INFINITY,
            by_slot: Vec::new(),
        }
    }
}

impl Throng {
    /// Whether a box has a cell.
    pub(super) fn takes(&self, bounds: Aabb) -> bool {
        size_of(bounds) <= self.limit
    }

    /// Lays out all who are there; says whose boxes are too large from now on.
    pub(super) fn lay_out(&mut self, members: impl Iterator<Item = Member>) -> Vec<u32> {
        self.members.clear();
        self.members.extend(members);
        self.by_slot.clear();
        let sizes = self.members.iter().map(|member| size_of(member.fat));
        #[expect(clippy::cast_precision_loss, reason = "a count of shapes")]
        let mean = sizes.sum::<f64>() / self.members.len() as f64;
        self.limit = if self.members.is_empty() {
            f64::INFINITY
        } else {
            LARGE * mean
        };
        let mut large = Vec::new();
        let limit = self.limit;
        let is_large = |member: &Member| size_of(member.fat) > limit;
        if self.members.iter().any(is_large) {
            large.extend(
                self.members
                    .iter()
                    .filter(|member| is_large(member))
                    .map(|member| member.goer.at),
            );
            self.members.retain(|member| !is_large(member));
        }
        let wide = WIDE * mean;
        for (cells, is_wide) in self.cells.iter_mut().zip([false, true]) {
            let all = (0_u32..).zip(&self.members);
            let boxes = all.map(|(k, member)| (member.fat, k));
            cells.fill(boxes.filter(|(fat, _)| (size_of(*fat) > wide) == is_wide));
        }
        for (k, member) in (0_u32..).zip(&self.members) {
            let slot = member.goer.slot as usize;
            if self.by_slot.len() <= slot {
                self.by_slot.resize(slot + 1, u32::MAX);
            }
            self.by_slot[slot] = k;
        }
        large
    }

    /// A shape of the body at `slot`, if it was laid out; of several shapes of a body one is.
    #[inline]
    pub(super) fn goer(&self, slot: u32, at: u32) -> Option<&Goer> {
        let member = self
            .members
            .get(*self.by_slot.get(slot as usize)? as usize)?;
        Some(&member.goer).filter(|goer| goer.at == at)
    }

    /// Calls `found` with all whose boxes overlap `sought`, with some twice.
    pub(super) fn query(&self, sought: Aabb, mut found: impl FnMut(&Goer)) {
        for cells in &self.cells {
            cells.query(sought, |k| found(&self.members[k as usize].goer));
        }
    }
}

/// Boxes of about one size.
#[derive(Clone, Debug, Default)]
struct Cells {
    /// By place, and whose they are.
    boxes: Vec<(Aabb, u32)>,
    /// Where those of each place begin, and where the last ones end.
    places: Vec<u32>,
    side: f64,
    /// Size of the largest box.
    largest: f64,
    /// Boxes as they came, and their places: scratch.
    came: Vec<(Aabb, u32, u32)>,
}

impl Cells {
    fn fill(&mut self, boxes: impl Iterator<Item = (Aabb, u32)>) {
        self.came.clear();
        self.came.extend(boxes.map(|(fat, k)| (fat, k, 0)));
        let largest = self.came.iter().map(|(fat, ..)| size_of(*fat));
        self.largest = largest.fold(f64::MIN_POSITIVE, f64::max);
        self.side = (self.largest / ACROSS).max(f64::MIN_POSITIVE);
        // Sorted by counting.
        let count = self.came.len();
        self.places.clear();
        self.places.resize(count.next_power_of_two() + 1, 0);
        for i in 0..count {
            let place = self.place(self.cell(self.came[i].0.min));
            #[expect(clippy::cast_possible_truncation, reason = "shapes are counted by u32")]
            {
                self.came[i].2 = place as u32;
            }
            self.places[place] += 1;
        }
        let mut end = 0;
        for place in &mut self.places {
            end += *place;
            *place = end;
        }
        self.boxes.clear();
        self.boxes.resize(count, (Aabb::EMPTY, 0));
        for &(fat, k, place) in &self.came {
            let end = &mut self.places[place as usize];
            *end -= 1;
            self.boxes[*end as usize] = (fat, k);
        }
    }

    fn query(&self, sought: Aabb, mut found: impl FnMut(u32)) {
        if self.boxes.is_empty() {
            return;
        }
        let low = below(sought.min, Vec2::splat(self.largest));
        let span = (sought.max - low) / self.side + Vec2::splat(2.0);
        let mut among = |boxes: &[(Aabb, u32)]| {
            for (fat, k) in boxes {
                if fat.overlaps(sought) {
                    found(*k);
                }
            }
        };
        #[expect(clippy::cast_precision_loss, reason = "a count of shapes")]
        let all = self.boxes.len() as f64;
        // A box that reaches into most cells is held against everybody.
        if span.x * span.y >= all {
            return among(&self.boxes);
        }
        let (low, high) = (self.cell(low), self.cell(sought.max));
        for y in low.1..=high.1 {
            for x in low.0..=high.0 {
                let place = self.place((x, y));
                let (from, to) = (self.places[place], self.places[place + 1]);
                among(&self.boxes[from as usize..to as usize]);
            }
        }
    }

    #[inline]
    fn cell(&self, corner: Vec2) -> (i64, i64) {
        let cell = corner / self.side;
        (floor(cell.x), floor(cell.y))
    }

    #[expect(clippy::cast_sign_loss, reason = "a hash: any bits do")]
    const fn place(&self, (x, y): (i64, i64)) -> usize {
        let mixed = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        (mixed >> 32) as usize & (self.places.len() - 2)
    }
}

/// Largest integer that is not above `x`; of those of an `i64` the nearest.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "beyond 2⁵³ all are integers"
)]
fn floor(x: f64) -> i64 {
    let near = x as i64;
    near.saturating_sub(i64::from(near as f64 > x))
}

/// Width and height of a box, in m, whichever is more.
fn size_of(bounds: Aabb) -> f64 {
    let size = bounds.max - bounds.min;
    size.x.max(size.y)
}

/// `p` − `by`, and not a rounding more.
fn below(p: Vec2, by: Vec2) -> Vec2 {
    let less = p - by;
    less - (less.abs() + by) * (4.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    fn boxes(count: usize) -> impl Strategy<Value = Vec<Aabb>> {
        let size = prop_oneof![9 => 0.1..1.0_f64, 1 => 5.0..20.0_f64];
        let place = (-20.0..20.0_f64, -5.0..5.0_f64, size.clone(), size);
        let bounds = place.prop_map(|(x, y, w, h)| Aabb::new(vec2(x, y), vec2(x + w, y + h)));
        proptest::collection::vec(bounds, 1..count)
    }

    fn lay_out(all: &[Aabb]) -> (Throng, Vec<u32>) {
        let members = all.iter().zip(0..).map(|(fat, at)| Member {
            fat: *fat,
            goer: Goer::standing(at),
        });
        let mut throng = Throng::default();
        let large = throng.lay_out(members);
        (throng, large)
    }

    fn query(throng: &Throng, sought: Aabb) -> Vec<u32> {
        let mut found = Vec::new();
        throng.query(sought, |goer| found.push(goer.at));
        found.sort_unstable();
        found.dedup();
        found
    }

    proptest! {
        /// What each against each finds is found, but for those whose boxes are too large.
        #[test]
        fn nobody_is_missed(all in boxes(100), shift in prop_oneof![Just(0.0), Just(1e6), Just(-1e12)]) {
            let shift = vec2(shift, shift);
            let all: Vec<Aabb> = all.into_iter().map(|b| Aabb::new(b.min + shift, b.max + shift)).collect();
            let (throng, large) = lay_out(&all);
            for sought in &all {
                let expected: Vec<u32> = (0_u32..)
                    .zip(&all)
                    .filter(|(at, bounds)| bounds.overlaps(*sought) && !large.contains(at))
                    .map(|(at, _)| at)
                    .collect();
                prop_assert_eq!(query(&throng, *sought), expected);
            }
        }
    }

    /// Who comes after an empty tick finds a place.
    #[test]
    fn an_empty_throng_takes_everybody() {
        let (throng, _) = lay_out(&[]);
        assert!(throng.takes(Aabb::new(Vec2::ZERO, Vec2::splat(1e9))));
        assert_eq!(query(&throng, Aabb::new(Vec2::ZERO, Vec2::ONE)), []);
    }

    #[test]
    fn boxes_far_apart_are_found_and_a_huge_one_finds_all() {
        let at = |x: f64| Aabb::new(vec2(x, x), vec2(x + 1.0, x + 1.0));
        let (throng, large) = lay_out(&[at(0.0), at(1e15), at(-1e300)]);
        assert_eq!(large, []);
        assert_eq!(query(&throng, at(1e15)), [1]);
        assert_eq!(query(&throng, at(-1e300)), [2]);
        let all = Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
        assert_eq!(query(&throng, all), [0, 1, 2]);
    }
}
