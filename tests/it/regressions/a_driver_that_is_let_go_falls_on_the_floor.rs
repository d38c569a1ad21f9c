//! A kinematic body in a large island that became a dynamic one went on as it was driven: through the floor.

use carom_dynamics::{BodyDef, BodyKind, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put, surface};

#[test]
fn a_driver_that_is_let_go_falls_on_the_floor() {
    let stone = surface(0.0, 0.5);
    let mut world = World::new(Settings {
        sleep: None,
        ..Settings::default()
    })
    .expect("valid settings");
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(&mut world, floor, block(60.0, 2.0), stone);
    // A plate at y = 1, and 40 boxes on it that lie across each other: one group.
    let plate = BodyDef::kinematic().at(vec2(0.0, 1.0));
    let plate = put(&mut world, plate, block(14.0, 0.4), stone);
    for k in 0..40 {
        let (column, row) = (f64::from(k % 10), f64::from(k / 10));
        let at = vec2(1.2 * column - 5.4 + 0.6 * (row % 2.0), 1.7 + row);
        put(
            &mut world,
            BodyDef::dynamic().at(at),
            block(1.0, 1.0),
            stone,
        );
    }
    // In the middle of a sub-step: the plate joins the large island on it at once.
    world.step(0.501);
    world
        .set_kind(plate, BodyKind::Dynamic)
        .expect("it is there");
    for second in 1..=3 {
        world.step(1.0);
        let height = world.body(plate).expect("it is there").centre().y;
        assert!(
            (height - 0.2).abs() < 0.01,
            "after {second} s at {height} m; on the floor it is at 0.2 m"
        );
    }
}
