//! Signorini's condition and Coulomb's law for impulses: what stops contacts that approach together.
//!
//! ```text
//! 0 ≤ j_n ⟂ u_n ≥ 0,      |j_t| ≤ µ j_n,      u_t ≠ 0  ⇒  j_t = −µ j_n sign(u_t)          u = u₀ + K j
//! ```
//!
//! In the plane a linear complementarity problem. The rows that hold are guessed from `j − u` of all rows
//! at once and solved for, until the guess stands (a semi-smooth Newton method: P. Alart, A. Curnier 1991);
//! all rows are treated alike, so symmetric questions get symmetric answers. Where guesses run in a circle
//! Lemke's pivoting finds a solution, which exists (M. Anitescu, F. Potra 1997); where bodies
//! are squeezed between others that do not yield none does, and sweeps end it. Nor is every solution an answer: a chain of
//! contacts that is θ rad off its dead point is driven out at u/θ by impulses of m u/θ², and a body that is driven
//! through dead points at random would in the mean give infinite energy to what it passes.

use carom_math::within;

use super::body::ImpactBody;
use super::dense::dot;
use super::equations::Equations;
use super::pivots::pivoted;
use super::rows::{Bound, Rows};
use super::sweeps::{TURN, swept, yielding};

/// Guesses before pivoting takes over; a pile of 32 contacts needs 5 to 8.
const GUESSES: usize = 24;

/// Guesses from known impulses on, before all begins from none: 1 or 2 where little changed.
const NEAR_GUESSES: usize = 6;

/// Compliance of a row, as a part of its own response: what shares a load that is not determined.
const COMPLIANCE: f64 = 1e-10;

/// The same where mass ratios leave less than that of a row.
const LEAST_COMPLIANCE: f64 = 1e-14;

/// Repetitions with the remainder before its rounding is taken for the answer's.
const REFINEMENTS: usize = 12;

/// Speed, or impulse that gives such a speed, as a part of the largest, that counts as 0 in a guess.
const GUESSED: f64 = 1e-11;

/// Speed, as a part of the largest, that counts as 0 in an answer.
const ANSWERED: f64 = 1e-10;

/// Speed with which a body that is squeezed by driven ones is moved, as a part of what closes or slips, from which on
/// it gives way instead: wedges and chains of less than 3.6° take more than 256 times the impulse of a free body.
const LEVER: f64 = 16.0;

/// A row's part in a guess.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// No impulse.
    Off,
    /// As much impulse as leaves no speed.
    Hold,
    /// Impulse at its upper limit.
    High,
    /// Impulse at its lower limit.
    Low,
}

/// What stops contacts.
#[derive(Clone, Debug)]
pub(super) struct Stop {
    /// Along all rows, in N·s.
    pub(super) impulses: Vec<f64>,
    /// Whether the conditions hold to rounding: false where none can, or bodies give way.
    pub(super) sure: bool,
    /// Floating-point operations that it took, to a factor of a few.
    pub(super) operations: u64,
}

/// The impulses along all rows that stop what approaches.
pub(super) fn stop(rows: &Rows) -> Stop {
    stop_near(rows, None)
}

/// The same, which begins with impulses in N·s that may be near an answer.
pub(super) fn stop_near(rows: &Rows, near: Option<&[f64]>) -> Stop {
    let mut solver = Solver::new(rows);
    let found = if solver.start.iter().any(|u| u.abs() > 0.0) {
        solver.stop(near).and_then(|found| solver.plausible(found))
    } else {
        Ok(vec![0.0; rows.len()])
    };
    let (impulses, sure) = match found {
        Ok(impulses) => (rows.unscaled(&impulses).collect(), true),
        Err(near) => {
            let share = solver.dissipating(&near);
            (rows.unscaled(&near).map(|j| share * j).collect(), false)
        }
    };
    Stop {
        impulses,
        sure,
        operations: solver.operations,
    }
}

/// A search for the stop of some rows, with what its guesses share.
struct Solver<'a> {
    rows: &'a Rows,
    /// Scaled speeds before.
    start: Vec<f64>,
    /// Largest speed along a row before, in m/s.
    fastest: f64,
    /// The equations of the last guess that was solved for.
    equations: Equations,
    /// Scaled speeds after the last impulses that were asked about.
    speeds: Vec<f64>,
    /// What these give to the bodies.
    given: Vec<ImpactBody>,
    operations: u64,
}

impl<'a> Solver<'a> {
    fn new(rows: &'a Rows) -> Self {
        let mut solver = Self {
            rows,
            start: Vec::new(),
            fastest: 0.0,
            equations: Equations::default(),
            speeds: Vec::new(),
            given: Vec::new(),
            // The matrix.
            operations: (8 * rows.len() * rows.len()) as u64,
        };
        solver.speed_up(&vec![0.0; rows.len()]);
        solver.start.clone_from(&solver.speeds);
        let all = solver.start.iter().zip(&rows.scales);
        solver.fastest = all.fold(0.0, |most: f64, (u, scale)| most.max((u * scale).abs()));
        solver
    }

    /// Scaled impulses that meet the conditions; or else some that come near.
    fn stop(&mut self, near: Option<&[f64]>) -> Result<Vec<f64>, Vec<f64>> {
        let rows = self.rows;
        let size = rows.len();
        if let Some(near) = near {
            let scaled = near.iter().zip(&rows.scales).map(|(j, scale)| j * scale);
            let near: Vec<f64> = scaled.collect();
            let parts = holding(rows, &near);
            if let Some(found) = self.settled(near, parts, NEAR_GUESSES) {
                return Ok(found);
            }
        }
        if let Some(found) = self.settled(vec![0.0; size], vec![Part::Off; size], GUESSES) {
            return Ok(found);
        }
        // About as many pivots as unknowns, of which friction has three.
        self.operations += 2 * (3 * size as u64).pow(3);
        if let Some((near, parts)) = pivoted(rows, &self.start) {
            let found = self.polished(&near, &parts, false);
            if let Some(found) = found.or_else(|| self.settled(near, parts, GUESSES)) {
                return Ok(found);
            }
        }
        let (near, operations) = swept(rows);
        self.operations += operations;
        let parts = holding(rows, &near);
        let found = self.polished(&near, &parts, false);
        if let Some(found) = found.or_else(|| self.settled(near.clone(), parts, GUESSES)) {
            return Ok(found);
        }
        // What cannot be polished may be an answer to rounding as it is.
        if self.answers(&near) {
            Ok(near)
        } else {
            Err(near)
        }
    }

    /// Impulses that meet the conditions, unless they drive a squeezed body out at more than [`LEVER`] times the speed that
    /// squeezes it; then some that yield.
    fn plausible(&mut self, found: Vec<f64>) -> Result<Vec<f64>, Vec<f64>> {
        if !self.rows.driven {
            return Ok(found);
        }
        self.speed_up(&found);
        let most = LEVER * self.fastest;
        let rows = &self.rows.rows;
        let touched = rows
            .iter()
            .flat_map(|row| [(row.a, row.points.0), (row.b, row.points.1)]);
        for (body, point) in touched {
            if self.given[body].velocity_of(point).length() > most {
                let (near, operations) = yielding(self.rows);
                self.operations += operations;
                return Err(near);
            }
        }
        Ok(found)
    }

    /// Guesses from given impulses on, until a guess stands.
    fn settled(
        &mut self,
        mut impulses: Vec<f64>,
        mut parts: Vec<Part>,
        guesses: usize,
    ) -> Option<Vec<f64>> {
        let zero = GUESSED * self.fastest;
        let mut next = Vec::new();
        let mut speeds = Vec::new();
        self.along(&impulses, &mut speeds);
        let mut solved = false;
        for _ in 0..guesses {
            guess(self.rows, &impulses, &speeds, &parts, zero, &mut next);
            if next == parts {
                return self.polished(&impulses, &parts, solved);
            }
            if !self.fit(&next, COMPLIANCE) {
                return None;
            }
            solved = true;
            self.equations.solve(self.rows, &self.start, &mut impulses);
            self.along(&impulses, &mut speeds);
            core::mem::swap(&mut parts, &mut next);
        }
        None
    }

    /// The equations of a guess; whether they have a solution.
    fn fit(&mut self, parts: &[Part], compliance: f64) -> bool {
        let fits = self.equations.fit(self.rows, parts, compliance);
        let (all, held) = (self.rows.len(), self.equations.held.len());
        self.operations += (2 * held * all + held * held * held / 3) as u64;
        fits
    }

    /// Scaled speeds after scaled impulses, to the rounding of K.
    fn along(&mut self, impulses: &[f64], to: &mut Vec<f64>) {
        let rows = self.rows;
        let change = |(r, start): (usize, &f64)| {
            let row = &rows.k[r * rows.len()..];
            start + dot(row, impulses)
        };
        to.clear();
        to.extend(self.start.iter().enumerate().map(change));
        self.operations += (rows.len() * rows.len()) as u64;
    }

    /// Scaled speeds after scaled impulses, to their own rounding.
    fn speed_up(&mut self, impulses: &[f64]) {
        self.rows
            .speeds(impulses, &mut self.given, &mut self.speeds);
        self.operations += (self.rows.len() * TURN) as u64;
    }

    /// The part of impulses, at most 1, up to which energy `j·u₀ + ½ jᵀ K j` only falls.
    fn dissipating(&mut self, impulses: &[f64]) -> f64 {
        let mut after = Vec::new();
        self.along(impulses, &mut after);
        dissipating(dot(impulses, &self.start), dot(impulses, &after))
    }

    /// Impulses near an answer, to rounding: what they leave is taken away until it is no smaller; `solved`: by the equations
    /// that are known already.
    ///
    /// Each time by the least impulses that do it, so loads that rows share stay shared as they are.
    fn polished(&mut self, near: &[f64], parts: &[Part], mut solved: bool) -> Option<Vec<f64>> {
        let fastest = self.fastest;
        let mut best = near.to_vec();
        for (impulse, part) in best.iter_mut().zip(parts) {
            if *part == Part::Off {
                *impulse = 0.0;
            }
        }
        let mut least: Option<f64> = None;
        let mut impulses = Vec::new();
        for compliance in [COMPLIANCE, LEAST_COMPLIANCE] {
            if !core::mem::take(&mut solved) && !self.fit(parts, compliance) {
                return None;
            }
            impulses.clone_from(&best);
            self.equations.spread(self.rows, &mut impulses);
            let mut last = f64::INFINITY;
            for _ in 0..REFINEMENTS {
                self.speed_up(&impulses);
                let left = self.equations.left(self.rows, &self.speeds);
                if least.is_none_or(|least| left < least) {
                    least = Some(left);
                    best.clone_from(&impulses);
                }
                if left <= f64::EPSILON * fastest || left > 0.5 * last {
                    break;
                }
                last = left;
                self.equations
                    .refine(self.rows, &mut impulses, &self.speeds);
            }
            if least.is_some_and(|left| left <= 64.0 * f64::EPSILON * fastest) {
                break;
            }
        }
        // Signs and limits that are off by rounding alone.
        for r in 0..self.rows.len() {
            let limit = self.rows.limit(r, &best).max(0.0);
            let least = if self.rows.rows[r].bound == Bound::Push {
                0.0
            } else {
                -limit
            };
            best[r] = within(best[r], least, limit);
        }
        self.answers(&best).then_some(best)
    }

    /// Whether speeds meet the conditions; impulses are within their bounds already.
    fn answers(&mut self, impulses: &[f64]) -> bool {
        self.speed_up(impulses);
        let rows = self.rows;
        let rounding = rows.rounding(impulses);
        (0..rows.len()).all(|r| {
            let (j, u) = (impulses[r], self.speeds[r]);
            let zero = (ANSWERED * self.fastest).max(rounding[r]);
            let none = u.abs() * rows.scales[r] <= zero;
            none || match rows.rows[r].bound {
                Bound::Push => u > 0.0 && j == 0.0,
                Bound::Friction(..) | Bound::Limit(_) => {
                    // Held back by all that the limit gives.
                    j * u <= 0.0 && j.abs() >= rows.limit(r, impulses) * (1.0 - ANSWERED)
                }
            }
        })
    }
}

/// The part of impulses, at most 1, up to which energy only falls: from their power on the speeds `before` them, and on those `after` all
/// of them, `j·(u₀ + s K j) ≤ 0`.
pub(super) fn dissipating(before: f64, after: f64) -> f64 {
    if before >= 0.0 {
        0.0
    } else if after <= 0.0 {
        1.0
    } else {
        before / (before - after)
    }
}

/// The guess that impulses stand for.
fn holding(rows: &Rows, impulses: &[f64]) -> Vec<Part> {
    let part = |(r, j): (usize, &f64)| {
        let limit = rows.limit(r, impulses);
        match rows.rows[r].bound {
            Bound::Push if *j > 0.0 => Part::Hold,
            Bound::Push => Part::Off,
            _ if limit <= 0.0 => Part::Off,
            _ if *j >= limit => Part::High,
            _ if *j <= -limit => Part::Low,
            _ => Part::Hold,
        }
    };
    impulses.iter().enumerate().map(part).collect()
}

/// What holds, from `j − u`: within its bounds it is an impulse that held, beyond them a speed that is left.
fn guess(
    rows: &Rows,
    impulses: &[f64],
    speeds: &[f64],
    before: &[Part],
    none: f64,
    parts: &mut Vec<Part>,
) {
    parts.clear();
    parts.resize(rows.len(), Part::Off);
    for r in 0..rows.len() {
        if rows.scales[r] == 0.0 {
            continue;
        }
        let zero = none / rows.scales[r];
        let wanted = impulses[r] - speeds[r];
        // A contact that begins to push has no limit yet: it is what its normal row wants.
        let limit = match rows.rows[r].bound {
            Bound::Push => {
                // What is 0 to rounding stays what it was.
                let least = if before[r] == Part::Hold { -zero } else { zero };
                parts[r] = if wanted > least {
                    Part::Hold
                } else {
                    Part::Off
                };
                continue;
            }
            Bound::Friction(normals, _) => {
                let mut pushes = normals.rows().filter(|n| parts[*n] != Part::Off).peekable();
                if pushes.peek().is_none() {
                    continue;
                }
                let wants = |n: usize| {
                    let begins = before[n] == Part::Off;
                    rows.factor(r, n) * (impulses[n] - if begins { speeds[n] } else { 0.0 })
                };
                pushes.map(wants).sum()
            }
            Bound::Limit(_) => rows.limit(r, impulses),
        };
        let reach = |part: Part| if before[r] == part { -zero } else { zero };
        parts[r] = if wanted > limit + reach(Part::High) {
            Part::High
        } else if wanted < -(limit + reach(Part::Low)) {
            Part::Low
        } else {
            Part::Hold
        };
    }
}
