//! Which pairs of what lies at one place get a contact.
//!
//! Of n bodies at one place all n²/2 pairs overlap: 4.5 million of 3,000, 2 GB of rows. What is deep in [`ENOUGH`] others is parted
//! by these, and a pair of two such bodies waits until one of them is deep in fewer.

use crate::BodyIx;
use crate::bodies::Bodies;
use crate::pieces::Pieces;
use crate::rows::{Deep, Graph};
use crate::update::{Pair, place};

/// Contacts of a body that are too deep for the sweeps, from which on it needs no more of them with what has as many.
/// A hundred boxes at one place are apart after 3.0 s, with 1.2 J; 32: after 13.5 s, with 4.1 J; without it after 3.4 s, with 2.2 J.
const ENOUGH: u32 = 64;

/// So many pairs at least two bodies are in that may both come to have enough.
const PAIRS: usize = ENOUGH as usize * (ENOUGH as usize + 1) / 2;

/// By slot, how many contacts of a body are deep; nothing if none is.
#[derive(Debug)]
pub(crate) struct DeepCounts(Vec<u32>);

impl DeepCounts {
    pub(crate) fn of(deep: &Deep, graph: &Graph, bodies: &Bodies) -> Self {
        let mut counts = Self(Vec::new());
        for pair in deep.pairs(graph) {
            counts.add(bodies, pair);
        }
        counts
    }

    /// There is one more between the bodies of these slots.
    pub(crate) fn add(&mut self, bodies: &Bodies, pair: [BodyIx; 2]) {
        self.0.resize(bodies.records.len(), 0);
        for slot in pair {
            self.0[slot.at()] += 1;
        }
    }

    /// Whether the bodies of a pair ask for a contact; those that have enough are noted, by slot, where they do not.
    pub(crate) fn asks(&self, pair: [BodyIx; 2], waits: &mut Vec<bool>) -> bool {
        let has = |slot: BodyIx| self.0.get(slot.at()).is_some_and(|n| *n >= ENOUGH);
        let asks = !pair.into_iter().all(has);
        if !asks {
            waits.resize(self.0.len(), false);
            for slot in pair {
                waits[slot.at()] = true;
            }
        }
        asks
    }
}

/// Takes those pairs out that may make one deep contact too many for both of their bodies, in the order of [`place`].
pub(crate) fn take_many(bodies: &Bodies, pieces: &Pieces, pairs: &mut Vec<Pair>) -> Vec<Pair> {
    if pairs.len() < PAIRS {
        return Vec::new();
    }
    let slots = |pair: &Pair| pair.slots(pieces);
    let mut counts = vec![0_u32; bodies.records.len()];
    for slot in pairs.iter().flat_map(slots) {
        counts[slot.at()] += 1;
    }
    let is_of_many = |pair: &mut Pair| slots(pair).iter().all(|slot| counts[slot.at()] > ENOUGH);
    let mut many: Vec<Pair> = pairs.extract_if(.., is_of_many).collect();
    many.sort_by_cached_key(|pair| pair.pieces.map(|piece| place(bodies, pieces, piece)));
    many
}
