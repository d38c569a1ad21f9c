//! Bodies and rows together, and one sub-step of them.
//!
//! The warm start of a sub-step is kept by body, not by row: as long as no row changes, what the
//! contacts did to a body's velocity in the last sub-step is the difference of the velocity after
//! and before. Invariant, outside a sub-step:
//!
//! ```text
//! v − start = Σ over its rows of M⁻¹ Jᵀ j
//! ```
//! Everything that changes a row, a velocity or a mass keeps it.

mod restitution;

use carom_math::{Vec2, perp};
use fearless_simd::Level;

use super::kernel::{Met, Pass, sweep};
use super::lanes::{Lanes, RowId};
use super::wide::{LANES, Line};
use super::{Law, Row, SolverBody};

/// The bodies of a solver, their rows, and the warm start.
#[derive(Clone, Debug)]
pub(crate) struct Rig {
    level: Level,
    pub(crate) lines: Vec<Line>,
    /// Velocities just before contacts acted.
    start: Vec<Start>,
    /// What pulls on each body: acceleration, and angular acceleration.
    pull: Vec<Pull>,
    pub(crate) lanes: Lanes,
    /// How far each body may move in a sub-step before it is swift.
    limits: Vec<Limit>,
    /// Who went farther in the last sub-step, and where it was before.
    pub(crate) swift: Vec<Swift>,
    /// Rows that were met in the last sub-step: their impulses stopped something once.
    pub(crate) met: Vec<RowId>,
    /// The same as the sweep tells it: scratch.
    blocks: Vec<Met>,
    free: Vec<u32>,
    /// What friction turned into heat, in J.
    pub(crate) heat: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Start {
    v: Vec2,
    w: f64,
}

/// What pulls on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pull {
    /// In m/s².
    pub(crate) acceleration: Vec2,
    /// In rad/s².
    pub(crate) angular: f64,
}

/// How far a body may move in a sub-step before it is swift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limit {
    /// Square of the travel, in m².
    pub(crate) travel: f64,
    /// In rad.
    pub(crate) turn: f64,
}

impl Limit {
    pub(crate) const NONE: Self = Self {
        travel: f64::INFINITY,
        turn: f64::INFINITY,
    };
}

/// Where a swift body was before a sub-step, against its base.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swift {
    pub(crate) slot: u32,
    pub(crate) d: Vec2,
    pub(crate) turn: f64,
}

/// A body that joins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    pub(crate) velocity: Vec2,
    pub(crate) spin: f64,
    pub(crate) inverse_mass: f64,
    pub(crate) inverse_inertia: f64,
    pub(crate) pull: Pull,
}

impl Default for Rig {
    fn default() -> Self {
        let mut lanes = Lanes::default();
        lanes.admit(0);
        Self {
            level: Level::new(),
            lines: vec![Line::EMPTY],
            start: vec![Start::default()],
            pull: vec![Pull::default()],
            lanes,
            limits: vec![Limit::NONE],
            swift: Vec::new(),
            met: Vec::new(),
            blocks: Vec::new(),
            free: Vec::new(),
            heat: 0.0,
        }
    }
}

impl Rig {
    /// Takes a body in, where it is now; its line counts from there.
    pub(crate) fn admit(&mut self, member: &Member) -> u32 {
        let slot = self.free.pop().unwrap_or_else(|| {
            #[expect(clippy::cast_possible_truncation, reason = "no more than bodies")]
            let slot = self.lines.len() as u32;
            self.lines.push(Line::EMPTY);
            self.start.push(Start::default());
            self.pull.push(Pull::default());
            self.limits.push(Limit::NONE);
            slot
        });
        let i = slot as usize;
        // No −0: a line that nothing moves must come back as it was written.
        let (v, w) = (member.velocity + Vec2::ZERO, member.spin + 0.0);
        self.lines[i] = Line::new(v, w, member.inverse_mass, member.inverse_inertia);
        self.start[i] = Start { v, w };
        self.pull[i] = member.pull;
        self.limits[i] = Limit::NONE;
        self.lanes.admit(slot);
        slot
    }

    /// Lets a body go. It must have no rows left.
    pub(crate) fn dismiss(&mut self, slot: u32) {
        debug_assert_eq!(self.lanes.degree(slot), 0, "a body leaves without its rows");
        let i = slot as usize;
        // It stays as a line that nothing moves until somebody takes the place.
        self.lines[i] = Line::new(Vec2::ZERO, 0.0, 0.0, 0.0);
        self.start[i] = Start::default();
        self.pull[i] = Pull::default();
        self.limits[i] = Limit::NONE;
        self.free.push(slot);
    }

    pub(crate) fn set_limit(&mut self, slot: u32, limit: Limit) {
        self.limits[slot as usize] = limit;
    }

    /// Whether a body moves farther than its limit in a sub-step of `h`, as fast as it is now.
    pub(crate) fn is_swift(&self, slot: u32, h: f64) -> bool {
        exceeds(&self.lines[slot as usize], self.limits[slot as usize], h)
    }

    /// Lines that nobody uses.
    pub(crate) fn holes(&self) -> usize {
        self.free.len()
    }

    /// Moves the bodies together; gives the new slot of each old one, `u32::MAX` for holes.
    pub(crate) fn compact(&mut self) -> Vec<u32> {
        let mut new: Vec<u32> = (0u32..).take(self.lines.len()).collect();
        for slot in self.free.drain(..) {
            new[slot as usize] = u32::MAX;
        }
        let mut next = 0;
        for (i, slot) in new.iter_mut().enumerate() {
            if *slot == u32::MAX {
                continue;
            }
            let to = next as usize;
            self.lines[to] = self.lines[i];
            self.start[to] = self.start[i];
            self.pull[to] = self.pull[i];
            self.limits[to] = self.limits[i];
            *slot = next;
            next += 1;
        }
        self.lines.truncate(next as usize);
        self.start.truncate(next as usize);
        self.pull.truncate(next as usize);
        self.limits.truncate(next as usize);
        self.lanes.renumber(&new);
        new
    }

    /// Gives a row a lane; its impulses are warm from the next sub-step on.
    pub(crate) fn insert(&mut self, row: &Row) -> RowId {
        self.warm(row, 1.0);
        self.lanes.insert(row, &self.lines)
    }

    /// Puts a new row of the same two bodies into the lane of an old one.
    pub(crate) fn rewrite(&mut self, id: RowId, row: &Row) {
        let old = self.row(id);
        debug_assert_eq!(old.bodies, row.bodies, "a lane is of two bodies");
        self.warm(&old, -1.0);
        self.warm(row, 1.0);
        self.retell(id, row);
    }

    /// Tells a row's gaps anew, from where its bodies' lines count now; its impulses stay.
    pub(crate) fn retell(&mut self, id: RowId, row: &Row) {
        let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let (line_a, line_b) = (self.lines[a], self.lines[b]);
        let (wide, lane) = self.lanes.at_mut(id);
        wide.put(lane, row, &line_a, &line_b);
    }

    /// Takes a row out.
    pub(crate) fn remove(&mut self, id: RowId) {
        let row = self.row(id);
        self.warm(&row, -1.0);
        self.lanes.remove(id, &self.lines);
        for slot in [row.bodies.0, row.bodies.1] {
            if self.lanes.degree(slot) == 0 {
                // Free flight is free of the rounding that rows leave behind.
                let i = slot as usize;
                (self.start[i].v, self.start[i].w) = (self.lines[i].v(), self.lines[i].w());
            }
        }
    }

    /// A row as it is now, with its gaps where the bodies are.
    pub(crate) fn row(&self, id: RowId) -> Row {
        let (wide, lane) = self.lanes.at(id);
        wide.row(lane, &self.lines)
    }

    /// Adds `sign` times a row's impulses to the warm start of its bodies.
    fn warm(&mut self, row: &Row, sign: f64) {
        let impulse = sign * (row.n * (row.j[0] + row.j[1]) + perp(row.n) * row.jt);
        let arm =
            |arms: [f64; 2], t: f64| sign * (arms[0] * row.j[0] + arms[1] * row.j[1] + t * row.jt);
        let (turn_a, turn_b) = (arm(row.a, row.at), arm(row.b, row.bt));
        let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
        let (line_a, line_b) = (self.lines[a], self.lines[b]);
        self.start[a].v += impulse * line_a.inverse_mass();
        self.start[a].w += turn_a * line_a.inverse_inertia();
        self.start[b].v -= impulse * line_b.inverse_mass();
        self.start[b].w -= turn_b * line_b.inverse_inertia();
    }

    /// Sets a velocity; what contacts do to the body stays.
    pub(crate) fn set_velocity(&mut self, slot: u32, v: Vec2, w: f64) {
        let (line, start) = (
            &mut self.lines[slot as usize],
            &mut self.start[slot as usize],
        );
        let (v, w) = (v + Vec2::ZERO, w + 0.0);
        start.v = v - (line.v() - start.v);
        start.w = w - (line.w() - start.w);
        line.0[..3].copy_from_slice(&[v.x, v.y, w]);
    }

    #[cfg(test)]
    /// Changes a mass: the same impulses, other velocities. Moving bodies only.
    pub(crate) fn set_mass(&mut self, slot: u32, inverse_mass: f64, inverse_inertia: f64) {
        let (line, start) = (
            &mut self.lines[slot as usize],
            &mut self.start[slot as usize],
        );
        let (v, w) = (line.v(), line.w());
        start.v = v - (v - start.v) * (inverse_mass / line.inverse_mass());
        start.w = w - (w - start.w) * (inverse_inertia / line.inverse_inertia());
        (line.0[3], line.0[7]) = (inverse_mass, inverse_inertia);
    }

    /// Says where a body is, against its base.
    pub(crate) fn set_displacement(&mut self, slot: u32, d: Vec2, turn: f64) {
        self.lines[slot as usize].0[4..7].copy_from_slice(&[d.x, d.y, turn]);
    }

    pub(crate) fn set_pull(&mut self, slot: u32, pull: Pull) {
        self.pull[slot as usize] = pull;
    }

    pub(crate) fn pull(&self, slot: u32) -> Pull {
        self.pull[slot as usize]
    }

    #[cfg(test)]
    /// Impulses and warm starts for another length of the sub-step: `ratio` = new over old.
    pub(crate) fn rescale(&mut self, ratio: f64) {
        for wide in self.lanes.colours.iter_mut().flatten() {
            for column in [&mut wide.j1, &mut wide.j2, &mut wide.jt] {
                for j in column {
                    *j *= ratio;
                }
            }
        }
        for (line, start) in self.lines.iter().zip(&mut self.start) {
            start.v = line.v() - (line.v() - start.v) * ratio;
            start.w = line.w() - (line.w() - start.w) * ratio;
        }
    }

    /// Works the warm start out from the impulses, against slow rounding.
    pub(crate) fn refresh(&mut self) {
        for (line, start) in self.lines.iter().zip(&mut self.start) {
            (start.v, start.w) = (line.v(), line.w());
        }
        let lanes = core::mem::take(&mut self.lanes);
        for row in lanes.rows(&self.lines.clone()) {
            self.warm(&row, 1.0);
        }
        self.lanes = lanes;
    }

    /// One sub-step. Displacements grow by it; rows are read where they are.
    ///
    /// `bounce` may change velocities before displacements are made of second order.
    pub(crate) fn step(&mut self, law: &Law, sweeps: usize, bounce: impl FnOnce(&mut Self)) {
        self.forget_impacts();
        self.pull_and_warm(law.h);
        self.blocks.clear();
        sweep(
            self.level,
            Pass::Solve,
            law,
            &mut self.lines,
            &mut self.lanes.colours,
            &mut self.blocks,
        );
        for met in &self.blocks {
            let (colour, block) = (met.colour as usize, met.block as usize);
            let lanes = (0..LANES).filter(|lane| met.lanes >> lane & 1 == 1);
            let rows = lanes.filter_map(|lane| self.lanes.owner(colour, block, lane));
            self.met.extend(rows);
        }
        self.displace(law.h);
        for _ in 0..sweeps {
            self.heat += sweep(
                self.level,
                Pass::Relax,
                law,
                &mut self.lines,
                &mut self.lanes.colours,
                &mut self.blocks,
            );
        }
        bounce(self);
        self.second_order(law.h);
    }

    /// Rows that were met start cold: what stopped a body, and what friction took from it then, does not act
    /// once more. Only those that one sweep solves for: in a pile what came in goes on for some sub-steps.
    fn forget_impacts(&mut self) {
        let mut met = core::mem::take(&mut self.met);
        for id in met.drain(..) {
            if !self.lanes.holds(id) {
                continue;
            }
            let row = self.row(id);
            let alone = |slot: u32| {
                self.lines[slot as usize].inverse_mass() == 0.0 || self.lanes.degree(slot) == 1
            };
            if !(alone(row.bodies.0) && alone(row.bodies.1)) {
                continue;
            }
            self.warm(&row, -1.0);
            let (wide, lane) = self.lanes.at_mut(id);
            (wide.j1[lane], wide.j2[lane], wide.jt[lane]) = (0.0, 0.0, 0.0);
        }
        self.met = met;
    }

    /// Work that driven bodies did through a row in the last sub-step, in J: impulse × their velocity.
    pub(crate) fn driven_work(&self, id: RowId) -> f64 {
        let row = self.row(id);
        let body = |slot: u32| {
            let line = &self.lines[slot as usize];
            SolverBody {
                v: line.v(),
                w: line.w(),
                inverse_mass: line.inverse_mass(),
                ..SolverBody::default()
            }
        };
        row.driven_work(&body(row.bodies.0), &body(row.bodies.1))
    }

    /// `p = v − start; start = v + h a; v = start + p`
    fn pull_and_warm(&mut self, h: f64) {
        for ((line, start), pull) in self.lines.iter_mut().zip(&mut self.start).zip(&self.pull) {
            let p = (line.v() - start.v, line.w() - start.w);
            start.v = line.v() + pull.acceleration * h;
            start.w = line.w() + pull.angular * h;
            let (v, w) = (start.v + p.0, start.w + p.1);
            (line.0[0], line.0[1], line.0[2]) = (v.x, v.y, w);
        }
    }

    /// `d += h v`
    fn displace(&mut self, h: f64) {
        self.swift.clear();
        for (slot, (line, limit)) in (0u32..).zip(self.lines.iter_mut().zip(&self.limits)) {
            if exceeds(line, *limit, h) {
                let (d, turn) = (line.d(), line.turn());
                self.swift.push(Swift { slot, d, turn });
            }
            for k in 0..3 {
                line.0[4 + k] += h * line.0[k];
            }
        }
    }

    /// Makes displacements of second order where velocities change smoothly.
    ///
    /// `h v` with the velocity at the end overshoots the trapezoid by h/2 Δv: g h²/2 in free flight,
    /// and likewise where friction brakes. Where a contact stopped the body at its surface there is
    /// nothing to take back; a stop is what changes the velocity by more than four times the pull.
    fn second_order(&mut self, h: f64) {
        for ((line, start), pull) in self.lines.iter_mut().zip(&self.start).zip(&self.pull) {
            let dv = line.v() - start.v + pull.acceleration * h;
            let most = 4.0 * h * pull.acceleration.length();
            if dv.length_squared() <= most * most {
                let dw = line.w() - start.w + pull.angular * h;
                line.0[4] -= 0.5 * h * dv.x;
                line.0[5] -= 0.5 * h * dv.y;
                line.0[6] -= 0.5 * h * dw;
            }
        }
    }

    /// Whether a row pushes.
    pub(crate) fn pushes(&self, id: RowId) -> bool {
        let (wide, lane) = self.lanes.at(id);
        wide.j1[lane] + wide.j2[lane] > 0.0
    }

    /// Whether contacts act on a body.
    pub(crate) fn is_pushed(&self, slot: u32) -> bool {
        let (line, start) = (&self.lines[slot as usize], &self.start[slot as usize]);
        line.v() != start.v || (line.w() - start.w).abs() > 0.0
    }

    /// Velocities at the start of the last sub-step.
    pub(crate) fn before(&self, slot: u32, h: f64) -> (Vec2, f64) {
        let (start, pull) = (&self.start[slot as usize], &self.pull[slot as usize]);
        (start.v - pull.acceleration * h, start.w - pull.angular * h)
    }

    #[cfg(test)]
    pub(super) fn warm_start(&self, slot: u32) -> (Vec2, f64) {
        let (line, start) = (&self.lines[slot as usize], &self.start[slot as usize]);
        (line.v() - start.v, line.w() - start.w)
    }
}

/// Whether a body goes beyond its limit within `h`.
fn exceeds(line: &Line, limit: Limit, h: f64) -> bool {
    let v = line.v();
    v.length_squared() * h * h > limit.travel || line.w().abs() * h > limit.turn
}
