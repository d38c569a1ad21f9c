//! Looking ahead: whom a flyer may meet up to its horizon, from when on, and when they touch.

use carom_geometry::Aabb;
use carom_math::SimTime;

use super::frame::Track;
use super::queue::{Ahead, Entry};
use super::window::{self, Window};
use super::{Foreseen, Seat, drift};
use crate::state::BodyState;
use crate::{BodyKind, PairSearch, World};

/// Part of a cell that a flyer travels within its horizon.
const TRAVEL: f64 = 0.35;

/// Way, in cells, that a flyer looks down for first.
const SPAN: f64 = 2.0;

/// Longest horizon, in s: what rests is looked for again at least this often.
const LONGEST: f64 = 1024.0;

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
        self.flyers.resize(&mut self.bodies, time);
        if self.look_round(index, time) {
            self.leave_tree(index);
            self.look_down(index, time, self.first_span(index, time));
        } else {
            self.follow(index, time);
        }
        self.meet_flyers(index, time, cause, but);
        self.meet_shapes(index, time, cause);
    }

    /// Registers a flyer in the grid up to its horizon; whether it fits.
    fn look_round(&mut self, index: u32, time: SimTime) -> bool {
        self.flyers.leave(&mut self.bodies, index);
        let way = TRAVEL * self.flyers.grid.side();
        let state = self.bodies.get_mut(index);
        let track = Track::of(&state.motion, time);
        let seen = self.flyers.frame.track(&track, time);
        let seconds = at_most(seen.seconds_for(way));
        state.course.horizon = time + seconds;
        state.course.swept = swept(state, &seen, seconds);
        if !self.flyers.enter(&mut self.bodies, index) {
            return false;
        }
        self.queue_end(index, Ahead::Horizon);
        true
    }

    /// Boxes of a flyer in the world for the next `span` seconds; without end while nothing is there.
    fn look_down(&mut self, index: u32, time: SimTime, span: f64) {
        if !self.flyers.grounded {
            let state = self.bodies.get_mut(index);
            state.course.ground = SimTime::NEVER;
            state.course.reached = Aabb::EMPTY;
            for &at in &state.colliders {
                self.colliders[at as usize].fat = Aabb::EMPTY;
            }
            return;
        }
        let span = at_most(span);
        let state = self.bodies.get_mut(index);
        state.course.span = span;
        state.course.ground = time + span;
        state.course.reached = swept(state, &Track::of(&state.motion, time), span);
        self.flyers.lift(&mut state.course, index);
        for &at in &state.colliders {
            self.colliders[at as usize].fat = state.course.reached;
        }
        self.queue_end(index, Ahead::Ground);
    }

    /// From the first box in the tree on flyers look down for what is there.
    pub(crate) fn look_down_first(&mut self, time: SimTime) {
        if self.flyers.grounded || self.broad.tree.is_empty() {
            return;
        }
        self.flyers.grounded = true;
        for index in self.bodies.indices().collect::<Vec<_>>() {
            if self.bodies.get(index).course.cells.is_some() {
                self.look_down(index, time, self.first_span(index, time));
                self.meet_shapes(index, time, Cause::Horizon);
            }
        }
    }

    /// How long a flyer with a new motion looks down for, in s.
    fn first_span(&self, index: u32, time: SimTime) -> f64 {
        let track = Track::of(&self.bodies.get(index).motion, time);
        track.seconds_for(SPAN * self.flyers.grid.side())
    }

    /// Boxes in the tree of a flyer that is too large for the grid.
    fn follow(&mut self, index: u32, time: SimTime) {
        let way = TRAVEL * self.flyers.grid.side();
        let state = self.bodies.get_mut(index);
        let track = Track::of(&state.motion, time);
        let seconds = at_most(track.seconds_for(way));
        state.course.ground = time + seconds;
        state.course.span = seconds;
        state.course.horizon = state.course.ground;
        state.course.reached = swept(state, &track, seconds);
        self.broad
            .follow(&self.bodies, &mut self.colliders, index, time, seconds);
        self.queue_end(index, Ahead::Ground);
        self.look_down_first(time);
    }

    /// Enters the end of a search, unless an earlier entry will come to it: a motion changes more often
    /// than its searches end.
    fn queue_end(&mut self, index: u32, ahead: Ahead) {
        let (end, entered) = self.bodies.get_mut(index).course.end(ahead);
        if *entered <= end {
            return;
        }
        *entered = end;
        self.flyers.queue.push(Entry {
            time: end,
            a: index,
            b: index,
            stamp: 0,
            ahead,
        });
    }

    /// A frame that is no faster than its flyers among themselves: all of them look round in it.
    fn retune(&mut self, time: SimTime) {
        self.flyers.drifts = false;
        let here = |i: &u32| self.bodies.get(*i).course.cells.is_some();
        let flying: Vec<u32> = self.bodies.indices().filter(here).collect();
        let Some(mean) = drift(&self.flyers.frame, &self.bodies, &flying, time) else {
            return;
        };
        for &index in &flying {
            self.flyers.leave(&mut self.bodies, index);
        }
        self.flyers.frame = self.flyers.frame.boosted(time, mean);
        let (fit, large): (Vec<u32>, Vec<u32>) = flying
            .into_iter()
            .partition(|index| self.look_round(*index, time));
        for index in fit {
            self.meet_flyers(index, time, Cause::Horizon, None);
        }
        for index in large {
            self.flyers.vanish(&mut self.bodies, index);
            self.foresee(index, time, Cause::Horizon, None);
        }
    }

    /// Flyers that `index` may meet up to its horizon.
    fn meet_flyers(&mut self, index: u32, time: SimTime, cause: Cause, but: Option<u32>) {
        let course = &self.bodies.get(index).course;
        let mut near = match course.cells {
            Some(cells) => {
                let seat = Seat::new(index, course.swept);
                self.flyers.search(&seat, cells, self.bodies.places())
            }
            None => {
                let mut near = Vec::new();
                self.flyers
                    .overlapping(&self.bodies, course.reached, &mut near);
                near
            }
        };
        self.flyers.searches += 1;
        self.flyers.renewed += usize::from(cause == Cause::Horizon);
        match self.broad.search {
            PairSearch::Indexed => {}
            PairSearch::None => near.clear(),
            PairSearch::AllPairs => {
                near.clear();
                let here = |i: &u32| self.bodies.get(*i).course.cells.is_some();
                near.extend(self.bodies.indices().filter(here));
            }
        }
        let own = Circle::of(self.bodies.get(index), time);
        for &other in &near {
            if other != index && Some(other) != but {
                self.approach(index, &own, other, time, cause);
            }
        }
        self.flyers.near = near;
    }

    /// Shapes in the tree that `index` may meet before it looks down again: of bodies that do not fly,
    /// and of flyers too large for the grid.
    fn meet_shapes(&mut self, index: u32, time: SimTime, cause: Cause) {
        let mut near = core::mem::take(&mut self.flyers.shapes);
        let course = &mut self.bodies.get_mut(index).course;
        self.broad
            .search_tree(&self.colliders, course.reached, &mut near);
        course.alone = near.is_empty();
        for &at in &near {
            let owner = self.colliders[at as usize].body;
            if owner == index {
                continue;
            }
            let state = self.bodies.get(owner);
            if state.course.flies {
                let own = Circle::of(self.bodies.get(index), time);
                self.approach(index, &own, owner, time, cause);
            } else if state.in_crowd {
                self.pair_flyer(index, at);
                self.knock_at(index, at, time);
                if !self.bodies.get(index).course.flies {
                    self.flyers.shapes = near;
                    return;
                }
            } else if state.is_active() {
                self.pair_flyer(index, at);
            } else {
                self.approach_shape(index, at, time, cause);
            }
        }
        for slot in 0..self.bodies.get(index).pairs.len() {
            self.predict(self.bodies.get(index).pairs[slot], time);
        }
        self.flyers.shapes = near;
    }

    /// Two flyers that may meet before one of their horizons ends, `own` the circle of the first.
    pub(super) fn approach(
        &mut self,
        index: u32,
        own: &Circle,
        other: u32,
        time: SimTime,
        cause: Cause,
    ) {
        let (a, b) = (self.bodies.get(index), self.bodies.get(other));
        let Some(window) = own.meets(&Circle::of(b, time)) else {
            return;
        };
        if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
            return;
        }
        if let ([one], [two]) = (&*a.colliders, &*b.colliders)
            && !self.may_touch((*one, *two))
        {
            return;
        }
        if window.from > 0.0 {
            let meet = time + window.from;
            if meet <= common_horizon(a, b) {
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

    pub(super) fn queue_near(&mut self, a: u32, b: u32, time: SimTime) {
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

    pub(super) fn stamp(&self, a: u32, b: u32) -> u32 {
        self.bodies
            .get(a)
            .version
            .wrapping_add(self.bodies.get(b).version)
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
        let left = body.course.ground - time;
        if from > left {
            return;
        }
        if from > 0.0 {
            self.queue_near_shape(index, at, time + from);
            return;
        }
        self.seek_shape(index, at, time, cause);
    }

    pub(super) fn queue_near_shape(&mut self, index: u32, at: u32, time: SimTime) {
        let entry = Entry {
            time,
            a: index,
            b: at,
            stamp: self.stamp(index, self.colliders[at as usize].body),
            ahead: Ahead::NearShape,
        };
        self.flyers.queue.push(entry);
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
        let Some(impact) = impact else {
            return self.run_search(&entry);
        };
        if self.flyers.drifts {
            self.retune(entry.time);
        }
        if self.stamp(entry.a, entry.b) == entry.stamp {
            self.strike_with_others((entry, impact));
        }
    }

    /// The end of a search, or the begin of a narrower one.
    pub(super) fn run_search(&mut self, entry: &Entry) {
        let (index, time) = (entry.a, entry.time);
        if self.flyers.drifts {
            self.retune(time);
        }
        match entry.ahead {
            Ahead::Horizon => {
                if self.ends_now(entry) {
                    self.flyers.resize(&mut self.bodies, time);
                    if self.look_round(index, time) {
                        self.meet_flyers(index, time, Cause::Horizon, None);
                    } else {
                        self.flyers.vanish(&mut self.bodies, index);
                        self.foresee(index, time, Cause::Horizon, None);
                    }
                }
            }
            Ahead::Ground => {
                if self.ends_now(entry) {
                    self.look_down_again(index, time);
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
            Ahead::Impact { .. } => {}
        }
    }

    /// Whether the search that an entry is for ends now; if it ends later, that is entered.
    fn ends_now(&mut self, entry: &Entry) -> bool {
        let course = &mut self.bodies.get_mut(entry.a).course;
        let (end, entered) = course.end(entry.ahead);
        if *entered != entry.time {
            return false;
        }
        *entered = SimTime::NEVER;
        if !course.flies || entry.ahead == Ahead::Horizon && course.cells.is_none() {
            return false;
        }
        if end > entry.time {
            self.queue_end(entry.a, entry.ahead);
        }
        end == entry.time
    }

    /// What does not fly is looked for anew: twice as far ahead where there was nothing.
    fn look_down_again(&mut self, index: u32, time: SimTime) {
        let course = &self.bodies.get(index).course;
        if course.cells.is_none() {
            self.follow(index, time);
            self.meet_flyers(index, time, Cause::Horizon, None);
            self.meet_shapes(index, time, Cause::Horizon);
            return;
        }
        let factor = if course.alone { 2.0 } else { 1.0 };
        let span = factor * course.span;
        self.look_down(index, time, span);
        self.meet_shapes(index, time, Cause::Horizon);
    }

    fn both_fly(&self, a: u32, b: u32) -> bool {
        self.bodies.get(a).course.flies && self.bodies.get(b).course.flies
    }
}

/// The bounding circle of a body at an instant, in motion.
pub(super) struct Circle {
    track: Track,
    reach: f64,
}

impl Circle {
    pub(super) fn of(state: &BodyState, time: SimTime) -> Self {
        Self {
            track: Track::of(&state.motion, time),
            reach: state.reach,
        }
    }

    /// When it overlaps another one, from now on.
    pub(super) fn meets(&self, other: &Self) -> Option<Window> {
        let (a, b) = (&self.track, &other.track);
        window::of_circles(
            b.centre - a.centre,
            b.velocity - a.velocity,
            b.acceleration - a.acceleration,
            self.reach + other.reach,
        )
    }
}

/// Until when two flyers have looked for each other.
pub(super) fn common_horizon(a: &BodyState, b: &BodyState) -> SimTime {
    let (a, b) = (&a.course, &b.course);
    if a.cells.is_some() && b.cells.is_some() {
        a.horizon.min(b.horizon)
    } else {
        // The larger one is in the tree, and met where the other looks down.
        a.ground.min(b.ground)
    }
}

fn at_most(seconds: f64) -> f64 {
    if seconds < LONGEST { seconds } else { LONGEST }
}

/// Box of a body's bounding circle along a track for `seconds`: both ends, and where it turns.
fn swept(state: &BodyState, track: &Track, seconds: f64) -> Aabb {
    let (from, to) = (track.centre, track.centre_after(seconds));
    let mut bounds = Aabb::from_points([from, to]);
    let turns = (-track.velocity / track.acceleration).to_array();
    for turn in turns {
        if turn > 0.0 && turn < seconds {
            bounds = bounds.union(Aabb::from_points([track.centre_after(turn)]));
        }
    }
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let room = 1e-9 * state.reach + 1e-14 * largest + state.motion.left_out;
    bounds.grown(state.reach * window::ROOM + room)
}
