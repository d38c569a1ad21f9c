//! Impulses and forces that would make a body faster than a world accepts are refused. 1e10 N·s on a microgram made 1e16 m/s, and on
//! tiny masses an infinite energy that the ledger kept for ever.

use carom_dynamics::{BodyDef, BodyError, Force, Impulse, Material, Settings, World};
use carom_geometry::Circle;
use carom_math::vec2;

#[test]
fn an_impulse_beyond_the_largest_speed_is_refused() {
    let mut world = World::new(Settings::default()).expect("valid settings");
    let disc = Circle::new(1e-6).expect("a disc");
    let body = world
        .insert(BodyDef::dynamic(), disc, Material::default())
        .expect("valid");
    let too_large = |refused: Result<(), BodyError>, name: &str| match refused {
        Err(BodyError::TooLarge { field, .. }) => assert_eq!(field, name),
        other => panic!("{name}: {other:?}"),
    };
    let refused = world.apply(body, Impulse::central(vec2(1e10, 0.0)));
    too_large(refused, "velocity.x");
    let refused = world.apply(body, Impulse::angular(1e-3));
    too_large(refused, "spin");
    let refused = world.apply_force(body, Force::central(vec2(0.0, 1e10)));
    too_large(refused, "acceleration.y");
    let refused = world.apply_force(body, Force::torque(1e-3));
    too_large(refused, "angular acceleration");
    // Nothing of all that was done.
    world.step(1.0);
    let velocity = world.body(body).expect("it is there").velocity();
    assert!((velocity - vec2(0.0, -9.81)).length() < 1e-14);
    assert!(world.energy().residual().abs() < 1e-24);
}
