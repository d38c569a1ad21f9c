//! Three bodies in a notch, a heavy one and a light one among them, strike each other ever faster and never come to an
//! end, since the Zeno series of each begins anew again and again: exact mode had no budget, and the step did not end.

use carom_dynamics::{BodyDef, Mode, Settings, StepReport, World};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, put, surface};

fn world(gravity: Vec2) -> World {
    World::new(Settings {
        gravity,
        mode: Mode::Exact,
        ..Settings::default()
    })
    .expect("valid settings")
}

#[test]
fn a_jam_ends_in_exact_mode() {
    let mut collapsed = 0;
    for e in [0.3, 0.5, 0.7, 0.8, 0.88, 0.9] {
        for round in [true, false] {
            let mut world = world(vec2(0.0, -10.0));
            for side in [-1.0, 1.0] {
                let wall = HalfPlane::new(Vec2::ZERO, vec2(side, 1.0)).expect("a wall");
                put(&mut world, BodyDef::fixed(), wall, surface(e, 0.0));
            }
            let bodies = [(1.0, 0.1), (100.0, -0.25), (0.01, 0.3)];
            for (k, (mass, x)) in (0..).zip(bodies) {
                let at = vec2(x, 3.0 + 1.5 * f64::from(k));
                let body = BodyDef::dynamic().at(at).turned(0.3).with_mass(mass);
                if round {
                    put(&mut world, body, disc(0.5), surface(e, 0.0));
                } else {
                    put(&mut world, body, block(1.0, 0.7), surface(e, 0.0));
                }
            }
            let mut report = StepReport::default();
            for _ in 0..180 {
                let step = world.step(1.0 / 60.0);
                assert!(step.impacts < 500_000, "{step:?}, e = {e}");
                assert_eq!(step.stopped, 0);
                report += step;
            }
            collapsed += report.collapsed;
            assert!(report.collapsed == 0 || !report.is_exact());
            for body in world.bodies() {
                assert!(body.centre().y >= 0.0, "e = {e}: {}", body.centre());
            }
        }
    }
    assert!(collapsed > 0, "no jam among them");
}

#[test]
fn without_loss_impacts_have_no_budget_in_exact_mode() {
    // Galperin's blocks at 100^4: 31,415 impacts, nearly all of them within a hundredth of a second.
    let mut world = world(Vec2::ZERO);
    let wall = BodyDef::fixed().at(vec2(-0.5, 0.0));
    put(&mut world, wall, block(1.0, 10.0), surface(1.0, 0.0));
    for (x, mass, speed) in [(1.0, 1.0, 0.0), (3.0, 1e8, -1.0)] {
        let body = BodyDef::dynamic().at(vec2(x, 0.0)).with_mass(mass);
        let body = body.moving(vec2(speed, 0.0)).with_locked_rotation();
        put(&mut world, body, block(1.0, 1.0), surface(1.0, 0.0));
    }
    let report = world.step(100.0);
    assert_eq!(report.impacts, 31_415);
    assert!(report.is_exact());
}
