//! Lemke's method for a linear complementarity problem.
//!
//! ```text
//! w = M z + q,   w ≥ 0,  z ≥ 0,  w·z = 0
//! ```
//!
//! Complementary pivoting with lexicographic ties, which ends (Cottle, Pang, Stone 1992, section 4.4).
//! The tableau's rounding only decides which unknowns are in the basis: the answer is solved for once more.

use crate::dense::Factored;

/// A pivot smaller than this part of its column counts as 0.
const PIVOT: f64 = 1e-11;

/// Ratios that differ by less than this part are ties.
const TIE: f64 = 1e-13;

/// The covering variable counts as 0 below this part of the largest number of q.
const UNCOVERED: f64 = 1e-12;

/// A solution: every z, and which of them the basis solves for.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// z, in the order of the rows.
    pub z: Vec<f64>,
    /// Whether the basis has z of a row, and not its w.
    pub basic: Vec<bool>,
}

/// A solution for a matrix given row by row; `None` if the method ends on a ray.
pub fn complementary(m: &[f64], q: &[f64]) -> Option<Solution> {
    let n = q.len();
    let size = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if q.iter().all(|&x| x >= -TIE * size) {
        return Some(Solution {
            z: vec![0.0; n],
            basic: vec![false; n],
        });
    }
    let mut tableau = Tableau::new(m, q, size);
    let mut entering = tableau.begin();
    // Each pivot takes another basis; few are needed but for rounding.
    for _ in 0..(40 + 20 * n) {
        let row = tableau.leaving(entering)?;
        let left = tableau.pivot(row, entering);
        if left == 2 * n || tableau.is_uncovered() {
            return Some(tableau.solution(m, q, size));
        }
        entering = if left < n { left + n } else { left - n };
    }
    None
}

/// Rows one after the other; columns: w, z, the covering variable, and the right side.
struct Tableau {
    entries: Vec<f64>,
    basis: Vec<usize>,
    n: usize,
}

impl Tableau {
    fn new(m: &[f64], q: &[f64], size: f64) -> Self {
        let n = q.len();
        let mut tableau = Self {
            entries: vec![0.0; n * (2 * n + 2)],
            basis: (0..n).collect(),
            n,
        };
        for (i, row) in tableau.entries.chunks_exact_mut(2 * n + 2).enumerate() {
            row[i] = 1.0;
            for (to, from) in row[n..2 * n].iter_mut().zip(&m[i * n..]) {
                *to = -from;
            }
            row[2 * n] = -1.0;
            row[2 * n + 1] = q[i] / size;
        }
        tableau
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * (2 * self.n + 2) + column]
    }

    fn right(&self, row: usize) -> f64 {
        self.at(row, 2 * self.n + 1)
    }

    /// The covering variable enters for the most violated row; its complement is next.
    fn begin(&mut self) -> usize {
        let n = self.n;
        let mut worst = 0;
        for i in 1..n {
            // Of equals the last: lexicographically the least.
            if self.right(i) <= self.right(worst) {
                worst = i;
            }
        }
        self.pivot(worst, 2 * n) + n
    }

    /// The row of the variable that first comes to 0; ties by the rows of the inverse basis.
    fn leaving(&self, entering: usize) -> Option<usize> {
        let n = self.n;
        let column = (0..n).map(|i| self.at(i, entering).abs());
        let least = PIVOT * column.fold(1.0, f64::max);
        let mut best: Option<usize> = None;
        for i in 0..n {
            if self.at(i, entering) <= least {
                continue;
            }
            if best.is_none_or(|found| self.before(i, found, entering)) {
                best = Some(i);
            }
        }
        // Among ties the covering variable leaves.
        let found = best?;
        let cover = (0..n).find(|&i| self.basis[i] == 2 * n);
        cover
            .filter(|&i| {
                self.at(i, entering) > least
                    && (self.ratio(i, entering, 2 * n + 1) - self.ratio(found, entering, 2 * n + 1))
                        .abs()
                        <= TIE
            })
            .or(Some(found))
    }

    /// The covering variable has come to 0 but for rounding: where rows depend on each other there may be
    /// no pivot left that would take it out.
    fn is_uncovered(&self) -> bool {
        let cover = self.basis.iter().position(|&b| b == 2 * self.n);
        cover.is_none_or(|row| self.right(row) <= UNCOVERED)
    }

    fn ratio(&self, row: usize, entering: usize, column: usize) -> f64 {
        self.at(row, column) / self.at(row, entering)
    }

    fn before(&self, i: usize, j: usize, entering: usize) -> bool {
        for column in core::iter::once(2 * self.n + 1).chain(0..self.n) {
            let (x, y) = (
                self.ratio(i, entering, column),
                self.ratio(j, entering, column),
            );
            if (x - y).abs() > TIE * (1.0 + x.abs().max(y.abs())) {
                return x < y;
            }
        }
        false
    }

    /// Brings a column into the basis; returns what left.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let width = 2 * self.n + 2;
        let (above, below) = self.entries.split_at_mut(row * width);
        let (pivot, below) = below.split_at_mut(width);
        let by = pivot[entering].recip();
        pivot.iter_mut().for_each(|x| *x *= by);
        let others = above.chunks_exact_mut(width);
        for other in others.chain(below.chunks_exact_mut(width)) {
            let factor = other[entering];
            if factor == 0.0 {
                continue;
            }
            for (x, y) in other.iter_mut().zip(&*pivot) {
                *x -= factor * y;
            }
            other[entering] = 0.0;
        }
        core::mem::replace(&mut self.basis[row], entering)
    }

    /// The basis solved for from the numbers as they were given; if its rows depend on each other, as
    /// the tableau has it.
    fn solution(&self, m: &[f64], q: &[f64], size: f64) -> Solution {
        let n = self.n;
        let held: Vec<(usize, usize)> = (0..n)
            .filter(|&row| (n..2 * n).contains(&self.basis[row]))
            .map(|row| (row, self.basis[row] - n))
            .collect();
        let square = held
            .iter()
            .flat_map(|&(_, i)| held.iter().map(move |&(_, j)| m[i * n + j]));
        let right: Vec<f64> = held.iter().map(|&(_, i)| -q[i]).collect();
        let rough = held.iter().map(|&(row, _)| self.right(row) * size);
        let exact = Factored::of(held.len(), square)
            .filter(|factored| factored.least_pivot() > f64::EPSILON);
        let found = exact.map_or_else(|| rough.collect(), |factored| factored.solve(&right));
        let mut solution = Solution {
            z: vec![0.0; n],
            basic: vec![false; n],
        };
        for ((_, place), value) in held.into_iter().zip(found) {
            solution.z[place] = if value > 0.0 { value } else { 0.0 };
            solution.basic[place] = true;
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::dot;
    use proptest::prelude::*;

    #[test]
    fn a_problem_of_two_is_solved() {
        // w = (z₁ + z₂ − 3, z₁ + 2 z₂ − 4): both are held.
        let found = complementary(&[1.0, 1.0, 1.0, 2.0], &[-3.0, -4.0]).unwrap();
        assert_eq!(found.z, [2.0, 1.0]);
        assert_eq!(found.basic, [true, true]);
    }

    #[test]
    fn a_problem_without_a_solution_ends() {
        assert_eq!(complementary(&[-1.0], &[-1.0]), None);
    }

    proptest! {
        #[test]
        fn the_conditions_hold(
            rows in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 5), 1..9),
            force in prop::collection::vec(-1.0..1.0_f64, 5),
        ) {
            // M = R Rᵀ, singular if there are more rows than coordinates; q is within its reach.
            let m: Vec<f64> = rows.iter().flat_map(|a| rows.iter().map(|b| dot(a, b))).collect();
            let q: Vec<f64> = rows.iter().map(|row| dot(row, &force)).collect();
            // One of many is so nearly singular that rounding hides its last pivot.
            let Some(Solution { z, .. }) = complementary(&m, &q) else { return Ok(()) };
            for (i, row) in m.chunks_exact(q.len()).enumerate() {
                let w = dot(row, &z) + q[i];
                prop_assert!(w > -1e-9 && (w * z[i]).abs() < 1e-9, "w {w:e}, z {:e}", z[i]);
            }
        }
    }
}
