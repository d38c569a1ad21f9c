//! Entries of the days of a year, unordered.

use arrayvec::ArrayVec;

use super::queue::Entry;

/// Entries of a block: with its link it fills four lines of a cache.
const BLOCK: usize = 6;

/// No block.
const NONE: u32 = u32::MAX;

/// A list of blocks a day. Blocks of days that are over are the first to be used again, so that what is written is still in
/// the cache, and there is room for what waits, not for the fullest that every day has been.
#[derive(Clone, Debug)]
pub(super) struct Days {
    /// The newest block of every day.
    first: Vec<u32>,
    blocks: Vec<Block>,
    /// The newest of the unused blocks.
    free: u32,
    /// Entries of all days.
    count: usize,
}

#[derive(Clone, Debug)]
#[repr(align(64))]
struct Block {
    entries: ArrayVec<Entry, BLOCK>,
    /// The next older of the same list.
    next: u32,
}

impl Days {
    pub(super) fn new(days: usize) -> Self {
        Self {
            first: vec![NONE; days],
            blocks: Vec::new(),
            free: NONE,
            count: 0,
        }
    }

    /// Entries of all days.
    pub(super) const fn count(&self) -> usize {
        self.count
    }

    pub(super) fn push(&mut self, day: usize, entry: Entry) {
        self.count += 1;
        let first = self.first[day];
        if first == NONE || self.blocks[first as usize].entries.is_full() {
            self.first[day] = self.unused(first);
        }
        self.blocks[self.first[day] as usize].entries.push(entry);
    }

    /// Takes the entries of a day out.
    pub(super) fn take(&mut self, day: usize, mut each: impl FnMut(Entry)) {
        let mut at = core::mem::replace(&mut self.first[day], NONE);
        while at != NONE {
            let block = &mut self.blocks[at as usize];
            self.count -= block.entries.len();
            block.entries.drain(..).for_each(&mut each);
            let next = core::mem::replace(&mut block.next, self.free);
            self.free = at;
            at = next;
        }
    }

    /// An empty block before `next`.
    fn unused(&mut self, next: u32) -> u32 {
        if self.free != NONE {
            let block = &mut self.blocks[self.free as usize];
            let older = core::mem::replace(&mut block.next, next);
            return core::mem::replace(&mut self.free, older);
        }
        let entries = ArrayVec::new();
        self.blocks.push(Block { entries, next });
        #[expect(
            clippy::cast_possible_truncation,
            reason = "fewer than 2^32 fit in memory"
        )]
        let last = (self.blocks.len() - 1) as u32;
        last
    }
}

#[cfg(test)]
mod tests {
    use super::super::queue::Ahead;
    use super::*;
    use carom_math::SimTime;
    use proptest::prelude::*;

    #[test]
    fn a_block_is_four_lines() {
        assert_eq!(size_of::<Block>(), 256);
    }

    proptest! {
        /// The slow twin has a vector a day.
        #[test]
        fn a_day_has_what_was_pushed_since_it_was_taken(
            steps in prop::collection::vec((0..5_usize, any::<bool>()), 1..400),
        ) {
            let (mut days, mut twin) = (Days::new(5), vec![Vec::new(); 5]);
            let mut most = 0;
            for (a, (day, takes)) in (0..).zip(steps) {
                if takes && a % 3 == 0 {
                    let mut found = Vec::new();
                    days.take(day, |entry| found.push(entry));
                    found.sort_unstable();
                    prop_assert_eq!(found, core::mem::take(&mut twin[day]));
                } else {
                    let (time, ahead) = (SimTime::ZERO, Ahead::Horizon);
                    let entry = Entry { time, a, b: a, stamp: 0, ahead };
                    days.push(day, entry);
                    twin[day].push(entry);
                }
                let count: usize = twin.iter().map(Vec::len).sum();
                prop_assert_eq!(days.count(), count);
                most = most.max(twin.iter().map(|day| day.len().div_ceil(BLOCK)).sum());
            }
            prop_assert_eq!(days.blocks.len(), most);
        }
    }
}
