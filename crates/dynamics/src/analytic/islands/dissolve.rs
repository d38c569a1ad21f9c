//! Analytic islands that end: their members go on as they are, or without the forces of the island.

use carom_math::SimTime;

use super::store::Group;
use crate::World;
use crate::motion::flight::fly;

impl World {
    /// Whether a body feels forces of an analytic island that is no more.
    pub(super) fn feels_island(&self, index: u32) -> bool {
        let state = self.bodies.get(index);
        state.member && !state.membership.is_closed()
    }

    /// Bodies of an island that is no more go on without its forces: these were equal and opposite, and what one body no longer
    /// feels must not act on another until the sub-step ends.
    pub(super) fn drop_forces(&mut self, members: &[u32], time: SimTime) {
        let left = self.clock.next() - time;
        for &index in members {
            let state = self.bodies.get(index);
            let moves = state.is_stepped() && !state.in_engine();
            if left > 0.0 && moves && self.feels_island(index) {
                fly(&mut self.bodies, index, time, left);
                self.redirect(index, time);
            }
        }
    }

    /// Takes a group apart; its members keep their motions until they are given others.
    pub(crate) fn dissolve(&mut self, place: u32, time: SimTime) -> Vec<u32> {
        self.land_group(place, time, true);
        let Some(group) = self.closed.remove(place) else {
            return Vec::new();
        };
        let (heat, driven) = group.works(time - group.since);
        self.bodies.book.friction.add(heat);
        self.bodies.book.external.add(driven);
        self.bodies.book.scheme.add(heat - driven);
        let members: Vec<u32> = group.members.iter().map(|(index, _)| *index).collect();
        for &index in &members {
            self.bodies.get_mut(index).leave_island();
        }
        self.leave_path(&group, time);
        members
    }

    /// A body is free from here on; the modes of its group are solved for without it.
    pub(crate) fn leave_group(&mut self, index: u32, time: SimTime) {
        let place = self.bodies.get(index).membership.group;
        if let Some(group) = self.closed.get(place) {
            let speed = group.speed;
            let mut members = self.dissolve(place, time);
            members.retain(|member| *member != index);
            self.solve_modes_of(&members, time, speed);
        }
    }

    /// A pair is no more: a group that it held together is taken apart.
    pub(crate) fn loosen(&mut self, pair: u32, bodies: (u32, u32), time: SimTime) {
        for index in [bodies.0, bodies.1] {
            let place = self.bodies.get(index).membership.group;
            let group = self.closed.get(place);
            let holds = |group: &Group| group.touches.iter().any(|touch| touch.pair == pair);
            if group.is_some_and(holds) {
                if self.bodies.get(index).is_asleep() {
                    self.wake(index, time);
                }
                let members = self.dissolve(place, time);
                self.drop_forces(&members, time);
            }
        }
    }
}
