//! What touches gets its method at that instant: a closed form, flight, or the engine, where it stands until the sub-step ends.

use arrayvec::ArrayVec;
use carom_collision::{TimeOfImpact, time_of_impact};
use carom_geometry::Aabb;
use carom_math::{SimTime, Vec2};

use crate::broad::window::box_ahead;
use crate::events::resolve::PairImpact;
use crate::model::ghost::look_at;
use crate::model::narrow::{NOISE, TOUCH, opening_speed, pace, rest_speed};
use crate::store::pairs::{Pair, PairPoint};
use crate::{BodyIx, Mode, PairIx, World};

impl World {
    /// Gives all that waits at an instant its method, once all that happens at that instant has happened; whether something waited.
    pub(crate) fn settle(&mut self, time: SimTime) -> bool {
        let are_known = self.joins.known == self.joins.waiting.len();
        if self.unsettled.is_empty() && are_known {
            return false;
        }
        let before = self.unsettled.len();
        self.look_at_fresh(time);
        let places = self.look_at_held(time);
        if self.strike_held_pairs(places, time) {
            return true;
        }
        let is_unsolved = |index: &BodyIx| self.bodies.get(*index).is_unsolved();
        let waiting: Vec<BodyIx> = self.unsettled.iter().copied().filter(is_unsolved).collect();
        self.close_groups_within(&waiting, time);
        self.drop_unsolved(time);
        self.join_unsolved(time);
        self.begin_analytic_rest(time);
        // What touches something more as it begins its motion waits again.
        let began = self.begin_analytic_motion(time);
        self.tell_waiting(time);
        // And what touches something that has come to rest lands on it.
        let mut left = self.unsettled.iter();
        let lands = left.any(|index| self.bodies.get(*index).is_unsolved());
        began || lands || !waiting.is_empty() || !are_known || self.unsettled.len() < before
    }

    /// Contacts of all that waits for its method; begins and ends of touch, and overlaps. Places of the pairs.
    fn look_at_held(&mut self, time: SimTime) -> Vec<PairIx> {
        let bodies = &self.bodies;
        let all = self.unsettled.iter();
        let all = all.flat_map(|index| &bodies.get(*index).pairs);
        let places = self.pairs.by_colliders(all.copied());
        for &place in &places {
            let pairs = &mut self.pairs;
            let pair = look_at(bodies, pairs, place, time);
            pair.fresh = false;
            let reach = |index: BodyIx| bodies.get(index).reach;
            let (a, b) = pair.bodies;
            let sunken = pair.overlaps(TOUCH * reach(a).min(reach(b)));
            self.report.sunken += u64::from(sunken);
            self.report.deepest_overlap = self.report.deepest_overlap.max(pair.depth());
            self.events.tell_touch(bodies, pair, time);
        }
        places
    }

    /// Strikes pairs that close faster than rest where they touch: a body that landed on one side may strike another one. Whether
    /// some do.
    fn strike_held_pairs(&mut self, places: Vec<PairIx>, time: SimTime) -> bool {
        let mut strikes = false;
        for place in places {
            if let Some(impact) = self.approach_of(place, time) {
                self.strike_pair(&impact);
                strikes = true;
            }
        }
        strikes
    }

    /// The first contact of a pair that closes faster than rest where it touches.
    fn approach_of(&self, place: PairIx, time: SimTime) -> Option<PairImpact> {
        let pair = self.pairs.find(place)?;
        let [a, b] = [pair.bodies.0, pair.bodies.1].map(|index| self.bodies.get(index));
        if pair.buried || a.in_engine() || b.in_engine() {
            return None;
        }
        let touch = TOUCH * a.reach.min(b.reach);
        let rest = rest_speed(&self.bodies, pair).max(NOISE * pace(a, b, time));
        pair.contacts.iter().find_map(|contact| {
            let closes = |point: &&PairPoint| {
                point.separation <= touch
                    && opening_speed(a, b, time, point.position, contact.normal) < -rest
            };
            let points = contact.points.iter().filter(closes);
            let points: ArrayVec<Vec2, 2> = points.map(|point| point.position).collect();
            (!points.is_empty()).then_some(PairImpact {
                time,
                pair: place,
                normal: contact.normal,
                points,
            })
        })
    }

    /// Bodies that nothing holds fly: what they touch opens. In hybrid mode this is so of one that bounced off all that it touches, as
    /// a disc that comes out of a corner, and of several with nothing near: others strike again soon, and are cheaper in the engine
    /// (dominoes 1.7 times, hills 1.3).
    fn drop_unsolved(&mut self, time: SimTime) {
        for island in self.unsolved_islands() {
            if self.settings.mode == Mode::Exact || self.is_clear(&island) {
                self.drop_unheld(&island, time);
            }
        }
    }

    /// Whether one body bounced off all that it touches, or nothing is near the bodies.
    fn is_clear(&self, island: &[BodyIx]) -> bool {
        let pairs = island
            .iter()
            .flat_map(|index| &self.bodies.get(*index).pairs);
        let pairs: Vec<&Pair> = pairs.map(|place| self.pairs.get(*place)).collect();
        let mut touching = pairs.iter().filter(|pair| pair.touching).peekable();
        let bounces = island.len() == 1
            && touching.peek().is_some()
            && touching.all(|pair| pair.material.restitution > 0.0);
        bounces || pairs.iter().all(|pair| pair.contacts.is_empty())
    }

    /// What meets a body that stands until the sub-step ends joins with it: neither the calendar queue nor the engine knows that
    /// body.
    fn tell_waiting(&mut self, time: SimTime) {
        let left = self.clock.next() - time;
        while let Some(&standing) = self.joins.waiting.get(self.joins.known) {
            self.joins.known += 1;
            if !self.stands(standing) {
                continue;
            }
            self.raise_free();
            let pose = self.bodies.get(standing).motion.pose_at(time);
            let (mut near, mut found) = (Vec::new(), Vec::new());
            for &at in &self.bodies.get(standing).colliders {
                let bounds = self.bodies.colliders[at].solid.aabb(pose);
                self.free.overlapping(&self.bodies, bounds, &mut found);
                near.extend(&found);
                let shapes = self.broad.in_tree(&self.bodies, bounds).into_iter();
                near.extend(shapes.map(|at| self.bodies.colliders[at].body));
            }
            near.sort_unstable();
            near.dedup();
            for index in near {
                let way = box_ahead(self.bodies.get(index), time, left);
                if self.meets_standing((index, way), standing, (time, left)) {
                    self.join(index, time);
                }
            }
        }
    }

    /// Whether a body outside of the engine meets one that stands for the `left` seconds to the end of the sub-step.
    pub(crate) fn meets_waiting(&self, index: BodyIx, ahead: (SimTime, f64)) -> bool {
        if self.joins.waiting.is_empty() {
            return false;
        }
        let way = box_ahead(self.bodies.get(index), ahead.0, ahead.1);
        let mut waiting = self.joins.waiting.iter();
        waiting.any(|at| self.stands(*at) && self.meets_standing((index, way), *at, ahead))
    }

    fn stands(&self, index: BodyIx) -> bool {
        self.bodies.is_alive(index) && self.bodies.get(index).in_engine()
    }

    /// The same of one that stands, and of a body with the box of its way.
    fn meets_standing(
        &self,
        (index, way): (BodyIx, Aabb),
        standing: BodyIx,
        (time, left): (SimTime, f64),
    ) -> bool {
        let (state, other) = (self.bodies.get(index), self.bodies.get(standing));
        if !state.is_outside() || !way.overlaps(box_ahead(other, time, left)) {
            return false;
        }
        let motions = [state, other].map(|state| state.motion.rebased(time));
        let all = state.colliders.iter();
        let mut shapes = all.flat_map(|mine| other.colliders.iter().map(move |at| [*mine, *at]));
        shapes.any(|shapes| {
            let [mine, theirs] = shapes.map(|at| &self.bodies.colliders[at]);
            let (one, two) = (&mine.solid, &theirs.solid);
            self.broad.may_touch(&self.bodies, shapes.into())
                && time_of_impact(one, &motions[0], two, &motions[1], left) != TimeOfImpact::Clear
        })
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::Circle;
    use carom_math::{Vec2, vec2};

    use crate::{BodyDef, Material, Settings, World};

    /// It went on as it did, unknown to the engine and to the calendar queue, and no report said so.
    #[test]
    fn what_joins_at_the_beginning_of_a_sub_step_that_was_made_stands() {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            ..Settings::default()
        })
        .expect("settings");
        let def = BodyDef::dynamic().moving(vec2(5.0, 0.0));
        let disc = Circle::new(0.5).expect("a disc");
        let id = world.insert(def, disc, Material::default());
        let index = id.expect("valid").index;
        world.begin_substep();
        world.join(index, world.clock.last());
        assert_eq!(world.joins.waiting, [index]);
        let state = world.bodies.get(index);
        assert_eq!(state.centre_at(world.clock.next()), Vec2::ZERO);
        assert_eq!(state.velocity_at(world.clock.last()), vec2(5.0, 0.0));
        assert!(!world.step(1e-3).is_exact(), "it stands");
    }
}
