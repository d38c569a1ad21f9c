//! A pyramid of 21 boxes falls asleep in the engine of hybrid mode, and is woken seconds later by a call. The step
//! that followed made up for all sub-steps that it had not needed: 720 where a box was pushed, and the pile moved by
//! two seconds within a frame.

use carom_dynamics::{BodyDef, BodyId, Force, Impulse, Settings, World};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

/// What wakes the pile by its top.
type Call = fn(&mut World, BodyId);

fn pyramid() -> (World, BodyId) {
    let mut world = World::new(Settings::default()).expect("valid settings");
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
    put(&mut world, BodyDef::fixed(), floor, surface(0.0, 0.5));
    let mut top = None;
    for row in 0..6 {
        for column in 0..6 - row {
            let x = 1.1 * (f64::from(column) - 0.5 * f64::from(6 - row));
            let at = BodyDef::dynamic().at(vec2(x, 0.5 + f64::from(row)));
            top = Some(put(&mut world, at, block(1.0, 1.0), surface(0.0, 0.5)));
        }
    }
    world.step(3.0);
    let top = top.expect("six rows");
    assert!(world.body(top).is_some_and(|body| body.is_asleep()));
    (world, top)
}

#[test]
fn a_step_after_a_call_has_the_substeps_of_a_step() {
    let calls: [(&str, Call); 7] = [
        ("wake_up", |world, id| {
            world.wake_up(id).expect("it is there");
        }),
        ("apply", |world, id| {
            world
                .apply(id, Impulse::central(Vec2::Y))
                .expect("it is there");
        }),
        ("apply_force", |world, id| {
            world
                .apply_force(id, Force::central(Vec2::Y))
                .expect("it is there");
        }),
        ("set_velocity", |world, id| {
            world.set_velocity(id, Vec2::Y, 0.0).expect("it is there");
        }),
        ("set_mass", |world, id| {
            world.set_mass(id, 2.0, 2.0).expect("valid");
        }),
        ("remove", |world, id| world.remove(id).expect("it is there")),
        ("set_gravity", |world, _| {
            world.set_gravity(vec2(0.0, -9.0)).expect("finite");
        }),
    ];
    for (name, call) in calls {
        let (mut world, top) = pyramid();
        call(&mut world, top);
        let report = world.step(1.0 / 60.0);
        assert_eq!(report.substeps, 6, "{name}");
        if let Some(body) = world.body(top) {
            let rose = body.centre().y - 5.5;
            assert!(rose.abs() < 0.02, "{name}: it moved by {rose} m");
        }
    }
}
