//! Many boxes at once: the tree from the bottom up, by pairing nearest neighbours.
//!
//! The boxes are laid out along a curve that fills the plane (Morton), so that near ones come near
//! each other. Then, in rounds, every node looks at a few neighbours along the curve for the one
//! with which it makes the smallest box, and nodes that look at each other become a pair
//! (parallel locally-ordered clustering, Meister and Bittner 2018).

use arrayvec::ArrayVec;
use carom_geometry::Aabb;

use super::bounds::Bounds;
use super::change::Content;
use super::{BoxTree, Child, NONE, NodeId, Pair, Place, ROOT};

/// How far along the curve a node looks for a neighbour, to either side.
const REACH: usize = 4;

/// A leaf on its way into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    leaf: u32,
    data: u32,
}

/// A node without a parent yet.
#[derive(Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// A leaf as its place in the list of items, or a pair.
    child: Child,
    /// How many leaves are below.
    leaves: u32,
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
            self.build(&items);
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
        self.build(&items);
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

    /// A node over n leaves takes the n − 1 pairs from its first on: the pairs of a tree lie in the
    /// order of a walk, and a descent mostly goes to the next one.
    fn build(&mut self, items: &[Item]) {
        self.pairs.clear();
        self.free_pair = NONE;
        self.ordered = true;
        self.built = 0.0;
        if items.len() < 2 {
            if let Some(item) = items.first() {
                self.pairs.push(Pair::EMPTY);
                self.put(Place::new(ROOT, 0), item.content());
            }
            return;
        }
        let joined = join(items);
        self.pairs.resize(joined.len(), Pair::EMPTY);
        // Every entry: which pair of nodes becomes which pair of the tree.
        let mut stack = vec![(joined.len() - 1, ROOT)];
        while let Some((node, pair)) = stack.pop() {
            let children = joined[node];
            // A child over n leaves takes the next n − 1 pairs.
            let mut below = pair + 1;
            for (side, child) in [0, 1].into_iter().zip(children) {
                let place = Place::new(pair, side);
                if child.child.is_leaf() {
                    self.put(place, items[child.child.index()].content());
                    continue;
                }
                self.pairs[below as usize].parent = place;
                let content = &mut self.pairs[pair as usize];
                content.children[side] = Child(below);
                content.boxes[side] = child.bounds;
                stack.push((child.child.index(), below));
                below += child.leaves - 1;
            }
        }
        // Children come after their parents: backwards, all heights below are known.
        for i in (1..self.pairs.len()).rev() {
            let pair = &self.pairs[i];
            let (place, height) = (pair.parent, pair.height());
            self.pairs[place.pair() as usize].heights[place.side()] = height;
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

/// All pairs over some leaves, the one at the top last.
fn join(items: &[Item]) -> Vec<[Node; 2]> {
    let mut joined = Vec::with_capacity(items.len() - 1);
    let mut nodes: Vec<Node> = along_the_curve(items)
        .into_iter()
        .map(|i| Node {
            bounds: items[i as usize].bounds,
            child: Child::leaf(i),
            leaves: 1,
        })
        .collect();
    let mut nearest = Vec::with_capacity(nodes.len());
    while nodes.len() > 1 {
        choose(&nodes, &mut nearest);
        let before = nodes.len();
        let mut kept = 0;
        for i in 0..before {
            let other = nearest[i].1 as usize;
            if nearest[other].1 as usize != i {
                nodes[kept] = nodes[i];
                kept += 1;
            } else if i < other {
                nodes[kept] = pair_up(&mut joined, nodes[i], nodes[other]);
                kept += 1;
            }
        }
        nodes.truncate(kept);
        // Where the nearest neighbour of each node has a nearer one itself, hardly any become a pair:
        // then neighbours along the curve do, and work stays bounded.
        if before - kept < before / 8 {
            let half = kept / 2;
            for i in 0..half {
                nodes[i] = pair_up(&mut joined, nodes[2 * i], nodes[2 * i + 1]);
            }
            if kept % 2 == 1 {
                nodes[half] = nodes[kept - 1];
            }
            nodes.truncate(kept - half);
        }
    }
    joined
}

fn pair_up(joined: &mut Vec<[Node; 2]>, a: Node, b: Node) -> Node {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "there are fewer pairs than leaves"
    )]
    let child = Child(joined.len() as u32);
    joined.push([a, b]);
    Node {
        bounds: a.bounds.union(b.bounds),
        child,
        leaves: a.leaves + b.leaves,
    }
}

/// With which of its neighbours every node makes the smallest box.
fn choose(nodes: &[Node], nearest: &mut Vec<(f32, u32)>) {
    nearest.clear();
    nearest.resize(nodes.len(), (f32::INFINITY, 0));
    for (i, node) in nodes.iter().enumerate() {
        for (j, other) in nodes.iter().enumerate().skip(i + 1).take(REACH) {
            let around = node.bounds.union(other.bounds).perimeter();
            #[expect(
                clippy::cast_possible_truncation,
                reason = "places in a list of less than 2^31 leaves"
            )]
            for (from, to) in [(i, j as u32), (j, i as u32)] {
                let best = &mut nearest[from];
                // Of equal ones the next-door neighbour of the same two: a heap of equal boxes
                // pairs up in one round.
                let closer = around < best.0 || (around <= best.0 && to == from as u32 ^ 1);
                if closer {
                    *best = (around, to);
                }
            }
        }
    }
}

/// The order of boxes along a curve that fills the plane.
///
/// The grid under the curve covers where most middles are; what lies outside counts as at its
/// border, so that a body that fell out of the world does not make one cell of all others.
fn along_the_curve(items: &[Item]) -> Vec<u32> {
    let grid = Grid::over(items);
    let mut keys: Vec<u64> = (0_u32..)
        .zip(items)
        .map(|(i, item)| u64::from(grid.morton(item.bounds.middle())) << 32 | u64::from(i))
        .collect();
    keys.sort_unstable();
    #[expect(clippy::cast_possible_truncation, reason = "the lower half is meant")]
    keys.into_iter().map(|key| key as u32).collect()
}

/// Cells of a square around most middles.
struct Grid {
    low: [f32; 2],
    scale: f32,
}

impl Grid {
    /// How many middles are sampled to find where most are.
    const SAMPLE: usize = 64;

    fn over(items: &[Item]) -> Self {
        let step = items.len().div_ceil(Self::SAMPLE);
        let mut low = [0.0; 2];
        let mut size = f32::MIN_POSITIVE;
        for axis in [0, 1] {
            let middles = items.iter().step_by(step).map(|i| i.bounds.middle()[axis]);
            let mut sample: ArrayVec<f32, { Self::SAMPLE }> = middles.collect();
            sample.sort_unstable_by(f32::total_cmp);
            // An eighth on both sides may be anywhere; as far again is left for those in between.
            let (first, last) = (
                sample[sample.len() / 8],
                sample[sample.len() - 1 - sample.len() / 8],
            );
            let middle = last - first;
            low[axis] = first - middle;
            size = if 3.0 * middle > size {
                3.0 * middle
            } else {
                size
            };
        }
        let scale = 65535.0 / size;
        Self { low, scale }
    }

    /// Bits of both coordinates in turn.
    fn morton(&self, middle: [f32; 2]) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "what is outside the grid is at its border"
        )]
        let cell = |axis: usize| ((middle[axis] - self.low[axis]) * self.scale).min(65535.0) as u32;
        spread(cell(0)) | spread(cell(1)) << 1
    }
}

/// 16 bits with a gap after each.
fn spread(x: u32) -> u32 {
    let x = (x | x << 8) & 0x00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

/// Boxes with their numbers.
impl FromIterator<(Aabb, u32)> for BoxTree {
    fn from_iter<T: IntoIterator<Item = (Aabb, u32)>>(boxes: T) -> Self {
        let mut tree = Self::new();
        tree.extend(boxes);
        tree
    }
}
