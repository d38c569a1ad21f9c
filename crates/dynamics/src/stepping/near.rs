//! Which bodies outside of the engine may meet its members before the next tick: these join.

use std::collections::BTreeSet;

use carom_math::SimTime;

use super::rules::Rules;
use super::{Joins, Stepping};
use crate::broad::window::box_ahead;

/// Which members are asked about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Among {
    All,
    /// Those that came or go otherwise since they were last asked about.
    News,
}

impl Joins {
    /// Bodies outside that may meet members before the next tick, in order: of what flies as it did when this was last called only
    /// those that may meet members that came or go otherwise since, but for the first time in a tick. `held`: those in sub-steps.
    pub(crate) fn outsiders_near(
        &mut self,
        stepping: &mut Stepping,
        rules: Rules<'_>,
        held: &[u32],
        time: SimTime,
        asks_all: bool,
    ) -> BTreeSet<u32> {
        let bodies = rules.bodies;
        self.aloft.sort_unstable();
        self.aloft.dedup();
        self.aloft
            .retain(|&index| bodies.is_alive(index) && bodies.get(index).is_free());
        let mut restless = core::mem::take(&mut self.restless);
        restless.sort_unstable();
        if self.aloft.is_empty() && held.is_empty() {
            stepping.engine.forget_news();
            return BTreeSet::new();
        }
        stepping.engine.prepare_queries();
        let left = stepping.engine.left();
        let free = self.aloft.iter().map(|&index| {
            let asks = asks_all || restless.binary_search(&index).is_ok();
            (index, if asks { Among::All } else { Among::News })
        });
        let held = held.iter().map(|&index| (index, Among::All));
        let near = free
            .chain(held)
            .filter(|(index, _)| bodies.get(*index).is_dynamic())
            .filter(|(index, among)| {
                stepping.nears_member(rules, self.reached, *index, (time, left), *among)
            })
            .map(|(index, _)| index)
            .collect();
        stepping.engine.forget_news();
        near
    }
}

impl Stepping {
    /// Whether a body may meet a member within `left` seconds.
    ///
    /// `reached`: where the engine's last sub-step ended.
    pub(crate) fn nears_member(
        &self,
        rules: Rules<'_>,
        reached: SimTime,
        index: u32,
        (time, left): (SimTime, f64),
        among: Among,
    ) -> bool {
        let mut shapes = Vec::new();
        let ahead = box_ahead(rules.bodies.get(index), time, left);
        let found = |tag| shapes.push(super::collider(tag));
        match among {
            Among::All => self.engine.query_awake(ahead, found),
            Among::News => self.engine.query_news(ahead, found),
        }
        shapes.into_iter().any(|at| {
            let owner = rules.colliders[at as usize].body;
            owner != index
                && rules.bodies.get(owner).in_engine()
                && self.nears(rules, reached, (index, owner), at, (time, left))
        })
    }

    /// Whether a shape of a member may be met by a body within `left` seconds: by their circles, then by their shapes.
    fn nears(
        &self,
        rules: Rules<'_>,
        reached: SimTime,
        (index, owner): (u32, u32),
        at: u32,
        (time, left): (SimTime, f64),
    ) -> bool {
        /// What is nearer than this joins however it moves, as a fraction of the smaller reach.
        const MARGIN: f64 = 1.0 / 128.0;
        let Some(theirs) = self.state(owner) else {
            return false;
        };
        let bodies = rules.bodies;
        let (state, other) = (bodies.get(index), bodies.get(owner));
        let mut pose = theirs.pose;
        pose.position -= theirs.velocity.0 * (reached - time).max(0.0);
        let own = state.centre_pose(time);
        let closing = theirs.velocity.0 - state.velocity_at(time);
        let pull =
            state.motion.acceleration.length() + bodies.pull_on(owner, pose.position).0.length();
        let bulge = 0.5 * pull * left * left;
        let margin = MARGIN * state.reach.min(other.reach) + bulge + state.motion.left_out;
        let apart = pose.position - own.position;
        // Where the line on which they pass each other is nearest.
        let speed = closing.length_squared();
        let nearest = if speed > 0.0 {
            (-apart.dot(closing) / speed).clamp(0.0, left)
        } else {
            0.0
        };
        let within = state.reach + other.reach + margin;
        if (apart + closing * nearest).length_squared() > within * within {
            return false;
        }
        let rim = |spin: f64, reach: f64| spin.abs() * reach * left;
        let turning = rim(state.spin_at(time), state.reach) + rim(theirs.velocity.1, other.reach);
        let margin = margin + closing.length() * left + turning;
        let mut found = Vec::new();
        for mine in &state.colliders {
            let [mine, their] = [*mine, at].map(|at| &rules.colliders[at as usize]);
            if rules.broad.may_touch(bodies, mine, their) {
                let seen = pose.seen_from(own);
                carom_collision::contacts(&mine.solid, &their.solid, seen, margin, &mut found);
            }
        }
        !found.is_empty()
    }
}
