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

/// Pivots for each unknown before it is given up.
const PIVOTS: usize = 20;

/// What keeps two candidates from leaving at once, as a part of the largest speed.
const SHIFT: f64 = 1e-11;

/// A pivot below this is rounding.
const LEAST_PIVOT: f64 = 1e-11;

/// Scaled impulses of a solution and who holds in it, for scaled speeds before; `None` if the pivots
/// do not end at one.
pub(super) fn pivoted(rows: &Rows<'_>, start: &[f64]) -> Option<(Vec<f64>, Vec<Part>)> {
    let layout = Layout::of(rows);
    let mut tableau = Tableau::new(&layout.matrix(rows), layout.constants(rows, start));
    let ends = tableau.run();
    ends.then(|| {
        (
            layout.impulses(rows, &tableau),
            layout.parts(rows, &tableau),
        )
    })
}

/// Where each row's unknowns are: one of a push, three of friction.
struct Layout {
    first: Vec<usize>,
    size: usize,
}

impl Layout {
    fn of(rows: &Rows<'_>) -> Self {
        let mut size = 0;
        let first = rows.rows.iter().map(|row| {
            let place = size;
            size += if row.bound == Bound::Push { 1 } else { 3 };
            place
        });
        let first = first.collect();
        Self { first, size }
    }

    fn is_push(rows: &Rows<'_>, r: usize) -> bool {
        rows.rows[r].bound == Bound::Push
    }

    fn matrix(&self, rows: &Rows<'_>) -> Vec<f64> {
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
                if let Bound::Friction(normal, _) = rows.rows[r].bound {
                    matrix[(i + 2) * n + self.first[normal]] = rows.factor(r);
                }
            }
        }
        matrix
    }

    #[expect(clippy::cast_precision_loss, reason = "a few hundred at most")]
    fn constants(&self, rows: &Rows<'_>, start: &[f64]) -> Vec<f64> {
        let size = start.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
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
        for (k, constant) in constants.iter_mut().enumerate() {
            *constant += SHIFT * size * (1.0 + k as f64 / self.size as f64);
        }
        constants
    }

    fn impulses(&self, rows: &Rows<'_>, tableau: &Tableau) -> Vec<f64> {
        let impulse = |(r, &i): (usize, &usize)| {
            if Self::is_push(rows, r) {
                tableau.value(i)
            } else {
                tableau.value(i) - tableau.value(i + 1)
            }
        };
        self.first.iter().enumerate().map(impulse).collect()
    }

    fn parts(&self, rows: &Rows<'_>, tableau: &Tableau) -> Vec<Part> {
        let part = |(r, &i): (usize, &usize)| {
            if rows.scales[r] == 0.0 {
                return Part::Off;
            }
            let holds = |normal: usize| tableau.is_basic(self.first[normal]);
            match rows.rows[r].bound {
                Bound::Push if tableau.is_basic(i) => Part::Hold,
                Bound::Push => Part::Off,
                Bound::Friction(normal, _) if !holds(normal) => Part::Off,
                Bound::Friction(..) | Bound::Limit(_) => match (
                    tableau.is_basic(i),
                    tableau.is_basic(i + 1),
                    tableau.is_basic(i + 2),
                ) {
                    (true, false, true) => Part::High,
                    (false, true, true) => Part::Low,
                    _ => Part::Hold,
                },
            }
        };
        self.first.iter().enumerate().map(part).collect()
    }
}

/// `w = M z + z₀ + q` solved for the basic unknowns: `I x_B = q̄ − …`.
struct Tableau {
    size: usize,
    /// Row by row: w's columns, z's, that of z₀, and the constants.
    entries: Vec<f64>,
    /// Unknown that each row is solved for: k is `w_k`, size + k is `z_k`, 2 size is z₀.
    basis: Vec<usize>,
}

impl Tableau {
    fn new(matrix: &[f64], constants: Vec<f64>) -> Self {
        let n = constants.len();
        let width = 2 * n + 2;
        let mut entries = vec![0.0; n * width];
        for (k, constant) in constants.into_iter().enumerate() {
            let row = &mut entries[k * width..(k + 1) * width];
            row[k] = 1.0;
            for (to, from) in row[n..2 * n].iter_mut().zip(&matrix[k * n..]) {
                *to = -from;
            }
            row[2 * n] = -1.0;
            row[2 * n + 1] = constant;
        }
        Self {
            size: n,
            entries,
            basis: (0..n).collect(),
        }
    }

    fn width(&self) -> usize {
        2 * self.size + 2
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * self.width() + column]
    }

    fn is_basic(&self, unknown: usize) -> bool {
        self.basis.contains(&(self.size + unknown))
    }

    fn value(&self, unknown: usize) -> f64 {
        let row = self
            .basis
            .iter()
            .position(|&held| held == self.size + unknown);
        row.map_or(0.0, |row| self.at(row, 2 * self.size + 1))
    }

    /// Whether z₀ left: then the rest is a solution.
    fn run(&mut self) -> bool {
        let n = self.size;
        let constant = |tableau: &Self, row: usize| tableau.at(row, 2 * n + 1);
        let worst = (0..n).min_by(|&a, &b| constant(self, a).total_cmp(&constant(self, b)));
        let Some(first) = worst.filter(|&row| constant(self, row) < 0.0) else {
            return true;
        };
        let mut leaving = self.pivot(first, 2 * n);
        for _ in 0..PIVOTS * n {
            if leaving == 2 * n {
                return true;
            }
            let entering = if leaving < n {
                leaving + n
            } else {
                leaving - n
            };
            let Some(row) = self.blocking(entering) else {
                return false;
            };
            leaving = self.pivot(row, entering);
        }
        false
    }

    /// The row that limits how far an unknown may grow; z₀ if it is among them.
    fn blocking(&self, entering: usize) -> Option<usize> {
        let n = self.size;
        let mut first: Option<(usize, f64)> = None;
        for row in 0..n {
            let rate = self.at(row, entering);
            if rate <= LEAST_PIVOT {
                continue;
            }
            let way = self.at(row, 2 * n + 1).max(0.0) / rate;
            let sooner = first.is_none_or(|(held, least)| {
                way < least || way <= least && self.basis[row] == 2 * n && self.basis[held] != 2 * n
            });
            if sooner {
                first = Some((row, way));
            }
        }
        first.map(|(row, _)| row)
    }

    /// Solves `row` for `entering`; the unknown that leaves.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let width = self.width();
        let inverse = self.at(row, entering).recip();
        let pivots: Vec<f64> = self.entries[row * width..(row + 1) * width]
            .iter()
            .map(|entry| entry * inverse)
            .collect();
        for (k, other) in self.entries.chunks_exact_mut(width).enumerate() {
            if k == row {
                other.copy_from_slice(&pivots);
                continue;
            }
            let factor = other[entering];
            if factor != 0.0 {
                for (entry, of_pivot) in other.iter_mut().zip(&pivots) {
                    *entry -= factor * of_pivot;
                }
            }
        }
        core::mem::replace(&mut self.basis[row], entering)
    }
}
