//! What a scene lacks costs nothing: shown by counters.

use carom_dynamics::{BodyDef, BodyKind, Material, PairSearch, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};
use carom_tests::run;

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
