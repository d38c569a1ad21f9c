//! A uniform grid of cells over the whole plane: which free bodies sweep over which cells.

use carom_geometry::Aabb;
use carom_math::Vec2;

use crate::store::swept::{Cells, Sides};
use crate::{BodyIx, Ix};

/// A body and the box that it sweeps over: 20 bytes, read one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SweptBox {
    pub(crate) body: BodyIx,
    sides: Sides,
}

impl SweptBox {
    pub(crate) const fn new(body: BodyIx, sides: Sides) -> Self {
        Self { body, sides }
    }

    /// What the sides of another box must not be above, if it overlaps this one.
    fn limits(&self) -> [f32; 4] {
        let [left, bottom, right, top] = self.sides.0;
        [-right, -top, -left, -bottom]
    }

    /// Four comparisons without a branch: most boxes are apart, in a direction that no branch predictor can tell.
    fn is_within(&self, limits: [f32; 4]) -> bool {
        let apart = [0, 1, 2, 3].map(|side| u32::from(self.sides.0[side] > limits[side]));
        apart[0] | apart[1] | apart[2] | apart[3] == 0
    }
}

/// Where the origin lies in its cell: scenes are often laid out about it, and what lies on a border is in two cells.
const CORNER: f64 = 0.381_966_011_250_105;

/// Lists of bodies by cell. Cells share lists by a hash of their numbers: the plane has no border,
/// and a list may name bodies of a cell far away.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    /// Side of a cell, in m.
    side: f64,
    lists: Vec<Vec<SweptBox>>,
}

impl Default for Grid {
    fn default() -> Self {
        Self::new(1.0, 0)
    }
}

impl Grid {
    pub(crate) fn new(side: f64, bodies: usize) -> Self {
        let lists = (2 * bodies).next_power_of_two().max(64);
        Self {
            side,
            lists: vec![Vec::new(); lists],
        }
    }

    /// Side of a cell, in m.
    pub(crate) const fn side(&self) -> f64 {
        self.side
    }

    /// Lists that cells share.
    pub(crate) fn room(&self) -> usize {
        self.lists.len()
    }

    /// The cells that a box covers.
    pub(crate) fn cells(&self, bounds: Aabb) -> Cells {
        Cells {
            low: self.cell(bounds.min),
            high: self.cell(bounds.max),
        }
    }

    pub(crate) fn insert(&mut self, swept_box: SweptBox, cells: Cells) {
        for cell in cells.each() {
            let list = self.list(cell);
            self.lists[list].push(swept_box);
        }
    }

    pub(crate) fn remove(&mut self, body: BodyIx, cells: Cells) {
        for cell in cells.each() {
            let list = self.list(cell);
            let list = &mut self.lists[list];
            if let Some(at) = list.iter().position(|swept_box| swept_box.body == body) {
                list.swap_remove(at);
            }
        }
    }

    /// Appends every body in the cells with a box that overlaps `swept_box`, itself included; some more than once.
    /// Returns how many boxes were compared.
    pub(crate) fn gather(
        &self,
        swept_box: &SweptBox,
        cells: Cells,
        near: &mut Vec<BodyIx>,
    ) -> usize {
        let (limits, mut count) = (swept_box.limits(), 0);
        for cell in cells.each() {
            let list = &self.lists[self.list(cell)];
            count += list.len();
            // Every body is written, and kept by advancing `end`: a branch on the overlap would be mispredicted.
            let mut end = near.len();
            near.resize(end + list.len(), BodyIx::NONE);
            for other in list {
                near[end] = other.body;
                end += usize::from(other.is_within(limits));
            }
            near.truncate(end);
        }
        count
    }

    fn cell(&self, point: Vec2) -> (i32, i32) {
        let cell = point / self.side + CORNER;
        (floor(cell.x), floor(cell.y))
    }

    /// Neighbours get neighbouring lists along a row; rows are spread by a golden-ratio hash.
    #[expect(clippy::cast_sign_loss, reason = "only bits count")]
    fn list(&self, (x, y): (i32, i32)) -> usize {
        let hash = (x as u32).wrapping_add((y as u32).wrapping_mul(0x9E37_79B1));
        hash as usize & (self.lists.len() - 1)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the cast saturates: beyond 2^31 cells all share the last one"
)]
fn floor(x: f64) -> i32 {
    let whole = x as i32;
    whole.saturating_sub(i32::from(f64::from(whole) > x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn overlapping_boxes_find_each_other(
            boxes in proptest::collection::vec((-1e3..1e3_f64, -1e3..1e3_f64, 0.0..9.0_f64, 0.0..9.0_f64), 1..60),
            side in 0.5..20.0_f64, moves in (-9.0..9.0_f64, -9.0..9.0_f64),
        ) {
            let mut grid = Grid::new(side, boxes.len());
            let boxes: Vec<Aabb> = boxes
                .iter()
                .map(|(x, y, w, h)| Aabb::new(vec2(*x, *y), vec2(x + w, y + h)))
                .collect();
            let before = boxes.clone();
            let way = vec2(moves.0, moves.1);
            let boxes: Vec<Aabb> = boxes
                .into_iter()
                .map(|b| Aabb::new(b.min + way, b.max + way))
                .collect();
            for (i, bounds) in (0..).map(BodyIx::new).zip(&before) {
                grid.insert(SweptBox::new(i, Sides::around(*bounds)), grid.cells(*bounds));
            }
            for (i, (from, to)) in (0..).map(BodyIx::new).zip(before.iter().zip(&boxes)) {
                grid.remove(i, grid.cells(*from));
                grid.insert(SweptBox::new(i, Sides::around(*to)), grid.cells(*to));
            }
            for (i, bounds) in (0..).map(BodyIx::new).zip(&boxes) {
                let mut near = Vec::new();
                let swept_box = SweptBox::new(i, Sides::around(*bounds));
                grid.gather(&swept_box, grid.cells(*bounds), &mut near);
                for (j, other) in (0..).map(BodyIx::new).zip(&boxes) {
                    prop_assert!(near.contains(&j) || !bounds.overlaps(*other), "{:?} misses {:?}", i, j);
                    let apart = !bounds.grown(1e-3).overlaps(other.grown(1e-3));
                    prop_assert!(!(near.contains(&j) && apart), "{:?} meets {:?}", i, j);
                }
            }
            for (i, bounds) in (0..).map(BodyIx::new).zip(&boxes) {
                grid.remove(i, grid.cells(*bounds));
            }
            prop_assert!(grid.lists.iter().all(Vec::is_empty));
        }
    }
}
