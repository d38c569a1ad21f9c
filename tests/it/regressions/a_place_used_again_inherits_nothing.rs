//! What was foreseen for a body is dropped when it comes up, not when the body is removed: the body that has its place
//! by then must know nothing of it.

use carom_dynamics::{BodyDef, BodyId, EventKind, Settings, World};
use carom_geometry::{Circle, HalfPlane, Shape};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::scenes::surface;

/// A ball that bounces ever faster, until 1.35 s, or flies past.
fn ball(world: &mut World, at: Vec2) -> BodyId {
    let circle = Circle::new(0.25).expect("a ball");
    world
        .insert(BodyDef::dynamic().at(at), circle, surface(0.5, 0.3))
        .expect("valid")
}

/// Instants and kinds of all that happens within `seconds`, and where the body is then.
fn course(world: &mut World, id: BodyId, seconds: f64) -> (Vec<(SimTime, String)>, Vec2) {
    let mut found = Vec::new();
    let end = world.time() + seconds;
    while world.time() < end {
        world.step_to_next_event(end - world.time());
        for event in world.events() {
            let kind = match event.kind {
                EventKind::Impact { point, .. } => format!("impact at {point}"),
                EventKind::Collapse { a, b, .. } => {
                    assert!(a == id || b == id, "{a:?} and {b:?} are not there");
                    "collapse".to_owned()
                }
                _ => continue,
            };
            found.push((event.time, kind));
        }
    }
    (found, world.body(id).expect("it is there").centre())
}

#[test]
fn a_place_used_again_inherits_nothing() {
    for gone_at in [0.0, 0.2, 0.5, 0.9, 1.3, 1.34] {
        let worlds = [false, true].map(|haunted| {
            let mut world = World::new(Settings::default()).expect("valid");
            let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
            let floor = Shape::from(floor);
            world
                .insert(BodyDef::fixed(), floor, surface(0.5, 0.3))
                .expect("valid");
            if haunted {
                let old = ball(&mut world, vec2(0.0, 1.25));
                world.step(gone_at);
                world.remove(old).expect("it is there");
            } else {
                world.step(gone_at);
            }
            let id = ball(&mut world, vec2(0.5, 2.25));
            assert_eq!(id.index(), 1);
            course(&mut world, id, 3.0)
        });
        assert!(worlds[0].0.len() > 10, "it bounces");
        assert_eq!(worlds[0], worlds[1], "after {gone_at} s");
    }
}
