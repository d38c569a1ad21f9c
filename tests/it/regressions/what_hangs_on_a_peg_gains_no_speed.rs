//! A hooked body that comes to hang on a peg, with a velocity that no row of the engine takes.
//!
//! Continuous collision stopped it in each sub-step where it stood and left it its velocity, for rows to take; none did, and gravity
//! added to it: after 1.5 s it had 69 J more, out of nothing, and had not moved.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_geometry::{Compound, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::put;

fn convex(corners: &[(f64, f64)]) -> ConvexPolygon {
    let corners: Vec<Vec2> = corners.iter().map(|(x, y)| vec2(*x, *y)).collect();
    ConvexPolygon::new(corners).expect("convex")
}

#[test]
fn what_hangs_on_a_peg_gains_no_speed() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let material = Material {
            friction: 0.0,
            restitution: 0.454_295_898_052_965_44,
            ..Material::default()
        };
        let settings = Settings {
            mode,
            gravity: vec2(0.0, -10.0),
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let wall = HalfPlane::new(vec2(-4.0, 0.0), Vec2::X).expect("a wall");
        put(&mut world, BodyDef::fixed(), wall, material);
        let peg = convex(&[(0.0, 0.0), (0.0, 0.1), (-0.1, 0.0)]);
        put(
            &mut world,
            BodyDef::fixed().at(vec2(-3.0, -1.8)),
            peg,
            material,
        );
        let parts: [&[(f64, f64)]; 6] = [
            &[(0.3, 0.4), (0.0, 0.49), (-0.1, 0.4), (0.0, 0.3)],
            &[(-0.1, 0.5), (-0.5, 0.2), (-0.1, 0.4)],
            &[(-0.5, 0.2), (-0.5, 0.0), (0.0, -0.2), (-0.4, 0.2)],
            &[(-0.45, -0.2), (-0.11, -0.49), (-0.1, -0.4), (-0.4, 0.0)],
            &[(-0.11, -0.49), (0.3, -0.4), (0.0, -0.3)],
            &[(0.0, -0.4), (0.5, 0.0), (0.3, 0.0)],
        ];
        let parts = parts.map(|part| (Shape::from(convex(part)), Pose::at(Vec2::ZERO)));
        let hook = Compound::new(parts).expect("a hook");
        let def = BodyDef::dynamic().at(vec2(-3.0, 3.0)).turned(0.9);
        let def = def.moving(vec2(-0.55, 0.0)).spinning(-2.65);
        put(&mut world, def, hook, material);
        let mut least = world.energy().mechanical();
        for _ in 0..240 {
            world.step(1.0 / 60.0);
            let now = world.energy().mechanical();
            assert!(now < least + 0.05, "{mode:?}: {now} J after {least} J");
            least = least.min(now);
        }
    }
}
