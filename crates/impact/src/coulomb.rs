//! Signorini's condition and Coulomb's law for impulses: what stops contacts that approach together.
//!
//! ```text
//! 0 ≤ j_n ⟂ u_n ≥ 0,      |j_t| ≤ µ j_n,      u_t ≠ 0  ⇒  j_t = −µ j_n sign(u_t)          u = u₀ + K j
//! ```
//!
//! In the plane a linear complementarity problem. Whoever holds is guessed from `j − u` of all rows
//! at once and solved for, until the guess stands (a semi-smooth Newton method: P. Alart, A. Curnier 1991);
//! all rows are treated alike, so symmetric questions get symmetric answers. Where guesses run in a circle
//! Lemke's pivoting finds a solution, which exists (M. Anitescu, F. Potra 1997); where bodies
//! are squeezed between others that do not yield none does, and sweeps end it.

use super::pivots::pivoted;
use super::rows::{Bound, Rows};
use super::sweeps::swept;
use crate::dense::Factored;

/// Guesses before pivoting takes over; a pile of 32 contacts needs 5 to 8.
const GUESSES: usize = 24;

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

/// The impulses along all rows, in N·s, and the bodies after them.
///
/// Whether the conditions hold to rounding comes last: false where none can.
pub(super) fn stop(rows: &Rows) -> (Vec<f64>, bool) {
    let start = rows.speeds(&vec![0.0; rows.len()]);
    let size = start.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    if size == 0.0 {
        return (vec![0.0; rows.len()], true);
    }
    let settled = |impulses: Vec<f64>, parts: Vec<Part>| settled(rows, &start, impulses, parts);
    let still = || (vec![0.0; rows.len()], vec![Part::Off; rows.len()]);
    let (none, off) = still();
    let found = settled(none, off).or_else(|| {
        let (near, parts) = pivoted(rows, &start)?;
        polished(rows, &near, &parts, None).or_else(|| settled(near, parts))
    });
    let found = found.map_or_else(
        || {
            let near = swept(rows);
            let parts = holding(rows, &near);
            let found = polished(rows, &near, &parts, None);
            let found = found.or_else(|| settled(near.clone(), parts));
            // What cannot be polished may be an answer to rounding as it is.
            let as_it_is = || answers(rows, &near, fastest(rows)).then(|| near.clone());
            found.or_else(as_it_is).ok_or(near)
        },
        Ok,
    );
    match found {
        Ok(impulses) => (rows.unscaled(&impulses).collect(), true),
        Err(near) => {
            let share = dissipating(rows, &start, &near);
            (rows.unscaled(&near).map(|j| share * j).collect(), false)
        }
    }
}

/// Guesses from given impulses on, until a guess stands.
fn settled(
    rows: &Rows,
    start: &[f64],
    mut impulses: Vec<f64>,
    mut parts: Vec<Part>,
) -> Option<Vec<f64>> {
    let zero = GUESSED * fastest(rows);
    let mut speeds = along(rows, start, &impulses);
    let mut system = None;
    for _ in 0..GUESSES {
        let next = guess(rows, &impulses, &speeds, &parts, zero);
        if next == parts {
            return polished(rows, &impulses, &parts, system);
        }
        let solved = System::new(rows, &next, COMPLIANCE)?;
        impulses = solved.solve(start);
        speeds = along(rows, start, &impulses);
        (parts, system) = (next, Some(solved));
    }
    None
}

/// Scaled speeds after scaled impulses, to the rounding of K.
fn along(rows: &Rows, start: &[f64], impulses: &[f64]) -> Vec<f64> {
    let change = |(r, start): (usize, &f64)| {
        let row = &rows.k[r * rows.len()..];
        start + row.iter().zip(impulses).map(|(k, j)| k * j).sum::<f64>()
    };
    start.iter().enumerate().map(change).collect()
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

/// The part of impulses, at most 1, up to which energy `j·u₀ + ½ jᵀ K j` only falls.
fn dissipating(rows: &Rows, start: &[f64], impulses: &[f64]) -> f64 {
    let after = along(rows, start, impulses);
    let power = |speeds: &[f64]| -> f64 { impulses.iter().zip(speeds).map(|(j, u)| j * u).sum() };
    let (before, after) = (power(start), power(&after));
    if before >= 0.0 {
        return 0.0;
    }
    if after <= 0.0 {
        1.0
    } else {
        before / (before - after)
    }
}

/// Who holds, from `j − u`: within its bounds it is an impulse that held, beyond them a speed that is left.
fn guess(rows: &Rows, impulses: &[f64], speeds: &[f64], before: &[Part], none: f64) -> Vec<Part> {
    let mut parts = vec![Part::Off; rows.len()];
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
            Bound::Friction(normal, _) if parts[normal] == Part::Off => continue,
            Bound::Friction(normal, _) if before[normal] == Part::Off => {
                rows.factor(r) * (impulses[normal] - speeds[normal])
            }
            Bound::Friction(..) | Bound::Limit(_) => rows.limit(r, impulses),
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
    parts
}

/// The equations of a guess: `u_r = 0` wherever a row holds.
struct System<'a> {
    rows: &'a Rows,
    parts: Vec<Part>,
    held: Vec<usize>,
    factored: Factored,
}

impl<'a> System<'a> {
    fn new(rows: &'a Rows, parts: &[Part], compliance: f64) -> Option<Self> {
        let size = rows.len();
        let held: Vec<usize> = (0..size).filter(|&r| parts[r] == Part::Hold).collect();
        let mut place = vec![usize::MAX; size];
        for (at, &r) in held.iter().enumerate() {
            place[r] = at;
        }
        let n = held.len();
        let mut entries = vec![0.0; n * n];
        for (at, &r) in held.iter().enumerate() {
            let (to, row) = (&mut entries[at * n..(at + 1) * n], &rows.k[r * size..]);
            for (column, &s) in held.iter().enumerate() {
                to[column] = row[s];
            }
            // A row that slips pushes along with its normal row.
            for (s, part) in parts.iter().enumerate() {
                let (Bound::Friction(normal, _), Some(sign)) = (rows.rows[s].bound, sign(*part))
                else {
                    continue;
                };
                if parts[normal] == Part::Hold {
                    to[place[normal]] += sign * rows.factor(s) * row[s];
                }
            }
            to[at] += compliance;
        }
        let factored = Factored::of(n, entries)?;
        Some(Self {
            rows,
            parts: parts.to_vec(),
            held,
            factored,
        })
    }

    /// Scaled impulses that take `speeds` away where rows hold, given limits included.
    fn solve(&self, start: &[f64]) -> Vec<f64> {
        let mut impulses = vec![0.0; self.rows.len()];
        for (r, part) in self.parts.iter().enumerate() {
            if let (Bound::Limit(_), Some(sign)) = (self.rows.rows[r].bound, sign(*part)) {
                impulses[r] = sign * self.rows.limit(r, &[]);
            }
        }
        let right: Vec<f64> = self
            .held
            .iter()
            .map(|&r| {
                let row = &self.rows.k[r * self.rows.len()..];
                let given: f64 = row.iter().zip(&impulses).map(|(k, j)| k * j).sum();
                -(start[r] + given)
            })
            .collect();
        self.spread(&self.factored.solve(&right), &mut impulses);
        impulses
    }

    /// Takes away what is left of `speeds`, once more.
    fn refine(&self, impulses: &mut [f64], speeds: &[f64]) {
        let right: Vec<f64> = self.held.iter().map(|&r| -speeds[r]).collect();
        self.spread(&self.factored.solve(&right), impulses);
    }

    /// Adds what the held rows push, and sets those that slip along with them.
    fn spread(&self, pushes: &[f64], impulses: &mut [f64]) {
        for (&r, push) in self.held.iter().zip(pushes) {
            impulses[r] += push;
        }
        for (r, part) in self.parts.iter().enumerate() {
            if let (Bound::Friction(normal, _), Some(sign)) = (self.rows.rows[r].bound, sign(*part))
            {
                impulses[r] = sign * self.rows.factor(r) * impulses[normal];
            }
        }
    }

    /// Largest speed that is left where rows hold, in m/s.
    fn left(&self, speeds: &[f64]) -> f64 {
        self.held.iter().fold(0.0, |most: f64, &r| {
            most.max((speeds[r] * self.rows.scales[r]).abs())
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

/// Impulses near an answer, to rounding: what they leave is taken away until it is no smaller, by
/// the equations that are known already, if they are.
///
/// Each time by the least impulses that do it, so loads that rows share stay shared as they are.
fn polished(
    rows: &Rows,
    near: &[f64],
    parts: &[Part],
    mut known: Option<System<'_>>,
) -> Option<Vec<f64>> {
    let fastest = fastest(rows);
    let mut near = near.to_vec();
    for (impulse, part) in near.iter_mut().zip(parts) {
        if *part == Part::Off {
            *impulse = 0.0;
        }
    }
    let mut best: Option<(f64, Vec<f64>)> = None;
    for compliance in [COMPLIANCE, LEAST_COMPLIANCE] {
        let system = match known.take() {
            Some(system) => system,
            None => System::new(rows, parts, compliance)?,
        };
        let mut impulses = best.as_ref().map_or(&near, |(_, held)| held).clone();
        system.spread(&[], &mut impulses);
        let mut last = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            let speeds = rows.speeds(&impulses);
            let left = system.left(&speeds);
            if best.as_ref().is_none_or(|(least, _)| left < *least) {
                best = Some((left, impulses.clone()));
            }
            if left <= f64::EPSILON * fastest || left > 0.5 * last {
                break;
            }
            last = left;
            system.refine(&mut impulses, &speeds);
        }
        if best
            .as_ref()
            .is_some_and(|(left, _)| *left <= 64.0 * f64::EPSILON * fastest)
        {
            break;
        }
    }
    let (_, mut impulses) = best?;
    // Signs and limits that are off by rounding alone.
    for r in 0..rows.len() {
        let limit = rows.limit(r, &impulses).max(0.0);
        let least = if rows.rows[r].bound == Bound::Push {
            0.0
        } else {
            -limit
        };
        impulses[r] = impulses[r].clamp(least, limit);
    }
    answers(rows, &impulses, fastest).then_some(impulses)
}

/// Largest speed along a row before, in m/s.
fn fastest(rows: &Rows) -> f64 {
    let speeds = rows.speeds(&vec![0.0; rows.len()]);
    let all = speeds.iter().zip(&rows.scales);
    all.fold(0.0, |most: f64, (u, scale)| most.max((u * scale).abs()))
}

/// Whether speeds meet the conditions; impulses are within their bounds already.
fn answers(rows: &Rows, impulses: &[f64], fastest: f64) -> bool {
    let speeds = rows.speeds(impulses);
    let rounding = rows.rounding(impulses);
    (0..rows.len()).all(|r| {
        let (j, u) = (impulses[r], speeds[r]);
        let zero = (ANSWERED * fastest).max(rounding[r]);
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
