//! What a world refuses, in the words it uses, unchanged.

use carom_dynamics::{
    BodyDef, BodyKind, Force, Impulse, Material, PairMaterial, Settings, Softness, World,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon, Segment};
use carom_math::{Pose, Vec2, vec2};

fn disc() -> Circle {
    Circle::new(0.5).expect("a disc")
}

fn refusal(def: BodyDef, material: Material) -> String {
    let mut world = World::new(Settings::default()).expect("valid");
    let before = world.state_hash();
    let error = world.insert(def, disc(), material).expect_err("refused");
    assert_eq!(world.state_hash(), before);
    assert_eq!(world.bodies().count(), 0);
    error.to_string()
}

#[test]
fn only_fixed_bodies_have_half_planes() {
    let ground = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("up");
    let parts = || {
        vec![
            (disc().into(), Material::default()),
            (ground.into(), Material::default()),
        ]
    };
    let mut world = World::new(Settings::default()).expect("valid");
    let error = world
        .insert_compound(BodyDef::dynamic(), parts())
        .expect_err("refused");
    let words = "shape 1 is a half-plane, which only a fixed body can have";
    assert_eq!(error.to_string(), words);
    let fixed = world
        .insert_compound(BodyDef::fixed(), parts())
        .expect("does not move");
    let error = world
        .set_kind(fixed, BodyKind::Kinematic)
        .expect_err("refused");
    assert_eq!(error.to_string(), words);
    world.step(0.1);
    assert!(world.body(fixed).expect("inserted").centre().is_finite());
}

#[test]
fn materials_say_which_number_is_wrong() {
    let with = |material| refusal(BodyDef::dynamic(), material);
    let fine = Material::default();
    assert_eq!(
        with(Material {
            restitution: 1.5,
            ..fine
        }),
        "restitution is 1.5, outside 0..1"
    );
    assert_eq!(
        with(Material {
            restitution: -0.1,
            ..fine
        }),
        "restitution is -0.1, outside 0..1"
    );
    assert_eq!(
        with(Material {
            restitution: f64::NAN,
            ..fine
        }),
        "restitution is NaN, not a finite number"
    );
    assert_eq!(
        with(Material {
            friction: -0.2,
            ..fine
        }),
        "friction is -0.2, below 0"
    );
    assert_eq!(
        with(Material {
            friction: f64::INFINITY,
            ..fine
        }),
        "friction is inf, not a finite number"
    );
    assert_eq!(
        with(Material {
            density: -1.0,
            ..fine
        }),
        "density is -1, below 0"
    );
    assert_eq!(
        with(Material {
            density: 0.0,
            ..fine
        }),
        "the shapes of the moving body have no mass (density 0), and none is given"
    );
}

#[test]
fn definitions_say_which_field_is_wrong() {
    let with = |def| refusal(def, Material::default());
    assert_eq!(
        with(BodyDef::dynamic().at(vec2(f64::NAN, 0.0))),
        "position.x is NaN, not a finite number"
    );
    assert_eq!(
        with(BodyDef::dynamic().at(vec2(0.0, 1e13))),
        "position.y is 1e13, beyond the limit of 1e12"
    );
    assert_eq!(
        with(BodyDef::dynamic().turned(f64::INFINITY)),
        "angle is inf, not a finite number"
    );
    assert_eq!(
        with(BodyDef::dynamic().moving(vec2(0.0, f64::NEG_INFINITY))),
        "velocity.y is -inf, not a finite number"
    );
    assert_eq!(
        with(BodyDef::dynamic().spinning(f64::NAN)),
        "spin is NaN, not a finite number"
    );
    assert_eq!(
        with(BodyDef::dynamic().with_mass(0.0)),
        "mass is 0, not above 0"
    );
    assert_eq!(
        with(BodyDef::dynamic().with_inertia(-2.0)),
        "inertia is -2, not above 0"
    );
    assert_eq!(
        with(BodyDef::dynamic().with_centre(vec2(f64::NAN, 0.0))),
        "centre.x is NaN, not a finite number"
    );
    assert_eq!(
        with(BodyDef::dynamic().with_gravity_scale(f64::NAN)),
        "gravity_scale is NaN, not a finite number"
    );
}

#[test]
fn a_given_mass_allows_density_zero() {
    let mut world = World::new(Settings::default()).expect("valid");
    let light = Material {
        density: 0.0,
        ..Material::default()
    };
    let id = world
        .insert(BodyDef::dynamic().with_mass(2.0), disc(), light)
        .expect("a mass is given");
    let body = world.body(id).expect("it is there");
    assert_eq!((body.mass(), body.inertia()), (2.0, 0.25));
}

#[test]
fn setters_refuse_and_leave_the_world_as_it_was() {
    let mut world = World::new(Settings::default()).expect("valid");
    let id = world
        .insert(BodyDef::dynamic(), disc(), Material::default())
        .expect("valid");
    let other = world
        .insert(
            BodyDef::dynamic().at(vec2(3.0, 0.0)),
            disc(),
            Material::default(),
        )
        .expect("valid");
    let before = world.state_hash();
    let nan = vec2(f64::NAN, 0.0);
    let errors = [
        world.set_velocity(id, nan, 0.0),
        world.set_velocity(id, Vec2::ZERO, f64::INFINITY),
        world.teleport(id, Pose::at(nan)),
        world.apply(id, Impulse::central(nan)),
        world.apply(id, Impulse::at(nan, Vec2::X)),
        world.apply_force(id, Force::central(vec2(0.0, f64::NAN))),
        world.apply_force(id, Force::torque(f64::NAN)),
        world.set_pair_material(
            id,
            id,
            PairMaterial {
                friction: 0.1,
                restitution: 0.1,
                ..PairMaterial::default()
            },
        ),
        world.set_pair_material(
            id,
            other,
            PairMaterial {
                friction: 0.1,
                restitution: 1.1,
                ..PairMaterial::default()
            },
        ),
    ];
    let said: Vec<String> = errors
        .into_iter()
        .map(|e| e.expect_err("refused").to_string())
        .collect();
    assert_eq!(
        said,
        [
            "velocity.x is NaN, not a finite number",
            "spin is inf, not a finite number",
            "position.x is NaN, not a finite number",
            "impulse.x is NaN, not a finite number",
            "point.x is NaN, not a finite number",
            "force.y is NaN, not a finite number",
            "torque is NaN, not a finite number",
            "body 0 cannot form a pair with itself",
            "restitution is 1.1, outside 0..1",
        ]
    );
    assert_eq!(world.state_hash(), before);
}

#[test]
fn a_stale_id_is_an_error_and_never_another_body() {
    let mut world = World::new(Settings::default()).expect("valid");
    let old = world
        .insert(BodyDef::dynamic(), disc(), Material::default())
        .expect("valid");
    world.remove(old).expect("it is there");
    let new = world
        .insert(BodyDef::dynamic(), disc(), Material::default())
        .expect("valid");
    assert_eq!(new.index(), old.index(), "the place is used again");
    assert_ne!(new, old);
    assert!(world.body(old).is_none());
    assert_eq!(world.pose_at(old, world.time()), None);
    let said = world
        .apply(old, Impulse::central(Vec2::X))
        .expect_err("stale")
        .to_string();
    assert_eq!(said, "body 0 is not in this world");
    assert_eq!(
        world.remove(old).expect_err("stale").to_string(),
        "body 0 is not in this world"
    );
    assert_eq!(world.set_velocity(new, Vec2::X, 0.0), Ok(()));
}

#[test]
fn settings_say_which_field_is_wrong() {
    let with = |settings| World::new(settings).expect_err("refused").to_string();
    let fine = Settings::default();
    assert_eq!(
        with(Settings {
            gravity: vec2(0.0, f64::NAN),
            ..fine
        }),
        "settings.gravity.y is NaN, not a finite number"
    );
    assert_eq!(
        with(Settings {
            gravity: vec2(-1e13, 0.0),
            ..fine
        }),
        "settings.gravity.x is -10000000000000, outside -1000000000000..1000000000000"
    );
    assert_eq!(
        with(Settings { tick: 0.0, ..fine }),
        "settings.tick is 0, not above 0"
    );
    assert_eq!(
        with(Settings {
            substep: -1.0,
            ..fine
        }),
        "settings.substep is -1, not above 0"
    );
    let loose = Softness {
        over_relaxation: 2.5,
        ..Softness::default()
    };
    assert_eq!(
        with(Settings {
            contact: loose,
            ..fine
        }),
        "settings.contact.over_relaxation is 2.5, outside 0.1..1.9"
    );
}

#[test]
fn shapes_say_which_vertex_or_number_is_wrong() {
    let polygon = |points: &[(f64, f64)]| {
        let points: Vec<Vec2> = points.iter().map(|(x, y)| vec2(*x, *y)).collect();
        Polygon::new(points).expect_err("refused").to_string()
    };
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, 0.0)]),
        "a polygon needs 3 distinct vertices, got 2"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (1.0, 0.0)]),
        "a polygon needs 3 distinct vertices, got 2"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]),
        "the polygon is degenerate: its vertices enclose no area"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]),
        "the polygon intersects itself: edge 0 meets edge 2"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, f64::NAN), (0.0, 1.0)]),
        "vertex 1 is not finite: NaN in its y coordinate"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, 0.0), (f64::INFINITY, 1.0)]),
        "vertex 2 is not finite: inf in its x coordinate"
    );
    assert_eq!(
        polygon(&[(0.0, 0.0), (2e12, 0.0), (0.0, 1.0)]),
        "vertex 1 is too large: 2e12 in its x coordinate, limit 1e12"
    );
    assert!(
        Polygon::new([vec2(0.0, 0.0), vec2(0.0, 1.0), vec2(1.0, 0.0)]).is_ok(),
        "clockwise is accepted"
    );
    assert_eq!(
        Circle::new(0.0).expect_err("refused").to_string(),
        "radius is 0, not above 0"
    );
    assert_eq!(
        Circle::new(-1.0).expect_err("refused").to_string(),
        "radius is -1, not above 0"
    );
    assert_eq!(
        Circle::new(f64::NAN).expect_err("refused").to_string(),
        "radius is NaN, not a finite number"
    );
    assert_eq!(
        Segment::new(Vec2::X, Vec2::X)
            .expect_err("refused")
            .to_string(),
        "the segment has no length: both ends are at (1, 0)"
    );
    assert_eq!(
        ConvexPolygon::new([
            vec2(0.0, 0.0),
            vec2(2.0, 0.0),
            vec2(1.0, 0.5),
            vec2(1.0, 2.0)
        ])
        .expect_err("refused")
        .to_string(),
        "the polygon is not convex at vertex 2"
    );
}
