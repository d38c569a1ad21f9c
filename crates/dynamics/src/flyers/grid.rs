//! A uniform grid of cells over the whole plane: which flyers sweep over which cells.

use carom_geometry::Aabb;
use carom_math::Vec2;

/// A rectangle of cells, corners included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cells {
    low: (i32, i32),
    high: (i32, i32),
}

impl Cells {
    /// How many there are.
    pub(crate) fn count(self) -> u64 {
        let side = |low: i32, high: i32| high.abs_diff(low).saturating_add(1);
        u64::from(side(self.low.0, self.high.0)) * u64::from(side(self.low.1, self.high.1))
    }

    fn each(self) -> impl Iterator<Item = (i32, i32)> {
        (self.low.1..=self.high.1)
            .flat_map(move |y| (self.low.0..=self.high.0).map(move |x| (x, y)))
    }
}

/// Lists of bodies by cell. Cells share lists by a hash of their numbers: the plane has no border,
/// and a list may name bodies of a cell far away.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    /// Side of a cell, in m.
    side: f64,
    lists: Vec<Vec<u32>>,
    /// Bodies in the grid.
    count: usize,
}

impl Grid {
    pub(crate) fn new(side: f64, bodies: usize) -> Self {
        let lists = (2 * bodies).next_power_of_two().max(64);
        Self {
            side,
            lists: vec![Vec::new(); lists],
            count: 0,
        }
    }

    /// Side of a cell, in m.
    pub(crate) const fn side(&self) -> f64 {
        self.side
    }

    /// Bodies in the grid.
    pub(crate) const fn count(&self) -> usize {
        self.count
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

    pub(crate) fn insert(&mut self, body: u32, cells: Cells) {
        self.count += 1;
        for cell in cells.each() {
            let list = self.list(cell);
            self.lists[list].push(body);
        }
    }

    pub(crate) fn remove(&mut self, body: u32, cells: Cells) {
        self.count -= 1;
        for cell in cells.each() {
            let list = self.list(cell);
            let list = &mut self.lists[list];
            if let Some(at) = list.iter().position(|other| *other == body) {
                list.swap_remove(at);
            }
        }
    }

    /// Calls `visit` with every body in the cells; with some more than once, and with some that are
    /// elsewhere.
    pub(crate) fn visit(&self, cells: Cells, mut visit: impl FnMut(u32)) {
        for cell in cells.each() {
            for body in &self.lists[self.list(cell)] {
                visit(*body);
            }
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast saturates: beyond 2^31 cells all share the last one"
    )]
    fn cell(&self, point: Vec2) -> (i32, i32) {
        let cell = (point / self.side).floor();
        (cell.x as i32, cell.y as i32)
    }

    /// Neighbours get neighbouring lists along a row; rows are spread by a golden-ratio hash.
    #[expect(clippy::cast_sign_loss, reason = "only bits count")]
    fn list(&self, (x, y): (i32, i32)) -> usize {
        let hash = (x as u32).wrapping_add((y as u32).wrapping_mul(0x9E37_79B1));
        hash as usize & (self.lists.len() - 1)
    }
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
            side in 0.5..20.0_f64,
        ) {
            let mut grid = Grid::new(side, boxes.len());
            let boxes: Vec<Aabb> = boxes
                .iter()
                .map(|(x, y, w, h)| Aabb::new(vec2(*x, *y), vec2(x + w, y + h)))
                .collect();
            for (i, bounds) in (0..).zip(&boxes) {
                grid.insert(i, grid.cells(*bounds));
            }
            for (i, bounds) in (0_u32..).zip(&boxes) {
                let mut near = Vec::new();
                grid.visit(grid.cells(*bounds), |body| near.push(body));
                for (j, other) in (0_u32..).zip(&boxes) {
                    prop_assert!(near.contains(&j) || !bounds.overlaps(*other), "{} misses {}", i, j);
                }
            }
            for (i, bounds) in (0..).zip(&boxes) {
                grid.remove(i, grid.cells(*bounds));
            }
            prop_assert!(grid.count() == 0 && grid.lists.iter().all(Vec::is_empty));
        }
    }
}
