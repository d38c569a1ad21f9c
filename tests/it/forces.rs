//! The engine article: forces and impulses at points, for one step.

use carom_dynamics::{BodyDef, BodyId, Force, Impulse, Material, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, vec2};

/// A 2 x 2 plate of 4 kg and 8/3 kg·m² in empty space.
fn plate() -> (World, BodyId) {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    })
    .expect("valid");
    let square = ConvexPolygon::square(2.0).expect("a square");
    let id = world
        .insert(
            BodyDef::dynamic().at(vec2(3.0, 1.0)),
            square,
            Material::default(),
        )
        .expect("valid");
    (world, id)
}

#[test]
fn a_force_at_the_centre_accelerates_for_one_step_only() {
    let (mut world, id) = plate();
    world
        .apply_force(id, Force::central(vec2(8.0, 0.0)))
        .expect("valid");
    world.step(0.5);
    let body = world.body(id).expect("it stays");
    assert!(
        (body.velocity() - vec2(1.0, 0.0)).length() < 1e-14,
        "F t / m"
    );
    assert!(
        (body.centre() - vec2(3.25, 1.0)).length() < 1e-14,
        "F t² / 2m"
    );
    world.step(1.0);
    let body = world.body(id).expect("it stays");
    assert!(
        (body.velocity() - vec2(1.0, 0.0)).length() < 1e-14,
        "gone after its step"
    );
    assert!((world.energy().forces - 2.0).abs() < 1e-13, "F s");
}

#[test]
fn a_force_at_a_point_adds_the_torque_about_the_centre_of_mass() {
    // The article's add_force_at_pos has no body: force += F; torque += (pos − centre) × F.
    let (mut world, id) = plate();
    world
        .apply_force(id, Force::at(vec2(4.0, 1.0), vec2(0.0, 8.0)))
        .expect("valid");
    world.step(0.25);
    let body = world.body(id).expect("it stays");
    assert!((body.velocity() - vec2(0.0, 0.5)).length() < 1e-14);
    assert!(
        (body.angular_velocity() - 0.75).abs() < 1e-14,
        "τ t / I = 8 · 0.25 / (8/3)"
    );
    assert!((body.angle() - 0.09375).abs() < 1e-14, "τ t² / 2I");
}

#[test]
fn a_torque_turns_and_an_impulse_is_at_once() {
    let (mut world, id) = plate();
    world.apply_force(id, Force::torque(8.0)).expect("valid");
    world
        .apply(id, Impulse::at(vec2(3.0, 2.0), vec2(4.0, 0.0)))
        .expect("valid");
    let body = world.body(id).expect("it stays");
    assert!((body.velocity() - vec2(1.0, 0.0)).length() < 1e-15);
    assert!(
        (body.angular_velocity() + 1.5).abs() < 1e-15,
        "r × J / I with r above the centre"
    );
    world.step(0.5);
    let body = world.body(id).expect("it stays");
    assert!(
        body.angular_velocity().abs() < 1e-14,
        "the torque undoes it: 8 · 0.5 / (8/3) = 1.5"
    );
}

#[test]
fn forces_wait_for_a_step_that_takes_time() {
    let (mut world, id) = plate();
    world
        .apply_force(id, Force::central(vec2(8.0, 0.0)))
        .expect("valid");
    world.step(0.0);
    world.step(0.5);
    assert!((world.body(id).expect("it stays").velocity() - vec2(1.0, 0.0)).length() < 1e-14);
}

#[test]
fn mass_inertia_and_density_follow_the_definition() {
    let mut world = World::new(Settings::default()).expect("valid");
    // The article takes the mean of the vertices for the centroid: a house shows the difference.
    let house = ConvexPolygon::new([
        vec2(-1.0, 0.0),
        vec2(1.0, 0.0),
        vec2(1.0, 2.0),
        vec2(0.0, 3.0),
        vec2(-1.0, 2.0),
    ])
    .expect("a house");
    let id = world
        .insert(
            BodyDef::dynamic().with_mass(10.0),
            house,
            Material::default(),
        )
        .expect("valid");
    let body = world.body(id).expect("it is there");
    assert_eq!(body.mass(), 10.0);
    let centroid = (4.0 * 1.0 + 1.0 * (2.0 + 1.0 / 3.0)) / 5.0;
    assert!(
        (body.centre() - vec2(0.0, centroid)).length() < 1e-15,
        "not the vertices' mean 1.4"
    );
    assert_eq!(
        body.pose().position,
        Vec2::ZERO,
        "the frame is where the user put it"
    );
}
