//! The bounce of one contact: Newton's restitution at its points, and Coulomb's friction of the whole blow.
//!
//! ```text
//! j = what rows did + what the bounce adds,   v(j) = v(0) + R j   (both points along the normal, then across)
//! jᵢ ≥ 0,  vᵢ ≥ leavesᵢ,  one of them an equality        |jₜ| ≤ µ (j₁ + j₂): vₜ = 0 within, and against vₜ at the limit
//! ```
//! Both points and friction are solved for at once, by trying which of them hold: one after the other they converge slowly
//! where a body sticks, since friction at the end of a long lever turns it.

use carom_math::{Vec2, perp};

use super::block::{Block, Cold};
use super::line::{Line, Quad};
use super::restitution::Arrival;
use crate::LineIx;
use crate::bodies::Bodies;

/// What is smaller is rounding, as a part of what was added up.
const ROUNDING: f64 = 1e-12;

/// A contact that bounces, where its bodies are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounce {
    lines: [LineIx; 2],
    axes: Axes,
    /// Inverse masses and inertias.
    inverse: [[f64; 2]; 2],
    /// What an impulse along one axis adds to the speed along another, in 1/kg.
    response: [[f64; 3]; 3],
    mu: f64,
    belt: f64,
    /// What the rows did in this sub-step.
    rows: [f64; 3],
    /// Slip before it bounces, in m/s.
    slipped: f64,
}

/// The lines in which the bodies of a contact push each other: along the normal at both points, and across.
#[derive(Clone, Copy, Debug)]
struct Axes([Axis; 3]);

#[derive(Clone, Copy, Debug)]
struct Axis {
    along: Vec2,
    /// Levers of both bodies about it, in m.
    arms: [f64; 2],
}

/// How friction acts: it stops the slip, or pushes with ±µ of the load.
#[derive(Clone, Copy, Debug)]
enum Friction {
    Sticks,
    Slides(f64),
}

impl Axes {
    fn new(block: &Block, lane: usize) -> Self {
        let (n, l) = (block.normal(lane), block.l[lane]);
        let arms = [block.a1[lane], block.b1[lane]];
        Self([
            Axis { along: n, arms },
            Axis {
                along: n,
                arms: arms.map(|arm| arm + l),
            },
            Axis {
                along: perp(n),
                arms: [block.at[lane], block.bt[lane]],
            },
        ])
    }

    /// Speeds of B along them less those of A.
    fn speeds(&self, [a, b]: [Quad; 2]) -> [f64; 3] {
        self.0.map(|Axis { along, arms }| {
            along.dot(b.v() - a.v()) + arms[1] * b.w() - arms[0] * a.w()
        })
    }

    /// What impulses along them add to the velocities of A and of B.
    fn pushes(&self, impulses: [f64; 3], [a, b]: [[f64; 2]; 2]) -> [Quad; 2] {
        let (mut impulse, mut turns) = (Vec2::ZERO, [0.0; 2]);
        for (Axis { along, arms }, j) in self.0.iter().zip(impulses) {
            impulse += *along * j;
            turns = [turns[0] + arms[0] * j, turns[1] + arms[1] * j];
        }
        [
            Quad::new(impulse * -a[0], -turns[0] * a[1]),
            Quad::new(impulse * b[0], turns[1] * b[1]),
        ]
    }
}

impl Bounce {
    pub(super) fn new(
        (block, cold, lane): (&Block, &Cold, usize),
        lines: [LineIx; 2],
        bodies: &Bodies,
    ) -> Self {
        let inverse = lines.map(|line| {
            let line = &bodies.lines[line];
            [line.inverse_mass(), line.inverse_inertia()]
        });
        let axes = Axes::new(block, lane);
        let unit = |k: usize| core::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
        let response = [0, 1, 2].map(|k| axes.speeds(axes.pushes(unit(k), inverse)));
        let mut bounce = Self {
            lines,
            axes,
            inverse,
            response,
            mu: block.mu[lane],
            belt: cold.belt[lane],
            rows: block.impulses(lane),
            slipped: 0.0,
        };
        bounce.slipped = bounce.speeds(&bodies.lines)[2];
        bounce
    }

    /// What both points open with, and the slip less the speed of a belt, in m/s.
    fn speeds(&self, lines: &[Line]) -> [f64; 3] {
        let velocities = self
            .lines
            .map(|line| Quad::new(lines[line.at()].v(), lines[line.at()].w()));
        let [one, other, across] = self.axes.speeds(velocities);
        [one, other, across - self.belt]
    }

    /// What impulses add to the velocities of A and of B.
    pub(super) fn pushes(&self, impulses: [f64; 3]) -> [Quad; 2] {
        self.axes.pushes(impulses, self.inverse)
    }

    /// Changes the impulses to those that fit the velocities of all bodies but for these two; v and start change alike. Whether they
    /// do so by more than rounding.
    pub(super) fn solve(&self, bodies: &mut Bodies, arrival: &mut Arrival) -> bool {
        let done: [f64; 3] = core::array::from_fn(|k| self.rows[k] + arrival.impulses[k]);
        let speeds = self.speeds(&bodies.lines);
        let pushed = self.opened(done);
        let free = core::array::from_fn(|k| speeds[k] - pushed[k]);
        let Some(all) = self.answer(free, arrival.leaves) else {
            return false;
        };
        let change = core::array::from_fn(|k| all[k] - done[k]);
        let most = |of: [f64; 3]| of.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if most(change) <= ROUNDING * most(all) {
            return false;
        }
        arrival.impulses = core::array::from_fn(|k| all[k] - self.rows[k]);
        for (line, push) in self.lines.into_iter().zip(self.pushes(change)) {
            bodies.start[line].add(&push);
            bodies.lines[line].add(&push);
        }
        true
    }

    /// R j.
    fn opened(&self, j: [f64; 3]) -> [f64; 3] {
        self.response
            .map(|row| row[0] * j[0] + row[1] * j[1] + row[2] * j[2])
    }

    /// All that acts in this sub-step, given the speeds without it.
    fn answer(&self, free: [f64; 3], leaves: [f64; 2]) -> Option<[f64; 3]> {
        let [first, second] = leaves.map(|leaves| leaves >= 0.0);
        let frictions = [
            Friction::Sticks,
            Friction::Slides(self.mu),
            Friction::Slides(-self.mu),
        ];
        let frictions = if self.mu > 0.0 {
            &frictions[..]
        } else {
            &frictions[1..2]
        };
        for holds in [[first, second], [first, false], [false, second], [false; 2]] {
            for &friction in frictions {
                let j = self.held(holds, friction, free, leaves);
                if let Some(j) = j.filter(|j| self.fits(*j, friction, free, leaves)) {
                    return Some(j);
                }
            }
        }
        None
    }

    /// Impulses with which the points that hold open as they should; what is not met keeps what its row did.
    fn held(
        &self,
        holds: [bool; 2],
        friction: Friction,
        free: [f64; 3],
        leaves: [f64; 2],
    ) -> Option<[f64; 3]> {
        let mut rows = [[0.0; 4]; 3];
        for point in 0..2 {
            let [one, other, across] = self.response[point];
            rows[point] = if holds[point] {
                [one, other, across, leaves[point] - free[point]]
            } else {
                // In the units of the others.
                let unit = self.response[point][point];
                let met = leaves[point] >= 0.0;
                let mut row = [
                    0.0,
                    0.0,
                    0.0,
                    if met { 0.0 } else { unit * self.rows[point] },
                ];
                row[point] = unit;
                row
            };
        }
        let [one, other, across] = self.response[2];
        rows[2] = match friction {
            Friction::Sticks => [one, other, across, -free[2]],
            Friction::Slides(part) => [-part * across, -part * across, across, 0.0],
        };
        solution(rows)
    }

    fn fits(&self, j: [f64; 3], friction: Friction, free: [f64; 3], leaves: [f64; 2]) -> bool {
        let v: [f64; 3] = {
            let pushed = self.opened(j);
            core::array::from_fn(|k| free[k] + pushed[k])
        };
        let load = j[0] + j[1];
        let fast = ROUNDING
            * free
                .iter()
                .chain(&leaves.map(|leaves| leaves.max(0.0)))
                .fold(0.0, |most: f64, v| most.max(v.abs()));
        let strong = ROUNDING * load.abs();
        let opens = (0..2).all(|k| j[k] >= -strong && v[k] >= leaves[k] - fast);
        let rubs = match friction {
            Friction::Sticks => j[2].abs() <= self.mu * load + strong,
            Friction::Slides(part) => part * v[2] <= fast * part.abs(),
        };
        opens && rubs
    }

    /// The heat of its friction, and what a belt gave for it, in J.
    ///
    /// Friction takes its impulse times the mean of the slips before and after. Where the impulses along the normal turn the
    /// slip, that is less than nothing: friction acted after the turn alone, and is no part of what the blow took.
    pub(super) fn work(&self, lines: &[Line], friction: f64) -> [f64; 2] {
        let mean = 0.5 * (self.slipped + self.speeds(lines)[2]);
        [(-friction * mean).max(0.0), friction * self.belt]
    }
}

/// The solution of three equations, rows of coefficients and what they are equal to: by elimination with row pivots; none of a
/// matrix that is singular but for rounding. Without memory of its own, as `carom_impact::Factored` has: each sweep tries
/// several.
fn solution(mut rows: [[f64; 4]; 3]) -> Option<[f64; 3]> {
    for k in 0..3 {
        let pivot = (k..3).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        let size = rows[k..]
            .iter()
            .flat_map(|row| &row[..3])
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        if rows[pivot][k].abs() <= ROUNDING * size {
            return None;
        }
        rows.swap(k, pivot);
        for i in k + 1..3 {
            let factor = rows[i][k] / rows[k][k];
            let row = rows[k];
            for (x, y) in rows[i].iter_mut().zip(row) {
                *x -= factor * y;
            }
        }
    }
    let mut x = [0.0; 3];
    for k in (0..3).rev() {
        let known: f64 = (k + 1..3).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][3] - known) / rows[k][k];
    }
    Some(x)
}
