//! A body that slept in the engine, and that a caller threw at the wall it lay on within a sub-step.
//!
//! It stood when it woke, but went on with the velocity that it got, known to neither the engine nor the calendar queue, up to
//! 4 cm until the sub-step ended: through a segment.

use carom_dynamics::{BodyDef, Mode};
use carom_math::vec2;
use carom_tests::scenes::{block, on_a_segment, put, surface};

#[test]
fn what_is_changed_within_a_sub_step_stands_until_it_ends() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        for rest in [3, 150] {
            let mut world = on_a_segment(mode, surface(0.0, 0.5));
            // What overlaps is the engine's.
            let def = BodyDef::dynamic().at(vec2(0.0, 0.009));
            let id = put(&mut world, def, block(0.1, 0.02), surface(0.0, 0.5));
            for _ in 0..rest {
                world.step(1.0 / 60.0);
            }
            let sleeps = world.body(id).expect("it is there").is_asleep();
            assert_eq!(sleeps, rest == 150, "{mode:?}");
            world.step(0.001);
            // Thrown twice: the first throw wakes it.
            for speed in [7.0, 14.5] {
                let thrown = world.set_velocity(id, vec2(0.0, -speed), 0.0);
                thrown.expect("it is there");
                world.step(0.0005);
            }
            for _ in 0..30 {
                world.step(1.0 / 60.0);
                let at = world.body(id).expect("it is there").pose().position;
                assert!(at.y > 0.008, "{mode:?} after {rest} steps: {at}");
            }
        }
    }
}
