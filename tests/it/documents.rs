//! Errors of the documents' engines, each held to what is right. The others live where they belong:
//! moments in `carom-geometry`, detection in `carom-collision`, the impulse in `carom_dynamics::impact`.

use carom_dynamics::{BodyDef, Impulse, Material, PairSearch, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;

fn disc(radius: f64) -> Circle {
    Circle::new(radius).expect("a disc")
}

#[test]
fn flying_balls_11_indexed_velocities_where_positions_belong() {
    // Two fast discs far apart in velocity and near in place meet, whichever search is used.
    let impacts = |search| {
        let settings = Settings {
            gravity: Vec2::ZERO,
            pair_search: search,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid");
        for (x, v) in [(-1.0, 30.0), (1.0, -40.0), (200.0, 30.0)] {
            let def = BodyDef::dynamic().at(vec2(x, 0.0)).moving(vec2(v, 0.0));
            world.insert(def, disc(0.5), elastic()).expect("valid");
        }
        world.step(0.1).impacts
    };
    assert_eq!(impacts(PairSearch::Indexed), 1);
    assert_eq!(impacts(PairSearch::AllPairs), 1);
}

#[test]
fn thesis_19_a_given_mass_kept_the_old_inertia() {
    let mut world = World::new(Settings::default()).expect("valid");
    let square = ConvexPolygon::square(2.0).expect("a square");
    let def = BodyDef::dynamic().with_mass(8.0);
    let id = world
        .insert(def, square, Material::default())
        .expect("valid");
    let body = world.body(id).expect("it is there");
    // Twice the mass that the density gives, and twice the inertia with it: m s² / 6.
    assert!((body.inertia() - 8.0 * 4.0 / 6.0).abs() < 1e-14);
}

#[test]
fn flying_balls_20_the_core_gave_back_all_speed_whatever_its_material() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    let dull = Material {
        restitution: 0.25,
        friction: 0.0,
        ..Material::default()
    };
    world
        .insert(BodyDef::fixed(), disc(1.0), dull)
        .expect("valid");
    let def = BodyDef::dynamic()
        .at(vec2(4.0, 0.0))
        .moving(vec2(-2.0, 0.0));
    let ball = world.insert(def, disc(0.5), dull).expect("valid");
    world.step(3.0);
    let v = world.body(ball).expect("it stays").velocity();
    assert!((v - vec2(0.5, 0.0)).length() < 1e-14, "{v}");
}

#[test]
fn flying_balls_21_walls_moved_a_ball_without_its_energy() {
    let mut world = World::new(Settings::default()).expect("valid");
    let floor = ConvexPolygon::rectangle(10.0, 1.0).expect("a floor");
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, elastic())
        .expect("valid");
    world
        .insert(BodyDef::dynamic().at(vec2(0.0, 3.0)), disc(0.5), elastic())
        .expect("valid");
    let before = world.energy().mechanical();
    for _ in 0..600 {
        world.step(1.0 / 60.0);
        let now = world.energy().mechanical();
        assert!((now / before - 1.0).abs() < 1e-11, "{now} J of {before} J");
    }
}

#[test]
fn flying_balls_23_knew_no_friction_and_no_rotation_from_ball_contacts() {
    // A disc that slides comes to roll at 2/3 of its first speed.
    let mut world = World::new(Settings::default()).expect("valid");
    let rough = Material {
        friction: 0.5,
        ..Material::default()
    };
    let floor = ConvexPolygon::rectangle(40.0, 1.0).expect("a floor");
    world
        .insert(BodyDef::fixed().at(vec2(0.0, -0.5)), floor, rough)
        .expect("valid");
    let def = BodyDef::dynamic()
        .at(vec2(-10.0, 0.5))
        .moving(vec2(3.0, 0.0));
    let ball = world.insert(def, disc(0.5), rough).expect("valid");
    world.step(3.0);
    let body = world.body(ball).expect("it stays");
    assert!(
        (body.velocity().x - 2.0).abs() < 1e-3,
        "{}",
        body.velocity()
    );
    assert!(
        (body.angular_velocity() + 4.0).abs() < 2e-3,
        "{}",
        body.angular_velocity()
    );
}

#[test]
fn engine_article_27_took_the_arm_from_the_origin_where_the_centre_of_mass_is_right() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    let square = ConvexPolygon::square(2.0).expect("a square");
    let def = BodyDef::dynamic().at(vec2(100.0, 0.0));
    let id = world
        .insert(def, square, Material::default())
        .expect("valid");
    let centre = vec2(100.0, 0.0);
    world
        .apply(id, Impulse::at(centre, vec2(0.0, 4.0)))
        .expect("valid");
    let body = world.body(id).expect("it is there");
    assert_eq!(
        body.angular_velocity(),
        0.0,
        "a push at the centre does not turn"
    );
    assert_eq!(body.velocity(), vec2(0.0, 1.0));
}
