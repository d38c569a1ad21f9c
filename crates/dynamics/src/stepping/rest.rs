//! Sleep: bodies that fell asleep or woke in the engine are told of, and changes by a caller wake what they touch.

use carom_math::SimTime;

use super::{Stepping, place};
use crate::{EventKind, Mode, World};

impl Stepping {
    /// Notes bodies that fell asleep or woke, to tell of them.
    fn note_sleep(&mut self) {
        let slept = &mut self.slept;
        self.engine.sleep_changes(|id, _| slept.push(id));
    }
}

impl World {
    /// Tells of bodies that fell asleep or woke.
    pub(super) fn tell_sleep(&mut self, stepping: &mut Stepping, time: SimTime) {
        let mut laid = Vec::new();
        stepping.note_sleep();
        let mut changed = core::mem::take(&mut stepping.slept);
        changed.sort_unstable();
        changed.dedup();
        let mut told: Vec<_> = (changed.into_iter())
            .filter_map(|id| Some((stepping.engine.state(id).ok()?, id)))
            .collect();
        told.sort_unstable_by_key(|(state, _)| place(state));
        for (state, id) in told {
            let asleep = stepping.engine.is_asleep(id).unwrap_or(false);
            let index = place(&state);
            let known = self.bodies.get(index);
            if known.is_asleep() == asleep {
                continue;
            }
            if self.may_join() && !asleep {
                self.joins.woken.push(index);
                if !known.in_engine() {
                    // A guest wakes with all that sleeps in touch with it.
                    continue;
                }
                // No sub-steps were counted while all slept.
                if !self.is_substepping() {
                    self.clock.catch_up(time);
                }
            }
            let known = self.bodies.get_mut(index);
            known.slow_for = 0.0;
            let id = known.id;
            let kind = if asleep {
                self.bodies.fall_asleep(index);
                EventKind::Asleep(id)
            } else {
                self.bodies.wake(index);
                EventKind::Awake(id)
            };
            self.events.push(time, kind);
            if asleep {
                self.write_rest(&state, time);
                if self.bodies.get(index).in_engine() {
                    laid.push(index);
                }
            }
        }
        // Free bodies meet them as bodies at rest.
        for index in laid {
            self.refit_among(index, time, self.clock.h, false);
            self.show(index, time);
        }
    }

    /// Bodies that fell asleep in a sub-step lie there from its end on, which is told when time has come to it.
    pub(super) fn lay_members(&mut self, stepping: &mut Stepping) {
        let reached = self.clock.next();
        let known = stepping.slept.len();
        stepping.note_sleep();
        for &id in &stepping.slept[known..] {
            let Ok(state) = stepping.engine.state(id) else {
                continue;
            };
            let asleep = stepping.engine.is_asleep(id).unwrap_or(false);
            if asleep && self.bodies.get(place(&state)).in_engine() {
                self.write_rest(&state, reached);
            }
        }
    }

    /// Whether the sleep of a body is the engine's to end.
    pub(crate) fn is_engines(&self, index: u32) -> bool {
        self.settings.mode == Mode::Stepped || self.bodies.get(index).in_engine()
    }

    /// Wakes a body, what sleeps with it and what sleeps in touch with it.
    pub(crate) fn wake_in_engine(&mut self, index: u32, time: SimTime) {
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        if let Some(id) = stepping.id(index) {
            let told = stepping.engine.wake(id);
            debug_assert!(told.is_ok(), "{told:?}");
            self.tell_sleep(&mut stepping, time);
            for woken in self.joins.woken.clone() {
                self.wait(woken, time);
            }
        }
        self.stepping = Some(stepping);
        self.take_woken(time);
        // The engine does not know it yet.
        let state = self.bodies.get(index);
        if state.is_asleep() {
            let id = state.id;
            self.bodies.wake(index);
            self.events.push(time, EventKind::Awake(id));
        }
    }
}
