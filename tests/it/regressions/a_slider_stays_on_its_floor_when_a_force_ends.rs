//! A force that ended under a group that slides in closed form left its opposite behind: a box that had been pulled sideways and up
//! fell through the floor at 8 m/s², by 0.16 m in 0.2 s, in steps that called themselves exact.

use carom_dynamics::{BodyDef, Force, Mode, Settings, World};
use carom_geometry::Shape;
use carom_math::vec2;
use carom_tests::scenes::{block, disc, floor, put, surface};

#[test]
fn a_slider_stays_on_its_floor_when_a_force_ends() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        for friction in [0.0, 0.5] {
            let shapes: [(Shape, f64); 2] =
                [(disc(0.1).into(), 0.1), (block(1.0, 1.0).into(), 0.5)];
            for (shape, height) in shapes {
                let settings = Settings {
                    gravity: vec2(0.0, -10.0),
                    mode,
                    sleep: None,
                    ..Settings::default()
                };
                let mut world = World::new(settings).expect("valid settings");
                floor(&mut world, surface(0.0, friction));
                let def = BodyDef::dynamic().at(vec2(0.0, height));
                let id = put(&mut world, def, shape, surface(0.0, friction));
                world.step(0.1);
                let body = world.body(id).expect("it stays");
                let pull = Force::at(body.centre(), vec2(-11.0, 8.0) * body.mass());
                world.apply_force(id, pull).expect("valid");
                world.step(1.0 / 60.0);
                world.step(0.2);
                let sunk = height - world.body(id).expect("it stays").centre().y;
                assert!(sunk.abs() < 1e-3, "{sunk} m, {mode:?}, friction {friction}");
            }
        }
    }
}
