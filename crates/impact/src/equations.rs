//! The equations of a guess of contact modes: `u_r = 0` wherever a row holds.

use super::coulomb::Part;
use super::rows::{Bound, Rows};
use crate::dense::{Factored, dot};

/// The equations, and scratch of their solution.
#[derive(Default)]
pub(super) struct Equations {
    parts: Vec<Part>,
    /// Rows that hold.
    pub(super) held: Vec<usize>,
    factored: Factored,
    /// Place of each row among those that hold.
    place: Vec<usize>,
    entries: Vec<f64>,
    right: Vec<f64>,
    pushes: Vec<f64>,
}

impl Equations {
    /// `false` if there is no solution.
    pub(super) fn fit(&mut self, rows: &Rows, parts: &[Part], compliance: f64) -> bool {
        let size = rows.len();
        self.parts.clear();
        self.parts.extend_from_slice(parts);
        self.held.clear();
        self.held
            .extend((0..size).filter(|&r| parts[r] == Part::Hold));
        self.place.clear();
        self.place.resize(size, usize::MAX);
        for (at, &r) in self.held.iter().enumerate() {
            self.place[r] = at;
        }
        let n = self.held.len();
        self.entries.clear();
        self.entries.resize(n * n, 0.0);
        for (at, &r) in self.held.iter().enumerate() {
            let (to, row) = (&mut self.entries[at * n..(at + 1) * n], &rows.k[r * size..]);
            for (column, &s) in self.held.iter().enumerate() {
                to[column] = row[s];
            }
            // A row that slips pushes along with its normal row.
            for (s, part) in parts.iter().enumerate() {
                let (Bound::Friction(normals, _), Some(sign)) = (rows.rows[s].bound, sign(*part))
                else {
                    continue;
                };
                for normal in normals.rows().filter(|n| parts[*n] == Part::Hold) {
                    to[self.place[normal]] += sign * rows.factor(s, normal) * row[s];
                }
            }
            to[at] += compliance;
        }
        self.factored.refactor(n, self.entries.iter().copied())
    }

    /// Scaled impulses that take `speeds` away where rows hold, given limits included.
    pub(super) fn solve(&mut self, rows: &Rows, start: &[f64], impulses: &mut Vec<f64>) {
        impulses.clear();
        impulses.resize(rows.len(), 0.0);
        for (r, part) in self.parts.iter().enumerate() {
            if let (Bound::Limit(_), Some(sign)) = (rows.rows[r].bound, sign(*part)) {
                impulses[r] = sign * rows.limit(r, &[]);
            }
        }
        self.right.clear();
        self.right.extend(self.held.iter().map(|&r| {
            let row = &rows.k[r * rows.len()..];
            -(start[r] + dot(row, impulses))
        }));
        self.push(rows, impulses);
    }

    /// Takes away what is left of `speeds`, once more.
    pub(super) fn refine(&mut self, rows: &Rows, impulses: &mut [f64], speeds: &[f64]) {
        self.right.clear();
        self.right.extend(self.held.iter().map(|&r| -speeds[r]));
        self.push(rows, impulses);
    }

    /// Adds the impulses that solve the equations for the right side.
    fn push(&mut self, rows: &Rows, impulses: &mut [f64]) {
        self.factored.solve_into(&self.right, &mut self.pushes);
        for (&r, push) in self.held.iter().zip(&self.pushes) {
            impulses[r] += push;
        }
        self.spread(rows, impulses);
    }

    /// Sets rows that slip along with their normal rows.
    pub(super) fn spread(&self, rows: &Rows, impulses: &mut [f64]) {
        for (r, part) in self.parts.iter().enumerate() {
            if let (Bound::Friction(..), Some(sign)) = (rows.rows[r].bound, sign(*part)) {
                impulses[r] = sign * rows.limit(r, impulses);
            }
        }
    }

    /// Largest speed that is left where rows hold, in m/s.
    pub(super) fn left(&self, rows: &Rows, speeds: &[f64]) -> f64 {
        self.held.iter().fold(0.0, |most: f64, &r| {
            most.max((speeds[r] * rows.scales[r]).abs())
        })
    }
}

fn sign(part: Part) -> Option<f64> {
    match part {
        Part::High => Some(1.0),
        Part::Low => Some(-1.0),
        Part::Off | Part::Hold => None,
    }
}
