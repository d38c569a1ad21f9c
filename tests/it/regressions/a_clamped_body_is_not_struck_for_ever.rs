//! A body that was put astride of a wall too thick for it was struck by both of its sides in turn, all at one instant: 32,768 times in
//! a sub-step where nothing is lost.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

#[test]
fn a_clamped_body_is_not_struck_for_ever() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let settings = Settings {
            mode,
            gravity: Vec2::ZERO,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let smooth = surface(1.0, 0.0);
        put(&mut world, BodyDef::fixed(), block(0.19, 2.0), smooth);
        let end = |x: f64| (disc(0.33).translated(vec2(x, 0.0)).into(), smooth);
        let astride = BodyDef::dynamic()
            .moving(vec2(0.3, 0.0))
            .with_locked_rotation();
        let astride = world
            .insert_compound(astride, vec![end(-0.41), end(0.41)])
            .expect("valid");
        let mut impacts = 0;
        for _ in 0..12 {
            impacts += world.step(1.0 / 60.0).impacts;
        }
        assert!(impacts < 2000, "{impacts} impacts, {mode:?}");
        let body = world.body(astride).expect("it stays");
        assert!(body.centre().length() < 0.1, "it is at {}", body.centre());
    }
}
