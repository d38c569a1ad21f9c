//! A member that a caller kicks within a sub-step, and that a wall stops before the sub-step ends, keeps its velocity and goes evenly to
//! where it stopped. That even motion was booked as if its velocity were the body's: the ledger lost what the kick had brought.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put, surface};

#[test]
fn a_stop_within_a_sub_step_is_booked_once() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let rough = surface(0.0, 0.5);
        let floor = BodyDef::fixed().at(vec2(0.0, -0.5));
        put(&mut world, floor, block(20.0, 1.0), rough);
        let wall = BodyDef::fixed().at(vec2(2.0, 5.0));
        put(&mut world, wall, block(0.2, 10.0), rough);
        // A load that falls has both join in the default mode.
        let carrier = BodyDef::dynamic().at(vec2(0.0, 0.5));
        let carrier = put(&mut world, carrier, block(1.0, 1.0), rough);
        let load = BodyDef::dynamic().at(vec2(0.3, 1.6)).turned(0.4);
        put(&mut world, load, block(0.6, 0.6), rough);
        world.step(0.25);
        let (mut before, mut stopped) = (world.energy(), false);
        for parts in [97.0, 31.0, 211.0, 64.0, 113.0] {
            world
                .set_velocity(carrier, vec2(800.0, 3.0), 1.0)
                .expect("a velocity");
            let report = world.step(parts / 65_536.0);
            assert_eq!(report.refused, None);
            let energy = world.energy();
            let size = energy.external.abs() + before.external.abs();
            let residual = energy.residual();
            assert!(
                residual.abs() < 1e-11 * size,
                "{residual:e} J of {size} J, {mode:?}"
            );
            let x = world.body(carrier).expect("it stays").aabb().max.x;
            stopped |= (x - 1.9).abs() < 0.01;
            before = energy;
        }
        assert!(stopped, "no wall stopped it, {mode:?}");
    }
}
