//! A box tree over the convex parts of one shape: made once, never changed.

use crate::Aabb;

/// Edges of a shape above which a tree of boxes is faster than a look at every part.
pub(crate) const TREE_ABOVE: usize = 32;

/// Boxes around the parts of a shape, halved again and again: a search for the parts near a place
/// tests a few boxes instead of all.
///
/// Flat and in order of depth, so that a left child follows its parent; at most 33 levels, since
/// every split halves the number of parts. 48 bytes a node, two nodes a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartTree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    bounds: Aabb,
    kind: PartBranch,
}

/// What lies below a box of a [`PartTree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartBranch {
    /// One part, by its index.
    Part(u32),
    /// Two boxes, by their index in the tree.
    Boxes(u32, u32),
}

impl PartTree {
    /// The tree over the boxes of a shape's parts, in their order. O(n log n).
    #[must_use]
    pub fn new(boxes: impl IntoIterator<Item = Aabb>) -> Self {
        let mut parts: Vec<(u32, Aabb)> = (0..).zip(boxes).collect();
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * parts.len()),
        };
        if !parts.is_empty() {
            tree.grow(&mut parts);
        }
        tree
    }

    /// Adds the tree over `parts` and gives its root.
    fn grow(&mut self, parts: &mut [(u32, Aabb)]) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a shape has fewer than 2^31 parts"
        )]
        let index = self.nodes.len() as u32;
        if let [(part, bounds)] = *parts {
            self.nodes.push(Node {
                bounds,
                kind: PartBranch::Part(part),
            });
            return index;
        }
        let around = |parts: &[(u32, Aabb)]| {
            let all = parts.iter().map(|(_, bounds)| *bounds);
            all.fold(Aabb::EMPTY, Aabb::union)
        };
        let bounds = around(parts);
        // Across the longer side, by the middles of the boxes; equal ones by their number.
        let wide = bounds.extents();
        let middle = |bounds: Aabb| {
            let sum = bounds.min + bounds.max;
            if wide.x >= wide.y { sum.x } else { sum.y }
        };
        let half = parts.len() / 2;
        parts.select_nth_unstable_by(half, |p, q| {
            middle(p.1).total_cmp(&middle(q.1)).then(p.0.cmp(&q.0))
        });
        self.nodes.push(Node {
            bounds,
            kind: PartBranch::Boxes(0, 0),
        });
        let (low, high) = parts.split_at_mut(half);
        let low = self.grow(low);
        let high = self.grow(high);
        self.nodes[index as usize].kind = PartBranch::Boxes(low, high);
        index
    }

    /// Whether there is no part in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Box number `index` (0 is around everything) and what lies below it.
    ///
    /// # Panics
    /// If there is no such box.
    #[must_use]
    pub fn node(&self, index: u32) -> (Aabb, PartBranch) {
        let node = &self.nodes[index as usize];
        (node.bounds, node.kind)
    }

    /// Visits every part if `near` holds for its box, and for all boxes around it.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::{Aabb, PartTree};
    /// use carom_math::{Vec2, vec2};
    /// let boxes = (0..100).map(|i| Aabb::new(vec2(f64::from(i), 0.0), vec2(f64::from(i) + 1.0, 1.0)));
    /// let tree = PartTree::new(boxes);
    /// let window = Aabb::new(vec2(10.25, 0.0), vec2(12.5, 0.5));
    /// let mut found = Vec::new();
    /// tree.search(|bounds| bounds.overlaps(window), |part| found.push(part));
    /// found.sort_unstable();
    /// assert_eq!(found, [10, 11, 12]);
    /// ```
    pub fn search(&self, mut near: impl FnMut(Aabb) -> bool, mut visit: impl FnMut(u32)) {
        // Halving leaves at most 33 levels for 2^32 parts, each with one sibling that waits.
        let mut waiting = [0; 34];
        let mut count = usize::from(!self.is_empty());
        while count > 0 {
            count -= 1;
            let (bounds, below) = self.node(waiting[count]);
            if !near(bounds) {
                continue;
            }
            match below {
                PartBranch::Part(part) => visit(part),
                PartBranch::Boxes(low, high) => {
                    waiting[count] = high;
                    waiting[count + 1] = low;
                    count += 2;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_search_finds_what_a_look_at_all_finds(
            boxes in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64, 0.0..2.0_f64, 0.0..2.0_f64), 0..80),
            x in -9.0..9.0_f64, y in -9.0..9.0_f64, size in 0.0..4.0_f64,
        ) {
            let boxes: Vec<Aabb> = boxes
                .iter()
                .map(|(x, y, w, h)| Aabb::new(vec2(*x, *y), vec2(x + w, y + h)))
                .collect();
            let window = Aabb::new(vec2(x, y), vec2(x + size, y + size));
            let mut found = Vec::new();
            PartTree::new(boxes.iter().copied()).search(|b| b.overlaps(window), |part| found.push(part));
            found.sort_unstable();
            let all = (0..).zip(&boxes).filter(|(_, b)| b.overlaps(window));
            prop_assert_eq!(found, all.map(|(i, _)| i).collect::<Vec<u32>>());
        }
    }
}
