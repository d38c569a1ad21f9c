//! The story of a step: impacts in order of time, sub-steps on their grid, then the caller's look.

use carom_math::SimTime;

use crate::flight::fly;
use crate::predict::{predict, price};
use crate::resolve::{Struck, strike};
use crate::sleep::wake;
use crate::{Refusal, StepReport, World};

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
        self.events.begin_step();
        self.spent = 0.0;
        self.stopwatch.start();
        if self.report.refused.is_some() {
            self.events.end_step();
            return self.report;
        }
        let start = self.clock.now;
        let end = start + dt;
        if dt > 0.0 {
            self.begin_forces();
        }
        // What the caller's changes brought about is told first.
        if !stop_at_event || self.events.is_empty() {
            self.clock.now = self.advance(end, stop_at_event);
        }
        self.stopwatch.lap(|p| &mut p.impacts);
        if dt > 0.0 {
            self.end_forces();
        }
        self.events.end_step();
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
            let grid = end.min(self.clock.next());
            let change = self.closed.next().filter(|time| *time <= grid);
            if let Some(time) = change
                && self.agenda.next().is_none_or(|entry| time <= entry)
            {
                self.change_group();
                if stop_at_event && !self.events.is_empty() {
                    return time;
                }
            } else if let Some(entry) = self.agenda.next_until(grid) {
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
                let time = self.clock.next();
                self.begin_substep();
                if stop_at_event && !self.events.is_empty() {
                    return time;
                }
            } else {
                return end;
            }
        }
    }

    /// A body with a new motion in the middle of a sub-step: its pairs are predicted again, and so
    /// are those of the contact group that it was or is in.
    pub(crate) fn deflected(&mut self, index: u32, time: SimTime) {
        self.redirect(index, time);
        self.regroup(index, time);
    }

    /// A body with a new motion in the middle of a sub-step: it may leave its boxes, and all its
    /// pairs are predicted again.
    pub(crate) fn redirect(&mut self, index: u32, time: SimTime) {
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

    pub(crate) fn predict(&mut self, place: u32, time: SimTime) {
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
}
