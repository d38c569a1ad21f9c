//! A U that rocks about an outer corner of its back, which two of its convex parts have: where both touched there, of the one no more than
//! that end of an edge, its rows stood there twice, and no path was found. The engine got the body.

use carom_dynamics::geometry::Polygon;
use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{floor, put};

#[test]
fn a_corner_of_two_parts_bears_once() {
    let ring = [
        (-0.6, -0.6),
        (-0.2, -0.6),
        (-0.2, 0.2),
        (0.2, 0.2),
        (0.2, -0.6),
        (0.6, -0.6),
        (0.6, 0.6),
        (-0.6, 0.6),
    ];
    let shape = Polygon::new(ring.map(|(x, y)| vec2(x, y))).expect("a U");
    for k in 0..30 {
        let mut world = World::new(Settings::default()).expect("valid settings");
        floor(&mut world, Material::default());
        let def = BodyDef {
            angle: 0.1 * f64::from(k) - 1.47,
            ..BodyDef::dynamic().at(vec2(0.0, 1.2))
        };
        put(&mut world, def, shape.clone(), Material::default());
        for _ in 0..180 {
            let report = world.step(1.0 / 60.0);
            assert!(report.is_exact(), "{k}: {report:?}");
        }
    }
}
