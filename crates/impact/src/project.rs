//! The nearest point of a polyhedron: what every law of several contacts at once is made of.
//!
//! ```text
//! minimise ½ |w − w₀|²  subject to  n_i · w ≥ b_i,      w = w₀ + Σ λ_i n_i,  λ ≥ 0,  λ_i (n_i · w − b_i) = 0
//! ```
//!
//! In velocities scaled by √m this is Gauss's principle of least constraint, and the λ are impulses.
//! Solved by the dual active-set method (Goldfarb and Idnani 1983) on an orthogonal factorisation:
//! finite, right to rounding, and unique in w where rows depend on each other.

use core::ops::Range;

use crate::dense::dot;

/// A row counts as dependent on others if less than this part of its length is its own.
const DEPENDENT: f64 = 1e-10;

/// The same, as a part of its length, at which its rounding shows.
const NEARLY: f64 = 0.01;

/// A coordinate that the members leave less than this of, as a part of 1, is theirs alone.
const DETERMINED: f64 = 8.0 * f64::EPSILON;

/// A square of what is left, as a part of 1, that no rounding hides: its root is far above [`DETERMINED`].
const LEFT: f64 = 1e-9;

/// The nearest point, and how it is reached.
pub(crate) struct Nearest {
    pub(crate) point: Vec<f64>,
    /// λ of every row, ≥ 0.
    pub(crate) multipliers: Vec<f64>,
    /// Floating-point operations on the way.
    pub(crate) operations: u64,
}

/// The point nearest to `start` that meets all bounds.
///
/// A bound counts as met within `tolerance`. If the polyhedron is empty, as where driven bodies squeeze others,
/// the rows that can be met are met. No row has a part along the orthonormal directions `kept`: nor has the way.
pub(crate) fn nearest(
    kept: &[Vec<f64>],
    rows: &[Vec<f64>],
    start: &[f64],
    bounds: &[f64],
    tolerance: f64,
) -> Nearest {
    let mut set = ActiveSet::new(kept, rows, start, bounds);
    set.settle(tolerance);
    let multipliers = set.shares();
    let operations = set.operations;
    Nearest {
        point: set.polished(),
        multipliers,
        operations,
    }
}

/// Multipliers with which the rows balance `load` as far as they can, and the largest coordinate of what is left of it.
pub fn balance(rows: &[Vec<f64>], load: &[f64], tolerance: f64) -> (Vec<f64>, f64) {
    let bounds = vec![0.0; rows.len()];
    let mut set = ActiveSet::new(&[], rows, load, &bounds);
    set.settle(tolerance);
    let mut left = load.to_vec();
    set.basis.reduce(&mut left);
    let largest = left.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (set.shares(), largest)
}

/// The rows that hold with equality, their multipliers and the point that they lead to.
#[derive(Default)]
struct ActiveSet<'a> {
    kept: &'a [Vec<f64>],
    rows: &'a [Vec<f64>],
    /// Where each row is not 0: a contact has two bodies, however many there are.
    spans: Vec<Range<usize>>,
    bounds: &'a [f64],
    members: Vec<usize>,
    /// Made of the members, in their order.
    basis: Basis,
    multipliers: Vec<f64>,
    start: &'a [f64],
    point: Vec<f64>,
    /// Rows that depend on the members of now and cannot be met, or are met but for rounding.
    hopeless: Vec<usize>,
    operations: u64,
}

impl<'a> ActiveSet<'a> {
    fn new(
        kept: &'a [Vec<f64>],
        rows: &'a [Vec<f64>],
        start: &'a [f64],
        bounds: &'a [f64],
    ) -> Self {
        Self {
            kept,
            rows,
            spans: rows.iter().map(|row| span(row)).collect(),
            bounds,
            start,
            point: start.to_vec(),
            ..Self::default()
        }
    }

    /// Takes rows in until all bounds are met that can be.
    fn settle(&mut self, tolerance: f64) {
        // A row enters and leaves a few times at most; the bound is for rounding alone.
        for _ in 0..(20 + 10 * self.rows.len()) {
            self.count(self.rows.len());
            match self.most_violated(tolerance) {
                Some(row) => self.enter(row),
                None => break,
            }
        }
    }

    /// One more member, with its parts along the others and its own.
    fn add(&mut self, row: usize, multiplier: f64, column: Vec<f64>, mut own: Vec<f64>) {
        let whole = &self.rows[row];
        // What is left of a row that depends on others is the more its rounding; a part of that along
        // what is kept would be a momentum out of nothing.
        if dot(&own, &own) < NEARLY * NEARLY * dot(whole, whole) {
            for direction in self.kept {
                let along = dot(&own, direction);
                add_scaled(&mut own, direction, -along);
            }
        }
        self.basis.add(column, own);
        self.members.push(row);
        self.multipliers.push(multiplier);
    }

    /// Takes a member out; those that came after it are reduced anew, as if it had never been.
    fn remove(&mut self, place: usize) {
        let later = self.members.split_off(place);
        let multipliers = self.multipliers.split_off(place);
        self.basis.truncate(place);
        for (row, multiplier) in later.into_iter().zip(multipliers).skip(1) {
            self.count(4 * self.members.len());
            let mut own = self.rows[row].clone();
            let column = self.basis.reduce(&mut own);
            self.add(row, multiplier, column, own);
        }
    }

    /// Counts `products` of vectors.
    const fn count(&mut self, products: usize) {
        self.operations += (products * self.start.len()) as u64;
    }

    fn slack(&self, row: usize) -> f64 {
        let span = self.spans[row].clone();
        dot(&self.rows[row][span.clone()], &self.point[span]) - self.bounds[row]
    }

    fn most_violated(&self, tolerance: f64) -> Option<usize> {
        let is_free = |row: usize| !self.members.contains(&row) && !self.hopeless.contains(&row);
        let mut worst = None;
        for row in 0..self.rows.len() {
            let slack = self.slack(row);
            let is_worse = slack < -tolerance && worst.is_none_or(|(_, least)| slack < least);
            // Most members are met: few are asked for.
            if is_worse && is_free(row) {
                worst = Some((row, slack));
            }
        }
        worst.map(|(row, _)| row)
    }

    /// Moves along the row's own direction until its bound is met; members with a multiplier that
    /// would turn negative on the way leave.
    fn enter(&mut self, row: usize) {
        let mut multiplier = 0.0;
        loop {
            self.count(4 * self.members.len() + 4);
            let mut own = self.rows[row].clone();
            let column = self.basis.reduce(&mut own);
            let shares = self.basis.shares(&column);
            let (length, whole) = (dot(&own, &own), dot(&self.rows[row], &self.rows[row]));
            // A share that is rounding alone would let a row that is one of the members go a way without end.
            let least = DEPENDENT * whole.sqrt();
            let (to_bound, least) = if length > least * least {
                (-self.slack(row) / length, 0.0)
            } else {
                (f64::INFINITY, least)
            };
            let blocking = self.first_to_leave(&shares, least);
            let leaving = blocking.filter(|&(_, way)| way < to_bound);
            let way = leaving.map_or(to_bound, |(_, way)| way);
            if way.is_infinite() {
                self.hopeless.push(row);
                return;
            }
            if to_bound.is_finite() {
                add_scaled(&mut self.point, &own, way);
            }
            for (held, share) in self.multipliers.iter_mut().zip(&shares) {
                *held -= way * share;
            }
            multiplier += way;
            match leaving {
                Some((place, _)) => self.remove(place),
                None => {
                    self.add(row, multiplier, column, own);
                    self.hopeless.clear();
                    return;
                }
            }
        }
    }

    /// Of the members with more than a `least` part in the new row.
    fn first_to_leave(&self, shares: &[f64], least: f64) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        for (place, (held, share)) in self.multipliers.iter().zip(shares).enumerate() {
            let member = &self.rows[self.members[place]];
            if *share * dot(member, member).sqrt() > least {
                let way = (held / share).max(0.0);
                if first.is_none_or(|(_, least)| way < least) {
                    first = Some((place, way));
                }
            }
        }
        first
    }

    /// The members solved for once more, with no rounding of the way left: λ of every row, ≥ 0.
    fn shares(&self) -> Vec<f64> {
        let lacks = |row: &usize| self.bounds[*row] - dot(&self.rows[*row], self.start);
        let mut shares: Vec<f64> = self.members.iter().map(lacks).collect();
        self.basis.solve_lower(&mut shares);
        self.basis.solve_upper(&mut shares);
        let mut multipliers = vec![0.0; self.rows.len()];
        for (&row, share) in self.members.iter().zip(shares) {
            multipliers[row] = if share > 0.0 { share } else { 0.0 };
        }
        multipliers
    }

    /// The point that they lead to.
    ///
    /// With the members as Q R, `w = Q R⁻ᵀ b + (1 − Q Qᵀ) w₀`: what the members determine comes from the
    /// bounds alone, and is exactly 0 where these are.
    fn polished(self) -> Vec<f64> {
        let mut along: Vec<f64> = self.members.iter().map(|&row| self.bounds[row]).collect();
        self.basis.solve_lower(&mut along);
        let mut point = self.start.to_vec();
        self.basis.reduce(&mut point);
        for (k, value) in point.iter_mut().enumerate() {
            if self.members.iter().all(|&row| self.rows[row][k] == 0.0) {
                *value = self.start[k];
            } else if self.basis.determines(k) {
                *value = 0.0;
            }
        }
        for (direction, part) in self.basis.directions.iter().zip(along) {
            add_scaled(&mut point, direction, part);
        }
        point
    }
}

/// Rows as Q R: orthonormal directions, and how each row is made of them.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    directions: Vec<Vec<f64>>,
    /// Where each direction is not 0.
    spans: Vec<Range<usize>>,
    /// Column k: the row k in the directions up to its own.
    columns: Vec<Vec<f64>>,
}

impl Basis {
    /// One more direction: what is a row's own beside its parts along the others.
    fn add(&mut self, mut column: Vec<f64>, mut own: Vec<f64>) {
        let length = dot(&own, &own).sqrt();
        own.iter_mut().for_each(|x| *x /= length);
        column.push(length);
        self.spans.push(span(&own));
        self.directions.push(own);
        self.columns.push(column);
    }

    /// Of rows that may depend on each other those that add a direction, in their order.
    pub fn independent(rows: impl IntoIterator<Item = Vec<f64>>, dependent: f64) -> Self {
        let mut basis = Self::default();
        for mut row in rows {
            let whole = dot(&row, &row).sqrt();
            let column = basis.reduce(&mut row);
            if dot(&row, &row).sqrt() > dependent * whole {
                basis.add(column, row);
            }
        }
        basis
    }

    /// Orthonormal directions that span the rows.
    pub fn into_directions(self) -> Vec<Vec<f64>> {
        self.directions
    }

    /// Whether some direction has a part along coordinate k.
    pub fn touches(&self, k: usize) -> bool {
        self.directions.iter().any(|direction| direction[k] != 0.0)
    }

    /// Takes the parts along the directions, which it returns; orthogonalised twice, which is enough (Kahan, Parlett).
    pub fn reduce(&self, row: &mut [f64]) -> Vec<f64> {
        // One more is added where it becomes a direction.
        let mut parts = Vec::with_capacity(self.directions.len() + 1);
        parts.resize(self.directions.len(), 0.0);
        for _ in 0..2 {
            let directions = self.directions.iter().zip(&self.spans);
            for (part, (direction, span)) in parts.iter_mut().zip(directions) {
                let (rest, direction) = (&mut row[span.clone()], &direction[span.clone()]);
                let along = dot(rest, direction);
                *part += along;
                add_scaled(rest, direction, -along);
            }
        }
        parts
    }

    /// The same parts as a sum of rows.
    fn shares(&self, column: &[f64]) -> Vec<f64> {
        let mut shares = column.to_vec();
        self.solve_upper(&mut shares);
        shares
    }

    /// Only the first rows.
    fn truncate(&mut self, count: usize) {
        self.directions.truncate(count);
        self.spans.truncate(count);
        self.columns.truncate(count);
    }

    /// Whether nothing of coordinate k lies outside the directions.
    pub fn determines(&self, k: usize) -> bool {
        // |e_k|² = 1 is that of its parts along the directions and that of the rest.
        let along: f64 = self.directions.iter().map(|own| own[k] * own[k]).sum();
        if along < 1.0 - LEFT {
            return false;
        }
        let size = self.directions.first().map_or(0, Vec::len);
        let axis = (0..size).map(|i| if i == k { 1.0 } else { 0.0 });
        let mut rest: Vec<f64> = axis.collect();
        self.reduce(&mut rest);
        dot(&rest, &rest).sqrt() <= DETERMINED
    }

    /// x with Rᵀ x = the given.
    fn solve_lower(&self, x: &mut [f64]) {
        for k in 0..x.len() {
            let known: f64 = (0..k).map(|i| self.columns[k][i] * x[i]).sum();
            x[k] = (x[k] - known) / self.columns[k][k];
        }
    }

    /// x with R x = the given.
    fn solve_upper(&self, x: &mut [f64]) {
        for k in (0..x.len()).rev() {
            let known: f64 = (k + 1..x.len()).map(|j| self.columns[j][k] * x[j]).sum();
            x[k] = (x[k] - known) / self.columns[k][k];
        }
    }
}

/// From the first number that is not 0 to the last.
fn span(row: &[f64]) -> Range<usize> {
    let is_some = |x: &f64| *x != 0.0;
    let first = row.iter().position(is_some).unwrap_or(0);
    let end = row.iter().rposition(is_some).map_or(0, |last| last + 1);
    first..end
}

fn add_scaled(to: &mut [f64], what: &[f64], factor: f64) {
    for (x, y) in to.iter_mut().zip(what) {
        *x += factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rows_that_depend_on_each_other_lead_to_one_point() {
        // Three supports under one plank: w = (1, 0) is unique, the forces are not.
        let rows = [vec![1.0, -1.0], vec![1.0, 0.0], vec![1.0, 1.0]];
        let found = nearest(&[], &rows, &[0.0, 0.0], &[1.0, 1.0, 1.0], 1e-15).point;
        assert!(
            (found[0] - 1.0).abs() < 1e-15 && found[1].abs() < 1e-15,
            "{found:?}"
        );
    }

    #[test]
    fn what_is_met_already_stays_bit_for_bit() {
        let found = nearest(&[], &[vec![1.0, 0.0]], &[0.1, 0.7], &[-1.0], 0.0);
        assert_eq!(
            (found.point, found.multipliers),
            (vec![0.1, 0.7], vec![0.0])
        );
    }

    #[test]
    fn what_is_stopped_is_exactly_still() {
        // Two supports of a plank at thirds: its fall and its turn are stopped, its slide goes on.
        let third = 1.0 / 3.0;
        let rows = [vec![0.0, third, -0.7], vec![0.0, third, 0.3]];
        let found = nearest(&[], &rows, &[0.1, -3.0, 0.2], &[0.0, 0.0], 1e-15).point;
        assert_eq!(found, [0.1, 0.0, 0.0]);
    }

    proptest! {
        #[test]
        fn the_conditions_hold(
            rows in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 6), 1..12),
            reach in prop::collection::vec(-1.0..1.0_f64, 6),
            start in prop::collection::vec(-1.0..1.0_f64, 6),
        ) {
            // Bounds that some point meets, so that the polyhedron is not empty.
            let bounds: Vec<f64> = rows.iter().map(|row| dot(row, &reach)).collect();
            let found = nearest(&[], &rows, &start, &bounds, 1e-14);
            let mut led = start.clone();
            for ((row, bound), multiplier) in rows.iter().zip(&bounds).zip(&found.multipliers) {
                let slack = dot(row, &found.point) - bound;
                prop_assert!(slack > -1e-11, "slack {slack:e}");
                prop_assert!(*multiplier >= 0.0);
                prop_assert!((multiplier * slack).abs() < 1e-9, "{multiplier:e} {slack:e}");
                add_scaled(&mut led, row, *multiplier);
            }
            let off = led.iter().zip(&found.point).map(|(a, b)| (a - b).abs());
            prop_assert!(off.fold(0.0, f64::max) < 1e-9);
        }

        #[test]
        fn what_balances_leaves_the_nearest_point_of_the_cone_that_no_row_pushes_into(
            rows in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 6), 1..12),
            load in prop::collection::vec(-1.0..1.0_f64, 6),
        ) {
            let found = nearest(&[], &rows, &load, &vec![0.0; rows.len()], 1e-14);
            let (multipliers, left) = balance(&rows, &load, 1e-14);
            let largest = found.point.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            prop_assert_eq!(multipliers, found.multipliers);
            prop_assert!((left - largest).abs() < 1e-13, "{left:e} for {largest:e}");
        }
    }
}
