//! Which bodies outside of the engine may meet its members before the next tick: these join.

use std::collections::BTreeSet;

use carom_math::SimTime;

use super::Stepping;
use crate::World;
use crate::broad::window::box_ahead;

/// Which members are asked about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Among {
    All,
    /// Those that came or go otherwise since they were last asked about.
    News,
}

impl World {
    /// Bodies outside that may meet members before the next tick, in order: of what flies as it did when this was last called only
    /// those that may meet members that came or go otherwise since, but for the first time in a tick.
    pub(super) fn outsiders_near(&mut self, time: SimTime, asks_all: bool) -> BTreeSet<u32> {
        let aloft = &mut self.joins.aloft;
        aloft.sort_unstable();
        aloft.dedup();
        let bodies = &self.bodies;
        aloft.retain(|&index| bodies.is_alive(index) && bodies.get(index).is_free());
        let mut restless = core::mem::take(&mut self.joins.restless);
        restless.sort_unstable();
        let is_alone = self.joins.aloft.is_empty() && self.stepped.is_empty();
        if let Some(stepping) = &mut self.stepping {
            if is_alone {
                stepping.engine.forget_news();
            } else {
                stepping.engine.prepare_queries();
            }
        }
        let Some(stepping) = self.stepping.as_ref().filter(|_| !is_alone) else {
            return BTreeSet::new();
        };
        let left = stepping.engine.left();
        let free = self.joins.aloft.iter().map(|&index| {
            let asks = asks_all || restless.binary_search(&index).is_ok();
            (index, if asks { Among::All } else { Among::News })
        });
        let held = self.stepped.iter().map(|&index| (index, Among::All));
        let near = free
            .chain(held)
            .filter(|(index, _)| self.bodies.get(*index).is_dynamic())
            .filter(|(index, among)| self.nears_member(stepping, *index, (time, left), *among))
            .map(|(index, _)| index)
            .collect();
        if let Some(stepping) = &mut self.stepping {
            stepping.engine.forget_news();
        }
        near
    }

    /// A free body with a new motion joins if it may meet a member before the next sub-step begins.
    pub(crate) fn meet_members(&mut self, index: u32, time: SimTime) {
        // Most worlds of free bodies have no members, and the grid's instants are sums with care.
        if self.bodies.member_count() == 0 {
            return;
        }
        self.joins.restless.push(index);
        let left = self.clock.next() - time;
        let near = left > 0.0
            && self.bodies.get(index).is_free()
            && self.stepping.as_ref().is_some_and(|stepping| {
                self.joins.reached == self.clock.next()
                    && self.nears_member(stepping, index, (time, left), Among::All)
            });
        if near {
            self.join(index, time);
        }
    }

    /// Whether a body may meet a member within `left` seconds.
    pub(super) fn nears_member(
        &self,
        stepping: &Stepping,
        index: u32,
        (time, left): (SimTime, f64),
        among: Among,
    ) -> bool {
        let mut shapes = Vec::new();
        let ahead = box_ahead(self.bodies.get(index), time, left);
        let found = |tag| shapes.push(super::collider(tag));
        match among {
            Among::All => stepping.engine.query_awake(ahead, found),
            Among::News => stepping.engine.query_news(ahead, found),
        }
        shapes.into_iter().any(|at| {
            let owner = self.colliders[at as usize].body;
            owner != index
                && self.bodies.get(owner).in_engine()
                && self.nears(stepping, (index, owner), at, (time, left))
        })
    }

    /// Whether a shape of a member may be met by a body within `left` seconds: by their circles, then by their shapes.
    fn nears(
        &self,
        stepping: &Stepping,
        (index, owner): (u32, u32),
        at: u32,
        (time, left): (SimTime, f64),
    ) -> bool {
        /// What is nearer than this joins however it moves, as a fraction of the smaller reach.
        const MARGIN: f64 = 1.0 / 128.0;
        let Some(theirs) = stepping.state(owner) else {
            return false;
        };
        let (state, other) = (self.bodies.get(index), self.bodies.get(owner));
        let mut pose = theirs.pose;
        pose.position -= theirs.velocity.0 * (self.joins.reached - time).max(0.0);
        let own = state.centre_pose(time);
        let closing = theirs.velocity.0 - state.velocity_at(time);
        let pull =
            state.motion.acceleration.length() + self.pull_on(owner, pose.position).0.length();
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
            let [mine, their] = [*mine, at].map(|at| &self.colliders[at as usize]);
            if self.broad.may_touch(&self.bodies, mine, their) {
                let seen = pose.seen_from(own);
                carom_collision::contacts(&mine.solid, &their.solid, seen, margin, &mut found);
            }
        }
        !found.is_empty()
    }
}
