//! The budget of mode solves: an island that exhausts it joins the engine.
//!
//! A mode solve of an island takes as long as hundreds of the engine's sub-steps. Each body has a budget that refills with time; a
//! solve of n bodies charges each of them n. The budget is the body's alone: no island depends on another.

use carom_math::{SimTime, Vec2};

use super::store::Closed;
use crate::BodyIx;
use crate::analytic::modes::BodyMove;
use crate::analytic::touching::Gathered;
use crate::store::bodies::Bodies;
use crate::store::state::BodyState;

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
    pub(crate) fn reset_budget(&mut self, index: BodyIx) {
        if let Some(budget) = self.budgets.get_mut(index) {
            *budget = ModeBudget::default();
        }
    }

    /// Charges each body of an island for a mode solve, with ticks of `tick` seconds.
    pub(crate) fn charge(&mut self, members: &[BodyIx], time: SimTime, tick: f64) {
        let cost = members.len() as f64;
        for &index in members {
            let budget = self.budgets.grown(index, ModeBudget::default());
            if budget.charge(cost, time, tick) {
                self.exhausted.push(index);
            }
        }
    }

    /// Takes out the bodies with exhausted budgets, in order.
    pub(crate) fn take_exhausted(&mut self) -> Vec<BodyIx> {
        let mut exhausted = core::mem::take(&mut self.exhausted);
        exhausted.sort_unstable();
        exhausted.dedup();
        exhausted
    }
}

/// Whether a mode change at `time` changes motions: not over a seam of tiles, or in the next stretch of a path.
pub(crate) fn changes_motion(
    bodies: &Bodies,
    gathered: &Gathered,
    moves: &[BodyMove],
    time: SimTime,
) -> bool {
    let mut both = gathered.places.iter().zip(moves);
    both.any(|(&index, moved)| changes(bodies.get(index), moved, time))
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
