//! A tree of boxes: which of many are near a box, a ray or a point.

use carom_geometry::Aabb;
use carom_math::Vec2;

/// A leaf of a [`BoxTree`]; it stays the same until the leaf is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

/// Boxes with a number each, found by where they are.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {}

impl BoxTree {
    /// An empty tree.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a box with its number.
    pub fn insert(&mut self, bounds: Aabb, data: u32) -> NodeId {
        let _ = (bounds, data);
        todo!()
    }

    /// Moves a leaf.
    pub fn update(&mut self, id: NodeId, bounds: Aabb) {
        let _ = (id, bounds);
        todo!()
    }

    /// Takes a leaf out.
    pub fn remove(&mut self, id: NodeId) {
        let _ = id;
        todo!()
    }

    /// The box that the tree keeps for a leaf.
    #[must_use]
    pub fn fat_box(&self, id: NodeId) -> Aabb {
        let _ = id;
        todo!()
    }

    /// Calls `found` with the number of every leaf whose box overlaps `bounds`.
    pub fn query(&self, bounds: Aabb, found: impl FnMut(u32)) {
        let _ = (bounds, found);
        todo!()
    }

    /// Calls `found` with the number of every leaf whose box contains `point`.
    pub fn point(&self, point: Vec2, found: impl FnMut(u32)) {
        self.query(Aabb::new(point, point), found);
    }

    /// Calls `found` with the number of every leaf whose box a ray meets; it returns how far the
    /// ray still goes, in lengths of `direction`.
    pub fn ray(&self, origin: Vec2, direction: Vec2, max: f64, found: impl FnMut(u32) -> f64) {
        let _ = (origin, direction, max, found);
        todo!()
    }
}
