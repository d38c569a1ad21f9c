//! Guests of the engine in [`crate::Mode::Hybrid`] and [`crate::Mode::Exact`]: bodies that it knows and does not move.
//!
//! All kinematic bodies are guests, what came to rest or was inserted after the first member, and what rested before where a member
//! is searched for. So the first member costs by its neighbourhood, not by the world. Which bodies are guests changes no bit:
//! contacts are in the order of the world's bodies.

use carom_geometry::Aabb;
use carom_math::SimTime;
use carom_stepped::Engine;

use super::Stepping;
use super::rules::Rules;
use crate::broad::tree::Broad;
use crate::store::bodies::Bodies;
use crate::{BodyIx, BodyKind, Mode};

/// Members are searched around this far beyond their boxes, as a part of these: what moves on is not searched around each tick. 0.5:
/// a drum takes 0.8 % longer.
const AROUND: f64 = 1.0;

impl Stepping {
    /// Boxes of members that reach beyond where these were searched around, of those that the engine tells of.
    fn uncovered(&self, of: impl FnOnce(&Engine, &mut dyn FnMut(u64, Aabb))) -> Vec<(u64, Aabb)> {
        let mut boxes = Vec::new();
        of(&self.engine, &mut |tag, bounds| {
            let covered = self.covered.get(super::body(tag));
            if covered.is_none_or(|covered| !covered.contains(bounds)) {
                boxes.push((tag, bounds));
            }
        });
        boxes
    }

    /// Contacts of the sub-step that begins, also with what rests near members; whether some body came, or deviates from its predicted
    /// motion.
    pub(crate) fn search_contacts(
        &mut self,
        bodies: &mut Bodies,
        broad: &Broad,
        mode: Mode,
        time: SimTime,
    ) -> bool {
        if mode != Mode::Stepped {
            self.engine.pose_boxes();
            let boxes = self.uncovered(|engine, found| engine.new_boxes(found));
            self.invite_in(bodies, broad, boxes, time);
        }
        self.engine.find_contacts(&Rules { bodies, broad })
    }

    /// What rests where fast members go within the `left` seconds of a sub-step is known to the engine.
    pub(crate) fn invite_ahead(
        &mut self,
        bodies: &mut Bodies,
        broad: &Broad,
        time: SimTime,
        left: f64,
    ) {
        let boxes = self.uncovered(|engine, found| engine.fast_boxes(left, found));
        self.invite_in(bodies, broad, boxes, time);
    }

    /// Bodies at rest in these boxes of members, and fixed bodies beside such that sleep, enter the engine.
    fn invite_in(
        &mut self,
        bodies: &mut Bodies,
        broad: &Broad,
        boxes: Vec<(u64, Aabb)>,
        time: SimTime,
    ) {
        let (mut guests, mut near) = (Vec::new(), Vec::new());
        // Bodies of these kinds at rest in a box become guests.
        let mut note = |bounds: Aabb,
                        is_asked: fn(BodyKind) -> bool,
                        guests: &mut Vec<BodyIx>,
                        bodies: &mut Bodies| {
            broad.search_tree(bodies, bounds, &mut near);
            for at in &near {
                let index = bodies.colliders[*at].body;
                let state = bodies.get_mut(index);
                let is_new = !state.is_guest && !state.in_engine() && state.rests_or_drives();
                if is_new && is_asked(state.kind) {
                    state.is_guest = true;
                    guests.push(index);
                }
            }
        };
        for (tag, bounds) in boxes {
            let size = bounds.extents();
            let around = bounds.grown(AROUND * size.x.max(size.y));
            *self.covered.grown(super::body(tag), Aabb::EMPTY) = around;
            note(around, |_| true, &mut guests, bodies);
        }
        // The engine wakes sleepers that a fixed body is put into: one that always was there comes first.
        let mut sleeper = 0;
        while let Some(&index) = guests.get(sleeper) {
            sleeper += 1;
            if bodies.get(index).kind == BodyKind::Dynamic {
                for &at in &bodies.get(index).colliders.clone() {
                    let is_fixed = |kind| kind == BodyKind::Fixed;
                    note(bodies.colliders[at].fat, is_fixed, &mut guests, bodies);
                }
            }
        }
        guests.sort_unstable_by_key(|index| {
            let kind = bodies.get(*index).kind;
            (kind != BodyKind::Fixed, *index)
        });
        for index in guests {
            self.enter(bodies, index, time);
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::{ConvexPolygon, HalfPlane};
    use carom_math::{Vec2, vec2};

    use crate::{BodyDef, BodyId, Material, Settings, World};

    fn block(world: &mut World, def: BodyDef, width: f64, height: f64) -> BodyId {
        let shape = ConvexPolygon::rectangle(width, height).expect("a block");
        world
            .insert(def, shape, Material::default())
            .expect("valid")
    }

    /// A blade between two walls about x that stirs boxes; walls come last.
    fn stir(world: &mut World, x: f64, speed: f64) -> Vec<BodyId> {
        let blade = BodyDef::kinematic().at(vec2(x, 3.0)).spinning(speed);
        block(world, blade, 6.0, 0.4);
        let boxes = (0..12).map(|k| {
            let at = vec2(x + f64::from(k % 4) - 1.5, 4.0 + f64::from(k / 4));
            block(world, BodyDef::dynamic().at(at), 0.6, 0.6)
        });
        let boxes = boxes.collect();
        for side in [-4.0, 4.0] {
            block(world, BodyDef::fixed().at(vec2(x + side, 50.0)), 0.5, 100.0);
        }
        boxes
    }

    fn empty() -> World {
        World::new(Settings::default()).expect("valid")
    }

    fn floor(world: &mut World) {
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        world
            .insert(BodyDef::fixed(), floor, Material::default())
            .expect("valid");
    }

    #[test]
    fn the_engine_knows_what_rests_near_members_alone() {
        let mut world = empty();
        stir(&mut world, 0.0, 2.0);
        for k in 0..500 {
            let at = vec2(10.0 + 3.0 * f64::from(k), 0.5);
            block(&mut world, BodyDef::fixed().at(at), 1.0, 1.0);
            let sleeps = BodyDef::dynamic().at(at + vec2(0.0, 1.0)).asleep();
            block(&mut world, sleeps, 1.0, 1.0);
        }
        floor(&mut world);
        for _ in 0..120 {
            world.step(1.0 / 60.0);
        }
        let stepping = world.stepping.as_ref().expect("an engine");
        let known = stepping.engine.bodies().count();
        let members = world.bodies.member_count();
        // The blade, two walls and the floor.
        assert!(
            members > 0 && known <= members + 4,
            "{known} beside {members}"
        );
    }

    /// Boxes between two walls about x that fall in touch, and rub; walls come last.
    fn heap(world: &mut World, x: f64, height: f64) -> Vec<BodyId> {
        let boxes = (0..25u32).map(|k| {
            let at = vec2(x + 0.6 * f64::from(k % 6), height + 0.6 * f64::from(k / 6));
            let speed = vec2(f64::from(k * 7 % 5) - 2.0, 0.0);
            block(world, BodyDef::dynamic().at(at).moving(speed), 0.6, 0.6)
        });
        let boxes = boxes.collect();
        for side in [-1.0, 4.0] {
            block(world, BodyDef::fixed().at(vec2(x + side, 5.0)), 0.5, 10.0);
        }
        boxes
    }

    /// Both lie on one floor, and the one beside is in the engine before: it invites the floor earlier.
    #[test]
    fn a_heap_has_the_bits_that_it_has_without_another_one_beside() {
        let places = |world: &World, ids: &[BodyId]| -> Vec<[u64; 3]> {
            let bits = |id: &BodyId| {
                let body = world.body(*id).expect("there");
                let (at, angle) = (body.centre(), body.angle());
                [at.x.to_bits(), at.y.to_bits(), angle.to_bits()]
            };
            ids.iter().map(bits).collect()
        };
        let (mut alone, mut beside) = (empty(), empty());
        let own = heap(&mut alone, 0.0, 0.8);
        let same = heap(&mut beside, 0.0, 0.8);
        floor(&mut alone);
        floor(&mut beside);
        heap(&mut beside, 1000.0, 0.3);
        let mut most = [0; 2];
        for step in 0..120 {
            alone.step(1.0 / 60.0);
            beside.step(1.0 / 60.0);
            for (most, world) in most.iter_mut().zip([&alone, &beside]) {
                *most = world.bodies.member_count().max(*most);
            }
            assert_eq!(places(&alone, &own), places(&beside, &same), "step {step}");
        }
        assert_eq!(most, [25, 50]);
    }

    /// In the midst of a sub-step the box on top is thrown so far that it would be beyond a ceiling, which no member was near, when it
    /// ends.
    #[test]
    fn what_is_thrown_within_a_sub_step_meets_a_ceiling_that_no_member_was_near() {
        let mut world = empty();
        let top = heap(&mut world, 0.0, 0.3)[24];
        floor(&mut world);
        let ceiling = block(&mut world, BodyDef::fixed().at(vec2(0.0, 40.0)), 1e5, 1.0);
        for _ in 0..10 {
            world.step(1.0 / 60.0);
        }
        world.step(1e-3);
        let is_guest = world.bodies.get(ceiling.index).is_guest;
        assert!(world.bodies.get(top.index).in_engine() && !is_guest);
        world.set_velocity(top, vec2(0.0, 5e4), 0.0).expect("there");
        for _ in 0..30 {
            world.step(1.0 / 60.0);
            let y = world.body(top).expect("there").centre().y;
            assert!(y < 40.0, "through the ceiling, to {y} m");
        }
    }
}
