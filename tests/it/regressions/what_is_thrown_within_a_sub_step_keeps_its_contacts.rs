//! A long plate under another one, thrown into the segment that both lie on within a sub-step.
//!
//! Where it would be at the end of the sub-step was farther off than a body goes that was not put there by hand: its contacts
//! were dropped, and made anew on the other side of the segment.

use carom_dynamics::{BodyDef, Mode};
use carom_math::vec2;
use carom_tests::scenes::{block, on_a_segment, put, surface};

#[test]
fn what_is_thrown_within_a_sub_step_keeps_its_contacts() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        for passed in [0.0005, 0.001, 0.0015, 0.002] {
            for spin in [-10.6, -3.0, 0.0, 3.0, 10.6] {
                let mut world = on_a_segment(mode, surface(0.3, 0.5));
                let def = BodyDef::dynamic().at(vec2(0.0, 0.0068));
                let id = put(&mut world, def, block(1.95, 0.014), surface(0.0, 0.8));
                let def = BodyDef::dynamic().at(vec2(0.4, 0.016));
                put(&mut world, def, block(1.26, 0.004), surface(0.0, 0.2));
                for _ in 0..20 {
                    world.step(1.0 / 60.0);
                }
                world.step(passed);
                let thrown = world.set_velocity(id, vec2(5.0, -10.3), spin);
                thrown.expect("it is there");
                for _ in 0..10 {
                    world.step(1.0 / 60.0);
                    let at = world.body(id).expect("it is there").pose().position;
                    assert!(
                        at.y > -0.02,
                        "{mode:?}, {passed} s, {spin} rad/s: {at} after {} s",
                        world.time().as_secs()
                    );
                }
            }
        }
    }
}
