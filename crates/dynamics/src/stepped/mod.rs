//! Every moving body in one solver: [`crate::Mode::Stepped`].
//!
//! ```text
//! changes ─► look (once a tick) ─► sub-steps ─────────► write
//! seats      near, faces           rig, bounce, swift   motions, touch
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
mod depths;
mod faces;
mod graze;
mod heap;
mod midway;
mod near;
mod partners;
mod relative;
mod rest;
mod round;
mod rush;
mod seats;
mod sent;
mod stand;
mod swift;
#[cfg(test)]
mod tests;
mod throng;
mod touch;
mod watch;
mod write;

use carom_collision::PartManifold;
use carom_math::{SimTime, Vec2};

use crate::pairs::PairContact;
use crate::solver::{Rig, RowId};
use crate::{Mode, World};
use ahead::Hurry;
use bounce::Bounces;
use cores::Cores;
use crowd::Crowd;
pub(crate) use crowd::{FEW, MANY};
use depths::Depths;
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
    /// Cores of shapes, for those who move far in a sub-step.
    cores: Cores,
    depths: Depths,
    /// Bodies that were changed within the present sub-step since time went on last.
    midway: Vec<u32>,
    /// Displacement and turn of each line before the last sub-step, where that is asked for.
    places: Vec<(Vec2, f64)>,
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
    /// Sub-steps up to `end`.
    pub(crate) fn advance_stepped(&mut self, end: SimTime, stop_at_event: bool) -> SimTime {
        self.stop_midway();
        let mut first = true;
        while self.clock.is_due(end) {
            let time = self.clock.next();
            if first {
                self.take_changes(time);
            } else if self.settings.history > 0 {
                self.write_motions(&[]);
            }
            self.book_forces(time, first);
            first = false;
            if self.pool.until_look == 0 {
                self.tell_touches(time);
                if let Some(sleep) = self.settings.sleep {
                    self.rest(sleep, time);
                    self.stopwatch.lap(|p| &mut p.sleep);
                }
                self.pool.seats.zone();
                self.pool.until_look = self.settings.substeps_per_tick();
                self.look_around(time);
            } else if self.is_restless() {
                self.look_between(time);
            }
            self.pool.until_look -= 1;
            self.clock.begin();
            self.report.substeps += 1;
            // Who looks at its end alone asks nothing of the way.
            self.note_places(self.settings.history > 0 || self.clock.is_within(end));
            self.substep();
            if stop_at_event {
                self.tell_touches(self.clock.next().min(end));
            }
            if self.clock.is_due(end) && self.uses_up() || stop_at_event && self.events.are_due() {
                self.tell_touches(self.clock.next().min(end));
                self.write_motions(&[]);
                return self.clock.next().min(end);
            }
        }
        if !first {
            self.tell_touches(self.clock.next().min(end));
            self.write_motions(&[]);
            self.stopwatch.lap(|p| &mut p.flight);
        } else if !self.clock.is_within(end) {
            self.end_way();
        }
        end
    }

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
        let often = self.rows_in_need();
        let (rig, bounces) = (&mut self.pool.seats.rig, &mut self.pool.bounces);
        let h = self.clock.h;
        bounces.arm(rig, h);
        if self.settings.mode != Mode::Stepped {
            // Rows of a crowd keep their impulses from step to step, those that have just met too.
            rig.met.clear();
        }
        let pay = bounces.owe().then_some(|rig: &mut Rig| bounces.pay(rig, h));
        rig.step(&self.law, &often, pay);
        self.pool.stirred |= !rig.met.is_empty();
        self.stop_swift();
    }
}
