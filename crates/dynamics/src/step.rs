//! The story of a step: impacts in order of time, sub-steps on their grid, then the caller's look.

use carom_geometry::Aabb;
use carom_math::SimTime;

use crate::broad::tree::Overlapping;
use crate::events::event_queue::Entry;
use crate::events::free::Cause;
use crate::events::predict::{predict, price};
use crate::events::resolve::{Slow, Struck, strike};
use crate::events::wake::{wake, wake_around};
use crate::motion::flight::fly;
use crate::store::bodies::Bodies;
use crate::{Mode, Refusal, StepReport, World};

/// More ticks than this in one step are refused.
const TICKS: f64 = 1e7;

impl World {
    /// Asks where everything is `dt` seconds later.
    ///
    /// `dt` only observes: sub-steps lie on a grid of their own, so a second in one step or in a
    /// hundred gives the same motions. 0 delivers events only. There is no error path: a negative,
    /// NaN, infinite or too long `dt` (over 1e7 ticks) moves nothing, and the report says so.
    ///
    /// Work is bounded by [`Settings::work`](crate::Settings::work): where it is used up the step stops between two events with
    /// [`StepReport::advanced`] below `dt`, and a step of the rest goes on with the bits of one long step. Forces end where
    /// a step stops.
    pub fn step(&mut self, dt: f64) -> StepReport {
        self.threads.clone().run(|| self.run(dt, false))
    }

    /// Goes on until something happens (see [`World::events`]), at most `max` seconds.
    pub fn step_to_next_event(&mut self, max: f64) -> StepReport {
        self.threads.clone().run(|| self.run(max, true))
    }

    fn run(&mut self, dt: f64, stop_at_event: bool) -> StepReport {
        self.report = StepReport {
            refused: self.refusal(dt),
            ..StepReport::default()
        };
        if self.report.refused.is_some() {
            return self.report;
        }
        self.events.begin_step(self.clock.now);
        self.begin_work(dt);
        self.stopwatch.start();
        let start = self.clock.now;
        let end = start + dt;
        self.unseen_until = if stop_at_event { start } else { end };
        if dt > 0.0 {
            self.begin_forces();
            // What the solver gave them lasts to the end of its sub-step, in whichever step that is.
            if self.is_substepping() && self.clock.next() - start > 1e-9 * self.clock.h {
                self.report.handed_over += self.handed_over;
            }
        }
        // What the caller's changes brought about is told first.
        if !stop_at_event || !self.events.are_due() {
            let reached = if self.settings.mode == Mode::Stepped {
                self.advance_stepping(end, stop_at_event)
            } else {
                self.carry_members();
                let time = self.advance(end, stop_at_event);
                self.write_members(time);
                time
            };
            // The sub-step that began with the event may begin before the step, where sums of `dt` round past it.
            self.clock.now = reached.max(start);
        }
        self.stopwatch.lap(|p| &mut p.impacts);
        if dt > 0.0 {
            self.end_forces();
        }
        self.bodies.check_regimes(self.settings.mode);
        self.events.end_step();
        self.bodies.end_step();
        self.report_left_paths(self.clock.now);
        self.tell_overlaps(self.clock.now);
        self.report.inaccurate += core::mem::take(&mut self.bodies.inaccurate);
        self.report.advanced = if stop_at_event || self.work.is_used_up() {
            self.clock.now - start
        } else {
            dt
        };
        self.report
    }

    fn refusal(&self, dt: f64) -> Option<Refusal> {
        let limit = TICKS * self.settings.tick;
        if !dt.is_finite() {
            Some(Refusal::NotFinite { dt })
        } else if dt < 0.0 {
            Some(Refusal::Negative { dt })
        } else if dt > limit {
            Some(Refusal::TooLong { dt, limit })
        } else {
            None
        }
    }

    /// Impacts of the event queue and sub-steps, whichever comes first, up to `end`.
    fn advance(&mut self, end: SimTime, stop_at_event: bool) -> SimTime {
        loop {
            let grid = if self.is_substepping() {
                end.min(self.clock.next())
            } else {
                end
            };
            let due = |time: &SimTime| *time <= grid;
            let change = self.closed.next().filter(due);
            let flight = self.free.next(&self.bodies, &self.colliders, grid);
            let impact = self.event_queue.next().filter(due);
            let before = |one: Option<SimTime>, other: Option<SimTime>| match (one, other) {
                (Some(one), Some(other)) => one <= other,
                (one, _) => one.is_some(),
            };
            if let Some(time) = change
                && before(change, flight)
                && before(change, impact)
            {
                self.change_group();
                if self.work.uses_up(self.report.pairs) || stop_at_event && self.events.are_due() {
                    return time;
                }
            } else if let Some(time) = flight
                && before(flight, impact)
            {
                self.run_free_bodies();
                if self.work.uses_up(self.report.pairs) || stop_at_event && self.events.are_due() {
                    return time;
                }
            } else if let Some(entry) = self.event_queue.next_until(grid) {
                if self.spent > self.impact_budget() {
                    self.give_up(entry);
                    continue;
                }
                self.strike_entry(&entry);
                if self.work.uses_up(self.report.pairs) || stop_at_event && self.events.are_due() {
                    return entry.time;
                }
            } else if self.is_substepping() && self.clock.is_due(end) {
                let time = self.clock.next();
                self.begin_substep();
                if self.work.uses_up(self.report.pairs) || stop_at_event && self.events.are_due() {
                    return time;
                }
            } else {
                return end;
            }
        }
    }

    /// An impact that is due, unless its bodies have other motions by now.
    pub(crate) fn strike_entry(&mut self, entry: &Entry) {
        let Some(pair) = self.pairs.find_same(entry.pair, entry.key) else {
            return;
        };
        let (a, b) = pair.bodies;
        let now = (self.bodies.version(a), self.bodies.version(b));
        // An analytic body is struck with all that holds it: by the impact that is foreseen once it has landed.
        if now == entry.versions
            && (self.hand_back_of(a, entry.time) | self.hand_back_of(b, entry.time))
        {
            return;
        }
        let mut rests = self.strike_or_rest(entry, Slow::Rests);
        let now = (self.bodies.version(a), self.bodies.version(b));
        let closed = |index: u32| self.bodies.get(index).membership.is_closed();
        let held = closed(a) || closed(b);
        let turns = self
            .pairs
            .find_same(entry.pair, entry.key)
            .is_some_and(|pair| pair.turning_rest > 0.0);
        if rests && turns && now == entry.versions && !held {
            rests = self.strike_or_rest(entry, Slow::Stops);
        }
        // It goes on closing until the solver holds it with the next sub-step.
        self.report.handed_over += u64::from(rests && !held);
    }

    /// The same; what is too slow to bounce rests, if nothing else is asked of it. Whether it does.
    fn strike_or_rest(&mut self, entry: &Entry, slow: Slow) -> bool {
        let struck = strike(
            &self.settings,
            &mut self.bodies,
            &self.colliders,
            &mut self.pairs,
            &mut self.narrow,
            entry,
            self.clock.h,
            slow,
            &mut self.events,
            &mut self.report,
        );
        match struck {
            Struck::Nothing => {}
            Struck::Rests => {
                if slow == Slow::Stops {
                    return true;
                }
                self.predict(entry.pair, entry.time);
                let (a, b) = self.pairs.get(entry.pair).bodies;
                // No motion has changed, but an island has one contact more: its modes are solved for once.
                self.gain_contact(a, entry.time);
                if !self.share_group(a, b) {
                    self.gain_contact(b, entry.time);
                }
                return true;
            }
            Struck::Impact {
                changed,
                operations,
            } => {
                self.work.impact(operations);
                let lost = price(&self.pairs.get(entry.pair).material);
                self.spent += lost;
                self.rush(&changed, lost, entry.time);
                // Wake sleeping bodies first: the contact search below skips sleepers. Failed mode solves are void.
                for &index in &changed {
                    self.bodies.get_mut(index).membership.forget();
                    if self.bodies.get(index).is_asleep() {
                        self.wake(index, entry.time);
                    }
                }
                self.go_on(&changed, entry.time);
                for index in changed {
                    self.deflected(index, entry.time);
                }
            }
        }
        false
    }

    /// Solves for the islands of bodies that an impact `changed`: their other members get new motions, too.
    fn go_on(&mut self, changed: &[u32], time: SimTime) {
        let moved = self.groups.go_on(
            &mut self.bodies,
            &mut self.pairs,
            changed,
            time,
            &mut self.report,
        );
        for index in moved {
            if !changed.contains(&index) {
                self.redirect(index, time);
            }
        }
    }

    /// A body with a new motion in the middle of a sub-step: its pairs are predicted again, and so
    /// are those of the contact group that it was or is in.
    pub(crate) fn deflected(&mut self, index: u32, time: SimTime) {
        if self.settings.mode == Mode::Stepped {
            // The next sub-step takes it from here.
            return self.bodies.touch(index);
        }
        self.hand_back_of(index, time);
        self.redirect(index, time);
        self.regroup(index, time);
    }

    /// A body with a new motion in the middle of a sub-step: it may leave its boxes, and all its
    /// pairs are predicted again.
    pub(crate) fn redirect(&mut self, index: u32, time: SimTime) {
        if self.steer(index, time) {
            for slot in 0..self.bodies.get(index).pairs.len() {
                self.predict(self.bodies.get(index).pairs[slot], time);
            }
        }
    }

    /// As [`Self::redirect`], but for predictions; whether there are any to make.
    pub(crate) fn steer(&mut self, index: u32, time: SimTime) -> bool {
        if self.bodies.get(index).is_asleep() {
            self.wake(index, time);
        }
        let state = self.bodies.get(index);
        if state.in_engine() {
            return false;
        }
        if state.goes_by_events() {
            self.foresee(index, time, Cause::Arrived, None);
            return false;
        }
        let left = (self.clock.next() - time).max(0.0);
        let state = self.bodies.get(index);
        if left > 0.0 && state.is_stepped() && !state.member && self.bodies.bends(index) {
            fly(&mut self.bodies, index, time, left);
        }
        self.refit(index, time, left);
        // What rests from now on may lie in the way of what is sub-stepped, too.
        if !self.bodies.get(index).is_stepped() {
            self.show(index, time);
        }
        true
    }

    /// Predicts impacts of all free bodies near a body that rests with it.
    pub(crate) fn show(&mut self, index: u32, time: SimTime) {
        let mut free = Vec::new();
        for &at in &self.bodies.get(index).colliders.clone() {
            let bounds = self.colliders[at as usize].fat;
            self.free.overlapping(&self.bodies, bounds, &mut free);
            for &body in &free {
                self.approach_shape(body, at, time, Cause::Arrived);
            }
            // Those in the tree are few and large.
            for other in self.broad.in_tree(&self.colliders, bounds) {
                let owner = self.colliders[other as usize].body;
                if self.bodies.get(owner).goes_by_events() {
                    self.approach_shape(owner, at, time, Cause::Arrived);
                }
            }
        }
    }

    /// What lies beside a body that started asleep must be known before either is struck.
    pub(crate) fn look_at_fresh(&mut self, time: SimTime) {
        for place in core::mem::take(&mut self.pairs.fresh) {
            let Some(pair) = self.pairs.find(place).filter(|pair| pair.fresh) else {
                continue;
            };
            let (a, b) = pair.bodies;
            if self.bodies.get(a).is_stepped() || self.bodies.get(b).is_stepped() {
                continue;
            }
            let pair = self.pairs.get_mut(place);
            pair.fresh = false;
            self.narrow
                .look(&self.bodies, &self.colliders, pair, time, self.clock.h);
        }
    }

    /// Wakes a body and all sleepers that it touches, and so on.
    pub(crate) fn wake(&mut self, index: u32, time: SimTime) {
        let woken = self.woken_with(index, time);
        self.resume_woken(&woken, time);
    }

    /// Ends the sleep of a body and all sleepers that it touches, and so on; returns them.
    pub(crate) fn woken_with(&mut self, index: u32, time: SimTime) -> Vec<u32> {
        if self.is_engines(index) {
            self.wake_in_engine(index, time);
            return Vec::new();
        }
        self.look_at_fresh(time);
        let mut woken = Vec::new();
        wake(
            &mut self.bodies,
            &self.pairs,
            index,
            time,
            &mut self.events,
            &mut woken,
        );
        self.wake_members(&mut woken, time);
        woken
    }

    /// Takes those out of bodies that wake which the engine has: it wakes them.
    fn wake_members(&mut self, woken: &mut Vec<u32>, time: SimTime) {
        let has = |index: &u32| self.bodies.get(*index).in_engine();
        let (members, others) = core::mem::take(woken)
            .into_iter()
            .partition::<Vec<_>, _>(has);
        *woken = others;
        for index in members {
            self.wake_in_engine(index, time);
        }
    }

    /// Wakes all sleepers that touch a body, and itself: what held them has changed.
    pub(crate) fn wake_around(&mut self, index: u32, time: SimTime) {
        if self.is_engines(index) {
            return self.wake_in_engine(index, time);
        }
        self.hand_back_around(index, time);
        self.look_at_fresh(time);
        let mut woken = Vec::new();
        wake_around(
            &mut self.bodies,
            &self.pairs,
            index,
            time,
            &mut self.events,
            &mut woken,
        );
        self.wake_members(&mut woken, time);
        self.resume_woken(&woken, time);
    }

    /// Begins to sub-step bodies that woke, and makes their pairs with the free bodies near them.
    pub(crate) fn resume_woken(&mut self, woken: &[u32], time: SimTime) {
        if self.settings.mode == Mode::Stepped {
            return;
        }
        let mut were_analytic = false;
        for &index in woken {
            let membership = self.bodies.get(index).membership;
            were_analytic |= membership.is_closed();
            self.dissolve(membership.group, time);
        }
        if !were_analytic && self.many_woke(woken, time) {
            return;
        }
        for &index in woken {
            self.begin_substepping(index, time);
        }
        for &index in woken {
            self.meet_near(index);
            for slot in 0..self.bodies.get(index).pairs.len() {
                self.predict(self.bodies.get(index).pairs[slot], time);
            }
        }
        self.drop_unheld(woken, time);
    }

    /// Makes the pairs of a body's boxes in the tree with what is near them, free bodies too.
    pub(crate) fn meet_near(&mut self, index: u32) {
        let free = |bodies: &Bodies, bounds: Aabb, near: &mut Vec<u32>| {
            self.free.overlapping(bodies, bounds, near);
        };
        for slot in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[slot];
            if self.colliders[at as usize].node.is_some() {
                self.broad.meet(
                    &mut self.bodies,
                    &self.colliders,
                    &mut self.pairs,
                    at,
                    Some(&free),
                );
            }
        }
    }

    /// A pair of a free body and a shape of a body that is sub-stepped.
    pub(crate) fn pair_free_body(&mut self, index: u32, at: u32) {
        for slot in 0..self.bodies.get(index).colliders.len() {
            let mine = self.bodies.get(index).colliders[slot];
            self.broad
                .pair_up(&mut self.bodies, &self.colliders, &mut self.pairs, mine, at);
        }
    }

    pub(crate) fn refit(&mut self, index: u32, time: SimTime, h: f64) {
        self.refit_among(index, time, h, true);
    }

    /// [`Self::refit`]; `meets`: free bodies in the new boxes are found.
    pub(crate) fn refit_among(&mut self, index: u32, time: SimTime, h: f64, meets: bool) {
        let free = |bodies: &Bodies, bounds: Aabb, near: &mut Vec<u32>| {
            self.free.overlapping(bodies, bounds, near);
        };
        let free: &Overlapping<'_> = &free;
        self.broad.refit(
            &mut self.bodies,
            &mut self.colliders,
            &mut self.pairs,
            index,
            time,
            h,
            meets.then_some(free),
        );
        self.look_down_first(time);
    }

    pub(crate) fn predict(&mut self, place: u32, time: SimTime) {
        predict(
            &self.bodies,
            &self.colliders,
            &mut self.pairs,
            &mut self.narrow,
            &mut self.event_queue,
            &mut self.report,
            place,
            time,
            self.clock.next(),
            self.clock.h,
        );
    }
}
