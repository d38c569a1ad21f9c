//! The pipeline of a sub-step: what begins to touch gets the method that holds it, and the engine moves its members.

use carom_math::SimTime;

use crate::World;
use crate::events::event_queue::Entry;
use crate::events::predict::BUDGET;
use crate::model::narrow::{TOUCH, opening_speed, rest_speed};
use crate::stepping::heap::Seen;
use crate::store::pairs::PairContact;

/// Sub-steps with nothing near after which a body flies: fewer, and what rattles changes sides all the time.
const IDLE: u8 = 4;

impl World {
    /// One sub-step: what touches is looked at, rests or moves in closed form or joins the engine, and what will strike is entered into
    /// the event queue.
    pub(crate) fn begin_substep(&mut self) {
        let (time, h) = (self.clock.next(), self.clock.h);
        self.stopwatch.lap(|p| &mut p.impacts);
        self.report_waiting(time);
        self.clock.begin();
        self.event_queue.clear();
        self.spent = 0.0;
        self.report.substeps += 1;
        self.look_at_fresh(time);
        self.follow_tips(time, h);
        let before = self.report.handed_over;
        self.end_rush(time);
        self.guard(time);
        self.find_pairs(time, h);
        self.stopwatch.lap(|p| &mut p.pairs);
        self.gather_landings(time, h);
        self.look(time, h);
        self.join_large(time);
        self.pairs.sort(&self.bodies, &self.stepped);
        self.close_groups(time);
        self.join_exhausted(time);
        self.stopwatch.lap(|p| &mut p.contacts);
        self.begin_analytic_rest(time);
        self.stopwatch.lap(|p| &mut p.sleep);
        self.begin_analytic_motion(time);
        self.join_unsolved(time);
        self.gather_members(time);
        self.pairs.sort(&self.bodies, &self.stepped);
        self.pairs_are_new();
        self.stopwatch.lap(|p| &mut p.contacts);
        self.release(time);
        self.stopwatch.lap(|p| &mut p.flight);
        self.step_members(time);
        self.stopwatch.lap(|p| &mut p.solver);
        self.pairs.sort(&self.bodies, &self.stepped);
        self.redirected.clear();
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            self.predict(place, time);
            i += 1;
        }
        self.handed_over = self.report.handed_over - before;
        self.stopwatch.lap(|p| &mut p.prediction);
    }

    /// Impacts of a sub-step before the rest of them is left to the solver: work stays bounded
    /// whatever was put where, at a body's own budget for every body.
    pub(crate) fn impact_budget(&self) -> f64 {
        256.0 + BUDGET * self.bodies.places() as f64
    }

    /// Leaves an impact, and all others that are due in this sub-step, to the next one's solver, and says so.
    pub(crate) fn give_up(&mut self, entry: Entry) {
        let mut due = Some(entry);
        while let Some(entry) = due {
            if let Some(pair) = self.pairs.find_same(entry.pair, entry.key)
                && !pair.given_up
            {
                pair.given_up = true;
                self.report.collapsed += 1;
            }
            due = self.event_queue.next_until(self.clock.next());
        }
    }

    /// Stops what is no longer finite.
    fn guard(&mut self, time: SimTime) {
        for index in self.stepped.clone() {
            if !self.bodies.get(index).motion.is_finite() {
                self.report.stopped += 1;
                self.bodies.stop(&self.colliders, index, time);
            }
        }
    }

    /// Boxes and pairs for the motions up to the end of the sub-step.
    fn find_pairs(&mut self, time: SimTime, h: f64) {
        for index in self.stepped.clone() {
            self.refit(index, time, h);
        }
        self.pairs.sort(&self.bodies, &self.stepped);
        let mut gone = Vec::new();
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            if !self.broad.keeps(&self.colliders, self.pairs.shapes(place)) {
                gone.push(place);
            }
        }
        for place in gone {
            self.part(place, time);
        }
        self.pairs.sort(&self.bodies, &self.stepped);
    }

    /// Free bodies that come to rest on stepped bodies are stepped from here on, and so on with those that
    /// rest on them.
    ///
    /// The modes of a stack are solved for once all of it has landed, not once a layer.
    fn gather_landings(&mut self, time: SimTime, h: f64) {
        let mut asked = self.pairs.ordered().to_vec();
        let mut landed = Vec::new();
        let mut seen = Seen::default();
        loop {
            let landings = asked.iter();
            let mut lands: Vec<u32> = landings
                .filter_map(|place| self.landing(*place, time, h))
                .collect();
            if landed.len() + lands.len() > self.few() {
                self.gather_heaps(&mut lands, &mut seen, time);
                landed.retain(|index| !self.bodies.get(*index).in_engine());
            }
            if lands.is_empty() && landed.is_empty() {
                break;
            }
            let before = self.bodies.versions().to_vec();
            if lands.is_empty() {
                for index in core::mem::take(&mut landed) {
                    self.regroup(index, time);
                }
            }
            for &index in &lands {
                self.land_first(index, time);
            }
            landed.extend(lands);
            // Only pairs of bodies with a changed motion may answer otherwise: those that landed, and those with modes
            // solved for anew because of it.
            let bodies = &self.bodies;
            let changed = |index: &&u32| bodies.version(**index) != before[**index as usize];
            let changed = self.stepped.iter().filter(changed);
            let pairs = changed.flat_map(|index| &bodies.get(*index).pairs);
            asked = self.pairs.by_colliders(pairs.copied());
        }
        self.pairs.sort(&self.bodies, &self.stepped);
    }

    /// The free body of a pair, if the other one is stepped and holds it.
    fn landing(&mut self, place: u32, time: SimTime, h: f64) -> Option<u32> {
        let (a, b) = self.pairs.get(place).bodies;
        let (one, two) = (self.bodies.get(a), self.bodies.get(b));
        let free = match (one.is_free(), two.is_free()) {
            (true, false) if two.is_stepped() => a,
            (false, true) if one.is_stepped() => b,
            _ => return None,
        };
        let pair = self.narrow.look_at(
            &self.bodies,
            &self.colliders,
            &mut self.pairs,
            place,
            time,
            h,
        );
        if pair.buried {
            return Some(free);
        }
        let rest = rest_speed(&self.bodies, pair, h);
        let touch = TOUCH * one.reach.min(two.reach);
        // What was struck within a sub-step and touches again at its end has come back: turning presses it.
        let back = pair.impacts > 0;
        let holds = |contact: &PairContact| {
            contact.points.iter().any(|point| {
                let rate = opening_speed(one, two, time, point.position, contact.normal);
                let reach = touch + if rate < 0.0 { -rate * h } else { 0.0 };
                if rate >= -rest {
                    point.separation <= reach
                } else {
                    back && point.separation <= touch
                }
            })
        };
        pair.contacts.iter().any(holds).then_some(free)
    }

    /// Contacts of all near pairs; begins and ends of touch; what touches a sleeper wakes it.
    fn look(&mut self, time: SimTime, h: f64) {
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            i += 1;
            let Some(pair) = self.pairs.find_mut(place) else {
                continue;
            };
            let (a, b) = pair.bodies;
            let active = (
                self.bodies.get(a).is_stepped(),
                self.bodies.get(b).is_stepped(),
            );
            pair.lasting = false;
            (pair.impacts, pair.spent) = (0, 0.0);
            if active == (false, false) && !pair.fresh {
                pair.given_up = false;
                self.events.tell_touch(&self.bodies, pair, time);
                continue;
            }
            pair.fresh = false;
            let pair = self.narrow.look_at(
                &self.bodies,
                &self.colliders,
                &mut self.pairs,
                place,
                time,
                h,
            );
            let touching = pair.touching;
            let reach = |index: u32| self.bodies.get(index).reach;
            let sunken = pair.overlaps(TOUCH * reach(a).min(reach(b)));
            self.report.sunken += u64::from(sunken);
            self.report.deepest_overlap = self.report.deepest_overlap.max(pair.depth());
            self.events.tell_touch(&self.bodies, pair, time);
            if touching && active != (false, false) {
                for index in [a, b] {
                    if self.bodies.get(index).is_asleep() {
                        self.wake(index, time);
                    }
                }
            }
        }
    }

    /// Overlaps of sub-stepped bodies when a call ends, as the next sub-step will see them: a caller reads these poses now. One to
    /// two in a hundred instructions of a stirred box of 60 bodies (2026-11-26).
    pub(crate) fn tell_overlaps(&mut self, time: SimTime) {
        self.tell_overlaps_between(time);
        for index in self.stepped.clone() {
            for slot in 0..self.bodies.get(index).pairs.len() {
                let place = self.bodies.get(index).pairs[slot];
                let other = self.pairs.get(place).other(index);
                let (one, two) = (self.bodies.get(index), self.bodies.get(other));
                let near = one.reach + two.reach;
                let apart = one.centre_at(time) - two.centre_at(time);
                if two.is_stepped() && other < index || apart.length_squared() > near * near {
                    continue;
                }
                let touch = TOUCH * one.reach.min(two.reach);
                // What a pair remembers is that of its sub-step: calls only observe.
                let kept = self.pairs.get(place).clone();
                let (bodies, colliders) = (&self.bodies, &self.colliders);
                let pairs = &mut self.pairs;
                let pair = self
                    .narrow
                    .look_at(bodies, colliders, pairs, place, time, self.clock.h);
                self.report.sunken += u64::from(pair.overlaps(touch));
                self.report.deepest_overlap = self.report.deepest_overlap.max(pair.depth());
                *self.pairs.get_mut(place) = kept;
            }
        }
    }

    /// Overlaps in the engine when a call ends within a sub-step.
    fn tell_overlaps_between(&mut self, time: SimTime) {
        if self.clock.is_within(time)
            && let Some(stepping) = &self.stepping
        {
            let deepest = stepping.deepest_at(self.rules(), time, self.clock.h);
            self.report.deepest_overlap = self.report.deepest_overlap.max(deepest);
        }
    }

    /// Budgets start anew once the solver has taken what was given up.
    fn pairs_are_new(&mut self) {
        let mut i = 0;
        while let Some(place) = self.pairs.place(i) {
            self.pairs.get_mut(place).given_up = false;
            i += 1;
        }
    }

    /// A body that fell asleep: it leaves the sub-steps, and free bodies meet it as one at rest.
    pub(crate) fn lie_down(&mut self, index: u32, time: SimTime) {
        self.end_substepping(index);
        for place in self.bodies.get(index).pairs.clone() {
            let pair = self.pairs.get_mut(place);
            let other = pair.other(index);
            let state = self.bodies.get(other);
            if state.goes_by_events() {
                self.part(place, time);
            } else if !state.is_stepped() {
                // No contact update before one of the two wakes.
                (pair.lasting, pair.given_up) = (false, false);
                (pair.impacts, pair.spent) = (0, 0.0);
            }
        }
        self.show(index, time);
        self.show_engine(index);
    }

    /// Bodies that nothing held or neared for a while fly from here on.
    fn release(&mut self, time: SimTime) {
        for index in self.stepped.clone() {
            let near = |place: &u32| !self.pairs.get(*place).contacts.is_empty();
            let held = self.bodies.get(index).pairs.iter().any(near);
            let state = self.bodies.get_mut(index);
            state.idle = if held { 0 } else { state.idle + 1 };
            if state.idle >= IDLE {
                self.take_off(index, time);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;
    use carom_math::{Vec2, vec2};

    use crate::events::event_queue::Entry;
    use crate::{BodyDef, Material, Settings, World};

    /// It turned by no number, so that the engine did not take it: it fell through the floor.
    #[test]
    fn what_was_stopped_lands_on_the_floor() {
        let mut world = World::new(Settings::default()).expect("settings");
        let mut put = |def: BodyDef, width: f64| {
            let block = ConvexPolygon::rectangle(width, 1.0).expect("a block");
            world
                .insert(def, block, Material::default())
                .expect("valid")
        };
        put(BodyDef::fixed().at(vec2(0.0, -0.5)), 10.0);
        let id = put(BodyDef::dynamic().at(vec2(0.0, 2.0)).turned(0.3), 1.0);
        world.step(0.1);
        let state = world.bodies.get_mut(id.index);
        (state.motion.spin, state.turned) = (f64::NAN, f64::NAN);
        let now = world.clock.now;
        world.bodies.stop(&world.colliders, id.index, now);
        let told = world.set_velocity(id, vec2(0.0, -5.0), 0.0);
        assert!(told.is_ok(), "{told:?}");
        world.step(2.0);
        let body = world.body(id).expect("there");
        assert!(body.centre().y > 0.4 && body.angle().is_finite());
    }

    #[test]
    fn the_impact_at_which_a_budget_ends_is_left_to_the_solver_and_counted() {
        let mut world = World::new(Settings::default()).expect("settings");
        let mut put = |def: BodyDef, width: f64| {
            let block = ConvexPolygon::rectangle(width, 1.0).expect("a block");
            let id = world.insert(def, block, Material::default());
            id.expect("valid").index
        };
        put(BodyDef::fixed().at(vec2(0.0, -0.5)), 10.0);
        let index = put(BodyDef::dynamic().at(vec2(0.0, 0.5)), 1.0);
        world.step(0.1);
        let place = world.bodies.get(index).pairs[0];
        let pair = world.pairs.get(place);
        let (later, points) = (world.clock.now + 0.005, [vec2(0.5, 0.0)]);
        let points = points.into_iter().collect();
        let entry = Entry::of(&world.bodies, (place, pair), later, Vec2::Y, points);
        world.event_queue.push(entry);
        world.spent = world.impact_budget() + 1.0;
        let report = world.step(0.01);
        assert!(world.pairs.get(place).given_up, "it got lost");
        assert!(report.collapsed > 0, "{report:?}");
    }
}
