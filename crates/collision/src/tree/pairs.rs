//! Which leaves overlap each other.

use super::bounds::Bounds;
use super::walk::Stack;
use super::{BoxTree, Child, ROOT};

impl BoxTree {
    /// Appends the numbers of all leaves whose boxes overlap, two by two: every pair once, the lower
    /// number first, in order.
    ///
    /// The boxes alone decide, not how the tree came to be. A leaf is no pair with itself.
    ///
    /// # Examples
    /// ```
    /// use carom_collision::BoxTree;
    /// use carom_geometry::Aabb;
    /// use carom_math::vec2;
    /// let domino = |i: u32| (Aabb::new(vec2(f64::from(i), 0.0), vec2(f64::from(i) + 1.0, 2.0)), i);
    /// let tree: BoxTree = (0..4).map(domino).collect();
    /// let mut pairs = Vec::new();
    /// tree.pairs(&mut pairs);
    /// assert_eq!(pairs, [(0, 1), (1, 2), (2, 3)]);                 // a common edge is enough
    /// ```
    pub fn pairs(&self, out: &mut Vec<(u32, u32)>) {
        let from = out.len();
        // Leaves are below different children of exactly one pair.
        for pair in &self.pairs {
            if pair.boxes[0].overlaps(pair.boxes[1]) {
                let [a, b] = [0, 1]
                    .map(|side| Item::of(pair.boxes[side], pair.children[side], pair.data[side]));
                across(self, self, a, b, |a, b| out.push((a.min(b), a.max(b))));
            }
        }
        sort(&mut out[from..]);
    }

    /// Appends the numbers of all leaves of this tree and of another that overlap, in order: moving
    /// bodies against fixed ones, say.
    pub fn pairs_with(&self, other: &Self, out: &mut Vec<(u32, u32)>) {
        if self.is_empty() || other.is_empty() {
            return;
        }
        let from = out.len();
        let root = |tree: &Self| Item::of(tree.pairs[ROOT as usize].bounds(), Child(ROOT), 0);
        across(self, other, root(self), root(other), |a, b| {
            out.push((a, b));
        });
        sort(&mut out[from..]);
    }
}

fn sort(pairs: &mut [(u32, u32)]) {
    pairs.sort_unstable_by_key(|(a, b)| u64::from(*a) << 32 | u64::from(*b));
}

/// A leaf, by its number, or a pair.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    index: u32,
    leaf: bool,
}

impl Item {
    fn of(bounds: Bounds, child: Child, data: u32) -> Self {
        let leaf = child.is_leaf();
        let index = if leaf { data } else { child.0 };
        Self {
            bounds,
            index,
            leaf,
        }
    }

    fn children(self, tree: &BoxTree) -> [Self; 2] {
        let pair = &tree.pairs[self.index as usize];
        [0, 1].map(|side| Self::of(pair.boxes[side], pair.children[side], pair.data[side]))
    }
}

/// All leaves below `a` in one tree that overlap leaves below `b` in another.
fn across(one: &BoxTree, two: &BoxTree, a: Item, b: Item, mut found: impl FnMut(u32, u32)) {
    let mut stack: Stack<(Item, Item)> = Stack::new();
    let mut next = Some((a, b));
    while let Some((a, b)) = next.take().or_else(|| stack.pop()) {
        let mut meet = |a: Item, b: Item| {
            if a.bounds.overlaps(b.bounds) {
                if a.leaf && b.leaf {
                    found(a.index, b.index);
                } else if let Some(other) = next.replace((a, b)) {
                    stack.push(other);
                }
            }
        };
        match (a.leaf, b.leaf) {
            (true, true) => meet(a, b),
            (true, false) => b.children(two).into_iter().for_each(|b| meet(a, b)),
            (false, true) => a.children(one).into_iter().for_each(|a| meet(a, b)),
            (false, false) => {
                for a in a.children(one) {
                    for b in b.children(two) {
                        meet(a, b);
                    }
                }
            }
        }
    }
}
