//! A notched body that falls on a spike, tip into the notch's corner, in exact mode.
//!
//! What is pressed together there began to last in contact; the look at its contacts found none, since the tip is between two pieces,
//! so that it took off, and the search found the same touch: at one instant without end, and no step went on any more.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, Polygon};
use carom_math::vec2;
use carom_tests::scenes::{put, surface};

#[test]
fn a_notch_on_a_spike_goes_on() {
    for turned in [-0.03, 0.03] {
        for k in 0..10 {
            let x = 0.004 * f64::from(k) - 0.018;
            let settings = Settings {
                mode: Mode::Exact,
                gravity: vec2(0.0, -10.0),
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            let smooth = surface(0.0, 0.0);
            let spike = [vec2(-0.1, -1.0), vec2(0.1, -1.0), vec2(0.0, 0.0)];
            let spike = ConvexPolygon::new(spike).expect("a spike");
            put(&mut world, BodyDef::fixed(), spike, smooth);
            let notch = [
                vec2(-0.5, 0.0),
                vec2(-0.2, 0.0),
                vec2(0.0, 0.5),
                vec2(0.2, 0.0),
                vec2(0.5, 0.0),
                vec2(0.5, 0.8),
                vec2(-0.5, 0.8),
            ];
            let notch = Polygon::new(notch).expect("a notch");
            let def = BodyDef::dynamic().at(vec2(x, 0.1)).turned(turned);
            put(&mut world, def, notch, smooth);
            let mut stands = 0;
            for _ in 0..120 {
                let report = world.step(1.0 / 60.0);
                stands = if report.advanced > 0.0 { 0 } else { stands + 1 };
                assert!(stands < 3, "{turned}, {x} m: {report:?}");
            }
        }
    }
}
