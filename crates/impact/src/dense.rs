//! A dense system of a few equations.

/// A square matrix as L U, its rows exchanged so that the largest of a column comes first.
#[derive(Clone, Debug, Default)]
pub struct Factored {
    size: usize,
    /// Row by row: L below the diagonal, U on and above it.
    entries: Vec<f64>,
    /// Row of the matrix that stands at each place.
    order: Vec<usize>,
}

/// The sum of products, as far as both go.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Factored {
    /// Of a square matrix given row by row; `None` if a pivot is 0 or not finite.
    pub fn of(size: usize, entries: impl Iterator<Item = f64>) -> Option<Self> {
        let mut factored = Self::default();
        factored.refactor(size, entries).then_some(factored)
    }

    /// Factors another matrix in place of this one; `false` if a pivot is 0 or not finite.
    pub fn refactor(&mut self, size: usize, entries: impl Iterator<Item = f64>) -> bool {
        self.entries.clear();
        self.entries.reserve(size * size);
        self.entries.extend(entries);
        self.eliminate(size)
    }

    fn eliminate(&mut self, size: usize) -> bool {
        let Self {
            size: kept,
            entries,
            order,
        } = self;
        *kept = size;
        order.clear();
        order.extend(0..size);
        for k in 0..size {
            let mut best = k;
            for row in k + 1..size {
                if entries[row * size + k].abs() > entries[best * size + k].abs() {
                    best = row;
                }
            }
            let pivot = entries[best * size + k];
            if pivot == 0.0 || !pivot.is_finite() {
                return false;
            }
            if best != k {
                order.swap(best, k);
                for column in 0..size {
                    entries.swap(best * size + column, k * size + column);
                }
            }
            let (above, below) = entries.split_at_mut((k + 1) * size);
            let pivots = &above[k * size..];
            for row in below.chunks_exact_mut(size) {
                let factor = row[k] / pivot;
                if factor == 0.0 {
                    continue;
                }
                row[k] = factor;
                for (entry, of_pivot) in row[k + 1..].iter_mut().zip(&pivots[k + 1..]) {
                    *entry -= factor * of_pivot;
                }
            }
        }
        true
    }

    /// The smallest pivot by size; infinite where there is none.
    pub fn least_pivot(&self) -> f64 {
        let diagonal = self.entries.iter().step_by(self.size + 1);
        diagonal.fold(f64::INFINITY, |least, pivot| least.min(pivot.abs()))
    }

    /// The x with A x = `right`.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut x = Vec::new();
        self.solve_into(right, &mut x);
        x
    }

    /// [`Self::solve`] into `x`.
    pub fn solve_into(&self, right: &[f64], x: &mut Vec<f64>) {
        x.clear();
        x.extend(self.order.iter().map(|&row| right[row]));
        for k in 0..self.size {
            let row = &self.entries[k * self.size..];
            x[k] -= dot(row, &x[..k]);
        }
        for k in (0..self.size).rev() {
            let row = &self.entries[k * self.size..(k + 1) * self.size];
            x[k] = (x[k] - dot(&row[k + 1..], &x[k + 1..])) / row[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_solved_solves(
            entries in prop::collection::vec(-1.0..1.0_f64, 49),
            wanted in prop::collection::vec(-1.0..1.0_f64, 7),
        ) {
            let times = |x: &[f64]| -> Vec<f64> {
                let rows = entries.chunks_exact(7);
                rows.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
            };
            let right = times(&wanted);
            let found = Factored::of(7, entries.iter().copied()).unwrap().solve(&right);
            let off = times(&found).iter().zip(&right).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
            let size = found.iter().map(|x| x.abs()).fold(1.0, f64::max);
            prop_assert!(off < 1e-13 * size, "{off:e}");
        }
    }

    #[test]
    fn a_matrix_without_inverse_is_refused() {
        assert!(Factored::of(2, [0.0, 0.0, 0.0, 1.0].into_iter()).is_none());
    }
}
