//! Many boxes at once: the tree from the top down, cut where it costs least.

use carom_geometry::Aabb;

use super::bounds::Bounds;
use super::change::Content;
use super::{BoxTree, Child, NONE, NodeId, Pair, Place, ROOT};

/// Slices of a range between which it may be cut.
const BINS: usize = 8;

/// A leaf on its way into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    leaf: u32,
    data: u32,
}

impl BoxTree {
    /// Adds many boxes with their numbers; the ids come in the same order.
    ///
    /// When they are more than the leaves that are there, the tree is built anew, which is faster
    /// than leaf by leaf, and gives a better tree.
    pub fn extend(&mut self, boxes: impl IntoIterator<Item = (Aabb, u32)>) -> Vec<NodeId> {
        let mut items = Vec::new();
        let mut ids = Vec::new();
        for (bounds, data) in boxes {
            let id = self.new_leaf();
            let bounds = Bounds::around(bounds);
            items.push(Item {
                bounds,
                leaf: id.leaf,
                data,
            });
            ids.push(id);
        }
        let old = self.len;
        self.len += items.len();
        if items.len() > old {
            self.collect_leaves(&mut items);
            self.build(items);
        } else {
            for item in items {
                self.attach(item.leaf, item.bounds, item.data);
            }
        }
        ids
    }

    /// Builds the tree anew over the same leaves: faster to ask after much has moved far.
    ///
    /// Ids, boxes and answers stay.
    pub fn rebuild(&mut self) {
        let mut items = Vec::with_capacity(self.len);
        self.collect_leaves(&mut items);
        self.build(items);
    }

    fn collect_leaves(&self, items: &mut Vec<Item>) {
        for pair in &self.pairs {
            for side in [0, 1] {
                let child = pair.children[side];
                if child.is_leaf() && !child.is_none() {
                    #[expect(clippy::cast_possible_truncation, reason = "it was a u32")]
                    let leaf = child.index() as u32;
                    items.push(Item {
                        bounds: pair.boxes[side],
                        leaf,
                        data: pair.data[side],
                    });
                }
            }
        }
    }

    /// A range of n leaves takes the n − 1 pairs from its first on: the pairs of a tree lie in the
    /// order of a walk, and whoever goes down mostly goes to the next one.
    fn build(&mut self, mut items: Vec<Item>) {
        self.pairs.clear();
        self.free_pair = NONE;
        let Some(first) = items.first() else {
            return;
        };
        self.pairs.resize(items.len().max(2) - 1, Pair::EMPTY);
        if items.len() == 1 {
            self.put(Place::new(ROOT, 0), first.content());
            return;
        }
        let mut stack = vec![(0, items.len(), ROOT)];
        while let Some((from, to, pair)) = stack.pop() {
            let middle = from + cut(&mut items[from..to]);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "there are less than 2^31 leaves"
            )]
            let second = pair + (middle - from) as u32;
            for (side, from, to, below) in [(1, middle, to, second), (0, from, middle, pair + 1)] {
                let place = Place::new(pair, side);
                if to - from == 1 {
                    self.put(place, items[from].content());
                } else {
                    self.pairs[pair as usize].children[side] = Child(below);
                    self.pairs[below as usize].parent = place;
                    stack.push((from, to, below));
                }
            }
        }
        // Children come after their parents: backwards, all boxes below are complete.
        for i in (1..self.pairs.len()).rev() {
            let pair = &self.pairs[i];
            let (place, bounds, height) = (pair.parent, pair.bounds(), pair.height());
            let above = &mut self.pairs[place.pair() as usize];
            above.boxes[place.side()] = bounds;
            above.heights[place.side()] = height;
        }
    }
}

impl Item {
    fn content(&self) -> Content {
        Content {
            bounds: self.bounds,
            child: Child::leaf(self.leaf),
            data: self.data,
            height: 0,
        }
    }
}

/// Sorts the items into two parts, and says where the second begins: both have at least one.
///
/// The cut is one of those between slices of equal width across the longer way of the boxes'
/// middles; it makes the sum of (way around × items) of both parts least.
fn cut(items: &mut [Item]) -> usize {
    if items.len() == 2 {
        return 1;
    }
    let mut low = [f32::INFINITY; 2];
    let mut high = [f32::NEG_INFINITY; 2];
    for item in &*items {
        let middle = item.bounds.middle();
        for axis in [0, 1] {
            low[axis] = if middle[axis] < low[axis] {
                middle[axis]
            } else {
                low[axis]
            };
            high[axis] = if middle[axis] > high[axis] {
                middle[axis]
            } else {
                high[axis]
            };
        }
    }
    let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
    let (low, scale) = (low[axis], BINS as f32 / (high[axis] - low[axis]));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not below 0; no number, where all middles are one, becomes 0"
    )]
    let bin = |item: &Item| (((item.bounds.middle()[axis] - low) * scale) as usize).min(BINS - 1);

    let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
    for item in &*items {
        let (bounds, count) = &mut bins[bin(item)];
        *bounds = bounds.union(item.bounds);
        *count += 1;
    }
    let mut after = [(Bounds::EMPTY, 0_usize); BINS];
    let mut sum = after[0];
    for i in (1..BINS).rev() {
        sum = (sum.0.union(bins[i].0), sum.1 + bins[i].1);
        after[i] = sum;
    }
    let mut before = (Bounds::EMPTY, 0_usize);
    let mut best = (f32::INFINITY, 0, 0);
    for i in 1..BINS {
        before = (before.0.union(bins[i - 1].0), before.1 + bins[i - 1].1);
        let cost = |part: (Bounds, usize)| part.0.perimeter() * part.1 as f32;
        let cost = cost(before) + cost(after[i]);
        if before.1 > 0 && after[i].1 > 0 && cost < best.0 {
            best = (cost, i, before.1);
        }
    }
    let (_, slice, count) = best;
    if count == 0 {
        return items.len() / 2;
    }
    let (mut i, mut j) = (0, items.len());
    loop {
        while i < j && bin(&items[i]) < slice {
            i += 1;
        }
        while i < j && bin(&items[j - 1]) >= slice {
            j -= 1;
        }
        if i >= j {
            return count;
        }
        items.swap(i, j - 1);
    }
}

/// Boxes with their numbers.
impl FromIterator<(Aabb, u32)> for BoxTree {
    fn from_iter<T: IntoIterator<Item = (Aabb, u32)>>(boxes: T) -> Self {
        let mut tree = Self::new();
        tree.extend(boxes);
        tree
    }
}
