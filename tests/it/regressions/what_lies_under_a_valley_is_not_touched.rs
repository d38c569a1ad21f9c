//! The part of a concave ground under a valley has one corner there, and no edge: what comes into the valley touches the parts beside it
//! first. It was searched for a touch of that corner, which it nears without end, and 18 searches a body found nothing.

use carom_dynamics::geometry::Polygon;
use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::ConvexPolygon;
use carom_math::vec2;
use carom_tests::scenes::put;

#[test]
fn what_lies_under_a_valley_is_not_touched() {
    for k in 0..24 {
        let mut world = World::new(Settings::default()).expect("valid settings");
        let ground = [(-5.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 1.0), (-5.0, 6.0)];
        let ground = Polygon::new(ground.map(|(x, y)| vec2(x, y))).expect("a valley");
        put(&mut world, BodyDef::fixed(), ground, Material::default());
        let wedge = [vec2(0.0, 0.0), vec2(1.2, 0.0), vec2(0.5, 0.8)];
        let wedge = ConvexPolygon::new(wedge).expect("a triangle");
        let def = BodyDef {
            angle: f64::from(k * 11 % 24) / 4.0,
            ..BodyDef::dynamic().at(vec2(f64::from(k % 5) / 2.0 - 1.0, 5.0))
        };
        put(&mut world, def, wedge, Material::default());
        for _ in 0..180 {
            let report = world.step(1.0 / 60.0);
            assert_eq!(report.unresolved, 0, "{k}: {report:?}");
        }
    }
}
