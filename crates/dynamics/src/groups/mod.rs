//! Contact groups: what pushes what, lasting, in one sub-step, pair by pair.
//!
//! To read in this order: this file (the groups of a sub-step), [`gather`] (rows of contacts that last), [`row`] (what is solved
//! for), [`apart`] (which contacts hang together), [`round`] and [`at_once`] (the solves: of discs, and of all others), [`motions`]
//! and [`go_on`] (what becomes of it), [`settle`] (groups at rest fall asleep).
//!
//! It is for few discs in exact mode that have no closed form, as they gain energy in the engine, and for what they touch meanwhile.

mod apart;
mod at_once;
mod gather;
mod go_on;
mod motions;
mod round;
mod row;
pub(crate) mod settle;

use core::ops::Range;

use carom_math::SimTime;

use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, Pairs};
use crate::store::state::Collider;
use crate::{BodyId, StepReport};
use apart::set_apart;
use at_once::{Place, solve_at_once};
use round::{Way, hold, members_of};
pub(crate) use row::{Row, SolverBody};

/// Contact groups of a sub-step, and the scratch of its solve.
#[derive(Clone, Debug, Default)]
pub(crate) struct Groups {
    /// Length of the sub-step, in s, and when it ends.
    h: f64,
    until: SimTime,
    rows: Vec<Row>,
    /// Where each row came from.
    sources: Vec<Source>,
    bodies: Vec<SolverBody>,
    /// How each of them goes through the sub-step.
    ways: Vec<Way>,
    /// Bodies of the solver, in its order.
    members: Vec<u32>,
    /// Version of the motion that each has.
    versions: Vec<u32>,
    rounds: Vec<Round>,
    /// Number of its group in `rounds` for each body of the solver, or [`NOT_HERE`].
    round_of: Vec<u32>,
    /// Place in the solver of each body, or [`NOT_HERE`].
    places: Vec<u32>,
}

/// Where a row came from.
#[derive(Clone, Copy, Debug)]
struct Source {
    pair: u32,
    /// Its shapes and their bodies: its place may be another pair's by the time that an impact cuts the sub-step short.
    key: Key,
    /// Contact within it.
    contact: usize,
    /// It is held as discs are; before groups are known, it may be.
    is_round: bool,
    /// Gap below which they touch, in m.
    touch: f64,
    /// Speed of approach beyond which it bounces, in m/s.
    rest: f64,
    /// What it may close by until the sub-step ends, in m/s.
    closes: f64,
    /// One of the two has left the group.
    gone: bool,
}

/// Shapes and bodies of a pair.
type Key = ((u32, u32), [BodyId; 2]);

fn key_of(bodies: &Bodies, pair: &Pair) -> Key {
    let ids = [pair.bodies.0, pair.bodies.1].map(|index| bodies.get(index).id);
    (pair.colliders, ids)
}

/// A group of discs.
#[derive(Clone, Debug)]
struct Round {
    rows: Range<usize>,
    /// Bodies of the solver that move, in order.
    members: Vec<u32>,
    /// What it is held for, in s.
    span: f64,
    /// Gap below which all of it touches, in m.
    touch: f64,
}

impl Source {
    /// Whether its pair is there yet: a caller may take a body out in the midst of a sub-step.
    fn stays(&self, bodies: &Bodies, pairs: &Pairs) -> bool {
        let pair = pairs.find(self.pair);
        pair.is_some_and(|pair| key_of(bodies, pair) == self.key)
    }

    /// Where its row pushes.
    fn place(self, bodies: &Bodies, pairs: &Pairs, time: SimTime) -> Place {
        let pair = pairs.get(self.pair);
        let centre = |index: u32| bodies.get(index).motion.centre_at(time);
        let points = &pair.contacts[self.contact].points;
        Place {
            points: points.iter().map(|point| point.position).collect(),
            centres: (centre(pair.bodies.0), centre(pair.bodies.1)),
        }
    }
}

const NOT_HERE: u32 = u32::MAX;

impl Groups {
    /// Solves all contacts that last from `time` on for a sub-step of `h` seconds, and gives every body that is pushed its motion.
    /// Bodies that nothing pushes are left to flight. `push_out`: of overlaps, in m/s.
    pub(crate) fn step(
        &mut self,
        (h, push_out): (f64, f64),
        bodies: &mut Bodies,
        colliders: &[Collider],
        pairs: &mut Pairs,
        time: SimTime,
        report: &mut StepReport,
    ) {
        (self.h, self.until) = (h, time + h);
        self.gather(bodies, colliders, pairs, time, h);
        if self.rows.is_empty() {
            return;
        }
        report.rows += self.rows.len() as u64;
        self.round_of.resize(self.bodies.len(), NOT_HERE);
        let groups = set_apart(&self.bodies, &mut self.rows, &mut self.sources);
        for (is_round, group) in groups {
            let (rows, sources) = (
                &mut self.rows[group.clone()],
                &mut self.sources[group.clone()],
            );
            for source in &mut *sources {
                source.is_round = is_round;
            }
            if is_round {
                let touch = sources.iter().map(|at| at.touch);
                let touch = touch.fold(f64::INFINITY, f64::min);
                hold(h, &mut self.bodies, &mut self.ways, rows, touch);
                self.note_round(group, touch, h);
            } else {
                let places = sources.iter().map(|at| at.place(bodies, pairs, time));
                let places: Vec<Place> = places.collect();
                solve_at_once((h, push_out), &mut self.bodies, rows, &places);
            }
        }
        bodies.booked.clear();
        for place in 0..self.members.len() {
            let member = &self.bodies[place];
            if member.inverse_mass > 0.0 && member.acted {
                report.handed_over += 1;
                self.send(bodies, place, time, h);
            }
        }
        for k in 0..self.rows.len() {
            self.book(bodies, pairs, k, time, h);
        }
    }

    /// Keeps a group that an impact may cut short.
    fn note_round(&mut self, rows: Range<usize>, touch: f64, span: f64) {
        let mut members = members_of(&self.rows[rows.clone()]);
        members.retain(|place| self.bodies[*place as usize].inverse_mass > 0.0);
        #[expect(clippy::cast_possible_truncation, reason = "fewer than there are rows")]
        let number = self.rounds.len() as u32;
        for place in &members {
            self.round_of[*place as usize] = number;
        }
        self.rounds.push(Round {
            rows,
            members,
            span,
            touch,
        });
    }

    /// Whatever its bodies do now, flights and sleep too, is what this sub-step gave them.
    pub(crate) fn stamp(&mut self, bodies: &Bodies) {
        self.versions.clear();
        let versions = self.members.iter().map(|index| bodies.version(*index));
        self.versions.extend(versions);
    }

    /// Whether the solver pushed body `index` in this sub-step.
    pub(crate) fn pushed(&self, index: u32) -> bool {
        let place = self.places.get(index as usize).copied().unwrap_or(NOT_HERE);
        place != NOT_HERE && self.bodies[place as usize].acted
    }

    /// Pairs of dynamic bodies that push each other, for the groups that sleep together.
    pub(crate) fn links(&self) -> impl Iterator<Item = (u32, u32)> + use<'_> {
        self.rows.iter().filter(|row| row.acts()).map(|row| {
            let body = |place: u32| self.members[place as usize];
            (body(row.bodies.0), body(row.bodies.1))
        })
    }
}
