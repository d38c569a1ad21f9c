//! Prediction: the bodies that a free body may meet up to its horizon, from when on, and the times of impact.

use carom_math::SimTime;

use super::circle::Circle;
use super::drift;
use super::foreseen::is_stale;
use super::queue::{Entry, What};
use crate::broad::free_fall_frame::Track;
use crate::broad::grid::SweptBox;
use crate::broad::window::{Window, swept};
use crate::store::state::BodyState;
use crate::store::swept::Sides;
use crate::{BodyIx, BodyKind, ColliderIx, Ix, PairSearch, Two, World};

/// Part of a cell that a free body travels within its horizon.
const TRAVEL: f64 = 0.35;

/// Look-ahead of an analytic body, in reaches: farther, and stepped bodies nearby are tested against it in vain.
const LOOK_AHEAD: f64 = 1.0;

/// Longest horizon, in s: what rests is looked for again at least this often.
const LONGEST: f64 = 1024.0;

/// Why a free body's events are predicted anew.
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
    /// Registers a free body with its motion from `time` on, and finds all that it may meet up to its
    /// horizon, `but` for a free body that looks for this one next.
    pub(crate) fn foresee(
        &mut self,
        index: BodyIx,
        time: SimTime,
        cause: Cause,
        but: Option<BodyIx>,
    ) {
        self.follow_law(index, time);
        if !self.bodies.get(index).motion.is_finite() {
            self.report.stopped += 1;
            self.bodies.stop(index, time);
        }
        self.free.resize(&mut self.bodies, time);
        // A body that does not fall leaves the free-fall frame ever faster.
        if self.bodies.get(index).moves_analytically() || !self.look_round(index, time) {
            self.follow(index, time, 0.0);
        } else {
            self.broad.forget(&mut self.bodies, index);
            self.look_down(index, time, self.first_span(index, time));
        }
        self.meet_free_bodies(index, time, cause, but);
        self.meet_shapes(index, time, cause);
        self.meet_members(index, time);
    }

    /// Registers a free body in the grid up to its horizon; whether it fits.
    fn look_round(&mut self, index: BodyIx, time: SimTime) -> bool {
        let way = TRAVEL * self.free.grid.side();
        let state = self.bodies.get_mut(index);
        let track = Track::of(&state.motion, time);
        let seen = self.free.frame.track(&track, time);
        let seconds = at_most(seen.seconds_for(way));
        let horizon = (time + seconds).min(state.piece());
        state.course.swept = Sides::around(swept(state, &seen, seconds));
        if !self.free.enter(&mut self.bodies, index, horizon) {
            return false;
        }
        self.queue_end(index, What::HORIZON);
        true
    }

    /// Boxes in the tree of a free body that is too large for the grid, for `least` seconds or more.
    pub(super) fn follow(&mut self, index: BodyIx, time: SimTime, least: f64) {
        let side = self.free.grid.side();
        let state = self.bodies.get_mut(index);
        let way = if state.moves_analytically() {
            LOOK_AHEAD * state.reach
        } else {
            // As far as in a grid of its own kind.
            TRAVEL * side.max(2.0 * state.reach)
        };
        let track = Track::of(&state.motion, time);
        let seconds = at_most(track.seconds_for(way).max(least));
        state.course.ground = (time + seconds).min(state.piece());
        state.course.span = seconds;
        state.course.reached = Sides::around(swept(state, &track, seconds));
        self.broad.follow(&mut self.bodies, index, time, seconds);
        self.queue_end(index, What::GROUND);
        self.look_down_first(time);
    }

    /// Enters the end of a search, unless an earlier entry will come to it: a motion changes more often
    /// than its searches end.
    pub(super) fn queue_end(&mut self, index: BodyIx, what: What) {
        let state = self.bodies.get_mut(index);
        let end = state.course.end(what);
        let entered = state.course.entered(what);
        if *entered <= end {
            return;
        }
        *entered = end;
        self.free.queue.push(Entry {
            time: end,
            a: index,
            b: index.number(),
            stamp: 0,
            what,
        });
    }

    /// A frame that is no faster than its free bodies among themselves: all of them look round in it.
    fn retune(&mut self, time: SimTime) {
        self.free.drifts = false;
        let free = self.free.in_order();
        let Some(mean) = drift(&self.free.frame, &self.bodies, &free, time) else {
            return;
        };
        for &index in &free {
            self.free.leave(&mut self.bodies, index);
        }
        self.free.frame = self.free.frame.boosted(time, mean);
        let (fit, large): (Vec<BodyIx>, Vec<BodyIx>) = free
            .into_iter()
            .partition(|index| self.look_round(*index, time));
        for index in fit {
            self.meet_free_bodies(index, time, Cause::Horizon, None);
        }
        for index in large {
            self.free.vanish(&mut self.bodies, index);
            self.foresee(index, time, Cause::Horizon, None);
        }
    }

    /// Free bodies that `index` may meet up to its horizon.
    pub(super) fn meet_free_bodies(
        &mut self,
        index: BodyIx,
        time: SimTime,
        cause: Cause,
        but: Option<BodyIx>,
    ) {
        let course = &self.bodies.get(index).course;
        let mut near = match course.cells {
            Some(cells) => {
                let swept_box = SweptBox::new(index, course.swept);
                self.free.search(&swept_box, cells)
            }
            None => {
                let mut near = Vec::new();
                self.free
                    .overlapping(&self.bodies, course.reached.bounds(), &mut near);
                near
            }
        };
        self.free.searches += 1;
        self.free.renewed += usize::from(cause == Cause::Horizon);
        match self.broad.search {
            PairSearch::Indexed => {}
            PairSearch::None => near.clear(),
            PairSearch::AllPairs => {
                near = self.free.in_order();
            }
        }
        let circle = Circle::of(self.bodies.get(index), time);
        let mark = self.free.begin_to_meet(self.bodies.places());
        for &other in &near {
            if other == index || Some(other) == but || self.free.has_met(other, mark) {
                continue;
            }
            let Some(window) = circle.meets(&Circle::of(self.bodies.get(other), time)) else {
                continue;
            };
            self.approach(index, other, window, time, cause);
        }
        self.free.near = near;
    }

    /// Two free bodies with circles that meet, perhaps before one of their horizons ends.
    pub(super) fn approach(
        &mut self,
        index: BodyIx,
        other: BodyIx,
        window: Window,
        time: SimTime,
        cause: Cause,
    ) {
        let (a, b) = (self.bodies.get(index), self.bodies.get(other));
        if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
            return;
        }
        if let ([one], [two]) = (&*a.colliders, &*b.colliders)
            && !self.broad.may_touch(&self.bodies, (*one, *two))
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
        // Followed to the end of its window when it began, where that is known and circles found it.
        if cause == Cause::Horizon && window.to.is_finite() && both_in_grid(a, b) {
            return;
        }
        self.seek((index, other), time, window, cause);
    }

    pub(super) fn queue_near(&mut self, a: BodyIx, b: BodyIx, time: SimTime) {
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        let entry = Entry {
            time,
            a,
            b: b.number(),
            stamp: self.stamp(a, b),
            what: What::NEAR,
        };
        self.free.queue.push(entry);
    }

    pub(super) fn stamp(&self, a: BodyIx, b: BodyIx) -> u32 {
        self.bodies.version(a).wrapping_add(self.bodies.version(b))
    }

    pub(super) fn queue_near_shape(&mut self, index: BodyIx, at: ColliderIx, time: SimTime) {
        let entry = Entry {
            time,
            a: index,
            b: at.number(),
            stamp: self.stamp(index, self.bodies.colliders[at].body),
            what: What::NEAR_SHAPE,
        };
        self.free.queue.push(entry);
    }

    /// Another look at a pair of bodies that a free body belongs to, at `time`.
    pub(super) fn look_again(
        &mut self,
        (a, b): Two<BodyIx>,
        shapes: Two<ColliderIx>,
        time: SimTime,
    ) {
        if self.both_fly(a, b) {
            self.queue_near(a, b, time);
        } else if self.bodies.get(a).goes_by_events() {
            self.queue_near_shape(a, shapes.1, time);
        } else {
            self.queue_near_shape(b, shapes.0, time);
        }
    }

    /// Runs the next event of free bodies.
    pub(crate) fn run_free_bodies(&mut self) {
        let Some((entry, impact)) = self.free.pop() else {
            return;
        };
        self.lower_idle(entry.time);
        let Some(impact) = impact else {
            return self.run_search(&entry);
        };
        if self.free.drifts {
            self.retune(entry.time);
        }
        if self.stamp(entry.a, entry.other()) != entry.stamp {
            return;
        }
        if self.moving_end(impact.bodies).is_some() && self.approaches(&impact, entry.time) {
            self.strike_held(&impact, entry.time);
        } else {
            self.strike_with_others((entry, impact));
        }
    }

    /// The end of a search, or the begin of a narrower one.
    pub(super) fn run_search(&mut self, entry: &Entry) {
        let (index, time) = (entry.a, entry.time);
        if self.free.drifts {
            self.retune(time);
        }
        match entry.what {
            What::HORIZON | What::GROUND => {
                if !self.ends_now(entry) {
                    return;
                }
                if self.piece_ends(index, time) {
                    return self.foresee(index, time, Cause::Deflected, None);
                }
                if entry.what == What::GROUND {
                    return self.look_down_again(index, time);
                }
                self.free.resize(&mut self.bodies, time);
                if self.look_round(index, time) {
                    self.meet_free_bodies(index, time, Cause::Horizon, None);
                } else {
                    self.free.vanish(&mut self.bodies, index);
                    self.foresee(index, time, Cause::Horizon, None);
                }
            }
            What::NEAR => {
                let other = entry.other();
                if self.stamp(index, other) == entry.stamp && self.both_fly(index, other) {
                    self.come_near(index, other, time);
                }
            }
            What::NEAR_SHAPE => {
                let owner = self.bodies.colliders[entry.shape()].body;
                let state = self.bodies.get(owner);
                let rests = !state.goes_by_events() && !state.is_active();
                if self.stamp(index, owner) == entry.stamp
                    && self.bodies.get(index).goes_by_events()
                    && rests
                {
                    self.seek_shape(index, entry.shape(), time, Cause::Deflected);
                }
            }
            _ => {
                // Impacts are run elsewhere.
                if entry.what == What::COLLAPSE && !is_stale(entry, &self.bodies) {
                    self.report_collapse((index, entry.other()), 0.0, time);
                }
            }
        }
    }

    /// Whether the search that an entry is for ends now; if it ends later, that is entered.
    fn ends_now(&mut self, entry: &Entry) -> bool {
        let state = self.bodies.get_mut(entry.a);
        let end = state.course.end(entry.what);
        let goes = state.goes_by_events();
        let course = &mut state.course;
        let entered = course.entered(entry.what);
        if *entered != entry.time {
            return false;
        }
        *entered = SimTime::NEVER;
        if !goes || entry.what == What::HORIZON && course.cells.is_none() {
            return false;
        }
        if end > entry.time {
            self.queue_end(entry.a, entry.what);
        }
        end == entry.time
    }

    pub(super) fn both_fly(&self, a: BodyIx, b: BodyIx) -> bool {
        self.bodies.get(a).goes_by_events() && self.bodies.get(b).goes_by_events()
    }
}

/// Whether two free bodies found each other by the ways of their circles, so that one of them was told of their window
/// before it began. What is in the tree is found by boxes of shapes, which the circle of something long and thin leaves
/// far behind: its window may have been open for long, and is followed from one look to the next.
pub(super) const fn both_in_grid(a: &BodyState, b: &BodyState) -> bool {
    a.course.cells.is_some() && b.course.cells.is_some()
}

/// Until when two free bodies have looked for each other.
pub(super) fn common_horizon(a: &BodyState, b: &BodyState) -> SimTime {
    if both_in_grid(a, b) {
        a.course.horizon.min(b.course.horizon)
    } else {
        // The larger one is in the tree, and met where the other looks down.
        a.course.ground.min(b.course.ground)
    }
}

pub(super) fn at_most(seconds: f64) -> f64 {
    if seconds < LONGEST { seconds } else { LONGEST }
}
