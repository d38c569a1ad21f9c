//! A tree of boxes: which of many are near a box, a ray or a point, and which near each other.
//!
//! Leaves go where they enlarge the tree least, and every box on the way up is tried against a
//! swap of neighbours that makes it smaller (surface area heuristic with rotations). Boxes are
//! kept in `f32`, rounded outwards: a leaf more may be found, never one less.

mod bounds;
mod build;
mod change;
mod pairs;
mod sweep;
mod walk;

use carom_geometry::Aabb;
use carom_math::Vec2;

use bounds::Bounds;

/// No leaf and no node.
const NONE: u32 = u32::MAX;

/// The pair at the top; it may have fewer than two children.
const ROOT: u32 = 0;

/// A leaf of a [`BoxTree`]; it stays the same until the leaf is removed, and is never used again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId {
    leaf: u32,
    generation: u32,
}

/// An inner node as its two children, side by side: a visit reads both, from one line of the
/// cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Pair {
    boxes: [Bounds; 2],
    children: [Child; 2],
    /// Number of a leaf.
    data: [u32; 2],
    /// Leaves are 0, pairs one more than their higher child.
    heights: [u32; 2],
    /// Where its own box is; of a free pair, the next free one.
    parent: Place,
}

impl Pair {
    const EMPTY: Self = Self {
        boxes: [Bounds::EMPTY; 2],
        children: [Child(NONE); 2],
        data: [0; 2],
        heights: [0; 2],
        parent: Place(NONE),
    };

    fn bounds(&self) -> Bounds {
        self.boxes[0].union(self.boxes[1])
    }

    fn height(&self) -> u32 {
        1 + self.heights[0].max(self.heights[1])
    }
}

/// A pair or, with the highest bit set, a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    const fn leaf(leaf: u32) -> Self {
        Self(leaf | Self::LEAF)
    }

    const fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    const fn is_none(self) -> bool {
        self.0 == NONE
    }

    /// Of a pair, where it is kept; of a leaf, where its place is noted.
    const fn index(self) -> usize {
        (self.0 & !Self::LEAF) as usize
    }
}

/// One of the two places in a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place(u32);

impl Place {
    #[expect(clippy::cast_possible_truncation, reason = "a side is 0 or 1")]
    const fn new(pair: u32, side: usize) -> Self {
        Self(2 * pair + side as u32)
    }

    const fn pair(self) -> u32 {
        self.0 / 2
    }

    const fn side(self) -> usize {
        (self.0 % 2) as usize
    }

    const fn other_side(self) -> usize {
        1 - self.side()
    }
}

/// Where a leaf is.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    /// Of a free leaf, the next free one.
    place: Place,
    /// Odd while the leaf is there.
    generation: u32,
}

/// Boxes with a number each, found by where they are.
///
/// The same calls in the same order give the same tree and the same order of answers. Memory is
/// 72 bytes a leaf. A side that is infinite or no number reaches everywhere; a box without points
/// is kept, and never found.
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
    /// The first is the root, if there is any leaf.
    pairs: Vec<Pair>,
    leaves: Vec<Leaf>,
    free_pair: u32,
    free_leaf: u32,
    len: usize,
    /// Every pair comes after the one above it: so in a tree that was built at once.
    ordered: bool,
    /// The sum of all ways around when the tree was built or first measured, in m; else 0.
    built: f64,
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
            pairs: Vec::new(),
            leaves: Vec::new(),
            free_pair: NONE,
            free_leaf: NONE,
            len: 0,
            ordered: true,
            built: 0.0,
        }
    }

    /// How many leaves there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no leaf.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Adds a box with its number; different leaves may have the same number.
    ///
    /// Many boxes at once are faster by [`Self::extend`].
    pub fn insert(&mut self, bounds: Aabb, data: u32) -> NodeId {
        let id = self.new_leaf();
        self.len += 1;
        self.attach(id.leaf, Bounds::around(bounds), data);
        id
    }

    /// Gives a leaf a new box, if it needs one; says whether it did.
    ///
    /// A leaf stays as it is while its box contains the new one, and is at most twice as long
    /// around: hand in a box with room to move, and leave the tree alone while the body is inside
    /// [`Self::fat_box`]. A leaf that was removed stays removed.
    pub fn update(&mut self, id: NodeId, bounds: Aabb) -> bool {
        let Some(place) = self.find(id) else {
            return false;
        };
        let Some(new) = self.renewal(place, bounds) else {
            return false;
        };
        self.displace(id.leaf, place, new);
        true
    }

    /// Follows something that moves; says whether its leaf has a new box.
    ///
    /// As long as the leaf's box contains `bounds`, nothing happens. Else the leaf gets the box of
    /// `bounds` with `margin` (m) on every side, stretched by `ahead`: the way (m) on which it is
    /// not to leave its box again. [`Self::update`] has the rest.
    ///
    /// # Examples
    /// ```
    /// use carom_collision::BoxTree;
    /// use carom_geometry::Aabb;
    /// use carom_math::{Vec2, vec2};
    /// let square = |x: f64| Aabb::new(vec2(x, 0.0), vec2(x + 1.0, 1.0));
    /// let mut tree = BoxTree::new();
    /// let id = tree.insert(square(0.0), 7);
    /// // At 0.5 m a step, looking 4 m ahead, every eighth or ninth step needs a new box.
    /// let renewed = (1..=80).filter(|i| {
    ///     tree.follow(id, square(0.5 * f64::from(*i)), vec2(4.0, 0.0), 0.125)
    /// });
    /// assert_eq!(renewed.count(), 9);
    /// ```
    pub fn follow(&mut self, id: NodeId, bounds: Aabb, ahead: Vec2, margin: f64) -> bool {
        let Some(place) = self.find(id) else {
            return false;
        };
        let Some(new) = self.stretched(place, bounds, ahead, margin) else {
            return false;
        };
        self.displace(id.leaf, place, new);
        true
    }

    /// [`Self::update`] for many leaves at once; says how many have a new box.
    ///
    /// All boxes above are found in one go, and the tree is built anew once its boxes have become
    /// half again as long around as they were.
    pub fn update_all(&mut self, moves: impl IntoIterator<Item = (NodeId, Aabb)>) -> usize {
        let mut moved = Vec::new();
        for (id, bounds) in moves {
            if let Some(place) = self.find(id)
                && let Some(new) = self.renewal(place, bounds)
            {
                moved.push((id.leaf, self.exchange(place, new)));
            }
        }
        self.displace_all(moved)
    }

    /// [`Self::follow`] for many leaves at once: id, box and way ahead of each; says how many have a
    /// new box.
    pub fn follow_all(
        &mut self,
        moves: impl IntoIterator<Item = (NodeId, Aabb, Vec2)>,
        margin: f64,
    ) -> usize {
        let mut moved = Vec::new();
        for (id, bounds, ahead) in moves {
            if let Some(place) = self.find(id)
                && let Some(new) = self.stretched(place, bounds, ahead, margin)
            {
                moved.push((id.leaf, self.exchange(place, new)));
            }
        }
        self.displace_all(moved)
    }

    /// Takes a leaf out and gives its number; `None` if it was removed before.
    pub fn remove(&mut self, id: NodeId) -> Option<u32> {
        let place = self.find(id)?;
        let data = self.pair(place).data[place.side()];
        self.detach(place);
        let leaf = &mut self.leaves[id.leaf as usize];
        leaf.generation = leaf.generation.wrapping_add(1);
        // A leaf is not used again once its generations are used up.
        if leaf.generation != 0 {
            leaf.place = Place(self.free_leaf);
            self.free_leaf = id.leaf;
        }
        self.len -= 1;
        if self.len == 0 {
            // Free the memory when the last leaf is removed.
            self.pairs = Vec::new();
            self.free_pair = NONE;
        }
        Some(data)
    }

    /// The number of a leaf; `None` if it was removed.
    #[must_use]
    pub fn data(&self, id: NodeId) -> Option<u32> {
        let place = self.find(id)?;
        Some(self.pair(place).data[place.side()])
    }

    /// The box that the tree keeps for a leaf: the one it was given, rounded outwards; `None` if it
    /// was removed.
    #[must_use]
    pub fn fat_box(&self, id: NodeId) -> Option<Aabb> {
        let place = self.find(id)?;
        Some(self.bounds(place).widened())
    }

    /// The longest way from the root to a leaf, 0 for a single leaf.
    #[must_use]
    pub fn height(&self) -> u32 {
        if self.len < 2 {
            0
        } else {
            self.pairs[ROOT as usize].height()
        }
    }

    /// All leaves, in the order in which they got their ids.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<'_> {
        let all = (0_u32..).zip(&self.leaves);
        all.filter(|(_, leaf)| leaf.is_there())
            .map(|(i, leaf)| NodeId {
                leaf: i,
                generation: leaf.generation,
            })
    }

    /// The new box of a leaf, if it needs one.
    fn renewal(&self, place: Place, bounds: Aabb) -> Option<Bounds> {
        let (old, new) = (self.bounds(place), Bounds::around(bounds));
        let stays = old.contains(new) && old.perimeter() <= 2.0 * new.perimeter();
        (!stays).then_some(new)
    }

    /// The new box of a leaf that moves, if it needs one.
    fn stretched(&self, place: Place, bounds: Aabb, ahead: Vec2, margin: f64) -> Option<Bounds> {
        if self.bounds(place).contains(Bounds::around(bounds)) {
            return None;
        }
        let there = Aabb::new(bounds.min + ahead, bounds.max + ahead);
        Some(Bounds::around(bounds.union(there).grown(margin)))
    }

    fn find(&self, id: NodeId) -> Option<Place> {
        let leaf = self.leaves.get(id.leaf as usize)?;
        (leaf.generation == id.generation).then_some(leaf.place)
    }

    fn pair(&self, place: Place) -> &Pair {
        &self.pairs[place.pair() as usize]
    }

    fn bounds(&self, place: Place) -> Bounds {
        self.pair(place).boxes[place.side()]
    }

    /// A leaf without a place yet.
    fn new_leaf(&mut self) -> NodeId {
        let place = Place(NONE);
        if self.free_leaf == NONE {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "2^31 leaves take 144 GB, and what needs more fails to allocate"
            )]
            let leaf = self.leaves.len() as u32;
            let generation = 1;
            self.leaves.push(Leaf { place, generation });
            return NodeId { leaf, generation };
        }
        let leaf = self.free_leaf;
        let entry = &mut self.leaves[leaf as usize];
        self.free_leaf = entry.place.0;
        let generation = entry.generation + 1;
        *entry = Leaf { place, generation };
        NodeId { leaf, generation }
    }
}

impl Leaf {
    const fn is_there(self) -> bool {
        self.generation % 2 == 1
    }
}

#[cfg(test)]
mod tests;
