//! A corner touches a ceiling and opens by its weight alone, since it neither comes nor goes. The body turns, and another
//! corner comes up: its island was in analytic motion, which is not searched for what it touches, and went through the
//! ceiling by all of its size in steps that called themselves exact.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::{ConvexPolygon, HalfPlane};
use carom_math::{Vec2, trig, vec2};
use carom_tests::scenes::{put, surface};

#[test]
fn what_opens_under_a_ceiling_comes_back_to_it() {
    for mode in [Mode::Exact, Mode::Hybrid] {
        for angle in [0.6, 0.8, 1.0, 1.2] {
            for spin in [-6.5, -20.0, 6.5] {
                let mut world = World::new(Settings {
                    gravity: vec2(0.0, -10.0),
                    mode,
                    ..Settings::default()
                })
                .expect("valid settings");
                let material = surface(0.0, 0.0);
                let ceiling = HalfPlane::new(Vec2::ZERO, vec2(0.0, -1.0)).expect("a ceiling");
                put(&mut world, BodyDef::fixed(), ceiling, material);
                // Its first corner is at the ceiling, and moves along it.
                let (sin, cos) = trig::sin_cos(angle);
                let corner = vec2(cos, sin) * 0.15;
                let body = BodyDef::dynamic().at(vec2(0.0, -corner.y)).turned(angle);
                let body = body.moving(vec2(5.0, -spin * corner.x)).spinning(spin);
                let triangle = ConvexPolygon::regular(3, 0.15).expect("a triangle");
                let id = put(&mut world, body, triangle.clone(), material);
                for _ in 0..60 {
                    world.step(1.0 / 960.0);
                    let pose = world.body(id).expect("it is there").pose();
                    for vertex in triangle.vertices() {
                        let height = pose.point(*vertex).y;
                        assert!(
                            height < 1e-9,
                            "{height} m beyond the ceiling, {mode:?}, turned by {angle}, {spin} rad/s, {:?}",
                            world.time()
                        );
                    }
                }
            }
        }
    }
}
