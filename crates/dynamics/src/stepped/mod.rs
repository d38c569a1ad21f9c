//! The solver of crowds: groups in [`crate::Mode::Hybrid`] that are too large for impacts one by one.
//!
//! ```text
//! changes ─► look (once a tick) ─► sub-steps ──► write
//! seats      near, faces           rig, bounce   motions, touch
//! ```
//! During a step bodies live in the solver's lines, and pairs in its rows. Motions are written once,
//! at the end; a look does nothing for a pair that kept its relative pose.

mod ahead;
mod among;
mod bounce;
mod boxes;
mod cores;
mod courses;
mod crowd;
mod faces;
mod graze;
mod heap;
mod near;
mod partners;
mod relative;
mod rest;
mod round;
mod rush;
mod seats;
mod sent;
mod stand;
#[cfg(test)]
mod tests;
mod throng;
mod touch;
mod watch;
mod write;

use carom_collision::PartManifold;

use crate::World;
use crate::pairs::PairContact;
use crate::solver::{Rig, RowId};
use ahead::Hurry;
use bounce::Bounces;
use cores::Cores;
use crowd::Crowd;
pub(crate) use crowd::{FEW, MANY};
pub(crate) use heap::Seen;
use round::Round;
use rush::Rush;
use seats::Seats;
use throng::Throng;

/// Ticks between two works-out of the warm start from the impulses.
const REFRESH: u32 = 64;

/// What stepping keeps between steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stepped {
    pub(crate) seats: Seats,
    pub(crate) bounces: Bounces,
    /// Scratch of a look.
    found: Vec<PartManifold>,
    /// Shapes near a box: scratch.
    near: Vec<u32>,
    /// Bodies that got new boxes at this tick, and their slots: scratch.
    reboxed: Vec<(u32, u32)>,
    throng: Throng,
    /// Contacts of the look before: scratch.
    before: Vec<PairContact>,
    /// Pair of each row, by the row's name.
    pair_of: Vec<u32>,
    /// Rows that began or ceased to push: scratch.
    changed: Vec<RowId>,
    /// Time since groups at rest were last looked for, in s.
    since_rest: f64,
    /// Sub-steps since members of crowds were last asked what nears them.
    since_idle: u32,
    /// Sub-steps until the next look.
    until_look: u32,
    /// Looks so far, modulo [`REFRESH`].
    looks: u32,
    /// Bodies that moved since they were last looked at.
    moved: Vec<u32>,
    /// Pairs that are asked before the next tick, and how many sub-steps before it; some were asked since.
    watched: Vec<(u32, u32)>,
    /// Somebody was struck since the last tick began.
    stirred: bool,
    hurry: Hurry,
    /// Core polygons, for ghost collisions.
    cores: Cores,
    /// Pairs that a look goes through: scratch.
    round: Round,
    pub(crate) crowd: Crowd,
    pub(crate) rush: Rush,
}

impl Stepped {
    /// Who is at rest at the first look counts as at rest for the tick before it.
    pub(crate) fn new(tick: f64) -> Self {
        Self {
            since_rest: tick,
            since_idle: u32::MAX / 2,
            ..Self::default()
        }
    }
}

impl World {
    fn substep(&mut self) {
        if !self.go_ahead() {
            self.make_substep();
        }
        self.pool.since_rest += self.clock.h;
        self.pool.since_idle += 1;
        let rig = &self.pool.seats.rig;
        self.report.rows += rig.lanes.len() as u64;
        self.report.handed_over += self.pool.seats.len() as u64;
        self.stopwatch.lap(|p| &mut p.solver);
    }

    fn make_substep(&mut self) {
        let (rig, bounces) = (&mut self.pool.seats.rig, &mut self.pool.bounces);
        let h = self.clock.h;
        bounces.arm(rig, h);
        let pay = bounces.owe().then_some(|rig: &mut Rig| bounces.pay(rig, h));
        rig.step(&self.law, pay);
        self.pool.stirred |= rig.met;
    }
}
