//! In a large island a velocity that was set in the middle of a sub-step had the rest of a bounce of that sub-step put on top: a
//! ball that was stopped within its bounce left at 4.4 m/s.

use carom_dynamics::{BodyDef, BodyId, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, boxed, disc, put, surface};

const SUBSTEP: f64 = 1.0 / 360.0;

/// An elastic ball of 0.2 m that falls on a pile, which is a large island in hybrid mode.
fn ball(mode: Mode) -> (World, BodyId) {
    let settings = Settings {
        mode,
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    let elastic = surface(1.0, 0.0);
    let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
    put(&mut world, floor, block(60.0, 2.0), elastic);
    for k in 0..40 {
        let at = vec2(f64::from(k % 5), 0.5 + f64::from(k / 5));
        boxed(&mut world, at, elastic);
    }
    let def = BodyDef::dynamic().at(vec2(2.3, 9.5)).spinning(2.0);
    let ball = put(&mut world, def, disc(0.2), elastic);
    (world, ball)
}

#[test]
fn a_velocity_that_is_set_is_not_thrown_on() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let (mut world, ball) = ball(mode);
        world.step(0.5 * SUBSTEP);
        for k in 0..400 {
            world.step(SUBSTEP);
            let mut other = world.clone();
            let before = other.body(ball).expect("it stays").velocity();
            other
                .set_velocity(ball, vec2(0.3, 0.0), 0.0)
                .expect("valid");
            other.step(0.5 * SUBSTEP);
            let after = other.body(ball).expect("it stays");
            let kept = (after.velocity() - vec2(0.3, 0.0)).length();
            assert!(
                kept <= 2.0 * 9.81 * SUBSTEP && after.angular_velocity().abs() < 0.1,
                "{mode:?}, sub-step {k}: {} m/s and {} rad/s within half a sub-step; it went at {before} m/s",
                after.velocity(),
                after.angular_velocity()
            );
        }
    }
}
