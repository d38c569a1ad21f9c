//! Thin plates on a wall without thickness, struck by others.
//!
//! A contact that overlapped by more than half of a plate was one with the other side of the wall at the next tick, and the plate
//! went on through it. What overlaps stays on the side on which it came.

use carom_dynamics::{BodyDef, Mode};
use carom_math::vec2;
use carom_tests::run;
use carom_tests::scenes::{block, on_a_segment, put, surface};

/// How low the plate that lies on the floor comes, in m, if one `tilt` rad aslant falls on it at `speed` m/s.
fn lowest(mode: Mode, tilt: f64, speed: f64) -> f64 {
    let mut world = on_a_segment(mode, surface(0.1, 0.5));
    let lies = BodyDef::dynamic().at(vec2(0.0, 0.0005));
    let lies = put(&mut world, lies, block(0.8, 0.001), surface(0.0, 0.5));
    let falls = BodyDef::dynamic()
        .at(vec2(-0.3, 0.5))
        .turned(tilt)
        .moving(vec2(0.0, -speed));
    put(&mut world, falls, block(1.2, 0.003), surface(0.0, 0.5));
    let mut lowest = 0.0_f64;
    run(&mut world, 1.0, |world| {
        let plate = world.body(lies).expect("it is there").pose();
        lowest = lowest.min(plate.position.y);
    });
    lowest
}

#[test]
fn a_plate_is_not_pressed_through_a_segment() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        for tilt in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5] {
            for speed in [1.0, 2.0, 3.0, 4.0, 6.0, 8.0] {
                let lowest = lowest(mode, tilt, speed);
                assert!(
                    lowest > -0.02,
                    "{mode:?}: {tilt} rad at {speed} m/s: {lowest} m"
                );
            }
        }
    }
}
