//! What flies in a field or with damping goes from piece to piece of its law. A new filter or a new kind took the piece away, but
//! not the law, so that no other piece ever began: the law was asked for far beyond what it covers. A body beside a planet
//! went 1e6 m/s after four seconds, and a damped one was foreseen to be where it never came.

use carom_dynamics::{BodyDef, BodyId, BodyKind, Filter, RadialField, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{disc, floor, put, surface};

/// A ball that bounces above a floor, damped and pulled by a planet beside it.
fn world() -> (World, BodyId) {
    let mut world = World::new(Settings::default()).expect("valid settings");
    floor(&mut world, surface(0.8, 0.5));
    let planet = RadialField::new(vec2(6.0, 2.0), 20.0, 0.5).expect("a planet");
    world.add_field(planet);
    let def = BodyDef::dynamic()
        .at(vec2(0.0, 3.0))
        .moving(vec2(1.0, 2.0))
        .damped(0.1, 0.1);
    let ball = put(&mut world, def, disc(0.25), surface(0.8, 0.5));
    (world, ball)
}

fn agree(name: &str, one: &World, other: &World, ball: BodyId) {
    let [one, other] = [one, other].map(|world| world.body(ball).expect("it is there"));
    let off = (one.centre() - other.centre()).length();
    assert!(
        off < 1e-9,
        "{name}: {off:e} m off, at {} for {}",
        one.centre(),
        other.centre()
    );
}

#[test]
fn a_changed_free_body_keeps_its_law() {
    let (mut untouched, ball) = world();
    let (mut filtered, _) = world();
    let (mut driven, _) = world();
    let start = {
        let body = driven.body(ball).expect("it is there");
        (body.pose(), body.velocity())
    };
    driven
        .set_kind(ball, BodyKind::Kinematic)
        .expect("it is there");
    driven
        .set_velocity(ball, Vec2::ZERO, 0.0)
        .expect("it is there");
    driven
        .set_kind(ball, BodyKind::Dynamic)
        .expect("it is there");
    driven.teleport(ball, start.0).expect("it is there");
    driven
        .set_velocity(ball, start.1, 0.0)
        .expect("it is there");
    driven
        .set_kind(ball, BodyKind::Dynamic)
        .expect("it is there");
    for step in 0..8 {
        filtered
            .set_filter(ball, Filter::default())
            .expect("it is there");
        for world in [&mut untouched, &mut filtered, &mut driven] {
            world.step(0.25);
        }
        let time = f64::from(step + 1) * 0.25;
        agree(
            &format!("a new filter, {time} s"),
            &filtered,
            &untouched,
            ball,
        );
        agree(
            &format!("another kind, {time} s"),
            &driven,
            &untouched,
            ball,
        );
    }
}
