//! Questions to a tree: depth first, without recursion.

use carom_geometry::Aabb;
use carom_math::Vec2;

use super::bounds::{Bounds, up};
use super::sweep::{Near, Sweep, less};
use super::{BoxTree, NONE, ROOT};

/// What is still to visit, or was found: without memory of its own as long as it fits, which it
/// does in any tree of less than 60 levels.
pub(super) struct Stack<T, const ROOM: usize> {
    near: [T; ROOM],
    len: usize,
    rest: Vec<T>,
}

impl<T: Copy, const ROOM: usize> Stack<T, ROOM> {
    pub(super) const fn new(nothing: T) -> Self {
        Self {
            near: [nothing; ROOM],
            len: 0,
            rest: Vec::new(),
        }
    }

    /// Conditional push without a branch: the outcome is unpredictable.
    ///
    /// There must be room: see [`Self::make_room`].
    #[inline]
    pub(super) fn push_if(&mut self, taken: bool, item: T) {
        self.near[self.len] = item;
        self.len += usize::from(taken);
    }

    /// Room for `count` more, one after the other, of which any may be left.
    #[inline]
    pub(super) fn make_room(&mut self, count: usize) {
        if !self.has_room(count) {
            self.rest.extend_from_slice(&self.near[..self.len]);
            self.len = 0;
        }
    }

    #[inline]
    pub(super) fn has_room(&self, count: usize) -> bool {
        self.len + count < ROOM
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline]
    pub(super) fn push(&mut self, item: T) {
        self.make_room(1);
        self.push_if(true, item);
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<T> {
        if self.len == 0 {
            return self.rest.pop();
        }
        self.len -= 1;
        Some(self.near[self.len])
    }

    /// The last few, as many as there are of them.
    #[inline]
    pub(super) fn pop_some<const COUNT: usize>(&mut self) -> ([T; COUNT], usize) {
        if self.len == 0
            && let Some(late) = self.rest.pop()
        {
            self.push_if(true, late);
        }
        let count = self.len.min(COUNT);
        let from = self.len - count;
        let mut some = [self.near[0]; COUNT];
        some[..count].copy_from_slice(&self.near[from..self.len]);
        self.len = from;
        (some, count)
    }

    /// All that is not in memory of its own.
    #[inline]
    pub(super) fn near(&self) -> &[T] {
        &self.near[..self.len]
    }
}

/// Leaves on their way out of a query.
const HITS: usize = 32;

impl BoxTree {
    /// Calls `found` with the number of every leaf with a box that overlaps `bounds`.
    pub fn query(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        if self.is_empty() {
            return;
        }
        let sought = Bounds::around(bounds).opposite();
        let mut stack: Stack<u32, 64> = Stack::new(ROOT);
        // Found leaves wait for others: a call for each would interrupt the walk.
        let mut hits = [0; HITS];
        let mut count = 0;
        let mut next = Some(ROOT);
        while let Some(at) = next {
            let pair = &self.pairs[at as usize];
            stack.make_room(2);
            // The first child comes next, in the walk as in memory.
            for side in [1, 0] {
                let (met, child) = (pair.boxes[side].meets(sought), pair.children[side]);
                stack.push_if(met & !child.is_leaf(), child.0);
                hits[count % HITS] = pair.data[side];
                count += usize::from(met & child.is_leaf());
            }
            if count > HITS - 2 {
                hits[..count].iter().for_each(|data| found(*data));
                count = 0;
            }
            next = stack.pop();
        }
        hits[..count].iter().for_each(|data| found(*data));
    }

    /// Calls `found` with the number of every leaf with a box that contains `point`.
    pub fn point(&self, point: Vec2, found: impl FnMut(u32)) {
        self.query(Aabb::new(point, point), found);
    }

    /// Calls `found` with the number of every leaf with a box that a ray meets, roughly the nearest first.
    ///
    /// `max` and what `found` returns are how far the ray goes, in lengths of `direction`: return
    /// the distance of a hit to leave out what lies behind it, or infinity to see everything up to
    /// `max`. What lies as far as the end is seen.
    pub fn ray(&self, origin: Vec2, direction: Vec2, max: f64, found: impl FnMut(u32) -> f64) {
        self.sweep(Aabb::new(origin, origin), direction, max, found);
    }

    /// Calls `found` with the number of every leaf with a box that a moving box meets, roughly the
    /// first met first.
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

    /// Calls `found` with the number of every leaf with a box within `max` (m) of `bounds`,
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
        let limit = Near::limit;
        self.nearest_first(limit(max), |b| near.square(b), |data| limit(found(data)));
    }

    /// Visits what is not farther than `max`, which `found` may shorten; the nearer child first.
    #[inline]
    fn nearest_first(
        &self,
        mut max: f32,
        far: impl Fn(Bounds) -> f32,
        mut found: impl FnMut(u32) -> f32,
    ) {
        if self.is_empty() {
            return;
        }
        let mut stack: Stack<(f32, u32), 64> = Stack::new((0.0, NONE));
        let mut next = Some(ROOT);
        while let Some(at) = next.take() {
            let pair = &self.pairs[at as usize];
            let [one, two] = pair.boxes.map(&far);
            let mut visit = |side: usize, far: f32| {
                // The way may have become shorter on the other side.
                if far <= max {
                    let child = pair.children[side];
                    if child.is_leaf() {
                        max = less(max, found(pair.data[side]));
                    } else if next.is_none() {
                        next = Some(child.0);
                    } else {
                        stack.push((far, child.0));
                    }
                }
            };
            // Two branches instead of one with a choice of sides: one predicted right is taken before
            // the distances are there.
            if two < one {
                visit(1, two);
                visit(0, one);
            } else {
                visit(0, one);
                visit(1, two);
            }
            while next.is_none() {
                match stack.pop() {
                    None => return,
                    Some((far, child)) if far <= max => next = Some(child),
                    Some(_) => {}
                }
            }
        }
    }
}
