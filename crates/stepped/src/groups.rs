//! Groups of what hangs together: union by number.

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
