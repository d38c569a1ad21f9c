//! A round through pairs, in order of their places.
//!
//! What is asked of a pair lies by place, so a round from the first to the last reads it from front to back, as the
//! caches like it; body by body the same is read criss-cross.

use crate::World;
use crate::pairs::Glance;

/// A round goes through all places, and not through the lists of those who moved, if there are at most so many places for each
/// of them: in a pile that moves as a whole there are three or four.
const ALL: usize = 8;

/// Pairs that a round goes through, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct Round {
    /// A bit for each place: pairs that are still to be updated.
    left: Vec<u64>,
    /// Words before this one have none left.
    at: usize,
    /// Who moved: scratch.
    moved: Marks,
}

/// A bit for each body that is marked.
#[derive(Clone, Debug, Default)]
struct Marks(Vec<u64>);

impl Marks {
    /// Marks these bodies, and nobody else.
    fn mark(&mut self, bodies: impl Iterator<Item = u32> + Clone) {
        let last = bodies.clone().max().map_or(0, |last| bit_of(last).0);
        self.0.clear();
        self.0.resize(last + 1, 0);
        for body in bodies {
            let (word, bit) = bit_of(body);
            self.0[word] |= bit;
        }
    }

    /// 1 if one of two is marked, and 0 if not.
    #[inline]
    fn either(&self, (a, b): (u32, u32)) -> u64 {
        let one = |body: u32| {
            let word = self.0.get(bit_of(body).0);
            word.map_or(0, |word| word >> (body % 64))
        };
        (one(a) | one(b)) & 1
    }
}

impl World {
    /// The round, which has just begun, goes through all pairs of these bodies.
    pub(super) fn note_pairs(
        &self,
        round: &mut Round,
        bodies: impl ExactSizeIterator<Item = u32> + Clone,
    ) {
        let glances = self.pairs.glances();
        if glances.len() <= ALL * bodies.len() {
            round.note_all(bodies, glances);
        } else {
            for place in bodies.flat_map(|index| &self.bodies.get(index).pairs) {
                round.note(*place);
            }
        }
    }
}

impl Round {
    /// A new round begins.
    pub(super) fn begin(&mut self) {
        self.left.clear();
        self.at = 0;
    }

    /// The round goes through this pair, too.
    fn note(&mut self, place: u32) {
        let (word, bit) = bit_of(place);
        if self.left.len() <= word {
            self.left.resize(word + 1, 0);
        }
        self.left[word] |= bit;
    }

    /// The round goes through all pairs of these bodies: the same as [`Self::note`] of each of them, without their lists.
    fn note_all(&mut self, moved: impl Iterator<Item = u32> + Clone, glances: &[Glance]) {
        self.moved.mark(moved);
        self.left.extend(glances.chunks(64).map(|glances| {
            let bits = glances.iter().zip(0..);
            bits.fold(0, |word, (glance, bit)| {
                word | self.moved.either(glance.bodies) << bit
            })
        }));
    }
}

/// Which word a bit lies in, and as what.
const fn bit_of(at: u32) -> (usize, u64) {
    (at as usize / 64, 1 << (at % 64))
}

impl Iterator for Round {
    type Item = u32;

    /// The lowest place that is left.
    fn next(&mut self) -> Option<u32> {
        let words = self.left.get(self.at..)?;
        self.at += words.iter().position(|word| *word != 0)?;
        let word = &mut self.left[self.at];
        let bit = word.trailing_zeros();
        *word &= *word - 1;
        #[expect(clippy::cast_possible_truncation, reason = "places are u32")]
        let place = self.at as u32 * 64 + bit;
        Some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_is_asked_once_in_order() {
        let mut round = Round::default();
        round.begin();
        for place in [200, 3, 64, 3, 63] {
            round.note(place);
        }
        let all: Vec<u32> = round.by_ref().collect();
        assert_eq!(all, [3, 63, 64, 200]);
        assert_eq!(round.next(), None);
        round.begin();
        assert_eq!(round.next(), None);
        round.note(5);
        assert_eq!(round.next(), Some(5));
    }

    #[test]
    fn all_pairs_of_bodies_are_those_of_their_lists() {
        let ends = |k: u32| (k * 7 % 190, k * 13 % 331);
        let mut glances: Vec<Glance> = (0..1000).map(|k| Glance::of(ends(k))).collect();
        glances[500] = Glance::NONE;
        let moved = [3, 64, 5, 189, 130, 200];
        let lists = moved.iter().flat_map(|body| {
            (0..1000).filter(move |k| *k != 500 && (ends(*k).0 == *body || ends(*k).1 == *body))
        });
        let (mut by_lists, mut by_places) = (Round::default(), Round::default());
        lists.for_each(|place| by_lists.note(place));
        by_places.note_all(moved.into_iter(), &glances);
        let expected: Vec<u32> = by_lists.collect();
        assert!(expected.len() > 20);
        // Who is noted again was noted.
        by_places.note(expected[7]);
        assert_eq!(by_places.collect::<Vec<u32>>(), expected);
    }
}
