//! Boxes of all shapes that no grid of flyers holds, in two trees.
//!
//! What stands or is slow lies in one, and bodies on their courses in the other: a search for what stands about does
//! not wade through a crowd, which is searched all at once ([`crate::stepped`]).

use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;
use carom_math::Vec2;

/// Where the box of a shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaf {
    Still(NodeId),
    OnCourse(NodeId),
}

/// Both trees.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trees {
    still: BoxTree,
    on_course: BoxTree,
    /// New boxes of those on their courses that the tree does not know yet.
    late: Vec<(NodeId, Aabb)>,
    gathers: bool,
}

impl Trees {
    pub(crate) const fn is_empty(&self) -> bool {
        self.still.is_empty() && self.on_course.is_empty()
    }

    /// From now on boxes of those on their courses come to the tree all at once, by [`Self::settle`]; nobody asks it
    /// before.
    pub(crate) const fn gather(&mut self) {
        self.gathers = true;
    }

    /// The tree knows all boxes again.
    pub(crate) fn settle(&mut self) {
        self.gathers = false;
        let used = self.late.len();
        if used > 0 {
            self.on_course.update_all(self.late.drain(..));
        }
        // A pile that has come to rest leaves no room of its fall behind.
        self.late.shrink_to(4 * used);
    }

    /// Gives shape `at` a new box.
    pub(crate) fn put(&mut self, leaf: &mut Option<Leaf>, bounds: Aabb, at: u32, on_course: bool) {
        match *leaf {
            Some(Leaf::Still(node)) if !on_course => {
                self.still.update(node, bounds);
            }
            Some(Leaf::OnCourse(node)) if on_course && self.gathers => {
                self.late.push((node, bounds));
            }
            Some(Leaf::OnCourse(node)) if on_course => {
                self.on_course.update(node, bounds);
            }
            other => {
                if let Some(other) = other {
                    self.remove(other);
                }
                *leaf = Some(if on_course {
                    Leaf::OnCourse(self.on_course.insert(bounds, at))
                } else {
                    Leaf::Still(self.still.insert(bounds, at))
                });
            }
        }
    }

    pub(crate) fn remove(&mut self, leaf: Leaf) {
        match leaf {
            Leaf::Still(node) => self.still.remove(node),
            Leaf::OnCourse(node) => {
                debug_assert!(
                    self.late.iter().all(|(late, _)| *late != node),
                    "a new box of a shape that is gone"
                );
                self.on_course.remove(node)
            }
        };
    }

    /// Calls `found` with every shape whose box overlaps `bounds`.
    pub(crate) fn query(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        debug_assert!(self.late.is_empty(), "boxes that the tree does not know");
        self.still.query(bounds, &mut found);
        self.on_course.query(bounds, found);
    }

    /// The same for what is not on a course.
    pub(crate) fn query_still(&self, bounds: Aabb, found: impl FnMut(u32)) {
        self.still.query(bounds, found);
    }

    /// Calls `found` with every shape whose box the moving `bounds` meet; it says how far to go on, as a fraction of
    /// `way`.
    pub(crate) fn sweep(
        &self,
        bounds: Aabb,
        way: Vec2,
        max: f64,
        mut found: impl FnMut(u32) -> f64,
    ) {
        let mut left = max;
        self.still.sweep(bounds, way, max, |at| {
            left = left.min(found(at));
            left
        });
        self.on_course.sweep(bounds, way, left, found);
    }

    /// The same for a ray.
    pub(crate) fn ray(
        &self,
        origin: Vec2,
        direction: Vec2,
        max: f64,
        found: impl FnMut(u32) -> f64,
    ) {
        self.sweep(Aabb::new(origin, origin), direction, max, found);
    }
}
