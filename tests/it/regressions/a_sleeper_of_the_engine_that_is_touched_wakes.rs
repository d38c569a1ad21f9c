//! What touches a sleeper of the engine at the start of a sub-step wakes it, and the engine takes its contacts over. The list of
//! contacts had them until it was made anew: a box that was put beside a sleeping one made the step panic, and so did 3 of 150 random
//! scripts ("a listed pair is there").

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_math::{Pose, vec2};
use carom_tests::scenes::{block, boxed, floor, put};

/// A damped box that fell asleep in the engine at the origin, and boxes put beside it where these places say.
fn beside_a_sleeper(places: &[f64]) {
    let mut world = World::new(Settings::default()).expect("settings");
    let material = Material::default();
    floor(&mut world, material);
    // Nothing damped has a closed form.
    let def = BodyDef::dynamic().at(vec2(0.0, 0.5)).damped(0.5, 0.5);
    let sleeper = put(&mut world, def, block(1.0, 1.0), material);
    let others: Vec<_> = places
        .iter()
        .map(|x| boxed(&mut world, vec2(8.0 * x, 0.5), material))
        .collect();
    for _ in 0..300 {
        world.step(1.0 / 60.0);
    }
    let asleep = world.body(sleeper).expect("it is there").is_asleep();
    assert!(asleep);
    for (&id, x) in others.iter().zip(places) {
        let pose = Pose::at(vec2(*x, 0.55));
        world.teleport(id, pose).expect("valid");
    }
    world.step(1.0 / 60.0);
    let asleep = world.body(sleeper).expect("it is there").is_asleep();
    assert!(!asleep, "beside {places:?}");
}

#[test]
fn a_sleeper_of_the_engine_that_is_touched_wakes() {
    beside_a_sleeper(&[0.99]);
    beside_a_sleeper(&[-0.99, 0.99]);
}
