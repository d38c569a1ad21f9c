//! Members of the engine are counted where they join it, leave it, wake and fall asleep. A sleeping column that a member pushed against
//! joined as one, and then each other box of it was counted again: once all slept, every step went on with 6 sub-steps of nothing.

use carom_dynamics::{BodyDef, BodyKind, Material, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, column, floor, put};

#[test]
fn what_wakes_in_the_engine_is_counted_once() {
    for count in 1..=3 {
        let mut world = World::new(Settings::default()).expect("settings");
        let material = Material::default();
        floor(&mut world, material);
        column(&mut world, count, material);
        // Nothing damped has a closed form: the engine moves it.
        let def = BodyDef::dynamic().at(vec2(-2.0, 0.5)).damped(0.5, 0.5);
        let pushing = put(&mut world, def, block(1.0, 1.0), material);
        let sleeps = |world: &World| {
            let mut bodies = world.bodies();
            bodies.all(|body| body.kind() == BodyKind::Fixed || body.is_asleep())
        };
        for _ in 0..200 {
            world.step(1.0 / 60.0);
        }
        assert!(sleeps(&world));
        world
            .set_velocity(pushing, vec2(6.0, 0.0), 0.0)
            .expect("valid");
        for _ in 0..400 {
            world.step(1.0 / 60.0);
        }
        assert!(sleeps(&world));
        let report = world.step(1.0 / 60.0);
        assert_eq!(report.substeps, 0, "a column of {count}");
    }
}
