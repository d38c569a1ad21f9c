//! Sub-steps of the engine: of all bodies in [`Mode::Stepped`], of its members in the other modes ([`crate::members`]).

use carom_math::SimTime;

use crate::stepping::rules::Rules;
use crate::stepping::{Stepping, accepted, place};
use crate::{BodyIx, EventKind, Mode, World};

impl World {
    /// Calls `f` with the engine beside the world; the engine is back in its place afterwards.
    pub(crate) fn with_engine<R>(
        &mut self,
        f: impl FnOnce(&mut Self, &mut Stepping) -> R,
    ) -> Option<R> {
        let mut stepping = self.stepping.take()?;
        let result = f(self, &mut stepping);
        self.stepping = Some(stepping);
        Some(result)
    }

    /// Sub-steps up to `end`; when they stopped.
    pub(crate) fn step_all(
        &mut self,
        stepping: &mut Stepping,
        end: SimTime,
        stop_at_event: bool,
    ) -> SimTime {
        self.enter_within(stepping);
        if end > self.clock.now && self.clock.is_within(self.clock.now) {
            // What the engine did lasts to the end of its sub-step, and what came meanwhile knows of no contact before.
            self.report.handed_over += stepping.engine.awake_count() as u64;
        }
        let mut first = true;
        while self.clock.is_due(end) {
            if first {
                self.enter_changed(stepping, self.clock.next(), self.clock.now);
            } else if self.bodies.history.is_kept() {
                stepping.write_all(&mut self.bodies, &self.clock);
            }
            let forced = self.all_forced();
            stepping.book_pulls(&mut self.bodies, &forced, &self.clock, first);
            self.push_in_substep(stepping, self.clock.next());
            first = false;
            self.clock.begin();
            self.report.substeps += 1;
            stepping.note_places(self.bodies.history.is_kept() || self.clock.is_within(end));
            self.substep_engine(stepping);
            let reached = self.clock.next().min(end);
            self.tell_sleep(stepping, reached);
            self.tell_impacts(stepping, reached);
            if stepping.engine.is_at_tick() || stop_at_event {
                self.tell_touches(stepping, reached);
            }
            if self.clock.is_due(end) && self.work.uses_up(self.report.pairs)
                || stop_at_event && self.events.are_due()
            {
                self.tell_touches(stepping, reached);
                stepping.write_all(&mut self.bodies, &self.clock);
                return reached;
            }
        }
        if !first {
            self.tell_touches(stepping, self.clock.next().min(end));
            stepping.write_all(&mut self.bodies, &self.clock);
            self.stopwatch.lap(|p| &mut p.contacts);
        } else if !self.clock.is_within(end) {
            stepping.end_motions(&mut self.bodies, &self.clock);
        }
        end
    }

    pub(crate) fn substep_engine(&mut self, stepping: &mut Stepping) {
        let (looks, stopped) = (stepping.engine.looks(), stepping.engine.stopped_count());
        self.search_contacts(stepping);
        stepping.engine.advance();
        self.invite_ahead(stepping, self.clock.h);
        stepping.engine.finish(&self.rules());
        self.book_drive(stepping);
        self.report.pairs += stepping.engine.looks() - looks;
        self.report.stopped += stepping.engine.stopped_count() - stopped;
        let deepest = stepping.engine.deepest_overlap();
        self.report.deepest_overlap = self.report.deepest_overlap.max(deepest);
        self.report.rows += stepping.engine.awake_contact_count() as u64;
        self.report.handed_over += stepping.engine.awake_count() as u64;
        self.stopwatch.lap(|p| &mut p.solver);
    }

    /// Contacts of the sub-step that begins; whether some body came, or deviates from its predicted motion.
    pub(crate) fn search_contacts(&mut self, stepping: &mut Stepping) -> bool {
        stepping.search_contacts(
            &mut self.bodies,
            &self.broad,
            self.settings.mode,
            self.clock.now,
        )
    }

    fn invite_ahead(&mut self, stepping: &mut Stepping, left: f64) {
        if self.settings.mode != Mode::Stepped {
            stepping.invite_ahead(&mut self.bodies, &self.broad, self.clock.now, left);
        }
    }

    pub(crate) fn rules(&self) -> Rules<'_> {
        Rules {
            bodies: &self.bodies,
            broad: &self.broad,
        }
    }

    /// Enters bodies that came or were changed, before the sub-step from `time` on. Bodies that this wakes are reported at `told`.
    pub(crate) fn enter_changed(&mut self, stepping: &mut Stepping, time: SimTime, told: SimTime) {
        stepping.enter_changed(&mut self.bodies, self.settings.mode, time);
        self.tell_sleep(stepping, told);
        self.stopwatch.lap(|p| &mut p.contacts);
    }

    /// Before time goes on within a sub-step in which a caller changed bodies: continuous collision for its rest.
    ///
    /// The engine has bodies at the poses that the sub-step ends with. A body that would pass through another one until then is
    /// stopped, keeps its velocity, and is shown to move there evenly.
    pub(crate) fn enter_within(&mut self, stepping: &mut Stepping) {
        let (now, end) = (self.clock.now, self.clock.next());
        if self.bodies.touched.is_empty() || !self.clock.is_within(now) {
            return;
        }
        let under_way = stepping.engine.fast();
        let under_way = under_way.filter_map(|id| stepping.engine.state(id).ok());
        let mut going: Vec<BodyIx> = under_way.map(|state| place(&state)).collect();
        going.extend(&self.bodies.touched);
        going.sort_unstable();
        going.dedup();
        let touched = self.bodies.touched.clone();
        stepping.leave_ways(&mut self.bodies, &touched, &self.clock);
        self.enter_changed(stepping, end, now);
        stepping.carry(&self.bodies, &going, now);
        let left = end - now;
        self.invite_ahead(stepping, left);
        let stopped = stepping.engine.stop_fast(left, &self.rules());
        stepping.show_stopped(&mut self.bodies, stopped, now, left);
        // The engine has them there already.
        self.bodies.touched.clear();
    }

    /// Begins and ends of touch since this was last called, in order of shapes.
    pub(crate) fn tell_touches(&mut self, stepping: &mut Stepping, time: SimTime) {
        stepping.tell_touches(&self.bodies, &mut self.joins.told, &mut self.events, time);
    }

    /// Impacts that ended by `time`, the end of a sub-step.
    pub(crate) fn tell_impacts(&mut self, stepping: &mut Stepping, time: SimTime) {
        let (events, report) = (&mut self.events, &mut self.report);
        stepping.tell_impacts(&self.bodies, events, report, time);
    }

    /// Tells of bodies that fell asleep or woke.
    pub(crate) fn tell_sleep(&mut self, stepping: &mut Stepping, time: SimTime) {
        let was_substepping = self.is_substepping();
        let mode = self.settings.mode;
        let slept = stepping.tell_sleep(&mut self.bodies, &mut self.events, mode, time);
        self.joins.woken.extend(slept.woken);
        if slept.wakes_member && !was_substepping {
            self.clock.catch_up(time);
        }
        for index in slept.laid {
            self.refit(index, time, self.clock.h, false);
            self.show(index, time);
        }
    }

    /// Whether the sleep of a body is the engine's to end.
    pub(crate) fn is_engines(&self, index: BodyIx) -> bool {
        self.settings.mode == Mode::Stepped || self.bodies.get(index).in_engine()
    }

    /// Wakes a body, what sleeps with it and what sleeps in touch with it.
    pub(crate) fn wake_in_engine(&mut self, index: BodyIx, time: SimTime) {
        let there = self.with_engine(|world, stepping| {
            if let Some(id) = stepping.id(index) {
                accepted(stepping.engine.wake(id));
                world.tell_sleep(stepping, time);
                for woken in world.joins.woken.clone() {
                    world.wait(woken, time);
                }
            }
        });
        if there.is_none() {
            return;
        }
        self.take_woken(time);
        // The engine does not know it yet.
        let state = self.bodies.get(index);
        if state.is_asleep() {
            let id = state.id;
            self.bodies.wake(index);
            self.events.push(time, EventKind::Awake(id));
        }
    }

    /// A body that goes, or comes back as another one, leaves the engine; whether it was there: then its touches end, and sleepers
    /// on it wake, which is for the caller to see to.
    pub(crate) fn leave_engine(&mut self, index: BodyIx, time: SimTime) -> bool {
        let known = self.with_engine(|world, stepping| {
            let known = stepping.id(index).is_some();
            if known {
                // What time goes on from is a caller's to change; the engine itself lets go what has no contact.
                if time == world.clock.now {
                    stepping.leave_ways(&mut world.bodies, &[index], &world.clock);
                }
                stepping.remove(index);
                world.tell_sleep(stepping, time);
            }
            known
        });
        self.bodies.get_mut(index).is_guest &= known.is_none();
        known.unwrap_or(false)
    }

    /// Asks anew how the contacts of a body meet, in the engine.
    pub(crate) fn resurface(&mut self, index: BodyIx) {
        self.with_engine(|world, stepping| {
            if let Some(id) = stepping.id(index) {
                accepted(stepping.engine.resurface(id, &world.rules()));
            }
        });
    }
}
