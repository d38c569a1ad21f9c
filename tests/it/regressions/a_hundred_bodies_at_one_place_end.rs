//! A hundred discs at one place struck each other without end: 20,000 impacts in the first tick.
//! Bodies that were put into each other are pushed apart, not struck.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::Circle;
use carom_math::Vec2;
use carom_tests::{overlaps, run};

#[test]
fn a_hundred_bodies_at_one_place_end() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    for _ in 0..100 {
        let disc = Circle::new(0.1).expect("a disc");
        world
            .insert(BodyDef::dynamic(), disc, Material::default())
            .expect("valid");
    }
    let mut impacts = 0;
    for _ in 0..60 {
        impacts += world.step(1.0 / 60.0).impacts;
    }
    assert!(impacts < 1000, "{impacts} impacts");
    assert!(world.bodies().all(|body| body.centre().is_finite()));
    run(&mut world, 7.0, |_| {});
    let pushed = 0.5 * 3.0 * 3.0 * world.bodies().map(|body| body.mass()).sum::<f64>();
    let kinetic = world.energy().kinetic;
    assert!(kinetic <= pushed, "{kinetic} J, more than all at 3 m/s");
    assert!(overlaps(&world).0 < 1e-9, "{:?}", overlaps(&world));
}
