//! The story of a step: impacts in order of time, sub-steps on their grid, then the caller's look.

use carom_math::SimTime;

use crate::flight::fly;
use crate::predict::{BUDGET, predict, price};
use crate::resolve::{Struck, strike};
use crate::sleep::{settle, wake};
use crate::{EventKind, Refusal, StepReport, World};

/// More ticks than this in one step are refused.
const TICKS: f64 = 1e7;

impl World {
    /// Asks where everything is `dt` seconds later.
    ///
    /// `dt` only observes: sub-steps lie on a grid of their own, so a second in one step or in a
    /// hundred gives the same motions. 0 delivers events only. There is no error path: a negative,
    /// NaN, infinite or too long `dt` (over 1e7 ticks) moves nothing, and the report says so.
    pub fn step(&mut self, dt: f64) -> StepReport {
        self.run(dt, false)
    }

    /// Goes on until something happens (see [`World::events`]), at most `max` seconds.
    pub fn step_to_next_event(&mut self, max: f64) -> StepReport {
        self.run(max, true)
    }

    fn run(&mut self, dt: f64, stop_at_event: bool) -> StepReport {
        self.report = StepReport {
            refused: self.refusal(dt),
            ..StepReport::default()
        };
        self.events.clear();
        self.spent = 0.0;
        self.stopwatch.start();
        if self.report.refused.is_some() {
            return self.report;
        }
        let start = self.clock.now;
        let end = start + dt;
        if dt > 0.0 {
            self.begin_forces();
        }
        self.clock.now = self.advance(end, stop_at_event);
        self.stopwatch.lap(|p| &mut p.impacts);
        if dt > 0.0 {
            self.end_forces();
        }
        self.report.advanced = if stop_at_event {
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

    /// Entries of the agenda and sub-steps, whichever comes first, up to `end`.
    fn advance(&mut self, end: SimTime, stop_at_event: bool) -> SimTime {
        loop {
            if let Some(entry) = self.agenda.next_until(end.min(self.clock.next())) {
                if self.spent > self.impact_budget() {
                    self.give_up();
                    continue;
                }
                let struck = strike(
                    self.settings.impact_law,
                    &mut self.bodies,
                    &self.colliders,
                    &mut self.pairs,
                    &mut self.narrow,
                    &entry,
                    self.clock.h,
                    &mut self.events,
                    &mut self.report,
                );
                match struck {
                    Struck::Nothing => {}
                    Struck::Rests => self.predict(entry.pair, entry.time),
                    Struck::Impact(changed) => {
                        self.spent += price(self.pairs.get(entry.pair));
                        for index in changed {
                            self.deflected(index, entry.time);
                        }
                    }
                }
                if stop_at_event && !self.events.is_empty() {
                    return entry.time;
                }
            } else if self.clock.is_due(end) {
                self.begin_substep();
            } else {
                return end;
            }
        }
    }

    /// One sub-step: what touches is looked at, what lasts is solved for, the rest flies, and
    /// what will strike is entered into the agenda.
    fn begin_substep(&mut self) {
        let (time, h) = (self.clock.next(), self.clock.h);
        self.stopwatch.lap(|p| &mut p.impacts);
        self.clock.begin();
        self.agenda.clear();
        self.spent = 0.0;
        self.report.substeps += 1;
        self.guard(time);
        self.find_pairs(time, h);
        self.stopwatch.lap(|p| &mut p.pairs);
        self.look(time, h);
        self.stopwatch.lap(|p| &mut p.contacts);
        self.groups.step(
            &self.law,
            &mut self.bodies,
            &mut self.pairs,
            time,
            h,
            &mut self.report,
        );
        self.pairs_are_new();
        self.stopwatch.lap(|p| &mut p.solver);
        for index in self.active() {
            if !self.groups.pushed(index) {
                fly(&mut self.bodies, index, time, h);
            }
        }
        self.stopwatch.lap(|p| &mut p.flight);
        if let Some(sleep) = self.settings.sleep {
            settle(
                sleep,
                &mut self.bodies,
                &self.groups,
                time,
                h,
                &mut self.events,
            );
        }
        self.stopwatch.lap(|p| &mut p.sleep);
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            self.predict(place, time);
            i += 1;
        }
        self.stopwatch.lap(|p| &mut p.prediction);
    }

    /// Impacts of a sub-step before the rest of them is left to the solver: work stays bounded
    /// whatever was put where, at a body's own budget for every body.
    fn impact_budget(&self) -> f64 {
        256.0 + BUDGET * self.bodies.places() as f64
    }

    /// Leaves all impacts that are due in this sub-step to the next one's solver, and says so.
    fn give_up(&mut self) {
        while let Some(entry) = self.agenda.next_until(self.clock.next()) {
            let pair = self.pairs.get_mut(entry.pair);
            if !pair.given_up {
                pair.given_up = true;
                self.report.collapsed += 1;
            }
        }
    }

    /// Stops what is no longer finite.
    fn guard(&mut self, time: SimTime) {
        for index in self.active() {
            if !self.bodies.get(index).motion.is_finite() {
                self.report.stopped += 1;
                self.stop(index, time);
            }
        }
    }

    /// Boxes and pairs for the motions up to the end of the sub-step.
    fn find_pairs(&mut self, time: SimTime, h: f64) {
        for index in self.active() {
            self.refit(index, time, h);
        }
        self.pairs.sort();
        let mut gone = Vec::new();
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            if !self.broad.keeps(&self.colliders, self.pairs.get(place)) {
                gone.push(place);
            }
        }
        for place in gone {
            self.part(place, time);
        }
        self.pairs.sort();
    }

    /// Contacts of all near pairs; begins and ends of touch; what touches a sleeper wakes it.
    fn look(&mut self, time: SimTime, h: f64) {
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            let pair = self.pairs.get_mut(place);
            let (a, b) = pair.bodies;
            let active = (
                self.bodies.get(a).is_active(),
                self.bodies.get(b).is_active(),
            );
            pair.held = pair.lasting || pair.impacts > 0 || pair.material.restitution == 0.0;
            pair.lasting = false;
            (pair.impacts, pair.spent) = (0, 0.0);
            if active == (false, false) && !pair.fresh {
                pair.given_up = false;
                continue;
            }
            pair.fresh = false;
            let touched = pair.touching;
            self.narrow
                .look(&self.bodies, &self.colliders, pair, time, h);
            let touching = pair.touching;
            for point in pair.contacts.iter().flat_map(|contact| &contact.points) {
                self.report.deepest_overlap = self.report.deepest_overlap.max(-point.separation);
            }
            let (id_a, id_b) = (self.bodies.get(a).id, self.bodies.get(b).id);
            if touching && !touched {
                self.events
                    .push(time, EventKind::Begin { a: id_a, b: id_b });
            } else if touched && !touching {
                self.events.push(time, EventKind::End { a: id_a, b: id_b });
            }
            if touching && active != (false, false) {
                for index in [a, b] {
                    if self.bodies.get(index).asleep {
                        wake(&mut self.bodies, &self.pairs, index, time, &mut self.events);
                    }
                }
            }
        }
    }

    /// Budgets start anew once the solver has taken what was given up.
    fn pairs_are_new(&mut self) {
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            self.pairs.get_mut(place).given_up = false;
            i += 1;
        }
    }

    /// A body with a new motion in the middle of a sub-step: it may leave its boxes, and all its
    /// pairs are predicted again.
    pub(crate) fn deflected(&mut self, index: u32, time: SimTime) {
        if self.bodies.get(index).asleep {
            wake(&mut self.bodies, &self.pairs, index, time, &mut self.events);
        }
        let left = (self.clock.next() - time).max(0.0);
        let state = self.bodies.get(index);
        if left > 0.0 && state.is_active() && !state.member && !self.bodies.pull.fields.is_empty() {
            fly(&mut self.bodies, index, time, left);
        }
        self.refit(index, time, left);
        for slot in 0..self.bodies.get(index).pairs.len() {
            self.predict(self.bodies.get(index).pairs[slot], time);
        }
    }

    pub(crate) fn refit(&mut self, index: u32, time: SimTime, h: f64) {
        self.broad.refit(
            &mut self.bodies,
            &mut self.colliders,
            &mut self.pairs,
            index,
            time,
            h,
        );
    }

    fn predict(&mut self, place: u32, time: SimTime) {
        predict(
            &self.bodies,
            &self.colliders,
            &mut self.pairs,
            &mut self.narrow,
            &mut self.agenda,
            &mut self.report,
            place,
            time,
            self.clock.next(),
            self.clock.h,
        );
    }

    /// Places of all bodies that move by themselves.
    fn active(&self) -> Vec<u32> {
        self.bodies
            .indices()
            .filter(|i| self.bodies.get(*i).is_active())
            .collect()
    }
}
