//! The bar of a T is two convex parts. When it landed flat the ends were struck one after the other,
//! and the T left turning. Flush contacts at one instant are one contact of two points.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::Polygon;
use carom_math::{Vec2, vec2};

#[test]
fn parts_that_land_together_do_not_turn() {
    let t = |mirror: f64| {
        let points = [
            (0.0, -0.9),
            (0.5, -0.9),
            (0.5, -0.25),
            (1.6, -0.25),
            (1.6, 0.25),
            (0.5, 0.25),
            (0.5, 0.9),
            (0.0, 0.9),
        ];
        Polygon::new(points.map(|(x, y)| vec2(mirror * x, y))).expect("a T")
    };
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    for restitution in [0.0, 0.5, 1.0] {
        let mut world = World::new(settings).expect("valid");
        let material = Material {
            restitution,
            friction: 0.3,
            ..Material::default()
        };
        let left = BodyDef::dynamic()
            .at(vec2(-1.0, 0.0))
            .moving(vec2(1.0, 0.0));
        world.insert(left, t(-1.0), material).expect("valid");
        let right = BodyDef::dynamic().at(vec2(0.3, 0.0));
        world.insert(right, t(1.0), material).expect("valid");
        world.step(2.0);
        let speeds: Vec<f64> = world.bodies().map(|body| body.velocity().x).collect();
        assert!(
            (speeds[1] - speeds[0] - restitution).abs() < 1e-9,
            "{speeds:?}"
        );
        for body in world.bodies() {
            assert!(
                body.angular_velocity().abs() < 1e-9,
                "{} rad/s",
                body.angular_velocity()
            );
        }
    }
}
