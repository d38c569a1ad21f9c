//! Bodies that start asleep: they cost nothing until they are struck, and then wake as others do.

use carom_dynamics::{BodyDef, BodyId, EventKind, Material, Settings, Sleep, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};

fn world(gravity: Vec2, sleep: Option<Sleep>) -> World {
    let settings = Settings {
        gravity,
        sleep,
        ..Settings::default()
    };
    World::new(settings).expect("valid")
}

/// A unit box at (x, y).
fn put(world: &mut World, def: BodyDef, x: f64, y: f64) -> BodyId {
    let square = ConvexPolygon::square(1.0).expect("a square");
    let def = def.at(vec2(x, y));
    world
        .insert(def, square, Material::default())
        .expect("valid")
}

fn is_asleep(world: &World, id: BodyId) -> bool {
    world.body(id).expect("it is there").is_asleep()
}

#[test]
fn a_sleeper_floats_until_it_is_struck() {
    let mut world = world(vec2(0.0, -10.0), Some(Sleep::default()));
    let sleeper = put(&mut world, BodyDef::dynamic().asleep(), 0.0, 0.0);
    let report = world.step(1.0);
    assert!(is_asleep(&world, sleeper));
    assert_eq!((report.pairs, report.rows), (0, 0));
    let body = world.body(sleeper).expect("it is there");
    assert_eq!((body.centre(), body.velocity()), (Vec2::ZERO, Vec2::ZERO));
    assert_eq!(world.energy().residual(), 0.0);

    let ball = Circle::new(0.25).expect("a ball");
    let def = BodyDef::dynamic()
        .at(vec2(-3.0, 0.0))
        .moving(vec2(20.0, 1.0));
    world.insert(def, ball, Material::default()).expect("valid");
    world.step(0.5);
    assert!(!is_asleep(&world, sleeper));
    let body = world.body(sleeper).expect("it is there");
    assert!(body.velocity().x > 0.5, "{}", body.velocity());
    assert!(
        body.centre().y < -0.5,
        "it falls once awake: {}",
        body.centre()
    );
    let ledger = world.energy();
    assert!(
        ledger.residual().abs() < 1e-12 * ledger.external.abs(),
        "{:e} J unaccounted for",
        ledger.residual()
    );
}

#[test]
fn a_blow_wakes_a_whole_row_of_sleepers_at_its_instant() {
    let mut world = world(Vec2::ZERO, Some(Sleep::default()));
    let row: Vec<_> = (0..20)
        .map(|i| put(&mut world, BodyDef::dynamic().asleep(), f64::from(i), 0.0))
        .collect();
    // A metre of gap at 60 m/s: it strikes after 1/60 s.
    let ram = BodyDef::dynamic().moving(vec2(60.0, 0.0));
    put(&mut world, ram, -2.0, 0.0);
    world.step(1.0 / 120.0);
    assert!(row.iter().all(|id| is_asleep(&world, *id)));
    let mut woken = Vec::new();
    for _ in 0..4 {
        world.step(1.0 / 120.0);
        for event in world.events().iter() {
            if matches!(event.kind, EventKind::Awake(_)) {
                woken.push(event.time);
            }
        }
    }
    assert!(row.iter().all(|id| !is_asleep(&world, *id)));
    assert_eq!(woken.len(), row.len());
    let first = woken[0];
    assert!((first.as_secs() - 1.0 / 60.0).abs() < 1e-12);
    assert!(woken.iter().all(|time| *time == first), "{woken:?}");
}

#[test]
fn a_body_that_moves_and_a_world_without_sleep_start_awake() {
    let asleep = BodyDef::dynamic().asleep();
    let mut without = world(Vec2::ZERO, None);
    let body = put(&mut without, asleep, 0.0, 0.0);
    assert!(!is_asleep(&without, body));

    let mut with = world(Vec2::ZERO, Some(Sleep::default()));
    let moving = put(&mut with, asleep.moving(vec2(1.0, 0.0)), 0.0, 0.0);
    let turning = put(&mut with, asleep.spinning(1.0), 5.0, 0.0);
    let fixed = put(&mut with, BodyDef::fixed().asleep(), 10.0, 0.0);
    for id in [moving, turning, fixed] {
        assert!(!is_asleep(&with, id));
    }
}

#[test]
fn a_sleeper_wakes_where_its_floor_is_taken_away() {
    let mut world = world(vec2(0.0, -10.0), Some(Sleep::default()));
    let floor = put(&mut world, BodyDef::fixed(), 0.0, -1.0);
    let sleeper = put(&mut world, BodyDef::dynamic().asleep(), 0.0, 0.0);
    world.step(0.1);
    assert!(is_asleep(&world, sleeper));
    world.remove(floor).expect("it is there");
    world.step(0.1);
    assert!(!is_asleep(&world, sleeper));
    assert!(world.body(sleeper).expect("it is there").velocity().y < -0.9);
}
