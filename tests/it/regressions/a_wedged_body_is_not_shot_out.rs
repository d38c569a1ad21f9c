//! A body between a floor and a driven plate that closes on it, in a wedge narrower than its friction, can neither stay nor
//! leave: no impulses stop both contacts. What the impact left closing was taken for rounding and taken away without friction,
//! which shot the body out of a wedge of 1e-5 rad at 2e5 m/s; others that it struck were moved by tens of metres in a step.
//! Now it is pressed into what holds it, the report says how deep, and it is pushed out again.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{HalfPlane, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn a_wedged_body_is_not_shot_out() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for tilt in [0.0, 1e-5, 1e-3, 0.1] {
            for e in [0.0, 0.5] {
                for round in [false, true] {
                    let settings = Settings {
                        mode,
                        sleep: None,
                        ..Settings::default()
                    };
                    let mut world = World::new(settings).expect("valid settings");
                    let rough = surface(e, 0.3);
                    let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
                    put(&mut world, BodyDef::fixed(), floor, rough);
                    let plate = BodyDef::kinematic()
                        .at(vec2(0.0, 1.7))
                        .turned(tilt)
                        .moving(vec2(0.0, -2.0));
                    let plate = put(&mut world, plate, block(8.0, 1.0), rough);
                    let shape: Shape = if round {
                        disc(0.5).into()
                    } else {
                        block(1.0, 1.0).into()
                    };
                    let def = BodyDef::dynamic().at(vec2(0.3, 0.5));
                    let body = put(&mut world, def, shape, rough);
                    let (mut fastest, mut deepest) = (0.0_f64, 0.0_f64);
                    for step in 0..16 {
                        if step == 8 {
                            world
                                .set_velocity(plate, vec2(0.0, 2.0), 0.0)
                                .expect("there");
                        }
                        deepest = deepest.max(world.step(1.0 / 60.0).deepest_overlap);
                        let velocity = world.body(body).expect("there").velocity();
                        fastest = fastest.max(velocity.length());
                    }
                    let story = format!("{mode:?}, {tilt} rad, e {e}, round {round}");
                    assert!(fastest < 20.0, "{story}: {fastest} m/s");
                    assert!(deepest > 0.02, "{story}: the report says {deepest} m");
                }
            }
        }
    }
}
