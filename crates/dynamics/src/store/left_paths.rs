//! Bodies that left an analytic island: they go on by the parabola of that instant, with the forces of then along the arms of then,
//! until the next sub-step or another motion. Neither energy nor angular momentum is kept, and reports say so.

use std::collections::BTreeMap;

use carom_math::{SimTime, Vec2};

use super::state::BodyState;

/// The bodies that left an island in the present sub-step.
#[derive(Clone, Debug, Default)]
pub(crate) struct LeftPaths {
    /// By body: one may leave several in a sub-step.
    list: BTreeMap<u32, Vec<LeftPath>>,
    /// Parabolas that no report tells of yet.
    untold: u64,
}

#[derive(Clone, Copy, Debug)]
struct LeftPath {
    acceleration: Vec2,
    left: SimTime,
    /// Until when its parabola was counted.
    counted: SimTime,
    /// Its island turned.
    turned: bool,
}

impl LeftPath {
    /// Whether the body still goes on by the parabola of that instant.
    fn goes_on(&self, state: &BodyState) -> bool {
        state.motion.acceleration == self.acceleration
            && state.is_stepped()
            && !state.membership.is_closed()
    }

    /// Counts the parabola of a body if it moved it since that was last asked.
    fn count(&mut self, state: &BodyState, time: SimTime) -> u64 {
        let moved = self.counted < time && self.goes_on(state);
        self.counted = time;
        u64::from(moved)
    }
}

impl LeftPaths {
    /// A body leaves an island, one that `turned` or not, and goes on by the parabola that it has.
    pub(crate) fn add(&mut self, index: u32, state: &BodyState, time: SimTime, turned: bool) {
        self.list.entry(index).or_default().push(LeftPath {
            acceleration: state.motion.acceleration,
            left: time,
            counted: time,
            turned,
        });
    }

    /// Whether a body goes on by the parabola of a path that it left.
    pub(crate) fn moves(&self, index: u32, state: &BodyState) -> bool {
        let mut list = self.list.get(&index).into_iter().flatten();
        list.any(|left| left.turned && left.goes_on(state))
    }

    /// A body gets another motion.
    pub(crate) fn end(&mut self, index: u32, state: &BodyState, time: SimTime) {
        for left in self.list.get_mut(&index).into_iter().flatten() {
            self.untold += left.count(state, time);
        }
    }

    /// How many parabolas moved a body before `now` that no report tells of yet. Bodies that do not go on so are forgotten, but where
    /// their motions depend on it: when this is asked changes no motion.
    pub(crate) fn tell(&mut self, bodies: &[BodyState], now: SimTime) -> u64 {
        self.list.retain(|index, list| {
            let state = &bodies[*index as usize];
            list.retain_mut(|left| {
                self.untold += left.count(state, now);
                left.turned || left.goes_on(state)
            });
            !list.is_empty()
        });
        core::mem::take(&mut self.untold)
    }

    /// A sub-step begins: what left a path before has another motion in it.
    pub(crate) fn begin_substep(&mut self, time: SimTime) {
        self.list.retain(|_, list| {
            list.retain(|left| left.left == time);
            !list.is_empty()
        });
    }
}
