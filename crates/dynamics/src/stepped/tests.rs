//! What is kept from step to step does not grow.

use carom_geometry::ConvexPolygon;
use carom_math::{Pose, Vec2, vec2};

use crate::{BodyDef, BodyId, Material, Mode, Settings, World};

fn block(world: &mut World, def: BodyDef, size: Vec2, material: Material) -> BodyId {
    let shape = ConvexPolygon::rectangle(size.x, size.y).expect("a rectangle");
    world.insert(def, shape, material).expect("a valid body")
}

fn world(mode: Mode) -> World {
    World::new(Settings {
        mode,
        sleep: None,
        ..Settings::default()
    })
    .expect("valid settings")
}

#[test]
fn a_body_changed_a_thousand_times_between_sub_steps_is_noted_now_and_then() {
    let mut world = world(Mode::Stepped);
    let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
    let id = block(&mut world, def, vec2(1.0, 1.0), Material::default());
    for k in 0..1000 {
        let v = vec2(f64::from(k), 0.0);
        world.set_velocity(id, v, 0.0).expect("it is there");
    }
    let noted = world.bodies.touched.len();
    assert!(noted <= 66, "noted {noted} times");
}

#[test]
fn a_member_flies_after_three_ticks_however_often_a_caller_changes_others() {
    let mut world = world(Mode::Hybrid);
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    block(&mut world, floor, vec2(60.0, 2.0), Material::default());
    let mut boxes = Vec::new();
    for i in 0..30 {
        let at = vec2(f64::from(i % 6), 0.5 + f64::from(i / 6));
        let def = BodyDef::dynamic().at(at);
        boxes.push(block(&mut world, def, vec2(1.0, 1.0), Material::default()));
    }
    let (top, other) = (boxes[29], boxes[0]);
    world.step(0.2);
    assert!(world.bodies.get(top.index).in_crowd, "the wall is a crowd");
    let high = Pose::at(vec2(0.0, 40.0));
    world.teleport(top, high).expect("it is there");
    let h = world.settings.substep;
    let mut waited = 0;
    while world.bodies.get(top.index).in_crowd {
        world
            .set_velocity(other, Vec2::ZERO, 0.0)
            .expect("it is there");
        world.step(h);
        waited += 1;
        assert!(waited < 1000, "it never flies");
    }
    assert!(
        waited >= 12,
        "it flies after {waited} sub-steps, two ticks are 12"
    );
}

/// A hundred boxes that rested from the start were carried from year to year of the calendar by the ends of searches
/// that they had entered as flyers.
#[test]
fn a_pile_that_landed_leaves_nothing_in_the_calendar() {
    let mut world = world(Mode::Hybrid);
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    block(&mut world, floor, vec2(60.0, 2.0), Material::default());
    for i in 0..100 {
        let at = vec2(f64::from(i % 10), 0.5 + f64::from(i / 10));
        let def = BodyDef::dynamic().at(at);
        block(&mut world, def, vec2(1.0, 1.0), Material::default());
    }
    let mut most = 0;
    for _ in 0..120 {
        world.step(1.0 / 60.0);
        most = most.max(world.flyers.ahead());
    }
    assert_eq!(world.pool.crowd.members, 100);
    assert_eq!(world.flyers.ahead(), 0, "of {most} at most");
    assert!(most > 0, "they flew before they landed");
}
