//! Which of the pairs that no list has room for have a contact.

/// A hash table from pairs of numbers to contacts, with linear probing; it is never iterated over.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// The pair, or [`Table::NONE`], and its contact. A power of two, at most half full.
    slots: Vec<(u64, u32)>,
    len: usize,
}

impl Table {
    const NONE: u64 = u64::MAX;

    pub(super) fn new() -> Self {
        Self {
            slots: vec![(Self::NONE, 0); 16],
            len: 0,
        }
    }

    /// The contact of a pair, in either order.
    pub(super) fn get(&self, pair: [u32; 2]) -> Option<u32> {
        let (key, contact) = self.slots[self.find(key(pair))];
        (key != Self::NONE).then_some(contact)
    }

    pub(super) fn insert(&mut self, pair: [u32; 2], contact: u32) {
        if 2 * (self.len + 1) > self.slots.len() {
            let empty = vec![(Self::NONE, 0); 2 * self.slots.len()];
            for slot in core::mem::replace(&mut self.slots, empty) {
                if slot.0 != Self::NONE {
                    let at = self.find(slot.0);
                    self.slots[at] = slot;
                }
            }
        }
        let at = self.find(key(pair));
        self.len += usize::from(self.slots[at].0 == Self::NONE);
        self.slots[at] = (key(pair), contact);
    }

    pub(super) fn remove(&mut self, pair: [u32; 2]) {
        let mut hole = self.find(key(pair));
        if self.slots[hole].0 == Self::NONE {
            return;
        }
        self.len -= 1;
        self.slots[hole].0 = Self::NONE;
        // What came after it in the same run may have been pushed past the hole.
        let mask = self.slots.len() - 1;
        let mut at = hole;
        loop {
            at = (at + 1) & mask;
            let slot = self.slots[at];
            if slot.0 == Self::NONE {
                return;
            }
            let home = self.home(slot.0);
            if (at.wrapping_sub(home) & mask) >= (at.wrapping_sub(hole) & mask) {
                self.slots[hole] = slot;
                self.slots[at].0 = Self::NONE;
                hole = at;
            }
        }
    }

    /// Where a key is, or would be.
    fn find(&self, key: u64) -> usize {
        let mask = self.slots.len() - 1;
        let mut at = self.home(key);
        while self.slots[at].0 != key && self.slots[at].0 != Self::NONE {
            at = (at + 1) & mask;
        }
        at
    }

    /// Fibonacci hashing: the upper bits of key × 2⁶⁴/φ.
    fn home(&self, key: u64) -> usize {
        let hash = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize;
        hash & (self.slots.len() - 1)
    }
}

fn key([a, b]: [u32; 2]) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn table_agrees_with_a_map() {
        let (mut table, mut map) = (Table::new(), BTreeMap::new());
        let mut random = 7u32;
        for step in 0..20_000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let pair = [random >> 27, random >> 22 & 31];
            if random & 1 == 0 {
                table.insert(pair, step);
                map.insert(key(pair), step);
            } else {
                table.remove(pair);
                map.remove(&key(pair));
            }
            let probe = [random >> 10 & 31, random >> 5 & 31];
            assert_eq!(table.get(probe), map.get(&key(probe)).copied());
            assert_eq!(table.len, map.len());
        }
    }
}
