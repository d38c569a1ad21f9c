//! Questions to a tree: depth first, without recursion.

use arrayvec::ArrayVec;
use carom_geometry::Aabb;
use carom_math::Vec2;

use super::bounds::{Bounds, up};
use super::sweep::{Near, Sweep};
use super::{BoxTree, ROOT};

/// What is still to visit: without memory of its own as long as it fits, which it does in any tree
/// of less than 64 levels.
pub(super) struct Stack<T> {
    near: ArrayVec<T, 64>,
    rest: Vec<T>,
}

impl<T> Stack<T> {
    pub(super) const fn new() -> Self {
        Self {
            near: ArrayVec::new_const(),
            rest: Vec::new(),
        }
    }

    #[inline]
    pub(super) fn push(&mut self, item: T) {
        if let Err(full) = self.near.try_push(item) {
            self.rest.push(full.element());
        }
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<T> {
        if self.rest.is_empty() {
            self.near.pop()
        } else {
            self.rest.pop()
        }
    }
}

impl BoxTree {
    /// Calls `found` with the number of every leaf whose box overlaps `bounds`.
    pub fn query(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        if self.is_empty() {
            return;
        }
        let sought = Bounds::around(bounds).opposite();
        let mut stack = Stack::new();
        let mut at = ROOT;
        loop {
            let pair = &self.pairs[at as usize];
            let mut next = None;
            for side in [1, 0] {
                if !pair.boxes[side].meets(sought) {
                    continue;
                }
                let child = pair.children[side];
                if child.is_leaf() {
                    found(pair.data[side]);
                } else if let Some(other) = next.replace(child.0) {
                    stack.push(other);
                }
            }
            let Some(below) = next.or_else(|| stack.pop()) else {
                return;
            };
            at = below;
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
    /// `max`. What lies as far as the end is seen.
    pub fn ray(&self, origin: Vec2, direction: Vec2, max: f64, found: impl FnMut(u32) -> f64) {
        self.sweep(Aabb::new(origin, origin), direction, max, found);
    }

    /// Calls `found` with the number of every leaf whose box a moving box meets, roughly the first
    /// met first.
    ///
    /// The box moves along `direction`; the rest is as with [`Self::ray`].
    pub fn sweep(
        &self,
        bounds: Aabb,
        direction: Vec2,
        max: f64,
        mut found: impl FnMut(u32) -> f64,
    ) {
        let sweep = Sweep::new(bounds, direction, max);
        let limit = |max: f64| up(max * sweep.unit);
        self.nearest_first(limit(max), |b| sweep.entry(b), |data| limit(found(data)));
    }

    /// Calls `found` with the number of every leaf whose box comes within `max` (m) of `bounds`,
    /// roughly the nearest first.
    ///
    /// What `found` returns is how near the others must be to be seen: return the distance of what
    /// was found to leave out what is farther, or infinity. What is as far is seen.
    ///
    /// # Examples
    /// ```
    /// use carom_collision::BoxTree;
    /// use carom_geometry::Aabb;
    /// use carom_math::vec2;
    /// let points: Vec<_> = (0..1000).map(|i| vec2(f64::from(i * 37 % 1000), 3.0)).collect();
    /// let tree: BoxTree = (0..).zip(&points).map(|(i, p)| (Aabb::new(*p, *p), i)).collect();
    /// let here = vec2(500.25, 0.0);
    /// let mut best = (f64::INFINITY, 0);
    /// let mut looked_at = 0;
    /// tree.nearest(Aabb::new(here, here), f64::INFINITY, |i| {
    ///     looked_at += 1;
    ///     let distance = points[i as usize].distance(here);
    ///     if (distance, i) < best {
    ///         best = (distance, i);
    ///     }
    ///     best.0
    /// });
    /// assert_eq!(points[best.1 as usize], vec2(500.0, 3.0));
    /// assert!(looked_at < 5);
    /// ```
    pub fn nearest(&self, bounds: Aabb, max: f64, mut found: impl FnMut(u32) -> f64) {
        let near = Near::new(bounds);
        self.nearest_first(up(max), |b| near.distance(b), |data| up(found(data)));
    }

    /// Visits what is not farther than `max`, which `found` may shorten; the nearer child first.
    fn nearest_first(
        &self,
        mut max: f32,
        far: impl Fn(Bounds) -> f32,
        mut found: impl FnMut(u32) -> f32,
    ) {
        if self.is_empty() {
            return;
        }
        let mut stack: Stack<(f32, u32)> = Stack::new();
        let mut at = ROOT;
        loop {
            let pair = &self.pairs[at as usize];
            let far = pair.boxes.map(&far);
            let mut next = None;
            let first = usize::from(far[1] < far[0]);
            for side in [first, 1 - first] {
                // Tested after the other side: the way may have become shorter meanwhile.
                if far[side] > max {
                    break;
                }
                let child = pair.children[side];
                if child.is_none() {
                    continue;
                } else if child.is_leaf() {
                    max = max.min(found(pair.data[side]));
                } else if next.is_none() {
                    next = Some(child.0);
                } else {
                    stack.push((far[side], child.0));
                }
            }
            while next.is_none() {
                match stack.pop() {
                    None => return,
                    Some((far, child)) if far <= max => next = Some(child),
                    Some(_) => {}
                }
            }
            let Some(below) = next else { return };
            at = below;
        }
    }
}
