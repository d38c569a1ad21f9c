//! Entries of the days of a year, unordered.

use carom_math::SimTime;

use super::queue::{Entry, What};

/// Entries of a block: with its link it fills a line of a cache. Most days have one or two: larger blocks would be empty for
/// the most part.
const BLOCK: usize = 2;

/// Blocks that room is made for at once: what grew by doubling would leave holes of half its size.
const CHUNK: usize = 128;

/// No block.
const NONE: u32 = u32::MAX;

/// A list of blocks a day. Blocks of days that are over are the first to be used again, so that what is written is still in
/// the cache, and there is room for what waits, not for the fullest that every day has been.
#[derive(Clone, Debug)]
pub(super) struct Days {
    /// The newest block of every day.
    first: Vec<u32>,
    chunks: Vec<Box<[Block; CHUNK]>>,
    /// Blocks that were ever used.
    used: u32,
    /// The newest of the unused ones among them.
    free: u32,
    /// Entries of all days.
    count: usize,
}

#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Block {
    entries: [Waiting; BLOCK],
    /// How many of them count.
    len: u32,
    /// The next older of the same list.
    next: u32,
}

impl Block {
    const EMPTY: Self = Self {
        entries: [Waiting {
            rest: 0.0,
            a: 0,
            b: 0,
            stamp: 0,
            what: What::HORIZON,
        }; BLOCK],
        len: 0,
        next: NONE,
    };
}

/// An entry of a known day: whole units of time are those before the day.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    rest: f64,
    a: u32,
    b: u32,
    stamp: u32,
    what: What,
}

impl From<Entry> for Waiting {
    fn from(entry: Entry) -> Self {
        Self {
            rest: entry.time.rest(),
            a: entry.a,
            b: entry.b,
            stamp: entry.stamp,
            what: entry.what,
        }
    }
}

impl Waiting {
    const fn after(self, units: i64) -> Entry {
        Entry {
            time: SimTime::of_parts(units, self.rest),
            a: self.a,
            b: self.b,
            stamp: self.stamp,
            what: self.what,
        }
    }
}

impl Days {
    pub(super) fn new(days: usize) -> Self {
        Self {
            first: vec![NONE; days],
            chunks: Vec::new(),
            used: 0,
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
        if first != NONE {
            let block = self.block(first);
            if let Some(room) = block.entries.get_mut(block.len as usize) {
                *room = entry.into();
                block.len += 1;
                return;
            }
        }
        let at = self.unused();
        self.first[day] = at;
        let block = self.block(at);
        block.entries[0] = entry.into();
        (block.len, block.next) = (1, first);
    }

    /// Takes the entries of a day out, before which there are `units` whole units of time.
    pub(super) fn take(&mut self, day: usize, units: i64, mut each: impl FnMut(Entry)) {
        let mut at = core::mem::replace(&mut self.first[day], NONE);
        while at != NONE {
            let free = core::mem::replace(&mut self.free, at);
            let block = self.block(at);
            let len = core::mem::take(&mut block.len) as usize;
            let entries = block.entries[..len].iter();
            entries.for_each(|waiting| each(waiting.after(units)));
            let next = core::mem::replace(&mut block.next, free);
            self.count -= len;
            at = next;
        }
    }

    /// All days are empty: frees the memory unused since the last call, so that a pile that landed leaves none behind.
    pub(super) fn give_back(&mut self) {
        debug_assert_eq!(self.count, 0, "every day was taken");
        self.chunks.truncate((self.used as usize).div_ceil(CHUNK));
        (self.used, self.free) = (0, NONE);
    }

    /// An empty block.
    fn unused(&mut self) -> u32 {
        if self.free != NONE {
            let at = self.free;
            self.free = self.block(at).next;
            return at;
        }
        let at = self.used;
        if at as usize == CHUNK * self.chunks.len() {
            self.chunks.push(Box::new([Block::EMPTY; CHUNK]));
        }
        self.used += 1;
        at
    }

    fn block(&mut self, at: u32) -> &mut Block {
        &mut self.chunks[at as usize / CHUNK][at as usize % CHUNK]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_block_is_a_line() {
        assert_eq!(size_of::<Block>(), 64);
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
                    days.take(day, 3, |entry| found.push(entry));
                    found.sort_unstable();
                    prop_assert_eq!(found, core::mem::take(&mut twin[day]));
                } else {
                    let (time, what) = (SimTime::of_parts(3, 1e-3), What::HORIZON);
                    let entry = Entry { time, a, b: a, stamp: 0, what };
                    days.push(day, entry);
                    twin[day].push(entry);
                }
                let count: usize = twin.iter().map(Vec::len).sum();
                prop_assert_eq!(days.count(), count);
                most = most.max(twin.iter().map(|day| day.len().div_ceil(BLOCK)).sum());
            }
            prop_assert_eq!(days.used as usize, most);

            // Once all are empty there is room for as many as came since that was last so.
            for day in 0..5 {
                days.take(day, 3, |_| ());
            }
            days.give_back();
            prop_assert_eq!(days.chunks.len(), most.div_ceil(CHUNK));
            for a in 0..7 {
                let (time, what) = (SimTime::of_parts(3, 1e-3), What::HORIZON);
                days.push(2, Entry { time, a, b: a, stamp: 0, what });
            }
            let mut found = 0;
            days.take(2, 3, |_| found += 1);
            prop_assert_eq!(found, 7);
            days.give_back();
            prop_assert_eq!(days.chunks.len(), 1);
            days.give_back();
            prop_assert_eq!(days.chunks.len(), 0);
        }
    }
}
