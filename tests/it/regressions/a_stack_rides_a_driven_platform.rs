//! Three boxes that stand on a platform in even motion, which carries them along or up: the third lands by what its place rounds to, and
//! a group with a driven body had no landing in closed form. It was the engine's for ever, and lagged by what it stood still in
//! its first sub-step, 83 mm at 30 m/s.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::vec2;
use carom_tests::scenes::{block, put};

#[test]
fn a_stack_rides_a_driven_platform() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for speed in [1e-3, 3.0, 30.0] {
            for velocity in [vec2(speed, 0.0), vec2(0.0, speed), vec2(-speed, -speed)] {
                let settings = Settings {
                    mode,
                    ..Settings::default()
                };
                let mut world = World::new(settings).expect("valid settings");
                let material = Material::default();
                let platform = BodyDef::kinematic().at(vec2(0.0, -0.5)).moving(velocity);
                put(&mut world, platform, block(40.0, 1.0), material);
                let boxes = [0.5, 1.5, 2.5].map(|y| {
                    let def = BodyDef::dynamic().at(vec2(0.0, y)).moving(velocity);
                    let square = ConvexPolygon::square(1.0).expect("a box");
                    (put(&mut world, def, square, material), y)
                });
                let begun = world.energy();
                for _ in 0..360 {
                    let report = world.step(1.0 / 360.0);
                    assert!(report.is_exact(), "{mode:?}, {velocity}: {report:?}");
                }
                for (id, y) in boxes {
                    let body = world.body(id).expect("it stays");
                    let off = body.centre() - vec2(0.0, y) - velocity * world.time().as_secs();
                    let off = off.length();
                    assert!(off < 1e-11, "{mode:?}, {velocity}: {off:e} m");
                }
                // What the platform did is its work, and no energy that a landing gave.
                let energy = world.energy();
                let gained = energy.mechanical() - begun.mechanical();
                let driven = energy.external - begun.external;
                assert!((gained - driven).abs() < 1e-9, "{gained} J by {driven} J");
                assert!(energy.impacts > -1e-9, "{} J", energy.impacts);
            }
        }
    }
}
