//! The calendar queue of free bodies: events in order of time.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use carom_math::SimTime;

use crate::{BodyIx, ColliderIx, ImpactIx, Ix};

/// What happens at an entry's time, if the bodies still move as they did; at equal times in this order, impacts by their slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct What(u32);

impl What {
    /// The search for free bodies that `a` meets reaches no further.
    pub(super) const HORIZON: Self = Self(0);
    /// The search for what does not fly reaches no further.
    pub(super) const GROUND: Self = Self(1);
    /// From now on free bodies `a` and `b` are near enough to meet.
    pub(super) const NEAR: Self = Self(2);
    /// From now on free body `a` is near enough to meet shape `b` of a body that does not fly.
    pub(super) const NEAR_SHAPE: Self = Self(3);
    /// The impacts of bodies `a` and `b`, ever faster, end here.
    pub(super) const COLLAPSE: Self = Self(4);
    /// Body `a` strikes body `b`, as the first slot says.
    const IMPACT: Self = Self(5);

    pub(super) fn impact(slot: ImpactIx) -> Self {
        Self(Self::IMPACT.0 + slot.number())
    }

    /// Of an impact.
    pub(super) fn slot(self) -> Option<ImpactIx> {
        self.0.checked_sub(Self::IMPACT.0).map(ImpactIx::new)
    }
}

/// An entry of the queue: half a line of a cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub(crate) time: SimTime,
    pub(crate) a: BodyIx,
    /// Number of body or shape `b`, as `what` says.
    pub(crate) b: u32,
    /// Sum of the two bodies' versions: versions only grow, so that it is equal only if both are.
    pub(crate) stamp: u32,
    pub(crate) what: What,
}

impl Entry {
    /// Body `b`.
    pub(super) fn other(&self) -> BodyIx {
        BodyIx::new(self.b)
    }

    /// Shape `b`.
    pub(super) fn shape(&self) -> ColliderIx {
        ColliderIx::new(self.b)
    }
}

impl Ord for Entry {
    /// Equal times are taken in order of bodies, never of insertion.
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |entry: &Self| (entry.time, entry.a, entry.b, entry.what, entry.stamp);
        key(self).cmp(&key(other))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Days of a year: entries within it have a list a day.
const YEAR: u64 = 4096;

/// Entries a day that the length of a day is chosen for: more, and a day's heap is deep; fewer, and
/// most days are looked at in vain.
const ENTRIES_PER_DAY: core::ops::Range<u64> = 8..64;

/// Entries of one day that it is cut for at once, instead of at the end of the year.
const MOST_PER_DAY: usize = 256;

/// The shortest day is 2⁻⁶ s / 2^20.
const SHORTEST: u32 = 20;

/// A calendar: a heap for today, a list for every day of the year, one list for all that is later.
///
/// Entries are dropped at the start of their day if they are stale by then, so that most of them never
/// see a heap. Order does not depend on the length of a day. After R. Brown, *Calendar queues* (1988).
#[derive(Clone, Debug)]
pub(crate) struct Queue {
    /// A day is 2⁻⁶ s / 2^shift.
    shift: u32,
    /// Number of today.
    today: u64,
    /// The last day of the year.
    last: u64,
    due: BinaryHeap<Reverse<Entry>>,
    /// Unordered. A day that is over leaves no memory: there is room for what waits, not for the fullest that every day has been.
    days: Vec<Vec<Entry>>,
    /// Entries of all days.
    waiting: usize,
    later: Vec<Entry>,
    /// Entries of the days that came this year, stale or not.
    come: u64,
}

impl Default for Queue {
    fn default() -> Self {
        Self {
            shift: 0,
            today: 0,
            last: YEAR - 1,
            due: BinaryHeap::new(),
            days: vec![Vec::new(); slot(YEAR - 1) + 1],
            waiting: 0,
            later: Vec::new(),
            come: 0,
        }
    }
}

impl Queue {
    pub(crate) fn push(&mut self, entry: Entry) {
        let day = entry.time.bin(self.shift);
        if day <= self.today {
            self.due.push(Reverse(entry));
        } else if day <= self.last {
            self.waiting += 1;
            self.days[slot(day)].push(entry);
        } else {
            self.later.push(entry);
        }
    }

    /// When the next entry is due, if that is by `limit`; `stale` says what may be dropped, and is told
    /// everything once that is.
    pub(crate) fn next(
        &mut self,
        limit: SimTime,
        mut stale: impl FnMut(&Entry) -> bool,
    ) -> Option<SimTime> {
        while self.due.is_empty() {
            let end = limit.bin(self.shift);
            if self.today >= end || self.waiting == 0 && self.later.is_empty() {
                return None;
            }
            if self.waiting == 0 {
                self.turn_the_year(end, &mut stale);
            } else if self.today == self.last {
                self.turn_the_year(self.last + 1, &mut stale);
            } else {
                self.today += 1;
            }
            self.open(&mut stale);
            while self.is_overfull() {
                self.refine();
                self.open(&mut stale);
            }
        }
        let Reverse(first) = self.due.peek()?;
        (first.time <= limit).then_some(first.time)
    }

    /// The first of today's.
    pub(crate) fn peek(&self) -> Option<&Entry> {
        self.due.peek().map(|Reverse(entry)| entry)
    }

    pub(crate) fn pop(&mut self) -> Option<Entry> {
        self.due.pop().map(|Reverse(entry)| entry)
    }

    /// Today's list becomes the heap.
    fn open(&mut self, stale: &mut impl FnMut(&Entry) -> bool) {
        let list = core::mem::take(&mut self.days[slot(self.today)]);
        self.waiting -= list.len();
        self.come += list.len() as u64;
        let fresh = list.into_iter().filter(|entry| !stale(entry));
        self.due.extend(fresh.map(Reverse));
    }

    /// A new year begins on the first day with an entry, or on `day` if that is earlier; its days are
    /// longer or shorter if those of the last one were empty or overfull. What is stale by now is not kept for years.
    fn turn_the_year(&mut self, day: u64, stale: &mut impl FnMut(&Entry) -> bool) {
        self.later.retain(|entry| !stale(entry));
        let days = self
            .today
            .saturating_sub(self.last.saturating_sub(YEAR - 1))
            + 1;
        let mean = self.come / days;
        let shift = if mean >= ENTRIES_PER_DAY.end && self.shift < SHORTEST {
            self.shift + 1
        } else if mean < ENTRIES_PER_DAY.start && self.shift > 0 {
            self.shift - 1
        } else {
            self.shift
        };
        self.begin_year(day, shift);
    }

    /// Whether today has so many entries that it should be cut, and there is something to cut.
    fn is_overfull(&self) -> bool {
        let mut times = self.due.iter().map(|Reverse(entry)| entry.time);
        self.due.len() > MOST_PER_DAY
            && self.shift < SHORTEST
            && times
                .next()
                .is_some_and(|first| times.any(|time| time != first))
    }

    /// A new year begins today, with days so short that a usual number of today's entries is in each.
    fn refine(&mut self) {
        let parts = self.due.len() / (MOST_PER_DAY / 8);
        self.later
            .extend(self.due.drain().map(|Reverse(entry)| entry));
        self.begin_year(self.today, (self.shift + parts.ilog2()).min(SHORTEST));
    }

    /// Sorts all that is not today's into the days of a year from `day` on, or from the first with an entry.
    fn begin_year(&mut self, day: u64, shift: u32) {
        let (old, mut later) = (self.shift, core::mem::take(&mut self.later));
        self.shift = shift;
        later.extend(self.days.iter_mut().flat_map(core::mem::take));
        self.waiting = 0;
        self.come = 0;
        let renamed = if shift >= old {
            day << (shift - old)
        } else {
            day >> (old - shift)
        };
        let first = later.iter().map(|entry| entry.time.bin(shift)).min();
        self.today = first.map_or(renamed, |first| first.min(renamed));
        self.last = self.today + (YEAR - 1);
        later.retain(|entry| {
            let day = entry.time.bin(shift);
            let waits = day > self.last;
            if !waits {
                self.waiting += 1;
                self.days[slot(day)].push(*entry);
            }
            waits
        });
        later.shrink_to(2 * later.len());
        self.later = later;
    }
}

const fn slot(day: u64) -> usize {
    (day % YEAR) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const POWERS: [f64; 6] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e6];

    fn entry(time: f64, a: u32) -> Entry {
        let (time, what) = (SimTime::from_secs(time), What::HORIZON);
        Entry {
            time,
            a: BodyIx::new(a),
            b: a,
            stamp: 0,
            what,
        }
    }

    #[test]
    fn four_bytes_hold_whatever_is_ahead_and_its_order() {
        let all = [What::HORIZON, What::GROUND, What::NEAR, What::NEAR_SHAPE];
        let slots = [0, 1, (1 << 29) - 1].map(ImpactIx::new);
        let all = [&all[..], &[What::COLLAPSE], &slots.map(What::impact)].concat();
        assert!(all.is_sorted() && all.windows(2).all(|two| two[0] != two[1]));
        assert!(all[..5].iter().all(|what| what.slot().is_none()));
        assert_eq!(slots.map(|slot| What::impact(slot).slot()), slots.map(Some));
        assert_eq!(size_of::<Entry>(), 32);
    }

    proptest! {
        /// The slow twin is a sorted list.
        #[test]
        fn entries_come_in_order_whatever_the_calendar(
            times in prop::collection::vec((0.0..1.0_f64, 0..6_usize), 1..400),
            step in 0.01..3.0_f64,
        ) {
            let (mut queue, mut list) = (Queue::default(), Vec::new());
            let (mut now, mut waiting) = (SimTime::ZERO, (0..).zip(&times));
            let mut left = times.len();
            while left > 0 {
                // Some are pushed now and then, up to 10⁶ s ahead.
                for (a, (part, power)) in waiting.by_ref().take(7) {
                    let ahead = entry(now.as_secs() + part * POWERS[*power], a);
                    queue.push(ahead);
                    list.push(ahead);
                }
                list.sort_unstable();
                let end = if list.len() < left { now + step } else { SimTime::from_secs(1e9) };
                while let Some(time) = queue.next(end, |_| false) {
                    let next = queue.pop().expect("it is due");
                    prop_assert_eq!(next, list.remove(0));
                    prop_assert!(next.time == time && time <= end);
                    left -= 1;
                }
                prop_assert!(list.first().is_none_or(|first| first.time > end));
                now = end;
            }
        }
    }

    /// They were left behind on the first part of the day that was cut, and came a year late.
    #[test]
    fn an_overfull_day_is_cut_without_losing_its_first_hour() {
        for together in [0.5, 0.500_001] {
            let mut queue = Queue::default();
            let times = (0..2000).map(|a| {
                if a < 1500 {
                    together
                } else {
                    0.5 + 1e-6 * f64::from(a)
                }
            });
            let mut list: Vec<Entry> = (0..).zip(times).map(|(a, time)| entry(time, a)).collect();
            for &entry in &list {
                queue.push(entry);
            }
            list.sort_unstable();
            let mut now = SimTime::ZERO;
            let mut found = Vec::new();
            for _ in 0..100 {
                now += 1.0 / 64.0;
                while queue.next(now, |_| false).is_some() {
                    found.extend(queue.pop());
                }
                assert!(
                    list[found.len()..]
                        .first()
                        .is_none_or(|next| next.time > now)
                );
            }
            assert_eq!(found, list);
        }
    }

    #[test]
    fn what_is_stale_on_its_day_never_comes() {
        let mut queue = Queue::default();
        for a in 0..100 {
            queue.push(entry(0.5 + 0.01 * f64::from(a), a));
        }
        let end = SimTime::from_secs(10.0);
        let mut seen = Vec::new();
        while queue.next(end, |entry| entry.a.number() % 3 != 0).is_some() {
            seen.extend(queue.pop().map(|entry| entry.a));
        }
        assert!(seen.iter().all(|a| a.number() % 3 == 0) && seen.len() == 34);
    }
}
