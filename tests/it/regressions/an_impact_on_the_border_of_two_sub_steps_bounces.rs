//! A ball that reached the wall exactly when a sub-step began was held by the solver as a contact
//! that lasts, and lost its restitution. Round numbers make such meetings common.

use carom_dynamics::{BodyDef, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;

#[test]
fn an_impact_on_the_border_of_two_sub_steps_bounces() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    // 10 m/s times the sub-step, and so many of them to the wall, give or take a rounding.
    let stride = 10.0 * settings.substep;
    for strides in 1..400_u32 {
        let mut world = World::new(settings).expect("valid");
        let wall = ConvexPolygon::rectangle(1.0, 4.0).expect("a wall");
        world
            .insert(BodyDef::fixed().at(vec2(0.5, 0.0)), wall, elastic())
            .expect("valid");
        let at = vec2(-0.25 - stride * f64::from(strides), 0.0);
        let start = BodyDef::dynamic().at(at).moving(vec2(10.0, 0.0));
        let ball = Circle::new(0.25).expect("a ball");
        let ball = world.insert(start, ball, elastic()).expect("valid");
        world.step(settings.substep * f64::from(strides + 3));
        let v = world.body(ball).expect("it stays").velocity();
        assert!(
            (v - vec2(-10.0, 0.0)).length() < 1e-12,
            "{v} after {strides} sub-steps"
        );
    }
}
