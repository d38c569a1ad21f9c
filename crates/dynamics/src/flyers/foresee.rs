//! Looking ahead: whom a flyer may meet up to its horizon, from when on, and when they touch.

use carom_collision::{AxisFeature, Impact, TimeOfImpact, contacts, time_of_impact};
use carom_geometry::Aabb;
use carom_math::SimTime;

use super::Foreseen;
use super::queue::{Ahead, Entry};
use super::window::{self, Window};
use crate::body::BodyState;
use crate::narrow::{TOUCH, opening_speed, rest_speed_between};
use crate::{BodyKind, PairSearch, World};

/// Part of a cell that a flyer travels within its horizon.
const TRAVEL: f64 = 0.4;

/// Longest horizon, in s: what rests is looked for again at least this often.
const LONGEST: f64 = 1024.0;

/// Largest turn that one search for a time of impact goes through, in rad: bounds on a gap's second
/// derivative are loose over more.
const TURN: f64 = 8.0;

/// Why a flyer looks ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The caller put it where it is, or moved it: it may overlap others.
    Arrived,
    /// It has a new motion.
    Deflected,
    /// Its motion stands; its horizon has ended.
    Horizon,
}

impl World {
    /// Registers a flyer with its motion from `time` on, and finds all that it may meet up to its
    /// horizon, `but` for a flyer that looks for this one next.
    pub(crate) fn foresee(&mut self, index: u32, time: SimTime, cause: Cause, but: Option<u32>) {
        if !self.bodies.get(index).motion.is_finite() {
            self.report.stopped += 1;
            self.stop(index, time);
        }
        self.flyers.resize(&mut self.bodies);
        self.flyers.leave(&mut self.bodies, index);
        let side = self.flyers.grid.side();
        let state = self.bodies.get_mut(index);
        let seconds = horizon(state, time, TRAVEL * side);
        state.course.horizon = time + seconds;
        state.course.swept = swept(state, time, seconds);
        let swept = state.course.swept;
        if self.flyers.enter(&mut self.bodies, index) {
            self.leave_tree(index);
            for &at in &self.bodies.get(index).colliders {
                self.colliders[at as usize].fat = swept;
            }
        } else {
            self.broad
                .follow(&self.bodies, &mut self.colliders, index, time, seconds);
        }
        let state = self.bodies.get(index);
        let entry = Entry {
            time: state.course.horizon,
            a: index,
            b: index,
            stamp: state.version.wrapping_mul(2),
            ahead: Ahead::Horizon,
        };
        self.flyers.queue.push(entry);
        self.meet_flyers(index, time, cause, but);
        self.meet_shapes(index, time, cause);
    }

    /// Flyers that `index` may meet up to its horizon.
    fn meet_flyers(&mut self, index: u32, time: SimTime, cause: Cause, but: Option<u32>) {
        let swept = self.bodies.get(index).course.swept;
        let mut near = match self.bodies.get(index).course.cells {
            Some(cells) => self.flyers.search(cells, self.bodies.places()),
            None => {
                let mut near = Vec::new();
                self.flyers.overlapping(&self.bodies, swept, &mut near);
                near
            }
        };
        self.flyers.searches += 1;
        self.flyers.met += near.len();
        match self.broad.search {
            PairSearch::Indexed => {}
            PairSearch::None => near.clear(),
            PairSearch::AllPairs => {
                near.clear();
                let here = |i: &u32| self.bodies.get(*i).course.cells.is_some();
                near.extend(self.bodies.indices().filter(here));
            }
        }
        for &other in &near {
            if other != index && Some(other) != but {
                self.approach(index, other, time, cause);
            }
        }
        self.flyers.near = near;
    }

    /// Shapes in the tree that `index` may meet up to its horizon: of bodies that do not fly, and of
    /// flyers too large for the grid.
    fn meet_shapes(&mut self, index: u32, time: SimTime, cause: Cause) {
        for at in self
            .broad
            .in_tree(&self.colliders, self.bodies.get(index).course.swept)
        {
            let owner = self.colliders[at as usize].body;
            if owner == index {
                continue;
            }
            let state = self.bodies.get(owner);
            if state.course.flies {
                self.approach(index, owner, time, cause);
            } else if state.is_active() {
                self.pair_flyer(index, at);
            } else {
                self.approach_shape(index, at, time, cause);
            }
        }
        for slot in 0..self.bodies.get(index).pairs.len() {
            self.predict(self.bodies.get(index).pairs[slot], time);
        }
    }

    /// Two flyers that may meet before one of their horizons ends.
    fn approach(&mut self, index: u32, other: u32, time: SimTime, cause: Cause) {
        let (a, b) = (self.bodies.get(index), self.bodies.get(other));
        if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
            return;
        }
        let horizon = a.course.horizon.min(b.course.horizon);
        let (window, _) = circles(a, b, time);
        let Some(window) = window else { return };
        if window.from > 0.0 {
            let meet = time + window.from;
            if meet <= horizon {
                self.queue_near(index, other, meet);
            }
            return;
        }
        // Followed to the end of its window when it began, where that is known.
        if cause == Cause::Horizon && window.to.is_finite() {
            return;
        }
        self.seek(index, other, time, window, cause);
    }

    fn queue_near(&mut self, a: u32, b: u32, time: SimTime) {
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        let entry = Entry {
            time,
            a,
            b,
            stamp: self.stamp(a, b),
            ahead: Ahead::Near,
        };
        self.flyers.queue.push(entry);
    }

    fn stamp(&self, a: u32, b: u32) -> u32 {
        self.bodies
            .get(a)
            .version
            .wrapping_add(self.bodies.get(b).version)
    }

    /// Time of impact of two flyers from now on, to the end of their window or, where that is not
    /// known, to the nearer horizon.
    fn seek(&mut self, a: u32, b: u32, time: SimTime, window: Window, cause: Cause) {
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let horizon = one.course.horizon.min(two.course.horizon) - time;
        let end = if window.to.is_finite() {
            window.to
        } else {
            horizon
        };
        let (length, cut) = cut_by_turn(one, two, time, end);
        let ends = (one.colliders.len(), two.colliders.len());
        let mut met = false;
        for i in 0..ends.0 {
            for j in 0..ends.1 {
                let shapes = (
                    self.bodies.get(a).colliders[i],
                    self.bodies.get(b).colliders[j],
                );
                met |= self.seek_shapes((a, b), shapes, time, length, cause);
            }
        }
        if cut && !met {
            self.queue_near(a, b, time + length);
        }
    }

    /// A flyer and a shape that rests.
    pub(crate) fn approach_shape(&mut self, index: u32, at: u32, time: SimTime, cause: Cause) {
        let body = self.bodies.get(index);
        let owner = self.bodies.get(self.colliders[at as usize].body);
        if body.kind != BodyKind::Dynamic && owner.kind != BodyKind::Dynamic {
            return;
        }
        let motion = &body.motion;
        let from = window::from_box(
            motion.centre_at(time),
            motion.velocity_at(time),
            motion.acceleration,
            body.reach,
            self.colliders[at as usize].fat,
        );
        let left = body.course.horizon - time;
        if from > left {
            return;
        }
        if from > 0.0 {
            self.queue_near_shape(index, at, time + from);
            return;
        }
        self.seek_shape(index, at, time, cause);
    }

    fn queue_near_shape(&mut self, index: u32, at: u32, time: SimTime) {
        let entry = Entry {
            time,
            a: index,
            b: at,
            stamp: self.stamp(index, self.colliders[at as usize].body),
            ahead: Ahead::NearShape,
        };
        self.flyers.queue.push(entry);
    }

    /// Time of impact of a flyer and a shape that rests, from now to the flyer's horizon.
    fn seek_shape(&mut self, index: u32, at: u32, time: SimTime, cause: Cause) {
        let owner = self.colliders[at as usize].body;
        let (body, other) = (self.bodies.get(index), self.bodies.get(owner));
        let (length, cut) = cut_by_turn(body, other, time, body.course.horizon - time);
        let mut met = false;
        for slot in 0..self.bodies.get(index).colliders.len() {
            let mine = self.bodies.get(index).colliders[slot];
            let (ends, shapes) = if index < owner {
                ((index, owner), (mine, at))
            } else {
                ((owner, index), (at, mine))
            };
            met |= self.seek_shapes(ends, shapes, time, length, cause);
        }
        if cut && !met {
            self.queue_near_shape(index, at, time + length);
        }
    }

    /// Time of impact of two shapes within `length` seconds; whether they meet.
    fn seek_shapes(
        &mut self,
        (a, b): (u32, u32),
        shapes: (u32, u32),
        time: SimTime,
        length: f64,
        cause: Cause,
    ) -> bool {
        self.report.pairs += 1;
        if cause == Cause::Arrived && self.holds((a, b), shapes, time) {
            self.land(a, time);
            self.land(b, time);
            return true;
        }
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let (motion_a, motion_b) = (one.motion.rebased(time), two.motion.rebased(time));
        let (first, second) = (
            &self.colliders[shapes.0 as usize],
            &self.colliders[shapes.1 as usize],
        );
        let next = time_of_impact(&first.solid, &motion_a, &second.solid, &motion_b, length);
        let (wait, impact) = match next {
            TimeOfImpact::Clear => (f64::INFINITY, None),
            TimeOfImpact::Hit(impact) => (impact.time, Some(impact)),
            TimeOfImpact::Touching(impact) => (0.0, Some(impact)),
            TimeOfImpact::Unresolved { .. } => {
                self.report.unresolved += 1;
                self.land(a, time);
                self.land(b, time);
                return true;
            }
        };
        let stamp = self.stamp(a, b);
        if let Some((end, next)) = self
            .flyers
            .hop
            .take_if(|(_, next)| next.colliders == shapes)
        {
            // The search may find the same end, blurred, or another point that strikes before.
            let near = 1e-6 * self.bodies.get(a).reach.min(self.bodies.get(b).reach);
            let same = |other: &Impact| (other.points[0] - next.points[0]).length() <= near;
            if wait > 0.5 * end && impact.as_ref().is_none_or(same) || wait > end {
                self.flyers.push_impact(time + end, stamp, next);
                return true;
            }
        }
        let Some(impact) = impact else {
            return false;
        };
        let foreseen = Foreseen {
            bodies: (a, b),
            colliders: shapes,
            normal: impact.normal,
            face: match impact.features[0].feature {
                AxisFeature::Edge { owner, .. } => Some(owner),
                AxisFeature::Vertices { .. } => None,
            },
            points: impact.points,
        };
        self.flyers.push_impact(time + wait, stamp, foreseen);
        true
    }

    /// Whether two shapes that the caller put where they are overlap by more than rounding, or rest on
    /// each other.
    fn holds(&self, (a, b): (u32, u32), shapes: (u32, u32), time: SimTime) -> bool {
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let (pose_a, pose_b) = (one.motion.pose_at(time), two.motion.pose_at(time));
        let touch = TOUCH * one.reach.min(two.reach);
        let mut found = Vec::new();
        contacts(
            &self.colliders[shapes.0 as usize].solid,
            &self.colliders[shapes.1 as usize].solid,
            pose_b.seen_from(pose_a),
            touch,
            &mut found,
        );
        let rest = rest_speed_between(&self.bodies, (a, b), self.clock.h);
        found.iter().any(|part| {
            let normal = pose_a.vector(part.manifold.normal);
            part.manifold.points.iter().any(|point| {
                let rate = opening_speed(one, two, time, pose_a.point(point.point), normal);
                point.separation < -touch || rest > 0.0 && rate.abs() <= rest
            })
        })
    }

    /// Another look at a pair of bodies that a flyer belongs to, at `time`.
    pub(super) fn look_again(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        if self.both_fly(a, b) {
            self.queue_near(a, b, time);
        } else if self.bodies.get(a).course.flies {
            self.queue_near_shape(a, impact.colliders.1, time);
        } else {
            self.queue_near_shape(b, impact.colliders.0, time);
        }
    }

    /// Takes the boxes of a body out of the tree.
    fn leave_tree(&mut self, index: u32) {
        for slot in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[slot];
            if let Some(node) = self.colliders[at as usize].node.take() {
                self.broad.tree.remove(node);
            }
        }
    }

    /// What is due for flyers at the next entry's time.
    pub(crate) fn run_flyers(&mut self) {
        let Some((entry, impact)) = self.flyers.pop() else {
            return;
        };
        let (index, time) = (entry.a, entry.time);
        match entry.ahead {
            Ahead::Horizon => {
                let state = self.bodies.get(index);
                let due =
                    state.version.wrapping_mul(2) == entry.stamp && state.course.horizon == time;
                if state.course.flies && due {
                    self.foresee(index, time, Cause::Horizon, None);
                }
            }
            Ahead::Near => {
                if self.stamp(index, entry.b) == entry.stamp && self.both_fly(index, entry.b) {
                    self.come_near(index, entry.b, time);
                }
            }
            Ahead::NearShape => {
                let owner = self.colliders[entry.b as usize].body;
                let state = self.bodies.get(owner);
                let rests = !state.course.flies && !state.is_active();
                if self.stamp(index, owner) == entry.stamp
                    && self.bodies.get(index).course.flies
                    && rests
                {
                    self.seek_shape(index, entry.b, time, Cause::Deflected);
                }
            }
            Ahead::Collapse => self.report_collapse((index, entry.b), 0.0, time),
            Ahead::Impact { .. } => {
                if let Some(impact) = impact
                    && self.stamp(index, entry.b) == entry.stamp
                {
                    self.strike_flyer(&impact, time);
                }
            }
        }
    }

    fn both_fly(&self, a: u32, b: u32) -> bool {
        self.bodies.get(a).course.flies && self.bodies.get(b).course.flies
    }

    /// The instant from which on two flyers may meet.
    fn come_near(&mut self, index: u32, other: u32, time: SimTime) {
        let (a, b) = (self.bodies.get(index), self.bodies.get(other));
        let (window, exact) = circles(a, b, time);
        let Some(window) = window else { return };
        // A bound may come early; a root is there but for its rounding.
        if !exact && window.from > 0.0 {
            self.approach(index, other, time, Cause::Deflected);
        } else {
            self.seek(index, other, time, window, Cause::Deflected);
        }
    }
}

/// When the circles of two flyers overlap, from `time` on; whether the window is exact.
fn circles(a: &BodyState, b: &BodyState, time: SimTime) -> (Option<Window>, bool) {
    let (one, two) = (&a.motion, &b.motion);
    let pull = two.acceleration - one.acceleration;
    let window = window::of_circles(
        two.centre_at(time) - one.centre_at(time),
        two.velocity_at(time) - one.velocity_at(time),
        pull,
        a.reach + b.reach,
    );
    (window, pull == carom_math::Vec2::ZERO)
}

/// Seconds that a flyer takes to travel `way` metres along either axis, at most.
fn horizon(state: &BodyState, time: SimTime, way: f64) -> f64 {
    let (v, a) = (
        state.motion.velocity_at(time).abs(),
        state.motion.acceleration.abs(),
    );
    let along = |v: f64, a: f64| 2.0 * way / (v + (v * v + 2.0 * a * way).sqrt());
    let (x, y) = (along(v.x, a.x), along(v.y, a.y));
    let first = if x < y { x } else { y };
    if first < LONGEST { first } else { LONGEST }
}

/// Box of a body's bounding circle from `time` on for `seconds`.
fn swept(state: &BodyState, time: SimTime, seconds: f64) -> Aabb {
    let motion = &state.motion;
    let (from, to) = (motion.centre_at(time), motion.centre_at(time + seconds));
    let bulge = motion.acceleration.length() * (0.125 * seconds * seconds);
    let largest = from.abs().max(to.abs()).max_element();
    let room = 1e-9 * state.reach + 1e-14 * largest + motion.left_out;
    Aabb::from_points([from, to]).grown(state.reach + bulge + room)
}

/// A search of `length` seconds, or as much of it as two bodies turn by [`TURN`] in; whether that
/// is less.
fn cut_by_turn(a: &BodyState, b: &BodyState, time: SimTime, length: f64) -> (f64, bool) {
    let spin = |state: &BodyState| {
        let (now, pull) = (
            state.motion.spin_at(time),
            state.motion.angular_acceleration,
        );
        now.abs() + pull.abs() * length
    };
    let longest = TURN / (spin(a) + spin(b));
    if length > longest {
        (longest, true)
    } else {
        (length, false)
    }
}
