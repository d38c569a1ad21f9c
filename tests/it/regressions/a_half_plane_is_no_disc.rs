//! In stepped mode a half-plane, with its point as only vertex, was taken for a disc that turns in place: its points
//! were thought to stay where they are as a body that turns sees it. So what spun at 3 rad/s without gravity flew into
//! the ground, by more than its size, before the pair was looked at.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

#[test]
fn what_spins_does_not_sink_into_a_half_plane() {
    let material = surface(0.0, 0.0);
    for turn in 0..20_u32 {
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            mode: Mode::Stepped,
            sleep: None,
            ..Settings::default()
        })
        .expect("valid settings");
        let ground = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a half-plane");
        put(&mut world, BodyDef::fixed(), ground, material);
        let def = BodyDef::dynamic()
            .at(vec2(-3.0, 0.5))
            .turned(0.3 * f64::from(turn))
            .moving(vec2(-4.0, -5.0))
            .spinning(3.0);
        put(&mut world, def, block(0.26, 0.26), material);
        for _ in 0..60 {
            world.step(1.0 / 360.0);
            let deep = -lowest(&world);
            assert!(
                deep < 2e-3,
                "{deep} m deep in the ground, turned {turn} times"
            );
        }
    }
}

/// Height of the lowest point of what moves, in m.
fn lowest(world: &World) -> f64 {
    let bounded = world.bodies().map(|body| body.aabb().min.y);
    bounded
        .filter(|y| y.is_finite())
        .fold(f64::INFINITY, f64::min)
}
