//! Boxes of free bodies: in the grid, and in the world while other bodies look for them there.

use carom_collision::{BoxTree, roundable};
use carom_geometry::Aabb;
use carom_math::SimTime;

use super::FreeBodies;
use crate::broad::grid::SweptBox;
use crate::store::bodies::Bodies;
use crate::store::course::Course;
use crate::store::swept::{Cells, Sides};
use crate::{BodyIx, Ix};

impl FreeBodies {
    /// Bodies of the grid with boxes that overlap a swept box, some more than once: see [`Self::has_met`].
    pub(super) fn search(&mut self, swept_box: &SweptBox, cells: Cells) -> Vec<BodyIx> {
        let mut near = core::mem::take(&mut self.near);
        near.clear();
        self.met += self.grid.gather(swept_box, cells, &mut near);
        near
    }

    /// The mark of a new search, which has met no body yet.
    pub(super) fn begin_to_meet(&mut self, bodies: usize) -> u32 {
        if self.seen.len() < bodies {
            self.seen.resize(bodies, self.mark);
        }
        if self.mark == u32::MAX {
            // Marks start anew: none of before may be taken for one to come.
            self.seen.fill(0);
            self.mark = 0;
        }
        self.mark += 1;
        self.mark
    }

    /// Whether the search with a mark has met a body before; perhaps not, where another search came between.
    pub(super) fn has_met(&mut self, body: BodyIx, mark: u32) -> bool {
        core::mem::replace(&mut self.seen[body], mark) == mark
    }

    /// Bodies of the grid that may be in `bounds` before they look down again, in order.
    pub(crate) fn overlapping(&self, bodies: &Bodies, bounds: Aabb, near: &mut Vec<BodyIx>) {
        near.clear();
        if self.in_grid.is_empty() {
            return;
        }
        let here = |body: BodyIx| {
            let course = &bodies.get(body).course;
            course.cells.is_some() && course.reached.overlaps(bounds)
        };
        match &self.aloft {
            Some(tree) => tree.query(bounds, |body| {
                let body = BodyIx::new(body);
                if here(body) {
                    near.push(body);
                }
            }),
            None => near.extend(self.in_grid.iter().filter(|body| here(**body))),
        }
        near.sort_unstable();
    }

    /// Bodies of the grid that may be in `bounds` at `time`, in order.
    pub(crate) fn present(&self, bodies: &Bodies, bounds: Aabb, time: SimTime) -> Vec<BodyIx> {
        let mut near = Vec::new();
        if self.in_grid.is_empty() {
            return near;
        }
        let seen = Aabb::new(
            self.frame.point(bounds.min, time),
            self.frame.point(bounds.max, time),
        );
        let here = |body: BodyIx| {
            let course = &bodies.get(body).course;
            course.cells.is_some() && course.swept.overlaps(seen)
        };
        let cells = self.grid.cells(seen);
        if cells.count() > self.in_grid.len() as u64 {
            near.extend(self.in_grid.iter().filter(|body| here(**body)));
        } else {
            let swept_box = SweptBox::new(BodyIx::NONE, Sides::around(seen));
            self.grid.gather(&swept_box, cells, &mut near);
            near.retain(|body| here(*body));
        }
        near.sort_unstable();
        near.dedup();
        near
    }

    /// From now on bodies look for free bodies by boxes in the world.
    pub(crate) fn raise(&mut self, bodies: &Bodies) {
        let all = self.in_order();
        let boxes = all
            .iter()
            .map(|index| (box_aloft(&bodies.get(*index).course), index.number()));
        let mut tree = BoxTree::new();
        let nodes = tree.extend(boxes);
        self.nodes.clear();
        self.nodes.resize(bodies.places(), None);
        for (index, node) in all.into_iter().zip(nodes) {
            self.nodes[index] = Some(node);
        }
        self.aloft = Some(tree);
    }

    /// Whether bodies look for free bodies by boxes in the world.
    pub(crate) const fn is_raised(&self) -> bool {
        self.aloft.is_some()
    }

    /// Drops the boxes in the world: no body looks for free bodies there any more.
    pub(crate) fn lower(&mut self) {
        if let Some(tree) = self.aloft.take() {
            for index in tree.ids().filter_map(|node| tree.data(node)) {
                self.nodes[BodyIx::new(index)] = None;
            }
        }
    }

    /// Keeps the box in the world of a free body in the grid.
    pub(super) fn lift(&mut self, course: &Course, index: BodyIx) {
        let Some(tree) = &mut self.aloft else {
            return;
        };
        let bounds = box_aloft(course);
        match self.nodes.grown(index, None) {
            Some(node) => {
                tree.update(*node, bounds);
            }
            none => *none = Some(tree.insert(bounds, index.number())),
        }
    }

    /// Takes a body out of the grid, and its box out of the tree aloft.
    pub(crate) fn vanish(&mut self, bodies: &mut Bodies, index: BodyIx) {
        self.leave(bodies, index);
        let node = self.nodes.get_mut(index).and_then(Option::take);
        if let (Some(tree), Some(node)) = (&mut self.aloft, node) {
            tree.remove(node);
        }
    }
}

/// Box in the world of a free body until it looks down again.
fn box_aloft(course: &Course) -> Aabb {
    let bounds = course.reached.bounds();
    bounds.grown(roundable(bounds))
}
