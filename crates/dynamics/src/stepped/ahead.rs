//! Sub-steps up to the next look, all at once: where nobody looks in between, and nothing can come up.

use crate::World;

/// After so many ticks at most it is tried again: in vain it costs a tick's sub-steps at most, and so a 64th of the time.
const LONGEST: u32 = 63;

/// How many sub-steps are made already, and when that is tried again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hurry {
    /// Sub-steps after the present one that are made.
    made: u32,
    /// Ticks until it is tried again, and how many these were: more each time that something came up.
    wait: u32,
    waited: u32,
}

impl World {
    /// Makes the present sub-step with all that follow up to the next look, where that can be; whether it is made, now or before.
    pub(super) fn go_ahead(&mut self) -> bool {
        if self.pool.hurry.made > 0 {
            debug_assert!(!self.is_restless(), "nothing came up");
            self.pool.hurry.made -= 1;
            return true;
        }
        let more = self.pool.until_look;
        let at_a_tick = more + 1 == self.settings.substeps_per_tick();
        if !(at_a_tick && more > 0 && self.may_go_ahead()) {
            return false;
        }
        let hurry = &mut self.pool.hurry;
        if hurry.wait > 0 {
            hurry.wait -= 1;
            return false;
        }
        let went = self.pool.seats.rig.step_ahead(&self.law, more + 1);
        if went {
            (hurry.made, hurry.waited) = (more, 0);
        } else {
            hurry.waited = (2 * hurry.waited + 1).min(LONGEST);
            hurry.wait = hurry.waited;
        }
        went
    }

    /// Whether sub-steps are made that lie ahead of the present one.
    pub(crate) fn is_ahead(&self) -> bool {
        self.pool.hurry.made > 0
    }

    /// Whether nothing but the solver moves anybody until the next look, and nobody asks where they are.
    fn may_go_ahead(&self) -> bool {
        let pool = &self.pool;
        let h = self.clock.h;
        let end = self.clock.next() + f64::from(pool.until_look) * h;
        let alone = self.stepped.is_empty()
            && !self.closed.changes()
            && self.flyers.is_idle()
            && !pool.rush.is_due()
            && self.pairs.near.is_empty()
            && self.pairs.fringe.is_empty()
            && pool.crowd.newcomers.is_empty()
            && pool.crowd.drivers.is_empty()
            && pool.crowd.belts.is_empty();
        pool.seats.rig.may_go_ahead()
            && alone
            && end - self.unseen_until <= 1e-9 * h
            && self.settings.history == 0
            && self.forced.is_empty()
            && !self.is_restless()
            && pool.bounces.is_idle()
    }
}
