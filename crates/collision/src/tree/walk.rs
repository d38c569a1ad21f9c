//! Questions to a tree: depth first, left before right, without recursion.

use arrayvec::ArrayVec;
use carom_geometry::Aabb;
use carom_math::Vec2;

use super::bounds::{Bounds, Ray};
use super::{BoxTree, NONE};

/// Nodes still to visit: on the stack as long as they fit, which they do in any tree of less than
/// 64 levels.
#[derive(Default)]
struct Stack {
    near: ArrayVec<u32, 64>,
    rest: Vec<u32>,
}

impl Stack {
    fn push(&mut self, node: u32) {
        if let Err(full) = self.near.try_push(node) {
            self.rest.push(full.element());
        }
    }

    fn pop(&mut self) -> Option<u32> {
        self.rest.pop().or_else(|| self.near.pop())
    }
}

impl BoxTree {
    /// Calls `found` with the number of every leaf whose box overlaps `bounds`.
    pub fn query(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        let bounds = Bounds::around(bounds);
        if self.root == NONE {
            return;
        }
        let mut stack = Stack::default();
        stack.push(self.root);
        while let Some(place) = stack.pop() {
            let node = &self.nodes[place as usize];
            if !node.bounds.overlaps(bounds) {
                continue;
            }
            if node.is_leaf() {
                found(node.children[1]);
            } else {
                stack.push(node.children[1]);
                stack.push(node.children[0]);
            }
        }
    }

    /// Calls `found` with the number of every leaf whose box contains `point`.
    pub fn point(&self, point: Vec2, found: impl FnMut(u32)) {
        self.query(Aabb::new(point, point), found);
    }

    /// Calls `found` with the number of every leaf whose box a ray meets, roughly the nearest first.
    ///
    /// `max` and what `found` returns are how far the ray goes, in lengths of `direction`: return
    /// the distance of a hit to leave out what lies behind it, or infinity to see everything up to
    /// `max`.
    pub fn ray(&self, origin: Vec2, direction: Vec2, max: f64, mut found: impl FnMut(u32) -> f64) {
        if self.root == NONE {
            return;
        }
        let ray = Ray::new(origin, direction);
        let mut max = max;
        let mut stack = Stack::default();
        stack.push(self.root);
        while let Some(place) = stack.pop() {
            let node = &self.nodes[place as usize];
            // Tested when it is visited, since the ray may have become shorter meanwhile.
            if node.bounds.entry(&ray, max).is_none() {
                continue;
            }
            if node.is_leaf() {
                max = max.min(found(node.children[1]));
                continue;
            }
            let [first, second] = node.children.map(|child| {
                let entry = self.nodes[child as usize].bounds.entry(&ray, max);
                entry.unwrap_or(f64::INFINITY)
            });
            let near = usize::from(second < first);
            for (side, entry) in [(1 - near, first.max(second)), (near, first.min(second))] {
                if entry < f64::INFINITY {
                    stack.push(node.children[side]);
                }
            }
        }
    }
}
