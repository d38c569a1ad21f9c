//! Which bodies outside of the engine may meet its members before the next tick: these join.

use std::collections::BTreeSet;

use carom_geometry::Aabb;
use carom_math::SimTime;

use super::rules::Rules;
use super::{Joins, Stepping};
use crate::broad::grid::{Grid, SweptBox};
use crate::broad::window::box_ahead;
use crate::store::swept::Sides;

/// Cells that a box may cover before its body is asked about in each query.
const MOST_CELLS: u64 = 64;

/// Where bodies outside go until a tick ends: what comes to the engine in it, or goes elsewhere, asks for them there.
#[derive(Clone, Debug)]
pub(crate) struct Ahead {
    /// Number of the tick; none before the first one, or if bodies took to flight that are not in it.
    tick: Option<u64>,
    /// Of those with newer motions there are boxes of the older ones, too.
    grid: Grid,
    /// Where they all are.
    bounds: Aabb,
    /// Bodies with boxes that are too large for the grid.
    large: Vec<u32>,
    /// What a query found: kept for its memory.
    found: Vec<u32>,
}

impl Default for Ahead {
    fn default() -> Self {
        Self {
            tick: None,
            bounds: Aabb::EMPTY,
            grid: Grid::new(1.0, 0),
            large: Vec::new(),
            found: Vec::new(),
        }
    }
}

impl Ahead {
    /// A body took to flight, and is not in it.
    pub(crate) const fn forget(&mut self) {
        self.tick = None;
    }

    /// Forgets all, and takes these: most of them cover four cells at most.
    fn fill(&mut self, boxes: &[(Aabb, u32)]) {
        let size = |bounds: Aabb| bounds.extents().max_element();
        let sizes = boxes.iter().map(|known| size(known.0));
        let sum: f64 = sizes.filter(|size| size.is_finite()).sum();
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^32 bodies")]
        let side = (2.0 * sum / boxes.len() as f64).max(f64::MIN_POSITIVE);
        self.grid.clear(side, boxes.len());
        self.large.clear();
        self.bounds = Aabb::EMPTY;
        self.extend(boxes);
    }

    fn extend(&mut self, boxes: &[(Aabb, u32)]) {
        for &(bounds, index) in boxes {
            let cells = self.grid.cells(bounds);
            self.bounds = self.bounds.union(bounds);
            if bounds.is_finite() && cells.count() <= MOST_CELLS {
                let swept_box = SweptBox::new(index, Sides::around(bounds));
                self.grid.insert(swept_box, cells);
            } else {
                self.large.push(index);
            }
        }
    }

    /// Bodies with boxes that may overlap one, each once; `all`: those that it knows, and perhaps more.
    fn query(&mut self, all: &[u32], bounds: Aabb) -> &[u32] {
        self.found.clear();
        if !self.bounds.overlaps(bounds) {
            return &[];
        }
        let cells = self.grid.cells(bounds);
        if cells.count() > all.len() as u64 {
            self.found.extend(all);
        } else {
            self.found.extend(&self.large);
            let swept_box = SweptBox::new(u32::MAX, Sides::around(bounds));
            self.grid.gather(&swept_box, cells, &mut self.found);
        }
        self.found.sort_unstable();
        self.found.dedup();
        &self.found
    }
}

impl Joins {
    /// Bodies outside that may meet members before the next tick, in order: of what flies as it did when this was last called only
    /// those that may meet members that came or go otherwise since, but for the first time in tick number `tick`. `held`: those in
    /// sub-steps.
    pub(crate) fn outsiders_near(
        &mut self,
        stepping: &mut Stepping,
        rules: Rules<'_>,
        held: &[u32],
        (time, tick): (SimTime, u64),
        asks_all: bool,
    ) -> BTreeSet<u32> {
        let bodies = rules.bodies;
        let is_aloft = |index: &u32| bodies.is_alive(*index) && bodies.get(*index).is_free();
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
        let box_of = |index: u32| box_ahead(bodies.get(index), time, left);
        let with_boxes = |some: &[u32]| -> Vec<(Aabb, u32)> {
            some.iter().map(|index| (box_of(*index), *index)).collect()
        };
        if asks_all || self.ahead.tick != Some(tick) {
            self.aloft.sort_unstable();
            self.aloft.dedup();
            self.aloft.retain(is_aloft);
            self.ahead.fill(&with_boxes(&self.aloft));
            self.ahead.tick = Some(tick);
        }
        let mut near = BTreeSet::new();
        let mut asked: Vec<u32> = held.to_vec();
        let meet = |tag: u64, bounds: Aabb| {
            let at = super::collider(tag);
            for &index in self.ahead.query(&self.aloft, bounds) {
                if is_aloft(&index)
                    && box_of(index).overlaps(bounds)
                    && stepping.nears(rules, self.reached, index, at, (time, left))
                {
                    near.insert(index);
                }
            }
        };
        if asks_all {
            stepping.engine.movers(meet);
        } else {
            stepping.engine.news(meet);
            restless.retain(is_aloft);
            self.ahead.extend(&with_boxes(&restless));
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
        index: u32,
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
        index: u32,
        at: u32,
        (time, left): (SimTime, f64),
    ) -> bool {
        /// What is nearer than this joins however it moves, as a fraction of the smaller reach.
        const MARGIN: f64 = 1.0 / 128.0;
        let bodies = rules.bodies;
        let owner = bodies.colliders[at as usize].body;
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
                let [mine, their] = [mine, at].map(|at| &bodies.colliders[at as usize].solid);
                let seen = pose.seen_from(own);
                carom_collision::contacts(mine, their, seen, margin, &mut found);
            }
        }
        !found.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::{Vec2, vec2};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bodies_with_boxes_that_overlap_are_found(
            boxes in proptest::collection::vec((-1e2..1e2_f64, -1e2..1e2_f64, 0.1..3.0_f64, 0..9_u32), 1..60),
        ) {
            let boxed = |(x, y, size, kind): (f64, f64, f64, u32)| {
                let factor = match kind {
                    0 => f64::INFINITY,
                    1 => 40.0,
                    _ => 1.0,
                };
                Aabb::from_points([vec2(x, y)]).grown(factor * size)
            };
            let boxes: Vec<(Aabb, u32)> = boxes.into_iter().map(boxed).zip(0..).collect();
            let mut ahead = Ahead::default();
            let (early, late) = boxes.split_at(boxes.len() / 2);
            ahead.fill(&[(Aabb::from_points([Vec2::ZERO]), 7)]);
            ahead.fill(early);
            ahead.extend(late);
            let all: Vec<u32> = (0..60).collect();
            for (bounds, _) in &boxes {
                let found = ahead.query(&all, *bounds);
                for (other, index) in &boxes {
                    prop_assert!(found.contains(index) || !other.overlaps(*bounds), "{index}");
                }
            }
        }
    }
}
