//! Which pairs of pieces have a contact.

use crate::PieceIx;
use std::collections::BTreeSet;

/// Partners in a list. Boxes in a pile have six, and rarely more than eight.
const ROOM: usize = 14;

/// Partners of each piece, in lists of both pieces: movers are asked about others one after the other,
/// and have theirs at hand. What has many (a floor) is in the lists of the many.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    lists: Vec<Partners>,
    /// Pairs that neither of the two lists had room for, the lesser piece first.
    rest: BTreeSet<[PieceIx; 2]>,
}

/// A cache line: pieces are compared all at once.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Partners {
    pieces: [PieceIx; ROOM],
    len: u32,
    /// Partners that are not in the list.
    missing: u32,
}

impl Partners {
    const NONE: Self = Self {
        pieces: [PieceIx::NONE; ROOM],
        len: 0,
        missing: 0,
    };

    fn contains(&self, piece: PieceIx) -> bool {
        let mut found = false;
        for other in self.pieces {
            found |= other == piece;
        }
        found
    }

    fn find(&self, piece: PieceIx) -> Option<usize> {
        let pieces = &self.pieces[..self.len as usize];
        pieces.iter().position(|other| *other == piece)
    }

    /// Whether there was room.
    fn insert(&mut self, piece: PieceIx) -> bool {
        let at = self.len as usize;
        let room = at < ROOM;
        if room {
            self.pieces[at] = piece;
            self.len += 1;
        } else {
            self.missing += 1;
        }
        room
    }

    /// Whether it was there.
    fn remove(&mut self, piece: PieceIx) -> bool {
        let found = self.find(piece);
        if let Some(at) = found {
            self.len -= 1;
            let last = self.len as usize;
            self.pieces[at] = self.pieces[last];
            self.pieces[last] = PieceIx::NONE;
        } else {
            self.missing -= 1;
        }
        found.is_some()
    }
}

impl Pairs {
    /// Whether a pair has a contact; the first had better be the one that is asked about more often.
    pub(crate) fn contains(&self, [a, b]: [PieceIx; 2]) -> bool {
        let Some(of_a) = self.lists.get(a.at()) else {
            return false;
        };
        of_a.contains(b) || of_a.missing > 0 && self.contains_otherwise([a, b])
    }

    /// Whether it does where the list of A may lack B.
    fn contains_otherwise(&self, [a, b]: [PieceIx; 2]) -> bool {
        // A piece that never had a contact has no list.
        self.lists.get(b.at()).is_some_and(|of_b| {
            of_b.contains(a) || of_b.missing > 0 && self.rest.contains(&in_order([a, b]))
        })
    }

    /// A pair without a contact gets one.
    pub(crate) fn insert(&mut self, [a, b]: [PieceIx; 2]) {
        let len = a.max(b).at() + 1;
        if self.lists.len() < len {
            self.lists.resize(len, Partners::NONE);
        }
        let in_a = self.lists[a.at()].insert(b);
        let in_b = self.lists[b.at()].insert(a);
        if !in_a && !in_b {
            self.rest.insert(in_order([a, b]));
        }
    }

    /// A pair with a contact has none any more.
    pub(crate) fn remove(&mut self, [a, b]: [PieceIx; 2]) {
        let in_a = self.lists[a.at()].remove(b);
        let in_b = self.lists[b.at()].remove(a);
        if !in_a && !in_b {
            self.rest.remove(&in_order([a, b]));
        }
    }
}

fn in_order([a, b]: [PieceIx; 2]) -> [PieceIx; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_agree_with_a_set() {
        let (mut pairs, mut set) = (Pairs::default(), BTreeSet::new());
        let mut random = 7u32;
        let mut full = 0;
        for step in 0..40_000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let (a, b) = (PieceIx(random >> 27), PieceIx(random >> 22 & 31));
            let pair = in_order([a, b]);
            // Lists fill, and empty again.
            let inserts = (random >> 8 & 63) < if step / 2000 % 2 == 0 { 48 } else { 16 };
            if a == b {
                continue;
            }
            match (inserts, set.contains(&pair)) {
                (true, false) => {
                    pairs.insert(pair);
                    set.insert(pair);
                }
                (false, true) => {
                    pairs.remove(pair);
                    set.remove(&pair);
                }
                _ => {}
            }
            full += usize::from(!pairs.rest.is_empty());
            let probe = [random >> 10 & 31, random >> 5 & 31].map(PieceIx);
            assert_eq!(pairs.contains(probe), set.contains(&in_order(probe)));
        }
        assert!(full > 1000, "{full}");
    }

    #[test]
    fn a_piece_without_contacts_is_in_no_full_list() {
        let mut pairs = Pairs::default();
        for other in 1..40 {
            pairs.insert([PieceIx(0), PieceIx(other)]);
        }
        let contains = |a, b| pairs.contains([PieceIx(a), PieceIx(b)]);
        assert!(contains(0, 39) && contains(39, 0));
        assert!(!contains(0, 40) && !contains(40, 0));
    }
}
