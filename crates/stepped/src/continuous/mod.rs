//! Continuous collision: a fast body does not pass through another one within a sub-step.
//!
//! A body is fast if it moves farther than a part of its width. Its motion is straight, from its pose before the sub-step to
//! the one after it, and its core polygon must be free along all of it: contacts that slide, roll or are held off by a row lie
//! outside of the core. Where the core would touch another shape, the body is stopped short of the touch of its surface, and
//! keeps its velocity; a contact row takes over in the next sub-step. For the rest of this one it goes as the other body goes, and
//! two that are both fast, or free, as their centre of mass. If there is a row that did not hold it, the body goes on without what
//! closes of its motion: no row takes the velocity along a wall, and what falls along it would hang there. What is stopped where it
//! stands in two sub-steps on end is held by no row, as in a notch that a peg has come into: it loses that velocity.

mod cores;
mod moving;
mod search;
mod touching;

use std::collections::BinaryHeap;

use carom_collision::Motion;
use carom_geometry::Aabb;
use carom_math::{Pose, Vec2};

use crate::bodies::{Bodies, Limit};
use crate::rows::{Quad, turn_shifted};
use crate::{BodyId, BodyIx, BodyKind, Engine, EngineError, LineIx, PairRules, Settings};
use moving::{Fast, Moving};
use touching::Touching;

/// A body stops so far before a touch, as a part of its reach: its contact is found open.
const SHORT: f64 = 1e-7;

/// A body that goes no farther than this part of its way hangs.
const HANGS: f64 = 0.125;

/// The motion of a fast body through the rest of a sub-step.
#[derive(Clone, Debug)]
pub(crate) struct FastBody {
    slot: BodyIx,
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

/// Notes the bodies that a displacement moved far, and where from.
pub(crate) fn note_fast(
    bodies: &Bodies,
    settings: &Settings,
    h: f64,
    far: &[(LineIx, Quad)],
    fast: &mut Vec<FastBody>,
) {
    fast.clear();
    for &(at, ref from) in far {
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
        if record.kind == BodyKind::Fixed || record.line == LineIx::NONE {
            return Ok(());
        }
        // Queries find it along all of its motion.
        let ends = [from.position, self.bodies.pose_of(id.slot).position];
        let around = Aabb::from_points(ends).grown(record.reach);
        for piece in record.pieces() {
            let bounds = &mut self.pieces.boxes[piece];
            *bounds = bounds.union(around);
            self.broad.enter(piece);
        }
        if record.kind != BodyKind::Dynamic {
            return Ok(());
        }
        let at = record.line;
        let (line, base) = (&self.bodies.lines[at], &self.bodies.base[at]);
        let d = from.position - base.position;
        let turn = (from.rotation * base.rotation.inverse()).angle();
        let square = (line.d() - d).length_squared();
        self.fast_bodies.retain(|body| body.slot != id.slot);
        // No rows hold it: what is thin is fast where it goes by less than an extent allows.
        let pieces = record.pieces();
        let widths = pieces.map(|piece| self.pieces.list[piece].width());
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
            let record = &self.bodies.records[slot];
            found(
                record.tag,
                way_box(from, velocity, left).grown(record.reach + passed),
            );
        }
    }

    /// A body may have been removed, fixed or put to sleep since it was noted.
    fn is_searched(&self, body: &FastBody) -> bool {
        self.bodies.is_dynamic(body.slot) && self.bodies.line_of(body.slot) > LineIx::GROUND
    }

    /// Fast bodies before their search.
    fn fast_of(&self, mut noted: Vec<FastBody>, left: f64) -> Fast {
        noted.retain(|body| self.is_searched(body));
        noted.sort_unstable_by_key(|body| body.slot);
        let mut fast = Fast {
            moving: vec![None; noted.len()],
            in_order: noted.len(),
            left,
            ..Fast::default()
        };
        for (k, body) in noted.iter().enumerate() {
            let leaves = self.leaves_boxes(body);
            fast.sought.push(self.sought(body, leaves));
            fast.leaving.extend(leaves.then_some(k));
            let is_unboxed = leaves || body.is_unforeseen();
            fast.unboxed.extend(is_unboxed.then_some(k));
        }
        Fast { noted, ..fast }
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
        let noted = core::mem::take(&mut self.fast_bodies);
        if noted.is_empty() {
            return Vec::new();
        }
        let mut fast = self.fast_of(noted, left);
        let mut touches = BinaryHeap::new();
        for k in 0..fast.noted.len() {
            self.search(&mut fast, k, (0.0, left), rules, &mut touches);
        }
        while let Some(mut touch) = touches.pop() {
            let ends = [Some(touch.a), fast.find(touch.other)];
            let stale =
                |(k, touches): (&Option<usize>, u8)| k.is_some_and(|k| fast.touches(k) != touches);
            if ends.iter().zip(touch.touches).any(stale) {
                continue;
            }
            self.share(&mut fast, &mut touch);
            self.deflect(&mut fast, &touch);
            let ends = [Some(touch.a), touch.b];
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
        let mut hanging = Vec::new();
        let touched = fast.moving.iter().zip(&fast.noted);
        let touched = touched.filter_map(|(body, noted)| Some((body.as_ref()?, noted.from.0)));
        let mut touched: Vec<_> = touched.filter(|(body, _)| body.touches > 0).collect();
        touched.sort_unstable_by_key(|(body, _)| body.birth);
        for (body, from) in touched {
            let shift = self.stop_at(body, left);
            hanging.extend(self.hangs(body, from, shift, &hung));
            stopped.push(self.bodies.id(body.slot));
        }
        let added = turn_shifted(&mut self.bodies, &fast.shifted);
        self.ways.shift(&self.bodies, &added, &fast.shifted);
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
        hung: &[[BodyIx; 2]],
    ) -> Option<[BodyIx; 2]> {
        let pair = [body.slot, body.touched?];
        let line = self.bodies.records[body.slot].line;
        let went = (self.bodies.lines[line].d() - from).length();
        if self.bodies.is_dynamic(pair[1]) || went > HANGS * (went + shift.length()) {
            return None;
        }
        if hung.contains(&pair) {
            let (known, motion) = (&self.bodies.lines[line], &body.motion);
            if motion.velocity.length_squared() <= known.v().length_squared() {
                let lost = Quad::new(motion.velocity - known.v(), -known.w());
                self.bodies.push(line, &lost);
                self.bodies.note_change(line);
            }
        }
        Some(pair)
    }

    /// Lines of two bodies, if contacts alone move both.
    fn free_pair(&self, slots: [BodyIx; 2]) -> Option<[LineIx; 2]> {
        let lines = slots.map(|slot| self.bodies.records[slot].line);
        let is_free = |line: &LineIx| *line != LineIx::NONE && self.bodies.is_free(*line);
        lines.iter().all(is_free).then_some(lines)
    }

    /// Both bodies go on without what closes of their motions, which they share as an impact without restitution does; as one if no
    /// normal is known, or no row would hold them.
    fn deflect(&self, fast: &mut Fast, touch: &Touching) {
        let slots = [fast.noted[touch.a].slot, touch.other];
        let inverse_mass =
            |slot: BodyIx| self.bodies.lines[self.bodies.line_of(slot)].inverse_mass();
        let of_a = touch.b.map_or(1.0, |_| {
            let [a, b] = slots.map(inverse_mass);
            a / (a + b)
        });
        let closing = touch
            .normal
            .map_or(touch.against, |n| n * touch.against.dot(n).max(0.0));
        let rest = fast.left - touch.wait;
        let mut shifts = [Vec2::ZERO; 2];
        for (side, (k, part)) in [(Some(touch.a), of_a), (touch.b, of_a - 1.0)]
            .into_iter()
            .enumerate()
        {
            let Some(k) = k else { continue };
            fast.unboxed.push(k);
            let body = fast.of(self, k);
            body.touched.get_or_insert(slots[1 - side]);
            shifts[side] = body.deflect(touch.wait, closing * part) * -rest;
        }
        let pair = self.free_pair(slots);
        fast.shifted.extend(pair.map(|lines| (lines, shifts)));
    }

    /// The other body of a free pair that touches, though not fast, has its share of what the first loses.
    fn share(&self, fast: &mut Fast, touch: &mut Touching) {
        let slots = [fast.noted[touch.a].slot, touch.other];
        if fast.find(touch.other).is_none() && self.free_pair(slots).is_some() {
            let line = &self.bodies.lines[self.bodies.line_of(touch.other)];
            let from = (
                line.d() - line.v() * fast.left,
                line.turn() - line.w() * fast.left,
            );
            touch.b = Some(fast.push(FastBody {
                slot: touch.other,
                from,
                turns: false,
                deviates: true,
                carried: false,
            }));
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
        self.bodies.deviating.push(at);
        shift
    }

    /// The motion that brings a body to its pose within `left` seconds: from a displacement, or at its velocity.
    fn motion(&self, slot: BodyIx, from: Option<(Vec2, f64)>, left: f64) -> Motion {
        let at = self.bodies.line_of(slot);
        if at <= LineIx::GROUND {
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
        let record = &self.bodies.records[body.slot];
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

    /// Whether the centre of mass of a fast body leaves the swept boxes of the tick.
    fn leaves_boxes(&self, body: &FastBody) -> bool {
        let record = &self.bodies.records[body.slot];
        let at = record.line;
        let base = self.bodies.base[at].position;
        let (from, to) = (base + body.from.0, base + self.bodies.lines[at].d());
        let boxes = record.pieces();
        let boxes = boxes.map(|piece| self.pieces.boxes[piece]);
        let boxes = boxes.fold(Aabb::EMPTY, Aabb::union);
        !(boxes.contains_point(from) && boxes.contains_point(to))
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
