//! Which leaves overlap each other.

use super::walk::Stack;
use super::{BoxTree, Pair, Place, ROOT};

impl BoxTree {
    /// Appends the numbers of all leaves with overlapping boxes, two by two: every pair once, the lower
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
        // Leaves are below different children of exactly one pair. Backwards: in a tree that was
        // built at once, what is below has then just been looked at.
        #[expect(clippy::cast_possible_truncation, reason = "a place is a u32")]
        for at in (0..self.pairs.len() as u32).rev() {
            let pair = &self.pairs[at as usize];
            search.meet(pair, Place::new(at, 0), pair, Place::new(at, 1));
            if at % 32 == 0 {
                search.run();
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
        let mut search = Search::new(self, other, |a, b| (a, b), out);
        search.inner.push((ROOT, ROOT));
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
/// predicted, so nothing branches on it: an answer goes to the end of each list that it might go to,
/// and one of the lists gets longer.
struct Search<'a, F> {
    one: &'a BoxTree,
    two: &'a BoxTree,
    pair: F,
    out: &'a mut Vec<(u32, u32)>,
    /// Two pairs.
    inner: Stack<(u32, u32), 128>,
    /// A leaf of the first tree and a pair of the second, and the other way round.
    leaf_one: Stack<(Place, u32), 128>,
    leaf_two: Stack<(u32, Place), 128>,
    found: Stack<(u32, u32), 128>,
}

/// How many questions are asked at once: their answers wait for memory together.
const BATCH: usize = 8;

impl<'a, F: Fn(u32, u32) -> (u32, u32)> Search<'a, F> {
    fn new(one: &'a BoxTree, two: &'a BoxTree, pair: F, out: &'a mut Vec<(u32, u32)>) -> Self {
        Self {
            one,
            two,
            pair,
            out,
            inner: Stack::new((0, 0)),
            leaf_one: Stack::new((Place(0), 0)),
            leaf_two: Stack::new((0, Place(0))),
            found: Stack::new((0, 0)),
        }
    }

    /// Asks whether what is in two places overlaps, and notes what there is to do.
    #[inline]
    fn meet(&mut self, one: &Pair, a: Place, two: &Pair, b: Place) {
        let (i, j) = (a.side(), b.side());
        let met = one.boxes[i].overlaps(two.boxes[j]);
        let (child_a, child_b) = (one.children[i], two.children[j]);
        let (leaf_a, leaf_b) = (child_a.is_leaf(), child_b.is_leaf());
        self.inner
            .push_if(met & !leaf_a & !leaf_b, (child_a.0, child_b.0));
        self.leaf_one
            .push_if(met & leaf_a & !leaf_b, (a, child_b.0));
        self.leaf_two
            .push_if(met & !leaf_a & leaf_b, (child_a.0, b));
        self.found
            .push_if(met & leaf_a & leaf_b, (self.pair)(one.data[i], two.data[j]));
    }

    fn run(&mut self) {
        let (one, two) = (self.one, self.two);
        loop {
            self.inner.make_room(4 * BATCH);
            self.leaf_one.make_room(4 * BATCH);
            self.leaf_two.make_room(4 * BATCH);
            if !self.found.has_room(4 * BATCH) {
                self.hand_over();
            }
            let (batch, count) = self.leaf_one.pop_some::<BATCH>();
            for &(a, below) in &batch[..count] {
                let (leaf, pair) = (one.pair(a), &two.pairs[below as usize]);
                self.meet(leaf, a, pair, Place::new(below, 0));
                self.meet(leaf, a, pair, Place::new(below, 1));
            }
            if count > 0 {
                continue;
            }
            let (batch, count) = self.leaf_two.pop_some::<BATCH>();
            for &(below, b) in &batch[..count] {
                let (pair, leaf) = (&one.pairs[below as usize], two.pair(b));
                self.meet(pair, Place::new(below, 0), leaf, b);
                self.meet(pair, Place::new(below, 1), leaf, b);
            }
            if count > 0 {
                continue;
            }
            let (batch, count) = self.inner.pop_some::<BATCH>();
            for &(a, b) in &batch[..count] {
                let (first, second) = (&one.pairs[a as usize], &two.pairs[b as usize]);
                for i in [0, 1] {
                    for j in [0, 1] {
                        self.meet(first, Place::new(a, i), second, Place::new(b, j));
                    }
                }
            }
            if count == 0 {
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
