//! A body that a force presses to a wall falls asleep within a long step. When the force ended its share was taken from the
//! acceleration of the sleeper, which had none: in stepped mode it flew off at −F/m, asleep.

use carom_dynamics::{BodyDef, Force, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

#[test]
fn a_sleeper_feels_no_force_that_has_ended() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            mode,
            ..Settings::default()
        })
        .expect("valid settings");
        let material = surface(0.0, 0.5);
        let wall = BodyDef::fixed().at(vec2(2.0, 0.0));
        put(&mut world, wall, block(1.0, 4.0), material);
        let body = BodyDef::dynamic().at(vec2(1.0, 0.0));
        let body = put(&mut world, body, block(1.0, 1.0), material);
        world
            .apply_force(body, Force::central(vec2(50.0, 0.0)))
            .expect("it is there");
        world.step(2.0);
        world.step(0.5);
        let now = world.body(body).expect("it is there");
        assert!(
            now.velocity().length() < 1e-3,
            "{mode:?}: it goes at {}",
            now.velocity()
        );
        assert!(
            (now.centre() - vec2(1.0, 0.0)).length() < 1e-3,
            "{mode:?}: it lies at {}",
            now.centre()
        );
    }
}
