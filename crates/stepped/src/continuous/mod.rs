//! Continuous collision: a fast body does not pass through another one within a sub-step.
//!
//! A body is fast if it moves farther than a part of its width. Its motion is straight, from its pose before the sub-step to
//! the one after it, and its core polygon must be free along all of it: contacts that slide, roll or are held off by a row lie
//! outside of the core. Where the core would touch another shape, the body is stopped short of the touch of its surface, and
//! keeps its velocity; a contact row takes over in the next sub-step.

mod cores;
mod touching;

use std::collections::BinaryHeap;

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_geometry::Aabb;
use carom_math::{Pose, SimTime, Vec2};

use crate::bodies::Bodies;
use crate::rows::Quad;
use crate::{BodyId, BodyKind, Engine, EngineError, PairRules, Settings};
use cores::cores;
use touching::Touching;

/// A body stops so far before a touch, as a part of its reach: its contact is found open.
const SHORT: f64 = 1e-7;

/// The motion of a fast body through the rest of a sub-step.
#[derive(Clone, Debug)]
pub(crate) struct FastBody {
    slot: u32,
    /// Displacement and turn at its start, since the base pose.
    from: (Vec2, f64),
    /// Rows do not know of it: touches with moving bodies are searched for, too.
    unforeseen: bool,
}

/// The same during the search.
struct Moving {
    slot: u32,
    birth: u64,
    motion: Motion,
    unforeseen: bool,
    /// It leaves the swept boxes of the tick.
    astray: bool,
    stopped: bool,
}

/// Notes the bodies that a displacement moved far, and where from. Rows do not hold moving bodies off a body that turns far, or
/// that an impact sent elsewhere than was foreseen when its rows were found.
pub(crate) fn note_fast(
    bodies: &Bodies,
    settings: &Settings,
    h: f64,
    far: &[(u32, Quad)],
    fast: &mut Vec<FastBody>,
) {
    fast.clear();
    for (at, from) in far {
        let at = *at as usize;
        let (line, limit) = (&bodies.lines[at], &bodies.limits[at]);
        if line.inverse_mass() > 0.0 {
            let turns = limit.is_far(0.0, line.w() * h);
            let strays = bodies.change(at, settings.tick) * h > settings.margin * limit.extent;
            fast.push(FastBody {
                slot: bodies.slot_of[at],
                from: (from.v(), from.w()),
                unforeseen: turns || strays,
            });
        }
    }
}

impl Engine {
    /// Notes that a body, if it is fast, moves from this pose to its present one, as a caller moved it: see [`Self::stop_fast`].
    ///
    /// # Errors
    /// [`EngineError::Stale`] if the body is not in this engine.
    pub fn carry(&mut self, id: BodyId, from: Pose) -> Result<(), EngineError> {
        let record = *self.bodies.get(id)?;
        if record.kind == BodyKind::Fixed || record.line == Bodies::NONE {
            return Ok(());
        }
        // Queries find it along all of its motion.
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
        let square = (line.d() - d).length_squared();
        let far = self.bodies.limits[at].is_far(square, line.turn() - turn);
        self.fast_bodies.retain(|body| body.slot != id.slot);
        if far {
            self.fast_bodies.push(FastBody {
                slot: id.slot,
                from: (d, turn),
                unforeseen: true,
            });
        }
        Ok(())
    }

    /// Fast bodies.
    pub fn fast(&self) -> impl Iterator<Item = BodyId> + '_ {
        let (bodies, h) = (&self.bodies, self.law.h);
        let far = (2..bodies.lines.len()).filter(move |at| {
            let line = &bodies.lines[*at];
            bodies.limits[*at].is_far((line.v() * h).length_squared(), line.w() * h)
        });
        far.map(|at| bodies.id(bodies.slot_of[at]))
    }

    /// Stops fast bodies that would pass through others within the `left` seconds of their motions; which ones it stopped.
    pub fn stop_fast(&mut self, left: f64, rules: &dyn PairRules) -> Vec<BodyId> {
        // Each motion is searched once; a body may have been removed, fixed or put to sleep since it was noted.
        let mut noted = core::mem::take(&mut self.fast_bodies);
        noted.retain(|body| {
            self.bodies.is_dynamic(body.slot) && self.bodies.line_of(body.slot) >= 2
        });
        if noted.is_empty() {
            return Vec::new();
        }
        noted.sort_unstable_by_key(|body| self.bodies.records[body.slot as usize].birth);
        let mut fast: Vec<_> = noted.iter().map(|body| self.moving(body, left)).collect();
        let astray: Vec<usize> = (0..fast.len()).filter(|k| fast[*k].astray).collect();
        let mut touches = BinaryHeap::new();
        for k in 0..fast.len() {
            self.search(&fast, k, (0.0, left), &astray, rules, &mut touches);
        }
        while let Some(touch) = touches.pop() {
            let ends = [Some(touch.a), touch.b];
            if ends.iter().flatten().any(|k| fast[*k].stopped) {
                continue;
            }
            for &k in ends.iter().flatten() {
                let body = &mut fast[k];
                body.stopped = true;
                let there = body.motion.rebased(body.motion.start + touch.wait);
                body.motion = Motion {
                    start: SimTime::ZERO,
                    velocity: Vec2::ZERO,
                    spin: 0.0,
                    ..there
                };
            }
            // A body that still moves may meet one that has stopped.
            for &stopped in ends.iter().flatten() {
                self.search_stopped(&fast, stopped, (touch.wait, left), rules, &mut touches);
            }
        }
        let mut stopped = Vec::new();
        for body in fast.iter().filter(|body| body.stopped) {
            self.stop_at(body);
            stopped.push(self.bodies.id(body.slot));
        }
        stopped
    }

    fn stop_at(&mut self, body: &Moving) {
        let at = self.bodies.line_of(body.slot);
        let base = self.bodies.base[at];
        let turn = (body.motion.rotation * base.rotation.inverse()).angle();
        self.bodies.lines[at].set_displacement(body.motion.centre - base.position, turn);
        (self.bodies.moved[at], self.bodies.may_stray) = (true, true);
    }

    /// The motion that brings a body to its pose within `left` seconds: from a displacement, or at its velocity.
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
        let (displacement, turn) = match from {
            Some((d, turn)) => (line.d() - d, line.turn() - turn),
            None => (line.v() * left, line.w() * left),
        };
        Motion {
            velocity: displacement / left,
            rotation: base.rotation.turned(line.turn() - turn),
            spin: turn / left,
            ..Motion::resting(base.position + line.d() - displacement)
        }
    }

    fn moving(&self, body: &FastBody, left: f64) -> Moving {
        let record = &self.bodies.records[body.slot as usize];
        let motion = self.motion(body.slot, Some(body.from), left);
        let boxes = record.first_piece..record.first_piece + record.pieces;
        let boxes = boxes.map(|piece| self.pieces.boxes[piece as usize]);
        let known = boxes.fold(Aabb::EMPTY, Aabb::union);
        Moving {
            slot: body.slot,
            birth: record.birth,
            motion,
            unforeseen: body.unforeseen,
            astray: !known.contains(bounds_of(&motion, 0.0, left)),
            stopped: false,
        }
    }

    /// Enters the first touches of fast body `k` with others from `span.0` to `span.1` seconds on; `astray`: fast bodies that
    /// leave their boxes.
    fn search(
        &self,
        fast: &[Moving],
        k: usize,
        span: (f64, f64),
        astray: &[usize],
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let body = &fast[k];
        let mine = &self.bodies.records[body.slot as usize];
        let bounds = bounds_of(&body.motion, mine.reach, span.1);
        let mut others: Vec<u32> = Vec::new();
        let found = |piece: u32| others.push(piece);
        if body.unforeseen {
            self.broad
                .pieces_in(&self.bodies, &self.pieces, bounds, found);
        } else {
            self.broad.standing_in(bounds, found);
        }
        for &other in astray {
            let theirs = &fast[other];
            let record = &self.bodies.records[theirs.slot as usize];
            if bounds_of(&theirs.motion, record.reach, span.1).overlaps(bounds) {
                others.extend(record.first_piece..record.first_piece + record.pieces);
            }
        }
        self.first_parts(&mut others);
        for piece in others {
            let slot = self.pieces.list[piece as usize].body;
            let partner = fast_of(fast, self.bodies.records[slot as usize].birth);
            // A pair of which both search among moving bodies is searched once.
            let again = partner.is_some_and(|other| other < k && fast[other].unforeseen);
            if slot != body.slot && !again {
                self.search_piece(fast, (k, partner), piece, span, rules, touches);
            }
        }
    }

    /// The same of all fast bodies that still move with one that has stopped.
    fn search_stopped(
        &self,
        fast: &[Moving],
        stopped: usize,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let record = &self.bodies.records[fast[stopped].slot as usize];
        let bounds = bounds_of(&fast[stopped].motion, record.reach, span.1);
        for (k, body) in fast.iter().enumerate().filter(|(_, body)| !body.stopped) {
            let reach = self.bodies.records[body.slot as usize].reach;
            if bounds_of(&body.motion, reach, span.1).overlaps(bounds) {
                let mut pieces: Vec<u32> =
                    (record.first_piece..record.first_piece + record.pieces).collect();
                self.first_parts(&mut pieces);
                for piece in pieces {
                    self.search_piece(fast, (k, Some(stopped)), piece, span, rules, touches);
                }
            }
        }
    }

    /// A shape is searched whole, from its first part on.
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

    /// Enters the first touch of fast body `k` with a piece of another one, fast or not.
    fn search_piece(
        &self,
        fast: &[Moving],
        (k, partner): (usize, Option<usize>),
        piece: u32,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let body = &fast[k];
        let theirs = &self.pieces.list[piece as usize];
        let motion = match partner {
            Some(other) => fast[other].motion,
            None => self.motion(theirs.body, None, span.1),
        };
        // Rows hold bodies that move little against each other, however fast both are.
        let left = span.1 - span.0;
        let [limit, other] =
            [body.slot, theirs.body].map(|slot| &self.bodies.limits[self.bodies.line_of(slot)]);
        let against = (body.motion.velocity - motion.velocity) * left;
        let turns = (body.motion.spin * left, motion.spin * left);
        if !limit.is_far(against.length_squared(), turns.0) && !other.is_far(0.0, turns.1) {
            return;
        }
        if let Some(wait) = self.first_touch(body, (piece, &motion), span, rules) {
            let birth = self.bodies.records[theirs.body as usize].birth;
            touches.push(Touching {
                wait,
                order: (body.birth, birth << 16 | u64::from(theirs.ordinal)),
                a: k,
                b: partner.filter(|other| !fast[*other].stopped),
            });
        }
    }

    /// When a body first touches the shape of a piece, in s, if its core meets it.
    fn first_touch(
        &self,
        body: &Moving,
        (piece, motion): (u32, &Motion),
        (from, to): (f64, f64),
        rules: &dyn PairRules,
    ) -> Option<f64> {
        let mine = &self.bodies.records[body.slot as usize];
        let start = SimTime::ZERO + from;
        let (own, other) = (body.motion.rebased(start), motion.rebased(start));
        let target = self.pieces.list[piece as usize].shape();
        let mut first: Option<f64> = None;
        for number in mine.first_piece..mine.first_piece + mine.pieces {
            let piece_of_mine = &self.pieces.list[number as usize];
            if piece_of_mine.part() != 0
                || self.is_held([number, piece], body.slot)
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
        !stands && self.known.contains(pair) && !self.bodies.limits[at].is_far(0.0, turn)
    }
}

/// The fast body of a birth.
fn fast_of(fast: &[Moving], birth: u64) -> Option<usize> {
    fast.binary_search_by_key(&birth, |body| body.birth).ok()
}

/// The box that a body stays in for so long.
fn bounds_of(motion: &Motion, reach: f64, left: f64) -> Aabb {
    let ends = [motion.centre, motion.centre + motion.velocity * left];
    Aabb::from_points(ends).grown(reach)
}
