//! Continuous collision: a fast body does not pass through another one within a sub-step.
//!
//! A body is fast if it moves farther than a part of its width. Its motion is straight, from its pose before the sub-step to
//! the one after it, and its core polygon must be free along all of it: contacts that slide, roll or are held off by a row lie
//! outside of the core. Where the core would touch another shape, the body is stopped short of the touch of its surface, and
//! keeps its velocity; a contact row takes over in the next sub-step. If there is a row that did not hold it, the body goes on
//! without what closes of its motion: no row takes the velocity along a wall, and what falls along it would hang there. What is stopped
//! where it stands in two sub-steps on end is held by no row, as in a notch that a peg has come into: it loses that velocity.

mod cores;
mod search;
mod touching;

use std::collections::BinaryHeap;

use carom_collision::Motion;
use carom_geometry::Aabb;
use carom_math::{Pose, SimTime, Vec2};

use crate::bodies::{Bodies, Limit};
use crate::rows::{Quad, turn_shifted};
use crate::{BodyId, BodyKind, Engine, EngineError, PairRules, Settings};
use touching::Touching;

/// A body stops so far before a touch, as a part of its reach: its contact is found open.
const SHORT: f64 = 1e-7;

/// A body that goes no farther than this part of its way hangs.
const HANGS: f64 = 0.125;

/// A body that touches so often within a sub-step is stopped there.
const MOST: u8 = 3;

/// The motion of a fast body through the rest of a sub-step.
#[derive(Clone, Debug)]
pub(crate) struct FastBody {
    slot: u32,
    /// Displacement and turn at its start, since the base pose.
    from: (Vec2, f64),
    /// Rows do not hold moving bodies off what turns so far.
    turns: bool,
    /// It goes otherwise than was foreseen when its rows were found.
    deviates: bool,
    /// A caller moves it: no rows were solved for, and what it touches does not hold it.
    carried: bool,
}

impl FastBody {
    /// Rows do not know of it: touches with moving bodies are searched for, too.
    const fn is_unforeseen(&self) -> bool {
        self.turns || self.deviates
    }
}

/// The same during the search.
#[derive(Clone, Copy)]
struct Moving {
    slot: u32,
    birth: u64,
    motion: Motion,
    carried: bool,
    /// How often it touched so far, and the slot of the body that it touched first.
    touches: u8,
    touched: Option<u32>,
}

impl Moving {
    const fn is_stopped(&self) -> bool {
        self.touches >= MOST
    }

    /// It goes on `wait` seconds on, without this part of its velocity, and without turning; stopped if it has none or touches
    /// too often.
    fn deflect(&mut self, wait: f64, part: Option<Vec2>) {
        self.touches = part.map_or(MOST, |_| self.touches + 1);
        let there = self.motion.rebased(self.motion.start + wait);
        let part = part.filter(|_| !self.is_stopped());
        let velocity = part.map_or(Vec2::ZERO, |part| there.velocity - part);
        self.motion = Motion {
            start: SimTime::ZERO,
            centre: there.centre - velocity * wait,
            velocity,
            spin: 0.0,
            ..there
        };
    }
}

/// All of them. Most meet nothing: motions are made where one is asked for.
struct Fast {
    /// By slot, in order.
    noted: Vec<FastBody>,
    moving: Vec<Option<Moving>>,
    /// Which of them are searched from.
    searched: Vec<bool>,
    /// Those that may be where no box of the tick is: they leave theirs, deviate, or touched something.
    unboxed: Vec<usize>,
    /// Seconds that the motions last.
    left: f64,
}

impl Fast {
    fn of(&mut self, engine: &Engine, k: usize) -> &mut Moving {
        self.moving[k].get_or_insert_with(|| engine.moving(&self.noted[k], self.left))
    }

    fn find(&self, slot: u32) -> Option<usize> {
        self.noted
            .binary_search_by_key(&slot, |body| body.slot)
            .ok()
    }

    fn is_stopped(&self, k: usize) -> bool {
        self.moving[k].as_ref().is_some_and(Moving::is_stopped)
    }

    /// How often it touched so far.
    fn touches(&self, k: usize) -> u8 {
        self.moving[k].as_ref().map_or(0, |body| body.touches)
    }

    /// The box that it stays in for so long.
    fn bounds(&self, engine: &Engine, k: usize, time: f64) -> Aabb {
        let body = &self.noted[k];
        let (from, velocity) = self.moving[k].as_ref().map_or_else(
            || engine.way(body, self.left),
            |body| (body.motion.centre, body.motion.velocity),
        );
        way_box(from, velocity, time).grown(engine.bodies.records[body.slot as usize].reach)
    }
}

/// Notes the bodies that a displacement moved far, and where from.
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
            fast.push(FastBody {
                slot: bodies.slot_of[at],
                from: (from.v(), from.w()),
                turns: limit.is_far(0.0, line.w() * h),
                deviates: bodies.change(at, settings.tick) * h > settings.margin * limit.extent,
                carried: false,
            });
        }
    }
}

impl Engine {
    /// Notes that a body, if it goes far for its width, moves from this pose to its present one, as a caller moved it: see
    /// [`Self::stop_fast`].
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
        for piece in record.pieces() {
            let bounds = &mut self.pieces.boxes[piece as usize];
            *bounds = bounds.union(around);
            self.broad.enter(piece);
        }
        if record.kind != BodyKind::Dynamic {
            return Ok(());
        }
        let at = record.line as usize;
        let (line, base) = (&self.bodies.lines[at], &self.bodies.base[at]);
        let d = from.position - base.position;
        let turn = (from.rotation * base.rotation.inverse()).angle();
        let square = (line.d() - d).length_squared();
        self.fast_bodies.retain(|body| body.slot != id.slot);
        // No rows hold it: what is thin is fast where it goes by less than an extent allows.
        let pieces = record.pieces();
        let widths = pieces.map(|piece| self.pieces.list[piece as usize].width());
        let limit = Limit {
            extent: widths.fold(f64::INFINITY, f64::min),
            ..self.bodies.limits[at]
        };
        if limit.is_far(square, line.turn() - turn) {
            self.fast_bodies.push(FastBody {
                slot: id.slot,
                from: (d, turn),
                turns: false,
                deviates: true,
                carried: true,
            });
        }
        Ok(())
    }

    /// Fast bodies.
    pub fn fast(&self) -> impl Iterator<Item = BodyId> + '_ {
        let bodies = &self.bodies;
        bodies.fast(self.law.h).map(|slot| bodies.id(slot))
    }

    /// Calls `found` with the tag of each fast body that [`Self::stop_fast`] may search for beyond the box of the tick, and where.
    pub fn fast_boxes(&self, left: f64, mut found: impl FnMut(u64, Aabb)) {
        let noted = self.fast_bodies.iter();
        let noted = noted.filter(|body| self.is_searched(body));
        let ways: Vec<_> = noted
            .map(|body| (body.slot, self.way(body, left)))
            .collect();
        // What one of them passes on to another one takes that elsewhere, no faster.
        let passed = if ways.len() > 1 {
            let speeds = ways.iter().map(|(_, (_, velocity))| velocity.length());
            speeds.fold(0.0, f64::max) * left
        } else {
            0.0
        };
        for (slot, (from, velocity)) in ways {
            let record = &self.bodies.records[slot as usize];
            found(
                record.tag,
                way_box(from, velocity, left).grown(record.reach + passed),
            );
        }
    }

    /// A body may have been removed, fixed or put to sleep since it was noted.
    fn is_searched(&self, body: &FastBody) -> bool {
        self.bodies.is_dynamic(body.slot) && self.bodies.line_of(body.slot) >= 2
    }

    /// Stops fast bodies that would pass through others within the `left` seconds of their motions; which ones it stopped.
    pub fn stop_fast(&mut self, left: f64, rules: &dyn PairRules) -> Vec<BodyId> {
        let is_whole = left >= self.law.h;
        let hung = if is_whole {
            core::mem::take(&mut self.hanging)
        } else {
            Vec::new()
        };
        // Each motion is searched once.
        let mut noted = core::mem::take(&mut self.fast_bodies);
        noted.retain(|body| self.is_searched(body));
        noted.sort_unstable_by_key(|body| body.slot);
        let leaves: Vec<bool> = (noted.iter())
            .map(|body| self.leaves_boxes(body, left))
            .collect();
        let may_touch = |(body, leaves): (&FastBody, &bool)| *leaves || self.may_touch(body);
        let may_touch: Vec<bool> = noted.iter().zip(&leaves).map(may_touch).collect();
        if !may_touch.contains(&true) {
            return Vec::new();
        }
        let leaving: Vec<usize> = (0..noted.len()).filter(|k| leaves[*k]).collect();
        let is_unboxed = |k: &usize| leaves[*k] || noted[*k].is_unforeseen();
        let mut fast = Fast {
            moving: vec![None; noted.len()],
            searched: may_touch,
            unboxed: (0..noted.len()).filter(is_unboxed).collect(),
            noted,
            left,
        };
        let mut touches = BinaryHeap::new();
        for &k in &leaving {
            self.note_beside(&mut fast, k);
        }
        for k in 0..fast.noted.len() {
            if fast.searched[k] {
                self.search(&mut fast, k, (0.0, left), &leaving, rules, &mut touches);
            }
        }
        while let Some(touch) = touches.pop() {
            let ends = [Some(touch.a), touch.b];
            let stale =
                |(k, touches): (&Option<usize>, u8)| k.is_some_and(|k| fast.touches(k) != touches);
            if ends.iter().zip(touch.touches).any(stale) {
                continue;
            }
            self.deflect(&mut fast, &touch);
            for &k in ends.iter().flatten() {
                let rest = (touch.wait, left);
                if !fast.is_stopped(k) {
                    self.search_on(&mut fast, k, rest, rules, &mut touches);
                }
                // A body that still moves may meet one that goes elsewhere.
                self.search_changed(&mut fast, k, rest, rules, &mut touches);
            }
        }
        let mut stopped = Vec::new();
        let mut shifted = Vec::new();
        let mut hanging = Vec::new();
        let mut touched: Vec<Moving> = fast.moving.into_iter().flatten().collect();
        touched.retain(|body| body.touches > 0);
        touched.sort_unstable_by_key(|body| body.birth);
        for body in &touched {
            let shift = self.stop_at(body, left);
            shifted.extend(self.free_pair(body).map(|pair| (pair, shift)));
            let from = fast
                .noted
                .binary_search_by_key(&body.slot, |noted| noted.slot);
            let from = from.map_or(Vec2::ZERO, |k| fast.noted[k].from.0);
            hanging.extend(self.hangs(body, from, shift, &hung));
            stopped.push(self.bodies.id(body.slot));
        }
        turn_shifted(&mut self.bodies, &shifted);
        if is_whole {
            self.hanging = hanging;
        }
        stopped
    }

    /// A body and what stands that it hangs on, if it was stopped where it stands, by `shift`; if it `hung` there before it loses what its
    /// motion lost.
    fn hangs(
        &mut self,
        body: &Moving,
        from: Vec2,
        shift: Vec2,
        hung: &[[u32; 2]],
    ) -> Option<[u32; 2]> {
        let pair = [body.slot, body.touched?];
        let line = self.bodies.records[body.slot as usize].line;
        let at = line as usize;
        let went = (self.bodies.lines[at].d() - from).length();
        if self.bodies.is_dynamic(pair[1]) || went > HANGS * (went + shift.length()) {
            return None;
        }
        if hung.contains(&pair) {
            let (known, motion) = (&self.bodies.lines[at], &body.motion);
            if motion.velocity.length_squared() <= known.v().length_squared() {
                let lost = Quad::new(motion.velocity - known.v(), -known.w());
                self.bodies.lines[at].add(&lost);
                self.bodies.start[at].add(&lost);
                self.bodies.note_change(line);
            }
        }
        Some(pair)
    }

    /// Lines of a body and of the one that it touched first, if both are free.
    fn free_pair(&self, body: &Moving) -> Option<[u32; 2]> {
        let lines = [Some(body.slot), body.touched].map(|slot| {
            let line = self.bodies.records[slot? as usize].line;
            (line != Bodies::NONE && self.bodies.is_free(line)).then_some(line)
        });
        Some([lines[0]?, lines[1]?])
    }

    /// Both bodies go on without what closes of their motions, which they share as an impact without restitution does.
    fn deflect(&self, fast: &mut Fast, touch: &Touching) {
        let inverse_mass = |k: usize| {
            let line = self.bodies.line_of(fast.noted[k].slot);
            self.bodies.lines[line].inverse_mass()
        };
        let of_a = touch.b.map_or(1.0, |b| {
            let (a, b) = (inverse_mass(touch.a), inverse_mass(b));
            a / (a + b)
        });
        let closing = touch.normal.map(|n| n * touch.against.dot(n).max(0.0));
        fast.unboxed
            .extend([Some(touch.a), touch.b].iter().flatten());
        let a = fast.of(self, touch.a);
        let slot = a.slot;
        a.touched.get_or_insert(touch.other);
        a.deflect(touch.wait, closing.map(|part| part * of_a));
        if let Some(b) = touch.b {
            let b = fast.of(self, b);
            b.touched.get_or_insert(slot);
            b.deflect(touch.wait, closing.map(|part| part * (of_a - 1.0)));
        }
    }

    /// Puts a body where its motion ends; by how much that is off where it was, in m.
    fn stop_at(&mut self, body: &Moving, left: f64) -> Vec2 {
        let at = self.bodies.line_of(body.slot);
        let base = self.bodies.base[at];
        let turn = (body.motion.rotation * base.rotation.inverse()).angle();
        let centre = body.motion.centre + body.motion.velocity * left;
        let line = &mut self.bodies.lines[at];
        let shift = centre - base.position - line.d();
        line.set_displacement(centre - base.position, turn);
        self.bodies.moved[at] = true;
        self.bodies
            .deviating
            .push(self.bodies.records[body.slot as usize].line);
        shift
    }

    /// The motion that brings a body to its pose within `left` seconds: from a displacement, or at its velocity.
    fn motion(&self, slot: u32, from: Option<(Vec2, f64)>, left: f64) -> Motion {
        let at = self.bodies.line_of(slot);
        if self.bodies.records[slot as usize].line == Bodies::NONE || at < 2 {
            let pose = self.bodies.pose_of(slot);
            return Motion {
                rotation: pose.rotation,
                ..Motion::resting(pose.position)
            };
        }
        let (line, base) = (&self.bodies.lines[at], self.bodies.base_of(slot));
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
        Moving {
            slot: body.slot,
            birth: record.birth,
            motion,
            carried: body.carried,
            touches: 0,
            touched: None,
        }
    }

    /// Whether a fast body leaves the swept boxes of the tick.
    fn leaves_boxes(&self, body: &FastBody, left: f64) -> bool {
        let record = &self.bodies.records[body.slot as usize];
        let boxes = record.pieces();
        let boxes = boxes.map(|piece| self.pieces.boxes[piece as usize]);
        let (from, velocity) = self.way(body, left);
        let way = way_box(from, velocity, left);
        !boxes.fold(Aabb::EMPTY, Aabb::union).contains(way)
    }

    /// Whether a search for the touches of a fast body that stays in its boxes may find something.
    fn may_touch(&self, body: &FastBody) -> bool {
        let record = &self.bodies.records[body.slot as usize];
        let mut pieces = record.pieces();
        let beside = |piece: u32| {
            self.broad.is_by_standing(piece) || body.turns && self.broad.is_by_moving(piece)
        };
        body.deviates || pieces.any(beside)
    }

    /// Fast bodies beside one that leaves its boxes may touch it.
    fn note_beside(&self, fast: &mut Fast, leaving: usize) {
        let bounds = fast.bounds(self, leaving, fast.left);
        self.broad.movers_in(&self.pieces, bounds, |piece| {
            if let Some(beside) = fast.find(self.pieces.list[piece as usize].body) {
                fast.searched[beside] = true;
            }
        });
    }

    /// Where a fast body came from `left` seconds before, and its velocity.
    fn way(&self, body: &FastBody, left: f64) -> (Vec2, Vec2) {
        let at = self.bodies.line_of(body.slot);
        let d = self.bodies.lines[at].d();
        let went = d - body.from.0;
        (self.bodies.base[at].position + d - went, went / left)
    }
}

/// The box around a straight way.
fn way_box(from: Vec2, velocity: Vec2, left: f64) -> Aabb {
    Aabb::from_points([from, from + velocity * left])
}
