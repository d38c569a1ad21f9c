//! A nudged stack has its contact modes solved for a few times in a sub-step. Each change of mode laid a new path of a quarter of a
//! second for all three bodies, up to 4,096 times: one nudge took 28 ms.

use carom_dynamics::{BodyDef, BodyId, Impulse, Material, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::{Vec2, vec2};

/// Stacks of three boxes, and their tops.
fn stacks(count: u32) -> (World, Vec<BodyId>) {
    let mut world = World::new(Settings::default()).expect("valid settings");
    let material = Material {
        friction: 0.6,
        ..Material::default()
    };
    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
    world
        .insert(BodyDef::fixed(), floor, material)
        .expect("valid");
    let mut tops = Vec::new();
    for stack in 0..count {
        for layer in 0..3_u32 {
            let at = vec2(3.0 * f64::from(stack), 0.5 + f64::from(layer));
            let shape = ConvexPolygon::square(1.0).expect("a square");
            let id = world
                .insert(BodyDef::dynamic().at(at), shape, material)
                .expect("valid");
            if layer == 2 {
                tops.push(id);
            }
        }
    }
    (world, tops)
}

#[test]
fn a_nudged_stack_has_its_contact_modes_solved_a_few_times() {
    let (mut world, tops) = stacks(30);
    for _ in 0..30 {
        world.step(1.0 / 60.0);
    }
    for top in &tops {
        let corner = world.body(*top).expect("it is there").centre() + vec2(0.0, 0.3);
        world
            .apply(*top, Impulse::at(corner, vec2(0.3, 0.0)))
            .expect("valid");
    }
    let report = world.step(1.0 / 60.0);
    // Each of the six sub-steps may solve for three changes of each of three bodies, and for one more at its start; a
    // bound of 4,096 changes a sub-step solved for 126 a stack.
    assert!(
        report.modes_solved <= 30 * 6 * 3 * 4,
        "{} islands were solved for",
        report.modes_solved
    );
    assert!(report.modes_solved > 0);
}
