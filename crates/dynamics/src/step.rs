//! The story of a step: impacts in order of time, sub-steps on their grid, then the caller's look.

use carom_math::SimTime;

use crate::events::resolve::{PairImpact, Struck, strike};
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
            self.begin_forces(end);
            // What the solver gave them lasts to the end of its sub-step, in whichever step that is.
            if self.is_substepping() && self.clock.next() - start > 1e-9 * self.clock.h {
                self.report.handed_over += self.handed_over;
            }
        }
        // What the caller's changes brought about is told first.
        if !stop_at_event || !self.events.are_due() {
            let reached = if self.settings.mode == Mode::Stepped {
                self.with_engine(|world, stepping| world.step_all(stepping, end, stop_at_event))
                    .unwrap_or(end)
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
        if dt > 0.0 {
            self.report_waiting(self.clock.now);
        }
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

    /// Events and sub-steps, whichever comes first, up to `end`.
    fn advance(&mut self, end: SimTime, stop_at_event: bool) -> SimTime {
        let mut reached = self.clock.now;
        loop {
            let grid = if self.is_substepping() {
                end.min(self.clock.next())
            } else {
                end
            };
            let due = |time: &SimTime| *time <= grid;
            let change = self.closed.next().filter(due);
            let flight = self.free.next(&self.bodies, grid);
            let next = [change, flight].into_iter().flatten().min();
            let next = next.unwrap_or(grid).min(grid);
            if next > reached && self.settle(reached) {
                if stop_at_event && self.events.are_due() {
                    return reached;
                }
                continue;
            }
            debug_assert!(next <= reached || self.closed.to_begin(false).is_empty());
            reached = next.max(reached);
            let time = if let Some(time) = change
                && flight.is_none_or(|flight| time <= flight)
            {
                self.change_group();
                time
            } else if let Some(time) = flight {
                self.run_free_bodies();
                time
            } else if self.is_substepping() && self.clock.is_due(end) {
                let time = self.clock.next();
                self.begin_substep();
                time
            } else {
                return end;
            };
            if self.work.uses_up(self.report.pairs) || stop_at_event && self.events.are_due() {
                return time;
            }
        }
    }

    /// An impact of a pair of which one body may be in an island that was just given back.
    pub(crate) fn strike_pair(&mut self, impact: &PairImpact) {
        let time = impact.time;
        let (a, b) = self.pairs.get(impact.pair).bodies;
        let struck = strike(
            &self.settings,
            &mut self.bodies,
            &mut self.pairs,
            impact,
            &mut self.events,
            &mut self.report,
        );
        match struck {
            Struck::Exhausted => {
                for index in [a, b] {
                    self.join(index, time);
                }
            }
            Struck::Rests => {
                // No motion has changed, but an island has one contact more: its modes are solved for once.
                for index in [a, b] {
                    let known = index == b && self.share_group(a, b);
                    if !self.land(index, time) && !known {
                        self.gain_contact(index, time);
                    }
                }
            }
            Struck::Impact {
                changed,
                operations,
            } => {
                self.work.impact(operations);
                let material = self.pairs.get(impact.pair).material;
                self.rush(&changed, 1.0 - material.restitution, time);
                // Wake sleeping bodies first: the contact search below skips sleepers. Failed mode solves are void.
                for &index in &changed {
                    self.bodies.get_mut(index).membership.forget();
                    if self.bodies.get(index).is_asleep() {
                        self.wake(index, time);
                    }
                }
                for index in changed {
                    self.deflected(index, time);
                }
            }
        }
    }
}
