//! Only what is slow falls asleep, though `Sleep::time` be 0. Every sub-stepped body had been slow for long enough then: a damped box
//! that slid at 3 m/s stood still after its first sub-step in exact mode, after 8 ticks in others.

use carom_dynamics::{BodyDef, Mode, Settings, Sleep, World};
use carom_math::vec2;
use carom_tests::scenes::{block, floor, put, surface};

#[test]
fn what_moves_does_not_fall_asleep() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let sleep = Sleep {
            time: 0.0,
            ..Sleep::default()
        };
        let settings = Settings {
            mode,
            sleep: Some(sleep),
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let material = surface(0.0, 0.2);
        floor(&mut world, material);
        // Nothing damped has a closed form.
        let def = BodyDef::dynamic().at(vec2(-5.0, 0.5)).damped(0.1, 0.1);
        let sliding = def.moving(vec2(3.0, 0.0));
        let body = put(&mut world, sliding, block(1.0, 1.0), material);
        for tick in 0..120 {
            let before = world.body(body).expect("it is there").velocity().length();
            world.step(1.0 / 60.0);
            let state = world.body(body).expect("it is there");
            // Friction takes 0.03 m/s in a tick, and damping less than 0.01.
            let lost = before - state.velocity().length();
            assert!(
                lost < 0.05 + sleep.speed,
                "{mode:?}: {lost} m/s in tick {tick}"
            );
        }
        assert!(
            world.body(body).expect("it is there").is_asleep(),
            "{mode:?}"
        );
    }
}
