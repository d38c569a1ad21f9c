//! Overlaps between two sub-steps: where a caller reads poses that no sub-step ended with.

use carom_collision::contacts;
use carom_math::SimTime;

use super::rules::Rules;
use super::{Stepping, collider, place};
use crate::PairSearch;
use crate::broad::window::box_ahead;

/// What a body moves or turns by in a sub-step, in sizes or rad, from which on the overlap between its ends is looked for: what moves
/// by less lies no deeper than at its ends, but for so much.
const NOTABLE: f64 = 1e-6;

impl Stepping {
    /// The deepest overlap at an instant within the last sub-step, in m, ≥ 0. Rows know of those at its ends alone: in the middle of a
    /// straight way along a curved surface a body lies deeper, and one that a caller sent elsewhere meanwhile meets others without rows.
    pub(crate) fn deepest_at(&self, rules: Rules<'_>, time: SimTime, h: f64) -> f64 {
        let (bodies, mut deepest) = (rules.bodies, self.engine.deepest_overlap());
        let (mut shapes, mut found) = (Vec::new(), Vec::new());
        if rules.broad.search == PairSearch::None {
            return deepest;
        }
        for state in self.engine.awake() {
            let index = place(&state);
            let body = bodies.get(index);
            let speed = body.velocity_at(time).length() / body.reach + body.spin_at(time).abs();
            if speed * h < NOTABLE {
                continue;
            }
            shapes.clear();
            let bounds = box_ahead(body, time, 0.0);
            self.engine.query(bounds, |tag| shapes.push(collider(tag)));
            shapes.sort_unstable();
            shapes.dedup();
            let pose = body.centre_pose(time);
            for &own in body.colliders.iter() {
                let mine = &bodies.colliders[own];
                for &at in &shapes {
                    let theirs = &bodies.colliders[at];
                    let other = bodies.get(theirs.body);
                    if theirs.body == index
                        || !(body.is_dynamic() || other.is_dynamic())
                        || !rules.broad.may_touch(bodies, (own, at))
                    {
                        continue;
                    }
                    found.clear();
                    let between = other.centre_pose(time).seen_from(pose);
                    contacts(&mine.solid, &theirs.solid, between, 0.0, &mut found);
                    let gaps = found.iter().filter_map(|part| part.manifold.deepest());
                    deepest = gaps.fold(deepest, |deepest, gap| deepest.max(-gap));
                }
            }
        }
        deepest
    }
}
