//! Which bodies outside of the engine may meet its members before the next tick: these join.

use std::collections::BTreeSet;

use carom_collision::BoxTree;
use carom_geometry::Aabb;
use carom_math::SimTime;

use super::rules::Rules;
use super::{Joins, Stepping};
use crate::broad::window::box_ahead;
use crate::{BodyIx, ColliderIx, Ix};

impl Joins {
    /// Bodies outside that may meet members before the next tick, in order: of what flies as it did when this was last called only
    /// those that may meet members that came or go otherwise since, but for the first time in tick number `tick`. `held`: those in
    /// sub-steps.
    pub(crate) fn outsiders_near(
        &mut self,
        stepping: &mut Stepping,
        rules: Rules<'_>,
        held: &BTreeSet<BodyIx>,
        (time, tick): (SimTime, u64),
        asks_all: bool,
    ) -> BTreeSet<BodyIx> {
        let bodies = rules.bodies;
        let is_aloft = |index: &BodyIx| bodies.is_alive(*index) && bodies.get(*index).is_free();
        let mut restless = core::mem::take(&mut self.restless);
        if !self.aloft.iter().any(is_aloft) {
            self.aloft.clear();
            if held.is_empty() {
                stepping.engine.forget_news();
                return BTreeSet::new();
            }
        }
        stepping.engine.prepare_queries();
        let left = stepping.engine.left();
        let box_of = |index: BodyIx| box_ahead(bodies.get(index), time, left);
        let with_box = |index: &BodyIx| (box_of(*index), index.number());
        let known = self.ahead.take();
        let known = known.filter(|(of, _)| *of == tick && !asks_all);
        let (_, tree) = self.ahead.insert(known.unwrap_or_else(|| {
            self.aloft.retain(is_aloft);
            let mut tree = BoxTree::new();
            tree.extend(self.aloft.iter().map(with_box));
            (tick, tree)
        }));
        let mut near = BTreeSet::new();
        let mut asked: Vec<BodyIx> = held.iter().copied().collect();
        let meet = |tag: u64, bounds: Aabb| {
            let at = super::collider(tag);
            tree.query(bounds, |index| {
                let index = BodyIx::new(index);
                if is_aloft(&index)
                    && box_of(index).overlaps(bounds)
                    && stepping.nears(rules, self.reached, index, at, (time, left))
                {
                    near.insert(index);
                }
            });
        };
        if asks_all {
            stepping.engine.movers(meet);
        } else {
            stepping.engine.news(meet);
            restless.retain(is_aloft);
            tree.extend(restless.iter().map(with_box));
            asked.append(&mut restless);
        }
        near.extend(asked.into_iter().filter(|index| {
            let is_dynamic = bodies.get(*index).is_dynamic();
            is_dynamic && stepping.nears_member(rules, self.reached, *index, (time, left))
        }));
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
        index: BodyIx,
        (time, left): (SimTime, f64),
    ) -> bool {
        let mut shapes = Vec::new();
        let ahead = box_ahead(rules.bodies.get(index), time, left);
        self.engine
            .query_awake(ahead, |tag| shapes.push(super::collider(tag)));
        shapes
            .into_iter()
            .any(|at| self.nears(rules, reached, index, at, (time, left)))
    }

    /// Whether a shape of a member may be met by a body within `left` seconds: by their circles, then by their shapes.
    fn nears(
        &self,
        rules: Rules<'_>,
        reached: SimTime,
        index: BodyIx,
        at: ColliderIx,
        (time, left): (SimTime, f64),
    ) -> bool {
        /// What is nearer than this joins however it moves, as a fraction of the smaller reach.
        const MARGIN: f64 = 1.0 / 128.0;
        let bodies = rules.bodies;
        let owner = bodies.colliders[at].body;
        if owner == index || !bodies.get(owner).in_engine() {
            return false;
        }
        let Some(theirs) = self.state(owner) else {
            return false;
        };
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
        for &mine in &state.colliders {
            if rules.broad.may_touch(bodies, (mine, at)) {
                let [mine, their] = [mine, at].map(|at| &bodies.colliders[at].solid);
                let seen = pose.seen_from(own);
                carom_collision::contacts(mine, their, seen, margin, &mut found);
            }
        }
        !found.is_empty()
    }
}
