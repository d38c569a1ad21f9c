//! Analytic islands at rest: they leave the sub-steps at once, and fall asleep after a while.

use carom_math::SimTime;

use crate::{EventKind, World};

impl World {
    /// Islands that came to rest since the last time leave the sub-steps: a body that meets one wakes it, as if it slept.
    pub(crate) fn begin_analytic_rest(&mut self, time: SimTime) {
        let still = self.closed.take_still();
        if still.is_empty() {
            return;
        }
        let mut lying = Vec::new();
        for place in still {
            let Some(group) = self.closed.get(place) else {
                continue;
            };
            for touch in &group.touches {
                touch.carry(&self.bodies, self.pairs.get_mut(touch.pair), self.clock.h);
            }
            for &(index, _) in &group.members {
                self.bodies.get_mut(index).begin_analytic_rest();
                lying.push(index);
            }
        }
        lying.sort_unstable();
        self.pairs.end_substepping_all(&mut self.stepped, &lying);
        for index in lying {
            self.lie_down(index, time);
        }
        self.lower_free_boxes_later();
        self.pairs.sort(&self.bodies, &self.stepped);
    }

    /// An analytic island that has been at rest for long enough falls asleep.
    pub(super) fn fall_asleep(&mut self, place: u32, time: SimTime) {
        let members = self.dissolve(place, time);
        let mut lying = Vec::new();
        for &index in &members {
            if self.bodies.fall_asleep(index) {
                lying.push(index);
            }
            let id = self.bodies.get(index).id;
            self.events.push(time, EventKind::Asleep(id));
        }
        for index in lying {
            self.lie_down(index, time);
        }
    }
}
