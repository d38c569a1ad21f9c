//! Between a wall and a driven one impacts that lose nothing come ever faster, 1e15 of them before the gap is closed: exact mode,
//! which does not count those, never ended its step.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn a_crushed_body_is_struck_for_a_while() {
    for mode in [Mode::Hybrid, Mode::Exact, Mode::Stepped] {
        let settings = Settings {
            gravity: Vec2::ZERO,
            mode,
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let lively = surface(1.0, 0.0);
        let (wall, driven) = (BodyDef::fixed(), BodyDef::kinematic());
        put(
            &mut world,
            wall.at(vec2(-0.5, 0.0)),
            block(1.0, 4.0),
            lively,
        );
        let driven = driven.at(vec2(1.7, 0.0)).moving(vec2(-1.0, 0.0));
        put(&mut world, driven, block(1.0, 4.0), lively);
        let ball = BodyDef::dynamic().at(vec2(0.6, 0.0));
        let ball = put(&mut world, ball, disc(0.5), lively);
        // The gap is closed after 0.2 s.
        for _ in 0..15 {
            let report = world.step(1.0 / 60.0);
            assert!(report.impacts < 1_000_000, "{report:?}, {mode:?}");
            let body = world.body(ball).expect("it stays");
            assert!(body.centre().is_finite() && body.velocity().is_finite());
        }
    }
}
