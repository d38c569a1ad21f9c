//! What the solver gives a body lasts for a sub-step. A step of the caller that began and ended within it said that every
//! motion came from a closed form, though the body went on by the solver's: its energy grew in steps that were called exact.

use carom_dynamics::{BodyDef, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, floor, put, surface};

#[test]
fn a_step_within_a_sub_step_of_the_solver_is_not_exact() {
    let mut world = World::new(Settings::default()).expect("valid settings");
    floor(&mut world, surface(0.0, 0.3));
    // 1 cm deep in the floor: the solver pushes it out.
    let def = BodyDef::dynamic().at(vec2(0.0, 0.49));
    put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.3));
    for step in 0..50 {
        let report = world.step(1e-4);
        assert!(!report.is_exact(), "step {step}");
    }
}
