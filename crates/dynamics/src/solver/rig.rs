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

mod ahead;
mod restitution;
mod substep;
mod zoning;

use carom_math::{Vec2, perp};
use fearless_simd::Level;

use super::coast::Quad;
use super::lanes::{Lanes, RowId};
use super::wide::Line;
use super::{Row, SolverBody};
pub(crate) use ahead::Ahead;
#[cfg(test)]
pub(crate) use substep::NOBODY;

/// The bodies of a solver, their rows, and the warm start.
#[derive(Clone, Debug)]
pub(crate) struct Rig {
    level: Level,
    pub(crate) lines: Vec<Line>,
    /// Velocities just before contacts acted.
    start: Vec<Quad>,
    /// What pulls on each body: acceleration, and angular acceleration.
    pull: Vec<Quad>,
    pub(crate) lanes: Lanes,
    /// Some contact closed with a speed in the last sub-step.
    pub(crate) met: bool,
    /// Rows that bounced in the last sub-step.
    bounced: Vec<RowId>,
    /// Whether groups that hang together are cut where they are too large for one zone.
    pub(crate) cuts: bool,
    /// Rows over all lines when the zones were made.
    crossing: usize,
    /// Zones are swept from the last to the first.
    back: bool,
    free: Vec<u32>,
    /// What friction turned into heat, in J.
    pub(crate) heat: f64,
}

/// What pulls on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pull {
    /// In m/s².
    pub(crate) acceleration: Vec2,
    /// In rad/s².
    pub(crate) angular: f64,
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
            start: vec![Quad::of(Vec2::ZERO, 0.0, 1.0)],
            pull: vec![Quad::default()],
            lanes,
            met: false,
            bounced: Vec::new(),
            cuts: cfg!(test),
            crossing: 0,
            back: false,
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
            self.start.push(Quad::default());
            self.pull.push(Quad::default());
            slot
        });
        let i = slot as usize;
        // No −0: a line that nothing moves must come back as it was written.
        let (v, w) = (member.velocity + Vec2::ZERO, member.spin + 0.0);
        self.lines[i] = Line::new(v, w, member.inverse_mass, member.inverse_inertia);
        self.start[i] = Quad::of(v, w, member.inverse_mass);
        self.set_pull(slot, member.pull);
        self.lanes.admit(slot);
        slot
    }

    /// Lets a body go. It must have no rows left.
    pub(crate) fn dismiss(&mut self, slot: u32) {
        debug_assert_eq!(self.lanes.degree(slot), 0, "a body leaves without its rows");
        let i = slot as usize;
        // It stays as a line that nothing moves until somebody takes the place.
        self.lines[i] = Line::new(Vec2::ZERO, 0.0, 0.0, 0.0);
        self.start[i] = Quad::default();
        self.pull[i] = Quad::default();
        self.free.push(slot);
    }

    /// Lines that nobody uses.
    pub(crate) fn holes(&self) -> usize {
        self.free.len()
    }

    /// Gives a row a lane; its impulses are warm from the next sub-step on.
    pub(crate) fn insert(&mut self, row: &Row) -> RowId {
        self.warm(row, 1.0);
        self.lanes.insert(row, &self.lines)
    }

    /// Puts a new row of the same two bodies into the lane of an old one.
    pub(crate) fn rewrite(&mut self, id: RowId, row: &Row) {
        debug_assert_eq!(self.bodies(id), row.bodies, "a lane is of two bodies");
        self.replace(id, |_, _| *row);
    }

    /// The same for a row that is made from the impulses of the old one.
    pub(crate) fn replace(&mut self, id: RowId, row: impl FnOnce([f64; 2], f64) -> Row) {
        let (wide, lane) = self.lanes.at_mut(id);
        let (push, turn_a, turn_b) = wide.push(lane);
        let row = row([wide.j1[lane], wide.j2[lane]], wide.jt[lane]);
        let (a, b) = (row.bodies.0 as usize, row.bodies.1 as usize);
        wide.put(lane, &row, &self.lines[a], &self.lines[b]);
        self.lanes.notes(&row);
        let new = push_of(&row);
        let change = (new.0 - push, new.1 - turn_a, new.2 - turn_b);
        self.push(row.bodies, change);
    }

    /// Impulses of a row: of both points, and of friction.
    pub(crate) fn impulses(&self, id: RowId) -> ([f64; 2], f64) {
        let (wide, lane) = self.lanes.at(id);
        ([wide.j1[lane], wide.j2[lane]], wide.jt[lane])
    }

    /// A body's line counts from where it is from now on; `rows`: all of its own.
    pub(crate) fn rebase(&mut self, slot: u32, rows: impl Iterator<Item = RowId>) {
        let line = self.lines[slot as usize];
        for id in rows {
            let of_b = self.bodies(id).1 == slot;
            let (wide, lane) = self.lanes.at_mut(id);
            wide.rebase(lane, of_b, &line);
        }
        self.set_displacement(slot, Vec2::ZERO, 0.0);
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
                self.start[i].set(self.lines[i].v(), self.lines[i].w());
            }
        }
    }

    /// A row as it is now, with its gaps where the bodies are.
    pub(crate) fn row(&self, id: RowId) -> Row {
        self.lanes.row(id, &self.lines)
    }

    /// Slots of the bodies of a row.
    pub(crate) fn bodies(&self, id: RowId) -> (u32, u32) {
        self.lanes.bodies_of(id)
    }

    /// Whether one of the two cannot be moved.
    fn is_ground(&self, id: RowId) -> bool {
        let (a, b) = self.bodies(id);
        [a, b]
            .into_iter()
            .any(|slot| self.lines[slot as usize].inverse_mass() == 0.0)
    }

    /// Adds `sign` times a row's impulses to the warm start of its bodies.
    fn warm(&mut self, row: &Row, sign: f64) {
        let (push, turn_a, turn_b) = push_of(row);
        self.push(row.bodies, (push * sign, turn_a * sign, turn_b * sign));
    }

    fn push(&mut self, (a, b): (u32, u32), (push, turn_a, turn_b): (Vec2, f64, f64)) {
        let (a, b) = (a as usize, b as usize);
        let (line_a, line_b) = (&self.lines[a], &self.lines[b]);
        let (mass_a, mass_b) = (line_a.inverse_mass(), line_b.inverse_mass());
        let (inertia_a, inertia_b) = (line_a.inverse_inertia(), line_b.inverse_inertia());
        self.start[a].add(push * mass_a, turn_a * inertia_a);
        self.start[b].add(-push * mass_b, -turn_b * inertia_b);
    }

    /// Sets a velocity; what contacts do to the body stays.
    pub(crate) fn set_velocity(&mut self, slot: u32, v: Vec2, w: f64) {
        let (line, start) = (
            &mut self.lines[slot as usize],
            &mut self.start[slot as usize],
        );
        let (v, w) = (v + Vec2::ZERO, w + 0.0);
        start.set(v - (line.v() - start.v()), w - (line.w() - start.w()));
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
        *start = Quad::of(
            v - (v - start.v()) * (inverse_mass / line.inverse_mass()),
            w - (w - start.w()) * (inverse_inertia / line.inverse_inertia()),
            inverse_mass,
        );
        (line.0[3], line.0[7]) = (inverse_mass, inverse_inertia);
        let ids: Vec<RowId> = self.lanes.ids().collect();
        for id in ids {
            let row = self.row(id);
            self.rewrite(id, &row);
        }
    }

    /// Says where a body is, against its base.
    pub(crate) fn set_displacement(&mut self, slot: u32, d: Vec2, turn: f64) {
        self.lines[slot as usize].0[4..7].copy_from_slice(&[d.x, d.y, turn]);
    }

    pub(crate) fn set_pull(&mut self, slot: u32, pull: Pull) {
        self.pull[slot as usize] = Quad::of(pull.acceleration, pull.angular, 0.0);
    }

    pub(crate) fn pull(&self, slot: u32) -> Pull {
        let pull = &self.pull[slot as usize];
        Pull {
            acceleration: pull.v(),
            angular: pull.w(),
        }
    }

    #[cfg(test)]
    /// Impulses and warm starts for another length of the sub-step: `ratio` = new over old.
    pub(crate) fn rescale(&mut self, ratio: f64) {
        let zones = self.lanes.zones.iter_mut();
        for wide in zones.flat_map(|zone| zone.colours.iter_mut().flatten()) {
            for column in [&mut wide.j1, &mut wide.j2, &mut wide.jt] {
                for j in column {
                    *j *= ratio;
                }
            }
        }
        for (line, start) in self.lines.iter().zip(&mut self.start) {
            let v = line.v() - (line.v() - start.v()) * ratio;
            let w = line.w() - (line.w() - start.w()) * ratio;
            start.set(v, w);
        }
    }

    /// Works the warm start out from the impulses, against slow rounding.
    pub(crate) fn refresh(&mut self) {
        for (line, start) in self.lines.iter().zip(&mut self.start) {
            start.set(line.v(), line.w());
        }
        let lanes = core::mem::take(&mut self.lanes);
        for id in lanes.ids() {
            self.warm(&lanes.row(id, &self.lines), 1.0);
        }
        self.lanes = lanes;
    }

    /// Rows that bounced off what cannot be moved start cold where nothing else pushes: what stopped a body, and what friction
    /// took from it then, does not act once more. In a pile what came in goes on for some sub-steps.
    fn forget_bounces(&mut self) {
        let mut bounced = core::mem::take(&mut self.bounced);
        bounced.retain(|id| self.lanes.holds(*id) && self.is_ground(*id));
        for id in &bounced {
            self.warm(&self.row(*id), -1.0);
        }
        let free: Vec<bool> = bounced.iter().map(|id| self.is_free(*id)).collect();
        for (id, free) in bounced.drain(..).zip(free) {
            if free {
                self.chill(id);
            } else {
                self.warm(&self.row(id), 1.0);
            }
        }
        self.bounced = bounced;
    }

    /// Whether nothing pushes the bodies of a row whose own push is taken back, but for rounding.
    fn is_free(&self, id: RowId) -> bool {
        let row = self.row(id);
        let zero = 1e-9 * (row.j[0] + row.j[1]);
        [row.bodies.0, row.bodies.1].into_iter().all(|slot| {
            let (line, start) = (&self.lines[slot as usize], &self.start[slot as usize]);
            let (push, turn) = (line.v() - start.v(), line.w() - start.w());
            let (m, i) = (line.inverse_mass(), line.inverse_inertia());
            // As impulse, and as what an impulse off the centre by a radius of gyration turns it by.
            push.length_squared() <= zero * zero * m * m && turn * turn <= zero * zero * m * i
        })
    }

    /// A row starts cold; its push is taken back already.
    fn chill(&mut self, id: RowId) {
        let (wide, lane) = self.lanes.at_mut(id);
        (wide.j1[lane], wide.j2[lane], wide.jt[lane]) = (0.0, 0.0, 0.0);
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

    /// Whether a row pushes.
    pub(crate) fn pushes(&self, id: RowId) -> bool {
        let (wide, lane) = self.lanes.at(id);
        wide.j1[lane] + wide.j2[lane] > 0.0
    }

    /// Whether contacts act on a body.
    pub(crate) fn is_pushed(&self, slot: u32) -> bool {
        let (line, start) = (&self.lines[slot as usize], &self.start[slot as usize]);
        line.v() != start.v() || (line.w() - start.w()).abs() > 0.0
    }

    /// Velocities at the start of the last sub-step.
    pub(crate) fn before(&self, slot: u32, h: f64) -> (Vec2, f64) {
        let (start, pull) = (&self.start[slot as usize], &self.pull[slot as usize]);
        (start.v() - pull.v() * h, start.w() - pull.w() * h)
    }

    #[cfg(test)]
    pub(super) fn warm_start(&self, slot: u32) -> (Vec2, f64) {
        let (line, start) = (&self.lines[slot as usize], &self.start[slot as usize]);
        (line.v() - start.v(), line.w() - start.w())
    }
}

/// What a row does to B: its impulse, and the turning ones about the centres of A and of B.
fn push_of(row: &Row) -> (Vec2, f64, f64) {
    let push = row.n * (row.j[0] + row.j[1]) + perp(row.n) * row.jt;
    let turn = |arms: [f64; 2], t: f64| arms[0] * row.j[0] + arms[1] * row.j[1] + t * row.jt;
    (push, turn(row.a, row.at), turn(row.b, row.bt))
}
