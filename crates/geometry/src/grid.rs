//! Points in the cells of a grid, for questions about small boxes.

use carom_math::{Vec2, vec2};

use crate::Aabb;

/// About two points a cell; the lists of all cells stand one after another.
pub(crate) struct Grid {
    corner: Vec2,
    /// Cells per metre.
    scale: Vec2,
    columns: usize,
    rows: usize,
    /// Where the list of each cell begins, and the end of the last.
    starts: Vec<usize>,
    members: Vec<usize>,
}

impl Grid {
    /// A grid of some of the `points`.
    pub(crate) fn new(points: &[Vec2], members: Vec<usize>) -> Self {
        let bounds = Aabb::from_points(members.iter().map(|&i| points[i]));
        let cells = members.len() / 2 + 1;
        let size = bounds.extents().max(Vec2::ZERO);
        let columns = whole((size.x / size.y * real(cells)).sqrt(), cells).max(1);
        let rows = (cells / columns).max(1);
        let scale = |count: usize, length: f64| {
            if length > 0.0 {
                real(count) / length
            } else {
                0.0
            }
        };
        let mut grid = Self {
            corner: bounds.min,
            scale: vec2(scale(columns, size.x), scale(rows, size.y)),
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            members: vec![0; members.len()],
        };
        // A counting sort: first how many, then where they begin, then the members themselves.
        let cells: Vec<usize> = members.iter().map(|&i| grid.cell(points[i])).collect();
        for &cell in &cells {
            grid.starts[cell + 1] += 1;
        }
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        let mut free = grid.starts.clone();
        for (member, cell) in members.into_iter().zip(cells) {
            grid.members[free[cell]] = member;
            free[cell] += 1;
        }
        grid
    }

    /// Whether the test holds for a member in `bounds`; it is asked for some outside, too.
    pub(crate) fn any_near(&self, bounds: Aabb, mut test: impl FnMut(usize) -> bool) -> bool {
        let (left, low) = self.column_and_row(bounds.min);
        let (right, high) = self.column_and_row(bounds.max);
        (low..=high).any(|row| {
            let (first, last) = (row * self.columns + left, row * self.columns + right);
            let members = &self.members[self.starts[first]..self.starts[last + 1]];
            members.iter().any(|&member| test(member))
        })
    }

    fn cell(&self, p: Vec2) -> usize {
        let (column, row) = self.column_and_row(p);
        row * self.columns + column
    }

    /// Monotone in both coordinates, so that a box sees every cell of a point inside it.
    fn column_and_row(&self, p: Vec2) -> (usize, usize) {
        let place = (p - self.corner) * self.scale;
        (
            whole(place.x, self.columns - 1),
            whole(place.y, self.rows - 1),
        )
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and NaN becomes 0"
)]
fn whole(x: f64, most: usize) -> usize {
    (x as usize).min(most)
}

#[expect(clippy::cast_precision_loss, reason = "a count of cells")]
fn real(count: usize) -> f64 {
    count as f64
}
