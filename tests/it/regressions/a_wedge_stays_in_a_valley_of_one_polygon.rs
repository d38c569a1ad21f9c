//! A wedge that falls, tip down, into a valley of one concave polygon.
//!
//! Its tip came a fraction of a millimetre into the piece below both slopes, across the cuts between them: the engine took that for a
//! contact with the floor of that piece, 1 m below, and pressed the wedge down through the ground. So it did in stepped mode at any
//! friction, and in hybrid mode without.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, Polygon};
use carom_math::vec2;
use carom_tests::scenes::{put, surface};

#[test]
fn a_wedge_stays_in_a_valley_of_one_polygon() {
    for mode in [Mode::Stepped, Mode::Hybrid, Mode::Exact] {
        for friction in [0.0, 0.3, 0.5] {
            let settings = Settings {
                mode,
                gravity: vec2(0.0, -10.0),
                ..Settings::default()
            };
            let mut world = World::new(settings).expect("settings");
            let material = surface(0.0, friction);
            let outline = [
                vec2(-3.0, -2.0),
                vec2(3.0, -2.0),
                vec2(3.0, 1.0),
                vec2(1.0, 1.0),
                vec2(0.0, -1.0),
                vec2(-1.0, 1.0),
                vec2(-3.0, 1.0),
            ];
            let ground = Polygon::new(outline).expect("a valley");
            put(&mut world, BodyDef::fixed(), ground, material);
            let corners = [vec2(0.0, 0.0), vec2(0.15, 0.5), vec2(-0.15, 0.5)];
            let wedge = ConvexPolygon::new(corners).expect("a wedge");
            let def = BodyDef::dynamic().at(vec2(0.02, 0.5)).turned(0.05);
            let id = put(&mut world, def, wedge, material);
            for _ in 0..240 {
                world.step(1.0 / 60.0);
                let pose = world.body(id).expect("it is there").pose();
                let lowest = corners.map(|corner| pose.point(corner).y);
                let lowest = lowest.into_iter().fold(f64::INFINITY, f64::min);
                assert!(lowest > -1.01, "{mode:?}, {friction}: at {lowest} m");
            }
        }
    }
}
