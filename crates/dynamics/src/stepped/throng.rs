//! Bodies on their courses, laid out for a search by many of them at once.
//!
//! Their boxes lie in bands, each in that of its lower side and in order of its left side. Two bands are swept from left to
//! right together, so that of two boxes the one that begins first is held against all that begin before it ends: every two
//! that overlap are found once. A box reaches from its own band into those up to its upper side.

use carom_geometry::Aabb;

use super::courses::{Goer, Mover};

/// Boxes of more than so many times the mean size have no place.
const LARGE: f64 = 4.0;

/// All who are on their courses.
#[derive(Clone, Debug)]
pub(super) struct Throng {
    members: Vec<Member>,
    /// Largest box that has a place.
    limit: f64,
    /// Member of each shape; `u32::MAX`: none.
    by_shape: Vec<u32>,
    /// Height of a band.
    height: f64,
    bands: Vec<Band>,
    /// Boxes of members, band by band from left to right, how they move, and whose they are.
    boxes: Vec<Aabb>,
    movers: Vec<(Mover, u32)>,
    /// Shapes that each member may meet, of those that it looks for, in order.
    found: Vec<u32>,
    /// Where those of each member begin, and where the last ones end.
    places: Vec<u32>,
    /// Which of those found are pairs already.
    known: Vec<bool>,
    /// Members that may meet, whoever looks first: scratch.
    meetings: Vec<(u32, u32)>,
}

/// A shape of a body on its course.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) fat: Aabb,
    pub(super) goer: Goer,
}

/// Boxes whose lower sides lie at about one height.
#[derive(Clone, Copy, Debug)]
struct Band {
    level: i64,
    /// Highest that one of them reaches into.
    top: i64,
    from: usize,
    to: usize,
}

impl Default for Throng {
    fn default() -> Self {
        Self {
            members: Vec::new(),
            limit: f64::INFINITY,
            by_shape: Vec::new(),
            height: 1.0,
            bands: Vec::new(),
            boxes: Vec::new(),
            movers: Vec::new(),
            found: Vec::new(),
            places: Vec::new(),
            known: Vec::new(),
            meetings: Vec::new(),
        }
    }
}

impl Throng {
    /// Whether a box has a place.
    pub(super) fn takes(&self, bounds: Aabb) -> bool {
        size_of(bounds) <= self.limit
    }

    /// Lays out all who are there; says whose boxes are too large from now on.
    pub(super) fn lay_out(&mut self, members: impl Iterator<Item = Member>) -> Vec<u32> {
        for member in &self.members {
            self.by_shape[member.goer.at as usize] = u32::MAX;
        }
        self.members.clear();
        self.members.extend(members);
        let sizes = self.members.iter().map(|member| size_of(member.fat));
        #[expect(clippy::cast_precision_loss, reason = "a count of shapes")]
        let mean = sizes.sum::<f64>() / self.members.len() as f64;
        self.limit = if self.members.is_empty() {
            f64::INFINITY
        } else {
            LARGE * mean
        };
        self.height = mean.max(f64::MIN_POSITIVE);
        let mut large = Vec::new();
        let limit = self.limit;
        self.members.retain(|member| {
            let fits = size_of(member.fat) <= limit;
            if !fits {
                large.push(member.goer.at);
            }
            fits
        });
        for (k, member) in (0_u32..).zip(&self.members) {
            let at = member.goer.at as usize;
            if self.by_shape.len() <= at {
                self.by_shape.resize(at + 1, u32::MAX);
            }
            self.by_shape[at] = k;
        }
        self.lay_bands();
        self.found.clear();
        self.places.clear();
        self.places.resize(self.members.len() + 1, 0);
        large
    }

    /// Forgets who was laid out, with the room that they took; what is too large stays so.
    pub(super) fn clear(&mut self) {
        *self = Self {
            limit: self.limit,
            height: self.height,
            ..Self::default()
        };
    }

    fn lay_bands(&mut self) {
        let height = self.height;
        let all = (0_u32..).zip(&self.members);
        let mut order: Vec<(u128, u32)> = all
            .map(|(k, member)| (key(member.fat, height), k))
            .collect();
        order.sort_unstable();
        self.bands.clear();
        self.boxes.clear();
        self.movers.clear();
        for (i, (_, k)) in order.into_iter().enumerate() {
            let member = &self.members[k as usize];
            let own = level(member.fat.min.y, height);
            if self.bands.last().is_none_or(|band| band.level != own) {
                self.bands.push(Band {
                    level: own,
                    top: own,
                    from: i,
                    to: i,
                });
            }
            if let Some(band) = self.bands.last_mut() {
                band.top = band.top.max(level(member.fat.max.y, height));
                band.to = i + 1;
            }
            self.boxes.push(member.fat);
            self.movers.push((member.goer.mover(), k));
        }
    }

    /// Finds for all who set out whom they may meet, as `may_meet` has it. Of two who set out together the lower body
    /// looks for the other.
    pub(super) fn seek(&mut self, may_meet: impl Fn(&Goer, &Goer) -> bool) {
        let mut meetings = core::mem::take(&mut self.meetings);
        meetings.clear();
        let (members, movers) = (&self.members, &self.movers);
        self.sweep(|i, j| {
            let ((one, k), (two, l)) = (&movers[i], &movers[j]);
            if !(one.sets_out || two.sets_out) || one.plainly_misses(two) {
                return;
            }
            let (mine, other) = (&members[*k as usize].goer, &members[*l as usize].goer);
            if mine.body != other.body && may_meet(mine, other) {
                let first = mine.looks_for(other);
                meetings.push(if first { (*k, other.at) } else { (*l, mine.at) });
            }
        });
        // Sorted by counting.
        for (k, _) in &meetings {
            self.places[*k as usize] += 1;
        }
        let mut end = 0;
        for place in &mut self.places {
            end += *place;
            *place = end;
        }
        self.found.clear();
        self.found.resize(meetings.len(), 0);
        for &(k, other) in &meetings {
            let place = &mut self.places[k as usize];
            *place -= 1;
            self.found[*place as usize] = other;
        }
        for ends in self.places.windows(2) {
            self.found[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        self.known.clear();
        self.known.resize(self.found.len(), false);
        self.meetings = meetings;
    }

    /// Calls `found` with every two that overlap, as they lie from left to right in their bands.
    fn sweep(&self, mut found: impl FnMut(usize, usize)) {
        for (b, low) in self.bands.iter().enumerate() {
            for i in low.from..low.to {
                self.sweep_from(i, i + 1, low.to, &mut found);
            }
            let above = self.bands[b + 1..].iter();
            for high in above.take_while(|high| high.level <= low.top) {
                let (mut i, mut j) = (low.from, high.from);
                while i < low.to && j < high.to {
                    if self.boxes[i].min.x <= self.boxes[j].min.x {
                        self.sweep_from(i, j, high.to, &mut found);
                        i += 1;
                    } else {
                        self.sweep_from(j, i, low.to, &mut found);
                        j += 1;
                    }
                }
            }
        }
    }

    /// One box against those from `from` on that begin before it ends.
    #[inline]
    fn sweep_from(&self, i: usize, from: usize, to: usize, found: &mut impl FnMut(usize, usize)) {
        let mine = self.boxes[i];
        for (j, other) in (from..to).zip(&self.boxes[from..to]) {
            if other.min.x > mine.max.x {
                break;
            }
            if other.min.y <= mine.max.y && mine.min.y <= other.max.y {
                found(i, j);
            }
        }
    }

    /// Whether two shapes of a pair may go on to meet, and notes that they are one; `None`: not both were laid out.
    pub(super) fn recognises(&mut self, (one, two): (u32, u32)) -> Option<bool> {
        let member = |at: u32| self.by_shape.get(at as usize).copied();
        let (k, l) = (member(one)?, member(two)?);
        let (one, two) = (self.members.get(k as usize)?, self.members.get(l as usize)?);
        let (mine, other) = (&one.goer, &two.goer);
        // Of two who set out together the first one saw to it.
        let (k, other) = if mine.looks_for(other) {
            (k as usize, other)
        } else if other.looks_for(mine) {
            (l as usize, mine)
        } else {
            return Some(true);
        };
        let from = self.places[k] as usize;
        let found = &self.found[from..self.places[k + 1] as usize];
        let at = found.iter().position(|at| *at == other.at);
        if let Some(at) = at {
            self.known[from + at] = true;
        }
        Some(at.is_some())
    }

    /// Whom a shape may meet, of those that it looks for and that are no pairs with it yet; `None`: it was not laid out.
    pub(super) fn strangers(&self, at: u32) -> Option<impl Iterator<Item = u32>> {
        let k = *self.by_shape.get(at as usize)? as usize;
        let (from, to) = (*self.places.get(k)?, *self.places.get(k + 1)?);
        let all = from as usize..to as usize;
        let found = self.found.get(all.clone())?.iter().zip(&self.known[all]);
        Some(found.filter(|(_, known)| !**known).map(|(other, _)| *other))
    }

    /// Calls `found` with all whose boxes overlap `sought`.
    pub(super) fn query(&self, sought: Aabb, mut found: impl FnMut(&Goer)) {
        let (low, high) = (
            level(sought.min.y, self.height),
            level(sought.max.y, self.height),
        );
        let bands = self.bands.iter().take_while(|band| band.level <= high);
        for band in bands.filter(|band| band.top >= low) {
            let boxes = &self.boxes[band.from..band.to];
            let movers = &self.movers[band.from..band.to];
            let begun = boxes.partition_point(|fat| fat.min.x <= sought.max.x);
            for (fat, (_, k)) in boxes[..begun].iter().zip(movers) {
                if fat.overlaps(sought) {
                    found(&self.members[*k as usize].goer);
                }
            }
        }
    }
}

/// Which band a height lies in. What is not lower lies in no lower band, however heights are rounded.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "beyond 2⁵³ all are integers, and beyond 2⁶³ all are in one band"
)]
fn level(y: f64, height: f64) -> i64 {
    let y = y / height;
    let near = y as i64;
    near.saturating_sub(i64::from(near as f64 > y))
}

/// By band, and from left to right: a number that is as large as they are far on, for a sort without branches.
fn key(fat: Aabb, height: f64) -> u128 {
    let band = level(fat.min.y, height).cast_unsigned() ^ (1 << 63);
    // No −0, which lies where 0 does. Of negative numbers all bits turn, of others the sign alone.
    let bits = (fat.min.x + 0.0).to_bits();
    let across = bits ^ ((bits.cast_signed() >> 63).cast_unsigned() | 1 << 63);
    u128::from(band) << 64 | u128::from(across)
}

/// Width and height of a box, in m, whichever is more.
fn size_of(bounds: Aabb) -> f64 {
    let size = bounds.max - bounds.min;
    size.x.max(size.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::{Vec2, vec2};
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
            goer: Goer::setting_out(at),
        });
        let mut throng = Throng::default();
        let large = throng.lay_out(members);
        throng.seek(|_, _| true);
        (throng, large)
    }

    fn query(throng: &Throng, sought: Aabb) -> Vec<u32> {
        let mut found = Vec::new();
        throng.query(sought, |goer| found.push(goer.at));
        found.sort_unstable();
        found
    }

    proptest! {
        /// What each against each finds is found once, but for those whose boxes are too large.
        #[test]
        fn nobody_is_missed(all in boxes(100), shift in prop_oneof![Just(0.0), Just(1e6), Just(-1e12), Just(1e300)]) {
            let shift = vec2(shift, shift);
            let all: Vec<Aabb> = all.into_iter().map(|b| Aabb::new(b.min + shift, b.max + shift)).collect();
            let (throng, large) = lay_out(&all);
            for (own, sought) in (0_u32..).zip(&all) {
                let expected: Vec<u32> = (0_u32..)
                    .zip(&all)
                    .filter(|(at, bounds)| bounds.overlaps(*sought) && !large.contains(at))
                    .map(|(at, _)| at)
                    .collect();
                prop_assert_eq!(query(&throng, *sought), expected.clone());
                // The lower one of two looks for the other.
                let later: Vec<u32> = expected.into_iter().filter(|at| *at > own).collect();
                let partners = throng.strangers(own).map(Iterator::collect);
                prop_assert_eq!(partners, (!large.contains(&own)).then_some(later));
            }
        }
    }

    /// Who comes after an empty tick finds a place.
    #[test]
    fn an_empty_throng_takes_everybody() {
        let (throng, _) = lay_out(&[]);
        assert!(throng.takes(Aabb::new(Vec2::ZERO, Vec2::splat(1e9))));
        assert_eq!(query(&throng, Aabb::new(Vec2::ZERO, Vec2::ONE)), []);
        assert_eq!(throng.strangers(0).map(Iterator::count), None);
    }

    #[test]
    fn who_is_too_large_stays_so_when_all_are_forgotten() {
        let at = |x: f64, size: f64| Aabb::new(vec2(x, 0.0), vec2(x + size, size));
        let all: Vec<Aabb> = (0..50).map(|i| at(2.0 * f64::from(i), 1.0)).collect();
        let (mut throng, _) = lay_out(&all);
        throng.clear();
        assert!(throng.takes(at(0.0, 3.0)) && !throng.takes(at(0.0, 5.0)));
        assert_eq!(throng.strangers(0).map(Iterator::count), None);
        assert_eq!(query(&throng, at(0.0, 3.0)), []);
        assert_eq!(throng.members.capacity(), 0);
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
