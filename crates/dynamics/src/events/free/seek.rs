//! When two bodies touch that are near enough to meet, and what is already in contact.

use std::sync::Arc;

use carom_collision::{
    Impact, TimeOfImpact, contacts, earlier, part, part_count, time_of_impact_beside,
};
use carom_geometry::Shape;
use carom_math::{SimTime, Vec2};

use super::Foreseen;
use super::circle::Circle;
use super::foresee::{Cause, both_in_grid, common_horizon};
use super::strike::approach_speed;
use super::turning::first_piece;
use crate::broad::window::{Window, ways_from};
use crate::model::approach::CLOSED;
use crate::model::ghost::{Exposed, Meeting};
use crate::model::graph::pair_of;
use crate::model::narrow::{TOUCH, opening_speed, pace, rest_speed, rest_speed_between};
use crate::motion::first_touch::{first_touch, first_touch_of_parts, parts_in_way};
use crate::store::few::Few;
use crate::{BodyIx, ColliderIx, PairIx, Two, World};

/// Part of a sub-step after which a contact that opens with t³ has a gap that a search sees, of some 1e-13 of a size.
const OPENED: f64 = 1.0 / 64.0;

/// Part of a sub-step that a search must have come if it is to go on: what opens with t³ lets it come by 0.3 and more. Shorter ones cost more
/// than the engine.
const FARTHER: f64 = 0.25;

/// A gap that is rounding, as a fraction of the largest coordinate: each of two centres is off by half a unit.
const BLUR: f64 = 2.0 * f64::EPSILON;

impl World {
    /// The instant from which on two free bodies may meet.
    pub(super) fn come_near(&mut self, index: BodyIx, other: BodyIx, time: SimTime) {
        let own = Circle::of(self.bodies.get(index), time);
        let theirs = Circle::of(self.bodies.get(other), time);
        let Some(window) = own.meets(&theirs) else {
            return;
        };
        // A bound, with an unknown end, may come early, but not by less than time rounds; a root is exact but for its rounding.
        if window.to.is_infinite() && time + window.from > time {
            self.approach(index, other, window, time, Cause::Deflected);
        } else {
            self.seek((index, other), time, window, Cause::Deflected);
        }
    }

    /// Time of impact of two free bodies from now on, to the end of their window or, where that is not
    /// known or one of them is in the tree, to the nearer horizon.
    pub(super) fn seek(
        &mut self,
        (a, b): Two<BodyIx>,
        time: SimTime,
        window: Window,
        cause: Cause,
    ) {
        let (a, b) = if self.goes_first(a, b) {
            (a, b)
        } else {
            (b, a)
        };
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let end = if window.to.is_finite() && both_in_grid(one, two) {
            window.to
        } else {
            window.to.min(common_horizon(one, two) - time)
        };
        let shapes = (one.colliders.clone(), two.colliders.clone());
        self.seek_all((a, b), shapes, time, end, cause);
    }

    /// Whether `a` is the first body of the pair: by how both began, so that roundings do not depend on the
    /// order in which they came.
    fn goes_first(&self, a: BodyIx, b: BodyIx) -> bool {
        let rank = |index: BodyIx| (self.bodies.get(index).rank, index);
        rank(a) < rank(b)
    }

    /// Time of impact of a free body and a shape that rests, from now to the free body's horizon.
    pub(super) fn seek_shape(
        &mut self,
        index: BodyIx,
        at: ColliderIx,
        time: SimTime,
        cause: Cause,
    ) {
        let owner = self.bodies.colliders[at].body;
        let body = self.bodies.get(index);
        let (end, mine) = (body.course.ground - time, body.colliders.clone());
        self.seek_all((index, owner), (mine, Few::One(at)), time, end, cause);
    }

    /// Time of impact of these shapes of two bodies within `end` seconds; what is left of a long search is made later.
    fn seek_all(
        &mut self,
        (a, b): Two<BodyIx>,
        shapes: (Few<ColliderIx>, Few<ColliderIx>),
        time: SimTime,
        end: f64,
        cause: Cause,
    ) {
        let (apart, length) = first_piece(&self.bodies, (a, b), time, end);
        let mut met = false;
        if apart <= 0.0 {
            let is_first = self.goes_first(a, b);
            for (&i, &j) in shapes
                .0
                .iter()
                .flat_map(|i| shapes.1.iter().map(move |j| (i, j)))
            {
                met |= if is_first {
                    self.seek_shapes((a, b), (i, j), time, length, cause)
                } else {
                    self.seek_shapes((b, a), (j, i), time, length, cause)
                };
            }
        }
        let looked = if apart > 0.0 { apart } else { length };
        if looked < end && !met {
            self.look_again((a, b), (shapes.0[0], shapes.1[0]), time + looked);
        }
    }

    /// Time of impact of two shapes within `length` seconds; whether they meet.
    fn seek_shapes(
        &mut self,
        (a, b): Two<BodyIx>,
        shapes: Two<ColliderIx>,
        time: SimTime,
        length: f64,
        cause: Cause,
    ) -> bool {
        if !self.broad.may_touch(&self.bodies, shapes) {
            return false;
        }
        if let Some(place) = self.moving_pair((a, b), shapes) {
            return self.seek_beside_mode(place, time, length);
        }
        self.report.pairs += 1;
        if cause == Cause::Arrived && self.holds((a, b), shapes, time) {
            self.land_both((a, b), time);
            return true;
        }
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        // Beyond the end of a micro-bounce there is nothing to ask.
        let back = self.free.micro_bounce.as_ref();
        let back = back.filter(|(_, next)| next.colliders == shapes);
        let length = back.map_or(length, |(back, _)| length.min(*back));
        let struck = self.free.struck.filter(|(struck, _)| *struck == shapes);
        let last = struck.map(|(_, last)| last);
        let [first, second] = self.bodies.solids(shapes);
        let (ends, span) = ([one, two], (time, length));
        let next = first_touch(ends, [first, second], span, ways_from(time), last);
        let (wait, impact) = match next {
            TimeOfImpact::Clear => (f64::INFINITY, None),
            TimeOfImpact::Hit(impact) => (impact.time, Some(impact)),
            TimeOfImpact::Touching(impact) => (0.0, Some(impact)),
            TimeOfImpact::Unresolved { safe_until } => {
                self.seek_on((a, b), shapes, (time, safe_until));
                return true;
            }
        };
        let stamp = self.stamp(a, b);
        if let Some((end, next)) = self
            .free
            .micro_bounce
            .take_if(|(_, next)| next.colliders == shapes)
        {
            // The search may find the same end, blurred, or another point that strikes before.
            let near = 1e-6 * self.bodies.get(a).reach.min(self.bodies.get(b).reach);
            let same = |other: &Impact| (other.points[0] - next.points[0]).length() <= near;
            if wait > 0.5 * end && impact.as_ref().is_none_or(same) || wait > end {
                self.free.push_impact(time + end, stamp, next);
                return true;
            }
        }
        let seen = |found| self.seen_from_support((a, b), shapes, found, time);
        let Some(impact) = impact.and_then(seen) else {
            return false;
        };
        let foreseen = Foreseen::of((a, b), shapes, &impact);
        let wait = if self.is_blurred(&foreseen, time, wait) {
            0.0
        } else {
            wait
        };
        self.free.push_impact(time + wait, stamp, foreseen);
        true
    }

    /// Other parts of two shapes may meet while some of them touch and approach by rounding alone, at `slow` m/s at most: the search
    /// that ended with this touch did not look beyond it.
    pub(super) fn seek_beside(&mut self, touch: &Foreseen, time: SimTime, length: f64, slow: f64) {
        let (a, b) = touch.bodies;
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        if one.flight.is_some() || two.flight.is_some() {
            return;
        }
        let [first, second] = self.bodies.solids(touch.colliders);
        let from = (time, slow);
        let next = time_of_impact_beside(from, first, &one.motion, second, &two.motion, length);
        match next {
            TimeOfImpact::Clear => {}
            TimeOfImpact::Hit(impact) | TimeOfImpact::Touching(impact) => {
                let foreseen = Foreseen::of((a, b), touch.colliders, &impact);
                let at = time + impact.time;
                // Far out the search measures an approach less exactly: of this touch it would tell at this instant without end.
                // What is beside it is looked at when the touch is looked at again.
                let again =
                    at <= time && approach_speed(&foreseen, &self.ends_of(&foreseen, time)) <= slow;
                if !again {
                    let stamp = self.stamp(a, b);
                    self.free.push_impact(at, stamp, foreseen);
                }
            }
            TimeOfImpact::Unresolved { .. } => self.leave_unresolved((a, b), time),
        }
    }

    /// A search of what a mode moves that gave up after `safe_until` seconds goes on from there, where what opens has a larger gap. One
    /// that came nowhere leaves two bodies to the engine, and so does one in the air: what spins fast would be sought without end.
    fn seek_on(
        &mut self,
        ends: Two<BodyIx>,
        shapes: Two<ColliderIx>,
        (time, safe_until): (SimTime, f64),
    ) {
        if self.moving_end(ends).is_some() && safe_until > FARTHER * self.clock.h {
            self.look_again(ends, shapes, time + safe_until);
        } else {
            self.leave_unresolved(ends, time);
        }
    }

    /// A search that found no end leaves two bodies to the engine.
    fn leave_unresolved(&mut self, ends: Two<BodyIx>, time: SimTime) {
        self.report.unresolved += 1;
        self.land_both(ends, time);
    }

    /// An impact as the side sees it that bears one of two bodies: `None` where the side that it is on is flush with that, and where it is
    /// on the tip of a ramp that goes up from there the ramp's side.
    fn seen_from_support(
        &self,
        ends: Two<BodyIx>,
        shapes: Two<ColliderIx>,
        impact: Impact,
        time: SimTime,
    ) -> Option<Impact> {
        let parts = impact.features[0].parts;
        let meeting = self
            .moving_end(ends)
            .and_then(|_| Meeting::of(&self.bodies, ends, shapes, parts, impact.normal));
        let Some(meeting) = meeting else {
            return Some(impact);
        };
        let at = time + impact.time;
        match meeting.exposed(&self.bodies, &self.pairs, at) {
            Exposed::Whole => Some(impact),
            Exposed::Nothing => None,
            Exposed::Side(out) => {
                let (one, two) = self.bodies.both(ends);
                let normal = meeting.facing(out, impact.normal);
                let gap_rate = opening_speed(one, two, at, impact.points[0], normal);
                (gap_rate < 0.0).then_some(Impact {
                    normal,
                    gap_rate,
                    ..impact
                })
            }
        }
    }

    /// Whether the gap that an impact with a loss waits for is no more than rounding made of none.
    ///
    /// Where impacts of a cluster come ever faster, a gap of one rounding lasts as long as all that were before when its
    /// approach has faded: at 20 m from the origin and 1 nm/s for 3.5 µs.
    fn is_blurred(&self, impact: &Foreseen, time: SimTime, wait: f64) -> bool {
        let (one, two) = self.bodies.both(impact.bodies);
        let approach = |at: SimTime| -opening_speed(one, two, at, impact.points[0], impact.normal);
        // What falls from rest approaches faster at the end of its way than now.
        let (now, then) = (approach(time), approach(time + wait));
        // Where the gap is now, within the smaller body's reach: the impact may be months ahead, and far off.
        let small = if one.reach < two.reach { one } else { two };
        let far = small.centre_at(time).abs().max_element() + small.reach;
        now > 0.0
            && now.max(then) * wait <= BLUR * far
            && self.material_of(impact).restitution < 1.0
    }

    /// Whether two shapes that the caller put where they are overlap by more than rounding, or rest on
    /// each other.
    fn holds(&self, (a, b): Two<BodyIx>, shapes: Two<ColliderIx>, time: SimTime) -> bool {
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let (pose_a, pose_b) = (one.centre_pose(time), two.centre_pose(time));
        let touch = TOUCH * one.reach.min(two.reach);
        let mut found = Vec::new();
        let [first, second] = self.bodies.solids(shapes);
        let seen = pose_b.seen_from(pose_a);
        contacts(first, second, seen, touch, &mut found);
        let rest = rest_speed_between(&self.bodies, (a, b));
        found.iter().any(|part| {
            let normal = pose_a.vector(part.manifold.normal);
            part.manifold.points.iter().any(|point| {
                let rate = opening_speed(one, two, time, pose_a.point(point.point), normal);
                point.separation < -touch || rest > 0.0 && rate.abs() <= rest
            })
        })
    }

    /// The pair of two shapes that an island in analytic motion has: that of a contact, or of one that is just over.
    pub(super) fn moving_pair(&self, ends: Two<BodyIx>, shapes: Two<ColliderIx>) -> Option<PairIx> {
        let index = self.moving_end(ends)?;
        pair_of(&self.bodies, &self.pairs, index, shapes)
    }

    /// The first of two bodies that is in an island in analytic motion.
    pub(super) fn moving_end(&self, (a, b): Two<BodyIx>) -> Option<BodyIx> {
        let moves = |index: &BodyIx| self.bodies.get(*index).moves_analytically();
        [a, b].into_iter().find(moves)
    }

    /// Whether a mode holds all that may touch of the shapes of a pair.
    pub(super) fn is_held_by_mode(&self, place: PairIx) -> bool {
        is_all_held(&self.solids_of(place), &self.held_parts(place))
    }

    fn solids_of(&self, place: PairIx) -> [Arc<Shape>; 2] {
        self.bodies
            .solids(self.pairs.get(place).colliders)
            .map(Arc::clone)
    }

    /// Parts of a pair in contacts that change with the mode of an island alone.
    fn held_parts(&self, place: PairIx) -> Vec<(u32, u32)> {
        let pair = self.pairs.get(place);
        let mut held = Vec::new();
        for index in [pair.bodies.0, pair.bodies.1] {
            if let Some(group) = self.closed.group_of(&self.bodies, index) {
                held.extend(group.held_parts(&self.bodies, place, pair));
            }
        }
        held
    }

    /// Whether a contact of two parts opens in a mode that begins now: where no force is left it does so with t³ alone.
    fn opens_now(&self, place: PairIx, parts: (usize, usize), time: SimTime) -> bool {
        let pair = self.pairs.get(place);
        [pair.bodies.0, pair.bodies.1].into_iter().any(|index| {
            let group = self.closed.group_of(&self.bodies, index);
            group.is_some_and(|group| group.since == time && group.opens(place, pair, parts))
        })
    }

    /// Time of impact of what an island's mode does not hold of a pair, within `length` seconds; whether there is one.
    ///
    /// What closes by rounding alone, or is a hidden side of what bears it, is none. A search that ends with it is made again a sub-step
    /// later; one that sees no end of a contact that begins to open sooner, once that has a gap.
    fn seek_beside_mode(&mut self, place: PairIx, time: SimTime, length: f64) -> bool {
        let (solids, held) = (self.solids_of(place), self.held_parts(place));
        if is_all_held(&solids, &held) {
            return false;
        }
        self.report.pairs += 1;
        let pair = self.pairs.get(place);
        let (ends, shapes) = (pair.bodies, pair.colliders);
        let (one, two) = self.bodies.both(ends);
        let rest = rest_speed(&self.bodies, pair);
        let is_slow = |impact: &Impact| {
            let at = time + impact.time;
            let least = CLOSED * (pace(one, two, at) + rest);
            let closes = |point: &Vec2| opening_speed(one, two, at, *point, impact.normal) < -least;
            !impact.points.iter().any(closes)
        };
        let (mut first, mut again) = (TimeOfImpact::Clear, f64::INFINITY);
        let shapes_of = [&*solids[0], &*solids[1]];
        let span = (time, length);
        let [of_one, of_two] = parts_in_way([one, two], shapes_of, span, ways_from(time));
        for &i in &of_one {
            for &j in &of_two {
                if held
                    .iter()
                    .any(|&(x, y)| (x as usize, y as usize) == (i, j))
                {
                    continue;
                }
                let parts = [part(&solids[0], i), part(&solids[1], j)];
                let next = first_touch_of_parts([one, two], parts, time, length);
                #[expect(clippy::cast_possible_truncation, reason = "parts of a shape")]
                let next = next.of_parts((i as u32, j as u32));
                let seen = |found: Impact| {
                    let found = (!is_slow(&found)).then_some(found)?;
                    self.seen_from_support(ends, shapes, found, time)
                };
                let next = match next {
                    TimeOfImpact::Hit(found) => seen(found).map(TimeOfImpact::Hit),
                    TimeOfImpact::Touching(found) => seen(found).map(TimeOfImpact::Touching),
                    next => Some(next),
                };
                match next {
                    None => again = self.clock.h.min(again),
                    Some(TimeOfImpact::Unresolved { .. })
                        if self.opens_now(place, (i, j), time) =>
                    {
                        again = OPENED * self.clock.h;
                    }
                    Some(next) => first = earlier(first, next),
                }
            }
        }
        let (wait, impact) = match first {
            TimeOfImpact::Clear => {
                if again < length {
                    self.look_again(ends, shapes, time + again);
                }
                return false;
            }
            TimeOfImpact::Unresolved { safe_until } => {
                self.seek_on(ends, shapes, (time, safe_until));
                return true;
            }
            TimeOfImpact::Hit(impact) => (impact.time, impact),
            TimeOfImpact::Touching(impact) => (0.0, impact),
        };
        let stamp = self.stamp(ends.0, ends.1);
        let foreseen = Foreseen::of(ends, shapes, &impact);
        self.free.push_impact(time + wait, stamp, foreseen);
        true
    }
}

/// Whether two shapes of one part each touch in a contact that a mode holds.
fn is_all_held(solids: &[Arc<Shape>; 2], held: &[(u32, u32)]) -> bool {
    !held.is_empty() && solids.iter().all(|solid| part_count(solid) == 1)
}
