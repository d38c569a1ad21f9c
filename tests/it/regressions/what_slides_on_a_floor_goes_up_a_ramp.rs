//! A box that slides along a floor onto a ramp, without friction: the tip of the ramp lies on the floor, and no side of it stands in the way.
//! In stepped mode the corner of the box was stopped at that tip, and 0.4 m/s were left of 3; in exact and hybrid mode it was where floor
//! and ramp are flush blocks side by side.

use carom_dynamics::geometry::Polygon;
use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::{Rot, Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

/// Velocity 0.4 s after the box has met the ramp, in m/s.
fn velocity(mode: Mode, ground: &[Vec<Vec2>]) -> Vec2 {
    let settings = Settings {
        mode,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    let smooth = surface(0.0, 0.0);
    for ring in ground {
        let shape = Polygon::new(ring.clone()).expect("a ground");
        put(&mut world, BodyDef::fixed(), shape, smooth);
    }
    let def = BodyDef::dynamic().at(vec2(-2.0, 0.25));
    let id = put(
        &mut world,
        def.moving(vec2(3.0, 0.0)),
        block(1.0, 0.5),
        smooth,
    );
    for _ in 0..54 {
        world.step(1.0 / 60.0);
    }
    world.body(id).expect("it stays").velocity()
}

#[test]
fn what_slides_on_a_floor_goes_up_a_ramp() {
    for degrees in [5.0_f64, 20.0, 35.0] {
        let top = Rot::from_angle(degrees.to_radians()) * vec2(6.0, 0.0);
        let (x, y) = (top.x, top.y);
        let floor = |end: f64| {
            vec![
                vec2(-6.0, -1.0),
                vec2(end, -1.0),
                vec2(end, 0.0),
                vec2(-6.0, 0.0),
            ]
        };
        let whole = vec![
            vec2(-6.0, -1.0),
            vec2(x, -1.0),
            vec2(x, y),
            Vec2::ZERO,
            vec2(-6.0, 0.0),
        ];
        let wedge = vec![Vec2::ZERO, vec2(x, -0.9), top];
        let block = vec![vec2(0.0, -1.0), vec2(x, -1.0), top, Vec2::ZERO];
        let exact = velocity(Mode::Exact, core::slice::from_ref(&whole));
        assert!(exact.x > 1.0, "{degrees}: {exact}");
        for ground in [
            vec![whole],
            vec![floor(6.0), wedge],
            vec![floor(0.0), block],
        ] {
            for (mode, bound) in [
                (Mode::Exact, 1e-9),
                (Mode::Hybrid, 1e-9),
                // To first order in the sub-step.
                (Mode::Stepped, 0.09),
            ] {
                let found = velocity(mode, &ground);
                let off = (found - exact).length();
                assert!(
                    off < bound,
                    "{degrees}, {mode:?}: {found}, {exact} on one ground"
                );
            }
        }
    }
}
