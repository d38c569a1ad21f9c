//! The integrator took damping for a part of the law, so that its stretches had to be short against 1/c for its rounds to
//! converge: the time for a second grew with c, to minutes at 1e6 per second.

use carom_dynamics::{BodyDef, Field, Settings, World};
use carom_math::{Vec2, trig, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{disc, put};

/// To the origin, by 4 1/s².
#[derive(Debug)]
struct Spring;

impl Field for Spring {
    fn acceleration(&self, at: Vec2) -> Vec2 {
        at * -4.0
    }
    fn potential(&self, at: Vec2) -> f64 {
        2.0 * at.length_squared()
    }
    fn gradient_bound(&self, _: Vec2, _: f64) -> f64 {
        4.0
    }
}

/// After `t` seconds at `(x, v)` with damping c > 4: `λ = −(c ± √(c² − 16))/2`, and the product of both is 4.
fn creeps((x, v): (f64, f64), c: f64, t: f64) -> f64 {
    let fast = -0.5 * (c + (c * c - 16.0).sqrt());
    let slow = 4.0 / fast;
    let part = (v - slow * x) / (fast - slow);
    (x - part) * trig::exp(slow * t) + part * trig::exp(fast * t)
}

#[test]
fn strong_damping_in_a_field_takes_no_longer_and_keeps_the_stated_error() {
    for error in [1e-9, 1e-12] {
        for c in [5.0, 40.0, 1e3, 1e4, 1e5, 1e6, 1e8, 1e12] {
            let mut world = World::new(Settings {
                gravity: Vec2::ZERO,
                sleep: None,
                field_error: error,
                ..Settings::default()
            })
            .expect("valid");
            world.add_field(Spring);
            let def = BodyDef::dynamic().at(vec2(1.0, 0.0));
            let def = def.moving(vec2(-0.5, 3.0)).damped(c, c);
            let id = put(&mut world, def, disc(0.25), elastic());
            let kinetic = world.energy().kinetic;
            let mut inaccurate = 0;
            for _ in 0..10 {
                inaccurate += world.step(0.2).inaccurate;
            }
            let body = world.body(id).expect("there");
            let exact = vec2(creeps((1.0, -0.5), c, 2.0), creeps((0.0, 3.0), c, 2.0));
            let off = (body.centre() - exact).length();
            let pieces = body.version();
            assert!(off < 2.0 * error + 1e-13, "{c}/s, {error:e} m/s: {off:e} m");
            assert!(pieces < 600, "{c}/s, {error:e} m/s: {pieces} pieces");
            assert_eq!(inaccurate, 0, "{c}/s, {error:e} m/s");
            let scheme = world.energy().scheme.abs();
            assert!(
                scheme < 1e-8 * kinetic,
                "{c}/s, {error:e} m/s: {scheme:e} J of {kinetic}"
            );
        }
    }
}
