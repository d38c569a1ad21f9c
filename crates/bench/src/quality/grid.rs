//! Which boxes meet: a uniform grid for most, a list for those that would fill it.

use carom_math::Vec2;

use super::solid::Solid;

/// A box that covers more cells than this is compared with every other one instead: floors, walls.
const MANY_CELLS: f64 = 64.0;

/// Calls `found` once for each pair of solids with boxes that meet.
pub(super) fn meeting(solids: &[Solid], mut found: impl FnMut(usize, usize)) {
    let grid = Grid::for_sizes_of(solids);
    let (mut cells, mut large) = (Vec::new(), Vec::new());
    for (index, solid) in solids.iter().enumerate() {
        match grid.covered(solid) {
            Some([low, high]) => {
                for x in low.0..=high.0 {
                    cells.extend((low.1..=high.1).map(|y| ((x, y), index)));
                }
            }
            None => large.push(index),
        }
    }

    cells.sort_unstable();
    for cell in cells.chunk_by(|a, b| a.0 == b.0) {
        for (i, &(place, a)) in cell.iter().enumerate() {
            for &(_, b) in &cell[i + 1..] {
                // A pair that shares several cells is found in the one where their common box begins.
                let common = solids[a].low.max(solids[b].low);
                if meet(&solids[a], &solids[b]) && grid.cell(common) == place {
                    found(a, b);
                }
            }
        }
    }

    for &a in &large {
        for b in 0..solids.len() {
            let both_large = b <= a && large.binary_search(&b).is_ok();
            if !both_large && meet(&solids[a], &solids[b]) {
                found(a, b);
            }
        }
    }
}

fn meet(a: &Solid, b: &Solid) -> bool {
    a.low.cmple(b.high).all() && b.low.cmple(a.high).all()
}

type Cell = (i64, i64);

struct Grid {
    /// Width of a cell, in m.
    width: f64,
}

impl Grid {
    /// Cells twice as wide as the median solid: most solids lie in one to four of them.
    fn for_sizes_of(solids: &[Solid]) -> Self {
        let extents = solids.iter().map(|solid| solid.high - solid.low);
        let mut extents: Vec<f64> = extents.map(Vec2::max_element).collect();
        extents.sort_unstable_by(f64::total_cmp);
        let median = extents.get(extents.len() / 2).copied().unwrap_or(1.0);
        Self {
            width: (2.0 * median).max(f64::MIN_POSITIVE),
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "what is too far out lies in the outermost cell, which is slow but right"
    )]
    fn cell(&self, point: Vec2) -> Cell {
        let cell = (point / self.width).floor();
        (cell.x as i64, cell.y as i64)
    }

    /// The cells of its low and high corner, if they are not too far apart.
    fn covered(&self, solid: &Solid) -> Option<[Cell; 2]> {
        let span = (solid.high / self.width).floor() - (solid.low / self.width).floor() + 1.0;
        (span.x * span.y <= MANY_CELLS).then(|| [self.cell(solid.low), self.cell(solid.high)])
    }
}
