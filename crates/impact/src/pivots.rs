//! Lemke's pivoting: a solution of the contact problem where guesses do not settle.
//!
//! Friction as a linear complementarity problem (M. Anitescu, F. Potra 1997, after D. Stewart, J. Trinkle 1996):
//!
//! ```text
//! j_t = β₊ − β₋      0 ≤ u_t + λ ⟂ β₊ ≥ 0      0 ≤ λ − u_t ⟂ β₋ ≥ 0      0 ≤ limit − β₊ − β₋ ⟂ λ ≥ 0
//! ```
//!
//! Its matrix is copositive, so the pivots end at a solution, as near as their roundings allow.

use super::coulomb::Part;
use super::rows::{Bound, Rows};
use crate::lemke::{Solution, complementary};

/// Scaled impulses of a solution and what holds in it, for scaled speeds before; `None` if the pivots
/// do not end at one.
pub(super) fn pivoted(rows: &Rows, start: &[f64]) -> Option<(Vec<f64>, Vec<Part>)> {
    let layout = Layout::of(rows);
    let found = complementary(&layout.matrix(rows), &layout.constants(rows, start))?;
    Some((layout.impulses(rows, &found), layout.parts(rows, &found)))
}

/// Where each row's unknowns are: one of a push, three of friction.
struct Layout {
    first: Vec<usize>,
    size: usize,
}

impl Layout {
    fn of(rows: &Rows) -> Self {
        let mut size = 0;
        let first = rows.rows.iter().map(|row| {
            let place = size;
            size += if row.bound == Bound::Push { 1 } else { 3 };
            place
        });
        let first = first.collect();
        Self { first, size }
    }

    fn is_push(rows: &Rows, r: usize) -> bool {
        rows.rows[r].bound == Bound::Push
    }

    fn matrix(&self, rows: &Rows) -> Vec<f64> {
        let n = self.size;
        let mut matrix = vec![0.0; n * n];
        for (r, &i) in self.first.iter().enumerate() {
            for (s, &j) in self.first.iter().enumerate() {
                let k = rows.k[r * rows.len() + s];
                let signs = |push: bool| if push { &[1.0][..] } else { &[1.0, -1.0] };
                for (di, up) in signs(Self::is_push(rows, r)).iter().enumerate() {
                    for (dj, along) in signs(Self::is_push(rows, s)).iter().enumerate() {
                        matrix[(i + di) * n + j + dj] = up * along * k;
                    }
                }
            }
            if !Self::is_push(rows, r) {
                matrix[i * n + i + 2] = 1.0;
                matrix[(i + 1) * n + i + 2] = 1.0;
                matrix[(i + 2) * n + i] = -1.0;
                matrix[(i + 2) * n + i + 1] = -1.0;
                if let Bound::Friction(normals, _) = rows.rows[r].bound {
                    for normal in normals.rows() {
                        matrix[(i + 2) * n + self.first[normal]] = rows.factor(r, normal);
                    }
                }
            }
        }
        matrix
    }

    fn constants(&self, rows: &Rows, start: &[f64]) -> Vec<f64> {
        let mut constants = vec![0.0; self.size];
        for (r, &i) in self.first.iter().enumerate() {
            constants[i] = start[r];
            if !Self::is_push(rows, r) {
                constants[i + 1] = -start[r];
                if let Bound::Limit(_) = rows.rows[r].bound {
                    constants[i + 2] = rows.limit(r, &[]);
                }
            }
        }
        constants
    }

    fn impulses(&self, rows: &Rows, found: &Solution) -> Vec<f64> {
        let impulse = |(r, &i): (usize, &usize)| {
            if Self::is_push(rows, r) {
                found.z[i]
            } else {
                found.z[i] - found.z[i + 1]
            }
        };
        self.first.iter().enumerate().map(impulse).collect()
    }

    fn parts(&self, rows: &Rows, found: &Solution) -> Vec<Part> {
        let part = |(r, &i): (usize, &usize)| {
            if rows.scales[r] == 0.0 {
                return Part::Off;
            }
            let holds = |normal: usize| found.basic[self.first[normal]];
            match rows.rows[r].bound {
                Bound::Push if found.basic[i] => Part::Hold,
                Bound::Push => Part::Off,
                Bound::Friction(normals, _) if !normals.rows().any(holds) => Part::Off,
                Bound::Friction(..) | Bound::Limit(_) => {
                    match (found.basic[i], found.basic[i + 1], found.basic[i + 2]) {
                        (true, false, true) => Part::High,
                        (false, true, true) => Part::Low,
                        _ => Part::Hold,
                    }
                }
            }
        };
        self.first.iter().enumerate().map(part).collect()
    }
}
