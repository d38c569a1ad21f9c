//! The budget of mode solves: an island that exhausts it joins the engine.
//!
//! A mode solve of an island takes as long as hundreds of the engine's sub-steps. Each body has a budget that refills with time; a
//! solve of n bodies charges each of them n. The budget is the body's alone: no island depends on another.

use carom_math::{SimTime, Vec2};

use super::store::Closed;
use crate::analytic::modes::BodyMove;
use crate::analytic::touching::Gathered;
use crate::model::graph::neighbours;
use crate::store::state::BodyState;
use crate::{Mode, World};

/// Size of a budget, in mode solves of one body. 16: boxes that rock to rest (`tests/it/rocking.rs`) join before, and part from the
/// exact motion by 1.5e-5 m.
const SIZE: f64 = 24.0;

/// Ticks that refill one solve. A solve takes 35 µs, the engine 11 µs for a second of one rocking box.
const REFILL: f64 = 60.0;

/// Relative change of velocity or acceleration below which a mode change leaves a motion as it was.
const SAME: f64 = 1e-6;

/// What the islands of a body spent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ModeBudget {
    /// Instant of the last charge.
    at: SimTime,
    /// Spent by then, in mode solves of one body.
    spent: f64,
}

impl ModeBudget {
    /// Charges `cost` at `time`, with ticks of `tick` seconds; whether the budget was exhausted before.
    fn charge(&mut self, cost: f64, time: SimTime, tick: f64) -> bool {
        let refilled = (time - self.at) / (REFILL * tick);
        self.spent = (self.spent - refilled).max(0.0);
        self.at = time;
        let is_exhausted = self.spent > SIZE;
        self.spent += cost;
        is_exhausted
    }
}

impl Closed {
    /// Whether islands join with the next sub-step.
    pub(crate) const fn has_exhausted(&self) -> bool {
        !self.exhausted.is_empty()
    }

    /// A body is inserted: its place may be that of an earlier one.
    pub(crate) fn reset_budget(&mut self, index: u32) {
        if let Some(budget) = self.budgets.get_mut(index as usize) {
            *budget = ModeBudget::default();
        }
    }

    fn budget(&mut self, index: u32) -> &mut ModeBudget {
        let at = index as usize;
        if at >= self.budgets.len() {
            self.budgets.resize(at + 1, ModeBudget::default());
        }
        &mut self.budgets[at]
    }
}

/// Whether a mode change at `time` changes the motion of a body.
fn changes(state: &BodyState, moved: &BodyMove, time: SimTime) -> bool {
    let (motion, reach) = (&state.motion, state.reach);
    let differ = |was: Vec2, is: Vec2, turned: f64, turns: f64| {
        let step = (is - was).length().max((turns - turned).abs() * reach);
        let size = was.length().max(turned.abs() * reach);
        step > SAME * size
    };
    state.is_dynamic()
        && (differ(
            state.velocity_at(time),
            moved.velocity,
            state.spin_at(time),
            moved.spin,
        ) || differ(
            motion.acceleration,
            moved.acceleration,
            motion.angular_acceleration,
            moved.angular_acceleration,
        ))
}

impl World {
    /// Charges an island for a new mode, unless its motion is as before: over a seam of tiles, or in the next stretch of a path.
    pub(super) fn charge_change(&mut self, gathered: &Gathered, moves: &[BodyMove], time: SimTime) {
        if self.settings.mode != Mode::Hybrid {
            return;
        }
        let mut both = gathered.places.iter().zip(moves);
        if both.any(|(&index, moved)| changes(self.bodies.get(index), moved, time)) {
            self.charge(&gathered.dynamic(), time);
        }
    }

    /// Charges each body of an island for a mode solve.
    pub(super) fn charge(&mut self, members: &[u32], time: SimTime) {
        if self.settings.mode != Mode::Hybrid {
            return;
        }
        let (cost, tick) = (members.len() as f64, self.settings.tick);
        let was = self.is_substepping();
        for &index in members {
            if self.closed.budget(index).charge(cost, time, tick) {
                self.closed.exhausted.push(index);
            }
        }
        if !was && self.closed.has_exhausted() {
            self.clock.catch_up(time);
        }
    }

    /// Analytic islands with exhausted budgets join, unless they rest.
    pub(crate) fn join_exhausted(&mut self, time: SimTime) {
        let mut exhausted = core::mem::take(&mut self.closed.exhausted);
        if exhausted.is_empty() {
            return;
        }
        exhausted.sort_unstable();
        exhausted.dedup();
        for index in exhausted {
            if !self.bodies.is_alive(index) || self.bodies.get(index).is_asleep() {
                continue;
            }
            let Some(group) = self.closed.get(self.bodies.get(index).membership.group) else {
                continue;
            };
            let members: Vec<u32> = group.members.iter().map(|(index, _)| *index).collect();
            if group.sleeps || self.keeps_method(&members) {
                continue;
            }
            for index in members {
                self.join(index, time);
            }
        }
        self.lower_free_boxes_later();
    }

    /// Whether an island keeps its method in spite of an exhausted budget; its budget is full again then.
    fn keeps_method(&mut self, members: &[u32]) -> bool {
        let keeps = !self.is_borne(members);
        if keeps {
            for &index in members {
                self.closed.budget(index).spent = 0.0;
            }
        }
        keeps
    }

    /// Whether an island is held by what it does not move: of bodies that touch each other alone the engine does not keep the angular
    /// momentum.
    pub(crate) fn is_borne(&self, members: &[u32]) -> bool {
        let bears = |index: u32| {
            let other = self.bodies.get(index);
            !other.is_dynamic() || other.is_asleep() || other.in_engine()
        };
        let mut members = members.iter();
        members.any(|&index| neighbours(&self.bodies, &self.pairs, index).any(bears))
    }
}
