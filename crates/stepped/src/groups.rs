//! Groups of what hangs together: union by number, and what is reached from some.

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

/// All that hangs together with the first: these, then the others in the order in which they are met. `lead` calls back with what a
/// number leads to; what was seen before is not met again.
pub(crate) fn reached(
    first: &[u32],
    seen: &mut [bool],
    mut lead: impl FnMut(u32, &mut dyn FnMut(u32)),
) -> Vec<u32> {
    let (mut found, mut next) = (first.to_vec(), 0);
    first.iter().for_each(|k| seen[*k as usize] = true);
    while let Some(&k) = found.get(next) {
        next += 1;
        lead(k, &mut |other| {
            if !core::mem::replace(&mut seen[other as usize], true) {
                found.push(other);
            }
        });
    }
    found
}
