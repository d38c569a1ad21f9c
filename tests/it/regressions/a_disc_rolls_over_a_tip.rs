//! Discs that roll up one segment, over a tip, and down another one.
//!
//! Beside the contact that an island's mode holds, a search found one with the other segment at the same place. Both only touch, so
//! that the island was given back and went on as before: the search found it again, at one instant without end, and no step went on
//! any more.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::Segment;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{disc, put, surface};

/// Height of both slopes beside the tip at the origin, by their width.
const SLOPE: f64 = 0.3;

/// In m/s².
const GRAVITY: f64 = 10.0;

#[test]
fn a_disc_rolls_over_a_tip() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for radius in [0.005, 0.02, 0.1] {
            for spare in [0.1, 0.2, 0.4, 0.8] {
                let settings = Settings {
                    mode,
                    gravity: vec2(0.0, -GRAVITY),
                    ..Settings::default()
                };
                let mut world = World::new(settings).expect("valid settings");
                let rough = surface(0.0, 1.0);
                for side in [-0.5, 0.5] {
                    let slope = Segment::new(vec2(side, -SLOPE * side.abs()), Vec2::ZERO);
                    put(&mut world, BodyDef::fixed(), slope.expect("a slope"), rough);
                }
                let up = vec2(1.0, SLOPE).normalize();
                let at = up * -0.2 + carom_math::perp(up) * radius;
                // Rolling it has 3/4 m v²; it rises by 0.2 m of slope, and where it turns about the tip.
                let rise = 0.2 * up.y + radius * (1.0 - up.x);
                let speed = (4.0 / 3.0 * GRAVITY * rise + spare * spare).sqrt();
                let def = BodyDef::dynamic().at(at).moving(up * speed);
                let id = put(
                    &mut world,
                    def.spinning(-speed / radius),
                    disc(radius),
                    rough,
                );
                for _ in 0..60 {
                    let report = world.step(1.0 / 60.0);
                    let at = world.body(id).expect("it is there").centre();
                    assert!(
                        report.advanced > 0.0,
                        "{mode:?}, {radius} m, {spare} m/s: stands at {at}"
                    );
                }
                // Perhaps back again.
                let at = world.body(id).expect("it is there").centre();
                assert!(
                    at.x.abs() > 0.02,
                    "{mode:?}, {radius} m, {spare} m/s: hangs at {at}"
                );
            }
        }
    }
}
