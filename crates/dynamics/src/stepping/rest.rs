//! Sleep: bodies that fell asleep or woke in the engine are told of, and changes by a caller wake what they touch.

use carom_math::SimTime;

use super::{Stepping, place};
use crate::{EventKind, World};

impl World {
    /// Tells of bodies that fell asleep or woke.
    pub(super) fn tell_sleep(&mut self, stepping: &mut Stepping, time: SimTime) {
        let mut changed = Vec::new();
        stepping
            .engine
            .sleep_changes(|id, asleep| changed.push((id, asleep)));
        let mut told: Vec<_> = (changed.into_iter())
            .filter_map(|(id, asleep)| Some((stepping.engine.state(id).ok()?, asleep)))
            .collect();
        told.sort_unstable_by_key(|(state, _)| place(state));
        for (state, asleep) in told {
            let index = place(&state);
            let known = self.bodies.get_mut(index);
            if known.asleep == asleep {
                continue;
            }
            (known.asleep, known.slow_for) = (asleep, 0.0);
            let id = known.id;
            let kind = if asleep {
                EventKind::Asleep(id)
            } else {
                EventKind::Awake(id)
            };
            self.events.push(time, kind);
            if asleep {
                self.write_rest(&state, time);
            }
        }
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
        }
        self.stepping = Some(stepping);
        // The engine does not know it yet.
        let state = self.bodies.get_mut(index);
        if state.asleep {
            state.asleep = false;
            let id = state.id;
            self.events.push(time, EventKind::Awake(id));
        }
    }
}
