//! A tree of boxes: which of many are near a box, a ray or a point.
//!
//! Leaves go where they enlarge the tree least, and every box on the way up is tried against a
//! swap of neighbours that makes it smaller (surface area heuristic with rotations). Boxes are
//! kept in `f32`, rounded outwards: a leaf more may be found, never one less.

mod bounds;
mod walk;

use carom_geometry::Aabb;

use bounds::Bounds;

/// No node.
const NONE: u32 = u32::MAX;

/// A leaf of a [`BoxTree`]; it stays the same until the leaf is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(u32);

/// 32 bytes, two to a cache line.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// Parent, or the next free node.
    parent: u32,
    /// Both children; a leaf has `[NONE, data]`.
    children: [u32; 2],
    /// Leaves are 0, inner nodes one more than their higher child; free nodes are `NONE`.
    height: u32,
}

impl Node {
    fn is_leaf(&self) -> bool {
        self.children[0] == NONE
    }
}

/// Boxes with a number each, found by where they are.
///
/// The same calls in the same order give the same tree and the same order of answers. Memory is
/// 64 bytes a leaf. A box that is not finite counts as reaching everywhere on that side.
///
/// # Examples
/// ```
/// use carom_collision::BoxTree;
/// use carom_geometry::Aabb;
/// use carom_math::vec2;
/// let mut tree = BoxTree::new();
/// for i in 0..100_u32 {
///     let x = f64::from(i);
///     tree.insert(Aabb::new(vec2(x, 0.0), vec2(x + 0.5, 1.0)), i);
/// }
/// let mut found = Vec::new();
/// tree.query(Aabb::new(vec2(6.75, 0.0), vec2(8.25, 0.5)), |i| found.push(i));
/// found.sort_unstable();
/// assert_eq!(found, [7, 8]);
/// ```
#[derive(Clone, Debug)]
pub struct BoxTree {
    nodes: Vec<Node>,
    root: u32,
    free: u32,
    leaves: usize,
}

impl Default for BoxTree {
    fn default() -> Self {
        Self::new()
    }
}

impl BoxTree {
    /// An empty tree.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            nodes: Vec::new(),
            root: NONE,
            free: NONE,
            leaves: 0,
        }
    }

    /// How many leaves there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.leaves
    }

    /// Whether there is no leaf.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.leaves == 0
    }

    /// Adds a box with its number.
    pub fn insert(&mut self, bounds: Aabb, data: u32) -> NodeId {
        let leaf = self.allocate(Node {
            bounds: Bounds::around(bounds),
            parent: NONE,
            children: [NONE, data],
            height: 0,
        });
        self.leaves += 1;
        self.attach(leaf);
        NodeId(leaf)
    }

    /// Gives a leaf a new box, if it needs one.
    ///
    /// A leaf whose box still contains the new one, and is at most twice as long around, stays as
    /// it is: hand in a box with room to move, and leave the tree alone while the body is inside
    /// [`Self::fat_box`].
    ///
    /// # Panics
    /// If the leaf was removed.
    pub fn update(&mut self, id: NodeId, bounds: Aabb) {
        let new = Bounds::around(bounds);
        let old = self.leaf(id).bounds;
        if old.contains(new) && old.perimeter() <= 2.0 * new.perimeter() {
            return;
        }
        self.detach(id.0);
        self.nodes[id.0 as usize].bounds = new;
        self.attach(id.0);
    }

    /// Takes a leaf out.
    ///
    /// # Panics
    /// If it was removed before.
    pub fn remove(&mut self, id: NodeId) {
        let _ = self.leaf(id);
        self.detach(id.0);
        self.release(id.0);
        self.leaves -= 1;
    }

    /// The number of a leaf.
    ///
    /// # Panics
    /// If the leaf was removed.
    #[must_use]
    pub fn data(&self, id: NodeId) -> u32 {
        self.leaf(id).children[1]
    }

    /// The box that the tree keeps for a leaf: the one it was given, rounded outwards.
    ///
    /// # Panics
    /// If the leaf was removed.
    #[must_use]
    pub fn fat_box(&self, id: NodeId) -> Aabb {
        self.leaf(id).bounds.widened()
    }

    /// The longest way from the root to a leaf, 0 for a single leaf.
    #[must_use]
    pub fn height(&self) -> u32 {
        if self.root == NONE {
            0
        } else {
            self.nodes[self.root as usize].height
        }
    }

    fn leaf(&self, id: NodeId) -> &Node {
        let node = &self.nodes[id.0 as usize];
        assert!(node.height == 0, "the leaf {} was removed", id.0);
        node
    }

    fn allocate(&mut self, node: Node) -> u32 {
        if self.free == NONE {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "2^32 nodes of 32 bytes do not fit in memory"
            )]
            let place = self.nodes.len() as u32;
            self.nodes.push(node);
            return place;
        }
        let place = self.free;
        self.free = self.nodes[place as usize].parent;
        self.nodes[place as usize] = node;
        place
    }

    fn release(&mut self, place: u32) {
        let node = &mut self.nodes[place as usize];
        node.parent = self.free;
        node.height = NONE;
        self.free = place;
    }

    /// Puts a leaf beside the node where that costs least.
    fn attach(&mut self, leaf: u32) {
        if self.root == NONE {
            self.nodes[leaf as usize].parent = NONE;
            self.root = leaf;
            return;
        }
        let sibling = self.best_sibling(self.nodes[leaf as usize].bounds);
        let above = self.nodes[sibling as usize].parent;
        let parent = self.allocate(Node {
            bounds: self.nodes[sibling as usize].bounds,
            parent: above,
            children: [sibling, leaf],
            height: 1,
        });
        self.replace_child(above, sibling, parent);
        self.nodes[sibling as usize].parent = parent;
        self.nodes[leaf as usize].parent = parent;
        self.refit(parent);
    }

    /// Takes a leaf and its parent out of the tree; the leaf keeps its place in memory.
    fn detach(&mut self, leaf: u32) {
        let parent = self.nodes[leaf as usize].parent;
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let node = self.nodes[parent as usize];
        let sibling = node.children[usize::from(node.children[0] == leaf)];
        self.replace_child(node.parent, parent, sibling);
        self.nodes[sibling as usize].parent = node.parent;
        self.release(parent);
        self.refit(node.parent);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
        } else {
            let children = &mut self.nodes[parent as usize].children;
            children[usize::from(children[0] != old)] = new;
        }
    }

    /// Goes down while a child gets less larger than a new pair of this node and the leaf would be.
    fn best_sibling(&self, leaf: Bounds) -> u32 {
        // Cost of a place: the perimeter of the new pair, and what every box above grows.
        // On the way down only the growth of the present node is still to be paid by both children.
        let mut place = self.root;
        loop {
            let node = &self.nodes[place as usize];
            if node.is_leaf() {
                return place;
            }
            let joined = node.bounds.union(leaf).perimeter();
            let growth = joined - node.bounds.perimeter();
            let cost = |child: u32| {
                let child = &self.nodes[child as usize];
                let joined = child.bounds.union(leaf).perimeter();
                let below = if child.is_leaf() {
                    joined
                } else {
                    joined - child.bounds.perimeter()
                };
                (growth + below, child.height)
            };
            let [first, second] = node.children.map(cost);
            if joined < first.0.min(second.0) {
                return place;
            }
            // Boxes that cost the same go to the lower side: many at one place stay a tree.
            let go_second = second.0 < first.0 || (second.0 <= first.0 && second.1 < first.1);
            place = node.children[usize::from(go_second)];
        }
    }

    /// Boxes and heights from a node up to the root, with a rotation at each where it helps.
    fn refit(&mut self, from: u32) {
        let mut place = from;
        while place != NONE {
            self.rotate(place);
            self.fit(place);
            place = self.nodes[place as usize].parent;
        }
    }

    fn fit(&mut self, place: u32) {
        let [first, second] = self.nodes[place as usize]
            .children
            .map(|c| self.nodes[c as usize]);
        let node = &mut self.nodes[place as usize];
        node.bounds = first.bounds.union(second.bounds);
        node.height = 1 + first.height.max(second.height);
    }

    /// Swaps a child with a grandchild on the other side, where that makes the inner box smaller.
    fn rotate(&mut self, place: u32) {
        let children = self.nodes[place as usize].children;
        let mut best = (0.0_f32, 0, None);
        for side in [0, 1] {
            let (child, other) = (children[side], children[1 - side]);
            let inner = self.nodes[other as usize];
            if inner.is_leaf() {
                continue;
            }
            for grandchild in [0, 1] {
                let stays = inner.children[1 - grandchild];
                let bounds = |i: u32| self.nodes[i as usize].bounds;
                let gain =
                    inner.bounds.perimeter() - bounds(child).union(bounds(stays)).perimeter();
                // Equal boxes rotate for the sake of height.
                let height = |i: u32| self.nodes[i as usize].height;
                let lower = height(inner.children[grandchild])
                    .saturating_sub(height(child).max(height(stays)));
                if gain > best.0 || (gain >= best.0 && lower > best.1) {
                    best = (gain, lower, Some((side, grandchild)));
                }
            }
        }
        if let (_, _, Some((side, grandchild))) = best {
            let (child, other) = (children[side], children[1 - side]);
            let moved = self.nodes[other as usize].children[grandchild];
            self.nodes[place as usize].children[side] = moved;
            self.nodes[moved as usize].parent = place;
            self.nodes[other as usize].children[grandchild] = child;
            self.nodes[child as usize].parent = other;
            self.fit(other);
        }
    }
}

#[cfg(test)]
mod tests;
