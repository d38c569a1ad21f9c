//! Sleep: bodies that fell asleep or woke in the engine are told of.

use carom_math::SimTime;

use super::write::write_rest;
use super::{Stepping, place};
use crate::store::bodies::Bodies;
use crate::{BodyIx, EventKind, Events, Mode};

impl Stepping {
    /// Notes bodies that fell asleep or woke, to tell of them.
    fn note_sleep(&mut self) {
        let slept = &mut self.slept;
        self.engine.sleep_changes(|id, _| slept.push(id));
    }

    /// Tells of bodies that fell asleep or woke. Guests that woke stay asleep: they wake with all that sleeps in touch with them.
    pub(crate) fn tell_sleep(
        &mut self,
        bodies: &mut Bodies,
        events: &mut Events,
        mode: Mode,
        time: SimTime,
    ) -> Slept {
        let mut slept = Slept::default();
        self.note_sleep();
        let mut changed = core::mem::take(&mut self.slept);
        changed.sort_unstable();
        changed.dedup();
        let mut told: Vec<_> = (changed.into_iter())
            .filter_map(|id| Some((self.engine.state(id).ok()?, id)))
            .collect();
        told.sort_unstable_by_key(|(state, _)| place(state));
        for (state, id) in told {
            let asleep = self.engine.is_asleep(id).unwrap_or(false);
            let index = place(&state);
            let known = bodies.get(index);
            if known.is_asleep() == asleep {
                continue;
            }
            if mode != Mode::Stepped && !asleep {
                slept.woken.push(index);
                if !known.in_engine() {
                    continue;
                }
                slept.wakes_member = true;
            }
            let id = known.id;
            let kind = if asleep {
                bodies.fall_asleep(index);
                EventKind::Asleep(id)
            } else {
                bodies.wake(index);
                EventKind::Awake(id)
            };
            events.push(time, kind);
            if asleep {
                write_rest(bodies, &state, time);
                if bodies.get(index).in_engine() {
                    slept.laid.push(index);
                }
            }
        }
        slept
    }

    /// Bodies that fell asleep in a sub-step lie there from its end on, which is told when time has come to it.
    pub(crate) fn lay_members(&mut self, bodies: &mut Bodies, reached: SimTime) {
        let known = self.slept.len();
        self.note_sleep();
        for &id in &self.slept[known..] {
            let Ok(state) = self.engine.state(id) else {
                continue;
            };
            let asleep = self.engine.is_asleep(id).unwrap_or(false);
            if asleep && bodies.get(place(&state)).in_engine() {
                write_rest(bodies, &state, reached);
            }
        }
    }
}

/// What bodies that fell asleep or woke ask for.
#[derive(Debug, Default)]
pub(crate) struct Slept {
    /// Members that fell asleep: free bodies meet them as bodies at rest.
    pub(crate) laid: Vec<BodyIx>,
    /// Members and guests that woke.
    pub(crate) woken: Vec<BodyIx>,
    /// One of them is a member: no sub-steps were counted while all slept.
    pub(crate) wakes_member: bool,
}
