//! Two bodies close on a third one from both sides, at 1e-11 of the speed with which one of them slides over it. The common stop of both
//! counted that as nothing, reflections did not: an impact without impulses came up again and again at its instant. A step of a
//! tick took 20 s, and left the world where it was.

use carom_dynamics::{BodyDef, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

#[test]
fn an_approach_hidden_by_a_slip_ends() {
    for mode in [Mode::Exact, Mode::Hybrid] {
        for (closing, gap) in [(1e-11, 1e-13), (4e-12, 1e-14)] {
            let mut world = World::new(Settings {
                mode,
                gravity: Vec2::ZERO,
                ..Settings::default()
            })
            .expect("settings");
            let bodies = [
                (-1.0 - gap, vec2(0.0, closing), 0.0),
                (0.0, Vec2::ZERO, 0.5),
                (1.0 + gap, vec2(2.0, -closing), 0.5),
            ];
            for (y, velocity, friction) in bodies {
                let def = BodyDef::dynamic().at(vec2(0.0, y)).moving(velocity);
                put(&mut world, def, block(1.0, 1.0), surface(1.0, friction));
            }
            let tick = 1.0 / 60.0;
            for _ in 0..3 {
                let report = world.step(tick);
                assert!(
                    report.advanced >= tick && report.impacts <= 4,
                    "{mode:?}, {closing:e} m/s: {report:?}"
                );
            }
        }
    }
}
