//! A ball that reaches the wall exactly when a sub-step begins was held by the solver as a contact
//! that lasts, and lost its restitution. Round numbers make such meetings common.

use carom_dynamics::{BodyDef, Settings, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Vec2, vec2};
use carom_tests::{elastic, run};

#[test]
fn an_impact_on_the_border_of_two_sub_steps_bounces() {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    for (at, w, h) in [
        (vec2(0.0, -2.0), 6.0, 1.0),
        (vec2(0.0, 2.0), 6.0, 1.0),
        (vec2(-2.5, 0.0), 1.0, 3.0),
        (vec2(2.5, 0.0), 1.0, 3.0),
    ] {
        let wall = ConvexPolygon::rectangle(w, h).expect("a wall");
        world
            .insert(BodyDef::fixed().at(at), wall, elastic())
            .expect("valid");
    }
    let start = BodyDef::dynamic().moving(vec2(3.0, 1.7));
    let ball = Circle::new(0.25).expect("a ball");
    let ball = world.insert(start, ball, elastic()).expect("valid");
    run(&mut world, 60.0, |world| {
        let v = world.body(ball).expect("it stays").velocity();
        let change = v.length() / vec2(3.0, 1.7).length() - 1.0;
        assert!(
            change.abs() < 1e-12,
            "{v} after {} s",
            world.time().as_secs()
        );
    });
}
