//! Two boxes that fell side by side, so near that their bounding circles met, struck each other 0.1 m apart where they
//! closed at 1e-8 m/s: whether a gap is only rounding was asked by the coordinates of the place where they will meet, 5e14 m
//! down, four months later. Where one of them turned the impulse became infinite.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::surface;

#[test]
fn what_meets_in_months_does_not_meet_now() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for closing in [1e-7, 1e-8, 1e-10, 1e-13] {
            let mut world = World::new(Settings {
                gravity: vec2(0.0, -10.0),
                mode,
                ..Settings::default()
            })
            .expect("settings");
            let square = || ConvexPolygon::rectangle(1.0, 1.0).expect("a box");
            let at = |x: f64, v: f64| BodyDef::dynamic().at(vec2(x, 0.0)).moving(vec2(v, 0.0));
            let left = world.insert(at(-0.55, closing), square(), surface(0.5, 0.5));
            let left = left.expect("valid");
            let right = world.insert(at(0.55, 0.0), square(), surface(0.5, 0.5));
            let right = right.expect("valid");
            let report = world.step(1.0);
            assert_eq!(report.impacts, 0, "{mode:?}: 0.1 m apart at {closing} m/s");
            let velocity = |id| world.body(id).expect("there").velocity();
            assert_eq!(velocity(left), vec2(closing, -10.0));
            assert_eq!(velocity(right), -10.0 * Vec2::Y);
        }
    }
}
