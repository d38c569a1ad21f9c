//! What a scene lacks costs nothing: shown by counters.

use carom_dynamics::{BodyDef, BodyKind, Event, EventKind, Material, PairSearch, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon};
use carom_math::{Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn bodies_far_apart_make_no_pairs_and_no_rows() {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    })
    .expect("valid");
    for i in 0..100 {
        let at = vec2(5.0 * f64::from(i), 0.0);
        let disc = Circle::new(0.5).expect("a disc");
        world
            .insert(
                BodyDef::dynamic().at(at).moving(vec2(0.0, 1.0)),
                disc,
                Material::default(),
            )
            .expect("valid");
    }
    let report = world.step(1.0);
    assert_eq!(
        (
            report.pairs,
            report.rows,
            report.impacts,
            report.handed_over
        ),
        (0, 0, 0, 0)
    );
    assert!(report.is_exact());
    // One change at insertion gives a body its flight; a second of flying changes nothing more.
    let version = world.bodies().next().expect("a disc").version();
    world.step(1.0);
    assert_eq!(world.bodies().next().expect("a disc").version(), version);
}

#[test]
fn fixed_bodies_make_no_pairs_among_themselves() {
    let mut world = World::new(Settings::default()).expect("valid");
    for _ in 0..20 {
        let block = ConvexPolygon::square(1.0).expect("a block");
        world
            .insert(BodyDef::fixed(), block, Material::default())
            .expect("valid");
    }
    let report = world.step(1.0);
    assert_eq!((report.pairs, report.rows), (0, 0));
}

#[test]
fn without_pair_search_everything_passes_through() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        pair_search: PairSearch::None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    let disc = || Circle::new(0.5).expect("a disc");
    let a = world
        .insert(
            BodyDef::dynamic()
                .at(vec2(-2.0, 0.0))
                .moving(vec2(2.0, 0.0)),
            disc(),
            Material::default(),
        )
        .expect("valid");
    world
        .insert(BodyDef::dynamic(), disc(), Material::default())
        .expect("valid");
    let report = world.step(2.0);
    assert_eq!(report.impacts, 0);
    assert!((world.body(a).expect("it stays").centre() - vec2(2.0, 0.0)).length() < 1e-14);
}

#[test]
fn a_sleeping_stack_is_not_looked_at_and_wakes_when_struck() {
    let scene = carom_scenes::find("stack").expect("a built-in scene");
    let mut world = scene.build().expect("it builds").world;
    run(&mut world, 5.0, |_| {});
    assert!(
        world
            .bodies()
            .filter(|b| b.kind() == BodyKind::Dynamic)
            .all(|b| b.is_asleep())
    );
    let report = world.step(1.0);
    assert_eq!((report.pairs, report.rows, report.handed_over), (0, 0, 0));
    let ball = BodyDef::dynamic()
        .at(vec2(-5.0, 5.0))
        .moving(vec2(20.0, 0.0));
    world
        .insert(ball, Circle::new(0.3).expect("a ball"), Material::default())
        .expect("valid");
    world.step(1.0);
    assert!(
        world
            .bodies()
            .any(|b| b.kind() == BodyKind::Dynamic && !b.is_asleep())
    );
}

#[test]
fn a_stack_that_stands_needs_no_sub_steps() {
    let mut world = World::new(Settings {
        sleep: None,
        ..Settings::default()
    })
    .expect("valid");
    let floor = ConvexPolygon::rectangle(20.0, 1.0).expect("a floor");
    let stone = Material {
        restitution: 0.0,
        ..Material::default()
    };
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, stone)
        .expect("valid");
    for k in 0..3 {
        let block = ConvexPolygon::square(1.0).expect("a block");
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5 + f64::from(k)));
        world.insert(def, block, stone).expect("valid");
    }
    world.step(1.0 / 60.0);
    let report = world.step(10.0);
    assert_eq!((report.substeps, report.pairs, report.rows), (0, 0, 0));
    assert!(world.bodies().all(|body| !body.is_asleep()));
    // What falls on it is met all the same, and the stack stands on.
    let ball = Circle::new(0.25).expect("a ball");
    world
        .insert(BodyDef::dynamic().at(vec2(0.0, 4.0)), ball, stone)
        .expect("valid");
    let report = world.step(2.0);
    assert!(report.impacts > 0, "{report:?}");
    let fastest = world.bodies().map(|body| body.velocity().length());
    let fastest = fastest.fold(0.0, f64::max);
    assert!(fastest < 1e-9, "{fastest:e} m/s, {report:?}");
    let top = world.bodies().last().expect("the ball").centre();
    assert!((top - vec2(0.0, 3.25)).length() < 1e-9, "{top}");
    assert_eq!(world.step(10.0).substeps, 0);
}

/// The mode of a slide holds the foot of a hook on its floor; its arm is searched for. Shapes of several parts were followed with
/// sub-steps.
#[test]
fn a_hook_that_slides_strikes_with_its_arm_and_needs_no_sub_steps() {
    let mut world = World::new(Settings::default()).expect("valid");
    let smooth = surface(1.0, 0.0);
    for (at, outward) in [(Vec2::ZERO, Vec2::Y), (vec2(3.0, 0.0), -Vec2::X)] {
        let wall = HalfPlane::new(at, outward).expect("a wall");
        put(&mut world, BodyDef::fixed(), wall, smooth);
    }
    let corners = [
        vec2(-0.5, 0.0),
        vec2(0.5, 0.0),
        vec2(0.5, 0.2),
        vec2(1.0, 0.2),
        vec2(1.0, 0.4),
        vec2(0.3, 0.4),
        vec2(0.3, 0.2),
        vec2(-0.5, 0.2),
    ];
    let hook = Polygon::new(corners.to_vec()).expect("a hook");
    let def = BodyDef::dynamic().at(vec2(1.0, 0.0)).moving(vec2(2.0, 0.0));
    let id = put(&mut world, def, hook, smooth);
    world.step(0.1);
    let report = world.step(0.39);
    assert_eq!((report.substeps, report.impacts), (0, 0), "{report:?}");
    assert!(report.is_exact());
    world.step(0.1);
    let strikes = |event: &&Event| matches!(event.kind, EventKind::Impact { .. });
    let at = world
        .events()
        .iter()
        .find(strikes)
        .expect("it strikes")
        .time;
    assert!((at.as_secs() - 0.5).abs() < 1e-12, "{at:?}");
    assert!(world.body(id).expect("there").velocity().x < 0.0);
}

/// A landing solves for the modes of the group that it joins anew, and what that does to the others' pairs is asked too: boxes that were
/// not asked joined the engine of large islands, and sank in there.
#[test]
fn stacks_that_land_at_once_stand_without_sub_steps() {
    let mut world = World::new(Settings {
        sleep: None,
        ..Settings::default()
    })
    .expect("valid");
    let stone = Material {
        restitution: 0.0,
        ..Material::default()
    };
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(&mut world, floor, block(3200.0, 2.0), stone);
    for (i, k) in (0..20).flat_map(|i| (0..10).map(move |k| (i, k))) {
        let at = vec2(-1500.0 + 3.0 * f64::from(i), 0.5 + f64::from(k));
        put(
            &mut world,
            BodyDef::dynamic().at(at),
            block(1.0, 1.0),
            stone,
        );
    }
    world.step(1.0 / 60.0);
    let report = world.step(1.0);
    assert_eq!((report.substeps, report.impacts), (0, 0), "{report:?}");
    let depths = world.contacts().flat_map(|contact| {
        let points = contact.points.iter().map(|point| point.separation);
        points.collect::<Vec<_>>()
    });
    let deepest = depths.fold(0.0, f64::min);
    assert!(deepest > -1e-12, "{deepest:e} m");
}

/// What slides or rolls moves in closed form until it stops or strikes, without sub-steps.
#[test]
fn what_slides_and_rolls_on_a_plane_needs_no_sub_steps() {
    const G: f64 = 9.81;
    let mut world = World::new(Settings {
        gravity: vec2(0.0, -G),
        sleep: None,
        ..Settings::default()
    })
    .expect("valid");
    let rough = surface(0.0, 0.5);
    let plane = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a plane");
    put(&mut world, BodyDef::fixed(), plane, rough);
    let mut bodies = Vec::new();
    for k in 0..50 {
        let speed = 2.0 + 0.02 * f64::from(k);
        let at = vec2(20.0 * f64::from(k), 0.5);
        let def = BodyDef::dynamic().at(at).moving(vec2(speed, 0.0));
        let id = if k % 2 == 0 {
            put(&mut world, def, block(1.0, 1.0), rough)
        } else {
            put(&mut world, def.spinning(-speed / 0.5), disc(0.5), rough)
        };
        bodies.push((id, at.x, speed));
    }
    world.step(1.0 / 60.0);
    let report = world.step(3.0 - 1.0 / 60.0);
    assert_eq!((report.substeps, report.rows), (0, 0), "{report:?}");
    for (k, (id, from, speed)) in bodies.into_iter().enumerate() {
        let way = if k % 2 == 0 {
            speed * speed / (2.0 * 0.5 * G)
        } else {
            speed * 3.0
        };
        let off = world.body(id).expect("it is there").centre().x - (from + way);
        assert!(off.abs() < 1e-12, "body {k} is {off:e} m off");
    }
}
