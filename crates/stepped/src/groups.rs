//! Groups of what hangs together: union by number, and what is reached from some.

use crate::BodyIx;

/// A forest over the numbers below a count; the root of a tree is its least number.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    root: Vec<usize>,
}

impl Groups {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            root: (0..count).collect(),
        }
    }

    pub(crate) fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.find(one), self.find(other));
        self.root[one.max(other)] = one.min(other);
    }

    pub(crate) fn find(&mut self, mut k: usize) -> usize {
        while self.root[k] != k {
            self.root[k] = self.root[self.root[k]];
            k = self.root[k];
        }
        k
    }
}

/// All bodies that hang together with the first: these, then the others in the order in which they are met. `lead` calls back with what
/// a body leads to; what was seen before is not met again.
pub(crate) fn reached(
    first: &[BodyIx],
    seen: &mut [bool],
    mut lead: impl FnMut(BodyIx, &mut dyn FnMut(BodyIx)),
) -> Vec<BodyIx> {
    let (mut found, mut next) = (first.to_vec(), 0);
    first.iter().for_each(|k| seen[k.at()] = true);
    while let Some(&k) = found.get(next) {
        next += 1;
        lead(k, &mut |other| {
            if !core::mem::replace(&mut seen[other.at()], true) {
                found.push(other);
            }
        });
    }
    found
}
