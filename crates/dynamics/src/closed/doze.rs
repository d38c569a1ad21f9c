//! Groups at rest in closed form: they leave the sub-steps at once, and fall asleep after a while.

use carom_math::SimTime;

use crate::{EventKind, World};

impl World {
    /// Groups that came to rest since the last time leave the sub-steps: what meets one wakes it, as if it slept.
    pub(crate) fn doze(&mut self, time: SimTime) {
        let still = self.closed.take_still();
        if still.is_empty() {
            return;
        }
        let mut lying = Vec::new();
        for place in still {
            let Some(group) = self.closed.get_mut(place) else {
                continue;
            };
            group.dozes = true;
            for touch in &group.touches {
                touch.carry(&self.bodies, self.pairs.get_mut(touch.pair), self.clock.h);
            }
            for &(index, _) in &group.members {
                let state = self.bodies.get_mut(index);
                (state.asleep, state.dozes) = (true, true);
                lying.push(index);
            }
        }
        lying.sort_unstable();
        self.discharge_all(&lying);
        for index in lying {
            self.lie_down(index, time);
        }
        self.lower_flyers_later();
        self.pairs.sort(&self.bodies, &self.stepped);
    }

    /// A group that has been at rest for long enough falls asleep.
    pub(super) fn lull(&mut self, place: u32, time: SimTime) {
        let members = self.dissolve(place, time);
        let mut lying = Vec::new();
        for &index in &members {
            let state = self.bodies.get_mut(index);
            state.asleep = true;
            if !core::mem::take(&mut state.dozes) {
                lying.push(index);
            }
            self.events.push(time, EventKind::Asleep(state.id));
        }
        for index in lying {
            self.lie_down(index, time);
        }
    }
}
