//! Which leaves overlap each other.

use super::walk::Stack;
use super::{BoxTree, Place, ROOT};

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
        let mut search = Search::new(self, self, |a, b| (a.min(b), a.max(b)), out);
        // Leaves are below different children of exactly one pair.
        for (at, _) in (0_u32..).zip(&self.pairs) {
            search.meet(Place::new(at, 0), Place::new(at, 1));
            if at % 32 == 31 {
                search.run();
            }
        }
        search.run();
        sort(&mut out[from..]);
    }

    /// Appends the numbers of all leaves of this tree and of another that overlap, in order: moving
    /// bodies against fixed ones, say.
    pub fn pairs_with(&self, other: &Self, out: &mut Vec<(u32, u32)>) {
        if self.is_empty() || other.is_empty() {
            return;
        }
        let from = out.len();
        let mut search = Search::new(self, other, |a, b| (a, b), out);
        for a in [0, 1] {
            for b in [0, 1] {
                search.meet(Place::new(ROOT, a), Place::new(ROOT, b));
            }
        }
        search.run();
        sort(&mut out[from..]);
    }
}

fn sort(pairs: &mut [(u32, u32)]) {
    pairs.sort_unstable_by_key(|(a, b)| u64::from(*a) << 32 | u64::from(*b));
}

/// What is below places of two trees, against each other.
///
/// Two pairs of children that overlap are four questions more. What comes of a question cannot be
/// foretold, so nothing branches on it: an answer goes to the end of each list that it might go to,
/// and one of the lists gets longer.
struct Search<'a, F> {
    one: &'a BoxTree,
    two: &'a BoxTree,
    pair: F,
    out: &'a mut Vec<(u32, u32)>,
    /// Two pairs.
    inner: Stack<(Place, Place), 128>,
    /// A leaf of the first tree and a pair of the second, and the other way round.
    leaf_one: Stack<(Place, Place), 128>,
    leaf_two: Stack<(Place, Place), 128>,
    found: Stack<(u32, u32), 128>,
}

impl<'a, F: Fn(u32, u32) -> (u32, u32)> Search<'a, F> {
    fn new(one: &'a BoxTree, two: &'a BoxTree, pair: F, out: &'a mut Vec<(u32, u32)>) -> Self {
        let nothing = (Place(0), Place(0));
        Self {
            one,
            two,
            pair,
            out,
            inner: Stack::new(nothing),
            leaf_one: Stack::new(nothing),
            leaf_two: Stack::new(nothing),
            found: Stack::new((0, 0)),
        }
    }

    /// Asks whether what is in two places overlaps, and notes what there is to do.
    #[inline]
    fn meet(&mut self, a: Place, b: Place) {
        let (one, two) = (self.one.pair(a), self.two.pair(b));
        let met = one.boxes[a.side()].overlaps(two.boxes[b.side()]);
        let (leaf_a, leaf_b) = (
            one.children[a.side()].is_leaf(),
            two.children[b.side()].is_leaf(),
        );
        let data = (one.data[a.side()], two.data[b.side()]);
        self.inner.push_if(met & !leaf_a & !leaf_b, (a, b));
        self.leaf_one.push_if(met & leaf_a & !leaf_b, (a, b));
        self.leaf_two.push_if(met & !leaf_a & leaf_b, (a, b));
        self.found
            .push_if(met & leaf_a & leaf_b, (self.pair)(data.0, data.1));
    }

    fn run(&mut self) {
        loop {
            self.inner.make_room(4);
            self.leaf_one.make_room(4);
            self.leaf_two.make_room(4);
            if !self.found.has_room(4) {
                self.hand_over();
            }
            if let Some((a, b)) = self.leaf_one.pop() {
                let below = self.two.pair(b).children[b.side()].0;
                self.meet(a, Place::new(below, 0));
                self.meet(a, Place::new(below, 1));
            } else if let Some((a, b)) = self.leaf_two.pop() {
                let below = self.one.pair(a).children[a.side()].0;
                self.meet(Place::new(below, 0), b);
                self.meet(Place::new(below, 1), b);
            } else if let Some((a, b)) = self.inner.pop() {
                let below_a = self.one.pair(a).children[a.side()].0;
                let below_b = self.two.pair(b).children[b.side()].0;
                for i in [0, 1] {
                    for j in [0, 1] {
                        self.meet(Place::new(below_a, i), Place::new(below_b, j));
                    }
                }
            } else {
                break;
            }
        }
        self.hand_over();
    }

    fn hand_over(&mut self) {
        self.out.extend_from_slice(self.found.near());
        self.found.clear();
    }
}
