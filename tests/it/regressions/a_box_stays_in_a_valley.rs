//! Boxes of 4 to 40 mm that slide down one segment into another one.
//!
//! Where a corner hung below the end of a segment, the row between both corners pointed down, and once the box lay on the segment
//! again it was kept on the side of that row: it was pushed through by all of its width.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_geometry::Segment;
use carom_math::{Vec2, trig, vec2};
use carom_tests::run;
use carom_tests::scenes::{block, put, surface};

/// Height of both slopes beside the valley at the origin, by their width.
const SLOPE: f64 = 0.3;

/// A box of a half `size` that lies on the left slope and goes down it at `speed` m/s.
fn valley(mode: Mode, friction: f64, size: f64, speed: f64) -> (World, BodyId) {
    let settings = Settings {
        mode,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let rough = surface(0.3, friction);
    for side in [-0.5, 0.5] {
        let slope = Segment::new(vec2(side, SLOPE * side.abs()), Vec2::ZERO);
        put(&mut world, BodyDef::fixed(), slope.expect("a slope"), rough);
    }
    let down = vec2(1.0, -SLOPE).normalize();
    let at = down * -0.2 + carom_math::perp(down) * size;
    let def = BodyDef::dynamic().at(at).turned(trig::atan2(-SLOPE, 1.0));
    let def = def.moving(down * speed);
    let id = put(&mut world, def, block(2.0 * size, 2.0 * size), rough);
    (world, id)
}

#[test]
fn a_box_stays_in_a_valley() {
    for mode in [Mode::Hybrid, Mode::Stepped] {
        for friction in [0.0, 0.2, 0.6] {
            for size in [0.002, 0.003, 0.005, 0.008, 0.013, 0.02] {
                for speed in [0.3, 0.6, 0.9, 1.2] {
                    let (mut world, id) = valley(mode, friction, size, speed);
                    run(&mut world, 1.5, |world| {
                        let at = world.body(id).expect("it is there").centre();
                        assert!(
                            at.y > SLOPE * at.x.abs(),
                            "{mode:?}, friction {friction}, half {size} m, {speed} m/s: {at} m"
                        );
                    });
                }
            }
        }
    }
}
