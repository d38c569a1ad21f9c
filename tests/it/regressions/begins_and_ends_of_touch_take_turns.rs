//! Looks of many kinds say whether two bodies touch, and some of them changed it without an event: callers were told of a
//! touch that began twice, or ended before it began. A body on a belt began to touch it twice within a sub-step.

use std::collections::BTreeSet;

use carom_dynamics::{BodyDef, BodyId, EventKind, Material, Mode, World};
use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface, walled};

/// Bodies in touch, as told by events.
#[derive(Default)]
struct Told(BTreeSet<(BodyId, BodyId)>);

impl Told {
    fn hear(&mut self, world: &World) {
        assert_eq!(world.events().dropped(), 0);
        for event in world.events() {
            let turn = match event.kind {
                EventKind::Begin { a, b, .. } => self.0.insert((a.min(b), a.max(b))),
                EventKind::End { a, b, .. } => self.0.remove(&(a.min(b), a.max(b))),
                _ => continue,
            };
            assert!(turn, "out of turn: {event:?}");
            assert!(event.time <= world.time(), "not yet: {event:?}");
        }
        for contact in world.contacts() {
            let pair = (contact.a.min(contact.b), contact.a.max(contact.b));
            assert!(self.0.contains(&pair), "not told of {contact:?}");
        }
    }
}

#[test]
fn what_lands_on_a_belt_begins_to_touch_it_once() {
    let belt = Material {
        tangent_speed: 0.5,
        ..surface(0.0, 0.0)
    };
    let mut world = walled(Mode::Hybrid, vec2(3.0, 3.0), surface(0.0, 0.0));
    put(
        &mut world,
        BodyDef::dynamic().at(vec2(0.0, -2.3)),
        disc(0.3),
        belt,
    );
    let mut told = Told::default();
    for _ in 0..60 {
        world.step(1.0 / 60.0);
        told.hear(&world);
    }
    assert_eq!(told.0.len(), 1, "it lies on the floor");
}

#[test]
fn begins_and_ends_of_touch_take_turns() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let material = surface(0.3, 0.5);
        let mut world = walled(mode, vec2(3.0, 3.0), material);
        let mut bodies = Vec::new();
        for k in 0..12_u32 {
            let (row, column) = (f64::from(k / 4), f64::from(k % 4));
            let at = vec2(1.3 * column - 1.9, 1.2 * row - 1.0);
            let def = BodyDef::dynamic()
                .at(at)
                .turned(0.7 * f64::from(k))
                .moving(vec2(2.0 - row, column - 1.0) * 2.0)
                .spinning(column - 2.0);
            let shape: Shape = match k % 3 {
                0 => block(0.7, 0.4).into(),
                1 => disc(0.3).into(),
                _ => ConvexPolygon::regular(5, 0.4).expect("a pentagon").into(),
            };
            bodies.push(put(&mut world, def, shape, material));
        }
        let mut told = Told::default();
        for step in 0..180_usize {
            // A length that no sub-step ends with.
            world.step(0.0123);
            told.hear(&world);
            match step {
                40 | 90 => world.set_velocity(bodies[step % 12], vec2(0.0, 4.0), 1.0),
                60 => world.remove(bodies[1]),
                120 => world.teleport(bodies[2], carom_math::Pose::at(Vec2::ZERO)),
                _ => Ok(()),
            }
            .expect("it is there");
        }
    }
}
