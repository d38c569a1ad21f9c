//! Which bodies touch, and which hang together.

use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;

/// Bodies that touch a body.
pub(crate) fn neighbours<'a>(
    bodies: &'a Bodies,
    pairs: &'a Pairs,
    index: u32,
) -> impl Iterator<Item = u32> + use<'a> {
    bodies.get(index).pairs.iter().filter_map(move |&place| {
        let pair = pairs.get(place);
        pair.touching.then(|| pair.other(index))
    })
}

/// Union by index: the smaller root wins, so that groups do not depend on the order of links.
pub(crate) struct Tree {
    parents: Vec<u32>,
}

impl Tree {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            parents: (0u32..).take(count).collect(),
        }
    }

    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let up = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = up;
            i = up;
        }
        i
    }

    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        self.parents[high as usize] = low;
    }
}
