//! Continuous collision: who goes far in a sub-step does not pass through anything.
//!
//! A body that goes farther than a part of its width has a way: from where it was to where the sub-step put it. Its core, a
//! little smaller than itself, must be free along all of it: who slides, rolls or grazes is outside of the core, and so is
//! what a row holds off. Where the core meets something, the body stops short of where its surface does, and keeps its
//! velocity: a row takes over from there.

mod cores;
mod meeting;

use std::collections::BinaryHeap;

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_geometry::Aabb;
use carom_math::{Pose, SimTime, Vec2};

use crate::bodies::Bodies;
use crate::{BodyId, BodyKind, Engine, EngineError, PairRules, Settings};
use cores::cores;
use meeting::Meeting;

/// Who goes by less than this part of its least half width meets nothing that a row does not hold.
const PART: f64 = 0.25;

/// A body stops so far before a touch, as a part of its reach: its contact is found open.
const SHORT: f64 = 1e-7;

/// A way through the rest of a sub-step.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    slot: u32,
    /// Displacement and turn at its start, since the base pose.
    from: (Vec2, f64),
    /// Rows do not know of it: it is looked for among what moves, too.
    unforeseen: bool,
}

/// A way while touches are looked for.
struct Going {
    slot: u32,
    birth: u64,
    motion: Motion,
    unforeseen: bool,
    /// It leaves the boxes that were made for the tick.
    astray: bool,
    stopped: bool,
}

/// Notes which bodies go far in the coming displacement, and where from. Rows do not hold moving bodies off a body that turns
/// far, or that an impact sent elsewhere than was foreseen when its rows were found.
pub(crate) fn note_ways(bodies: &Bodies, settings: &Settings, h: f64, ways: &mut Vec<Way>) {
    ways.clear();
    for at in 2..bodies.lines.len() {
        let line = &bodies.lines[at];
        if !is_far(bodies, at, line.v() * h, line.w() * h) || line.inverse_mass() <= 0.0 {
            continue;
        }
        let turns = is_far(bodies, at, Vec2::ZERO, line.w() * h);
        let strays =
            bodies.change(at, settings.tick) * h > settings.margin * bodies.limits[at].extent;
        ways.push(Way {
            slot: bodies.slot_of[at],
            from: (line.d(), line.turn()),
            unforeseen: turns || strays,
        });
    }
}

impl Engine {
    /// A body comes from a pose to where it is within `left` seconds, as a caller moved it: see [`Self::stop_ways`].
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine.
    pub fn carry(&mut self, id: BodyId, from: Pose) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        if record.kind == BodyKind::Fixed || record.line == Bodies::NONE {
            return Ok(());
        }
        // Whoever asks for what is in a box until then finds it.
        let ends = [from.position, self.bodies.pose_of(id.slot).position];
        let around = Aabb::from_points(ends).grown(record.reach);
        for piece in record.first_piece..record.first_piece + record.pieces {
            let bounds = &mut self.pieces.boxes[piece as usize];
            *bounds = bounds.union(around);
            self.broad.enlarged(piece);
        }
        if record.kind != BodyKind::Dynamic {
            return Ok(());
        }
        let at = record.line as usize;
        let (line, base) = (&self.bodies.lines[at], &self.bodies.base[at]);
        let d = from.position - base.position;
        let turn = (from.rotation * base.rotation.inverse()).angle();
        let far = is_far(&self.bodies, at, line.d() - d, line.turn() - turn);
        self.ways.retain(|way| way.slot != id.slot);
        if far {
            self.ways.push(Way {
                slot: id.slot,
                from: (d, turn),
                unforeseen: true,
            });
        }
        Ok(())
    }

    /// Bodies that go far in a sub-step.
    pub fn swift(&self) -> impl Iterator<Item = BodyId> + '_ {
        let (bodies, h) = (&self.bodies, self.law.h);
        let far = (2..bodies.lines.len()).filter(move |at| {
            let line = &bodies.lines[*at];
            is_far(bodies, *at, line.v() * h, line.w() * h)
        });
        far.map(|at| bodies.id(bodies.slot_of[at]))
    }

    /// Stops whoever would pass through something on its way, which takes `left` seconds; those that it stopped.
    pub fn stop_ways(&mut self, left: f64, rules: &dyn PairRules) -> Vec<BodyId> {
        // Each way is gone once; whoever was taken out, fell asleep or was fixed meanwhile goes none.
        let mut noted = core::mem::take(&mut self.ways);
        noted.retain(|way| self.bodies.is_dynamic(way.slot) && self.bodies.line_of(way.slot) >= 2);
        if noted.is_empty() {
            return Vec::new();
        }
        noted.sort_unstable_by_key(|way| self.bodies.records[way.slot as usize].birth);
        let mut ways: Vec<_> = noted.iter().map(|way| self.going(way, left)).collect();
        let astray: Vec<usize> = (0..ways.len()).filter(|k| ways[*k].astray).collect();
        let mut meetings = BinaryHeap::new();
        for k in 0..ways.len() {
            self.meet(&ways, k, (0.0, left), &astray, rules, &mut meetings);
        }
        while let Some(meeting) = meetings.pop() {
            let ends = [Some(meeting.a), meeting.b];
            if ends.iter().flatten().any(|k| ways[*k].stopped) {
                continue;
            }
            for &k in ends.iter().flatten() {
                let way = &mut ways[k];
                way.stopped = true;
                let there = way.motion.rebased(way.motion.start + meeting.wait);
                way.motion = Motion {
                    start: SimTime::ZERO,
                    velocity: Vec2::ZERO,
                    spin: 0.0,
                    ..there
                };
            }
            // Who is still under way may meet one that has stopped.
            for &stopped in ends.iter().flatten() {
                self.meet_stopped(&ways, stopped, (meeting.wait, left), rules, &mut meetings);
            }
        }
        let mut stopped = Vec::new();
        for way in ways.iter().filter(|way| way.stopped) {
            self.stop_at(way);
            stopped.push(self.bodies.id(way.slot));
        }
        stopped
    }

    fn stop_at(&mut self, way: &Going) {
        let at = self.bodies.line_of(way.slot);
        let base = self.bodies.base[at];
        let turn = (way.motion.rotation * base.rotation.inverse()).angle();
        self.bodies.lines[at].set_displacement(way.motion.centre - base.position, turn);
        self.bodies.moved[at] = true;
    }

    /// How a body comes to where it is within `left` seconds: from a displacement, or at its velocity.
    fn motion(&self, slot: u32, from: Option<(Vec2, f64)>, left: f64) -> Motion {
        let at = self.bodies.line_of(slot);
        let pose = self.bodies.pose_of(slot);
        let (line, base) = (&self.bodies.lines[at], self.bodies.base_of(slot));
        if self.bodies.records[slot as usize].line == Bodies::NONE || at < 2 {
            return Motion {
                rotation: pose.rotation,
                ..Motion::resting(pose.position)
            };
        }
        let (way, turn) = match from {
            Some((d, turn)) => (line.d() - d, line.turn() - turn),
            None => (line.v() * left, line.w() * left),
        };
        Motion {
            velocity: way / left,
            rotation: base.rotation.turned(line.turn() - turn),
            spin: turn / left,
            ..Motion::resting(base.position + line.d() - way)
        }
    }

    fn going(&self, way: &Way, left: f64) -> Going {
        let record = &self.bodies.records[way.slot as usize];
        let motion = self.motion(way.slot, Some(way.from), left);
        let boxes = record.first_piece..record.first_piece + record.pieces;
        let boxes = boxes.map(|piece| self.pieces.boxes[piece as usize]);
        let known = boxes.fold(Aabb::EMPTY, Aabb::union);
        Going {
            slot: way.slot,
            birth: record.birth,
            motion,
            unforeseen: way.unforeseen,
            astray: !known.contains(bounds_of(&motion, 0.0, left)),
            stopped: false,
        }
    }

    /// Enters the first touches of way `k` with other bodies from `span.0` to `span.1` seconds on; `astray`: ways that are not
    /// in their boxes.
    fn meet(
        &self,
        ways: &[Going],
        k: usize,
        span: (f64, f64),
        astray: &[usize],
        rules: &dyn PairRules,
        meetings: &mut BinaryHeap<Meeting>,
    ) {
        let way = &ways[k];
        let mine = &self.bodies.records[way.slot as usize];
        let bounds = bounds_of(&way.motion, mine.reach, span.1);
        let mut others: Vec<u32> = Vec::new();
        let found = |piece: u32| others.push(piece);
        if way.unforeseen {
            self.broad
                .pieces_in(&self.bodies, &self.pieces, bounds, found);
        } else {
            self.broad.standing_in(bounds, found);
        }
        for &other in astray {
            let theirs = &ways[other];
            let record = &self.bodies.records[theirs.slot as usize];
            if bounds_of(&theirs.motion, record.reach, span.1).overlaps(bounds) {
                others.extend(record.first_piece..record.first_piece + record.pieces);
            }
        }
        self.first_parts(&mut others);
        for piece in others {
            let slot = self.pieces.list[piece as usize].body;
            let partner = way_of(ways, self.bodies.records[slot as usize].birth);
            // Two ways that both look for what moves are looked at once.
            let again = partner.is_some_and(|other| other < k && ways[other].unforeseen);
            if slot != way.slot && !again {
                self.meet_piece(ways, (k, partner), piece, span, rules, meetings);
            }
        }
    }

    /// The same of all ways that go on with one that stopped.
    fn meet_stopped(
        &self,
        ways: &[Going],
        stopped: usize,
        span: (f64, f64),
        rules: &dyn PairRules,
        meetings: &mut BinaryHeap<Meeting>,
    ) {
        let record = &self.bodies.records[ways[stopped].slot as usize];
        let bounds = bounds_of(&ways[stopped].motion, record.reach, span.1);
        for (k, way) in ways.iter().enumerate().filter(|(_, way)| !way.stopped) {
            let reach = self.bodies.records[way.slot as usize].reach;
            if bounds_of(&way.motion, reach, span.1).overlaps(bounds) {
                let mut pieces: Vec<u32> =
                    (record.first_piece..record.first_piece + record.pieces).collect();
                self.first_parts(&mut pieces);
                for piece in pieces {
                    self.meet_piece(ways, (k, Some(stopped)), piece, span, rules, meetings);
                }
            }
        }
    }

    /// A shape is looked at whole, from its first part on.
    fn first_parts(&self, pieces: &mut Vec<u32>) {
        for piece in &mut *pieces {
            let part = self.pieces.list[*piece as usize].part();
            #[expect(clippy::cast_possible_truncation, reason = "parts are pieces")]
            {
                *piece -= part as u32;
            }
        }
        pieces.sort_unstable();
        pieces.dedup();
    }

    /// Enters the first touch of way `k` with a piece of another body, which may have a way, too.
    fn meet_piece(
        &self,
        ways: &[Going],
        (k, partner): (usize, Option<usize>),
        piece: u32,
        span: (f64, f64),
        rules: &dyn PairRules,
        meetings: &mut BinaryHeap<Meeting>,
    ) {
        let way = &ways[k];
        let theirs = &self.pieces.list[piece as usize];
        let motion = match partner {
            Some(other) => ways[other].motion,
            None => self.motion(theirs.body, None, span.1),
        };
        // Rows hold those that go little against each other, however fast both are.
        let left = span.1 - span.0;
        let (at, other) = (
            self.bodies.line_of(way.slot),
            self.bodies.line_of(theirs.body),
        );
        let against = (way.motion.velocity - motion.velocity) * left;
        let turns = (way.motion.spin * left, motion.spin * left);
        if !is_far(&self.bodies, at, against, turns.0)
            && !is_far(&self.bodies, other, Vec2::ZERO, turns.1)
        {
            return;
        }
        if let Some(wait) = self.first_touch(way, (piece, &motion), span, rules) {
            let birth = self.bodies.records[theirs.body as usize].birth;
            meetings.push(Meeting {
                wait,
                order: (way.birth, birth << 16 | u64::from(theirs.ordinal)),
                a: k,
                b: partner.filter(|other| !ways[*other].stopped),
            });
        }
    }

    /// When a body first touches the shape of a piece, in s, if its core meets it.
    fn first_touch(
        &self,
        way: &Going,
        (piece, motion): (u32, &Motion),
        (from, to): (f64, f64),
        rules: &dyn PairRules,
    ) -> Option<f64> {
        let mine = &self.bodies.records[way.slot as usize];
        let start = SimTime::ZERO + from;
        let (own, other) = (way.motion.rebased(start), motion.rebased(start));
        let target = self.pieces.list[piece as usize].shape();
        let mut first: Option<f64> = None;
        for number in mine.first_piece..mine.first_piece + mine.pieces {
            let piece_of_mine = &self.pieces.list[number as usize];
            if piece_of_mine.part() != 0
                || self.is_held([number, piece], way.slot)
                || self.pieces.surface([number, piece], rules).is_none()
            {
                continue;
            }
            for (core, whole) in cores(piece_of_mine) {
                let left = first.unwrap_or(to) - from;
                let wait = match time_of_impact(&core, &own, target, &other, left) {
                    TimeOfImpact::Hit(hit) => hit.time,
                    TimeOfImpact::Unresolved { safe_until } => safe_until,
                    // In touch from the start: its rows hold it.
                    TimeOfImpact::Clear | TimeOfImpact::Touching(_) => continue,
                };
                let wait = match time_of_impact(&whole, &own, target, &other, wait) {
                    TimeOfImpact::Hit(hit) => {
                        (hit.time + SHORT * mine.reach / hit.gap_rate).max(0.0)
                    }
                    _ => wait,
                };
                first = Some(from + wait);
            }
        }
        first
    }

    /// Whether a row of two pieces is there that a body on its way cannot turn out of.
    fn is_held(&self, pair: [u32; 2], slot: u32) -> bool {
        let at = self.bodies.line_of(slot);
        let turn = self.bodies.lines[at].w() * self.law.h;
        // One sweep may leave much of a blow: what stands is sought whether there is a row or not.
        let stands = self.bodies.records[self.pieces.list[pair[1] as usize].body as usize].line
            == Bodies::GROUND;
        !stands && self.known.contains(pair) && !is_far(&self.bodies, at, Vec2::ZERO, turn)
    }
}

/// The way of the body of a birth.
fn way_of(ways: &[Going], birth: u64) -> Option<usize> {
    ways.binary_search_by_key(&birth, |way| way.birth).ok()
}

/// The box that a body stays in for so long.
fn bounds_of(motion: &Motion, reach: f64, left: f64) -> Aabb {
    let ends = [motion.centre, motion.centre + motion.velocity * left];
    Aabb::from_points(ends).grown(reach)
}

/// Whether a body goes so far, or turns so much, that it may pass through something.
fn is_far(bodies: &Bodies, at: usize, way: Vec2, turn: f64) -> bool {
    let limit = &bodies.limits[at];
    let least = PART * 0.5 * limit.extent;
    way.length_squared() > least * least || turn.abs() * limit.reach > least
}
