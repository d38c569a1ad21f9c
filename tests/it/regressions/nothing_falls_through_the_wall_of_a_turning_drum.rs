//! A wall that had turned far since a pair was last looked at was taken to be farther off than it was, and boxes of a
//! tumbler fell through it; so they did while boxes that a drum carried were asked by their own speed alone.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put};

#[test]
fn nothing_falls_through_the_wall_of_a_turning_drum() {
    let material = Material {
        friction: 0.6,
        restitution: 0.0,
        ..Material::default()
    };
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("valid settings");
        let bar = |wide, high, x, y| block(wide, high).translated(vec2(x, y));
        let walls = [
            bar(1.0, 20.0, 10.0, 0.0),
            bar(1.0, 20.0, -10.0, 0.0),
            bar(20.0, 1.0, 0.0, 10.0),
            bar(20.0, 1.0, 0.0, -10.0),
        ];
        let drum = BodyDef::kinematic().spinning(0.436);
        let shapes = walls.map(|wall| (wall.into(), material)).to_vec();
        let drum = world.insert_compound(drum, shapes).expect("valid");
        for k in 0..400 {
            let at = vec2(f64::from(k % 20), f64::from(k / 20)) * 0.4;
            let at = BodyDef::dynamic().at(at + vec2(-9.0, 1.4));
            put(&mut world, at, block(0.25, 0.25), material);
        }
        for _ in 0..480 {
            world.step(1.0 / 60.0);
            let frame = world.body(drum).expect("it stays").pose();
            for body in world.bodies().filter(|body| body.id() != drum) {
                let at = frame.inverse_point(body.centre()).abs();
                assert!(
                    at.x.max(at.y) < 9.5,
                    "{mode:?}: body {:?} is in a wall after {} s, at {at}",
                    body.id(),
                    world.time().as_secs()
                );
            }
        }
    }
}
