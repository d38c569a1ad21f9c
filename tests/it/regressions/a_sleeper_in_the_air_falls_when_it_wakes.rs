//! A body that was put to sleep in the air and woke hung there until the next sub-step began, in steps that called themselves
//! exact; and a free body that woke it bounced off it as off something held.

use carom_dynamics::{BodyDef, EventKind, Force, Mode, Settings, World};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::scenes::{block, disc, floor, put, surface};

const PULL: Vec2 = vec2(0.0, -10.0);

fn world(mode: Mode) -> World {
    World::new(Settings {
        gravity: PULL,
        mode,
        ..Settings::default()
    })
    .expect("valid settings")
}

#[test]
fn a_sleeper_in_the_air_falls_when_it_wakes() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        // In the middle of a sub-step, on its border, and after none.
        for wait in [1e-3, 1.0 / 60.0, 0.0] {
            let mut world = world(mode);
            floor(&mut world, surface(0.0, 0.0));
            let def = BodyDef::dynamic().at(vec2(0.0, 8.0)).asleep();
            let id = put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.0));
            world.step(wait);
            assert!(world.body(id).expect("it is there").is_asleep());
            world
                .apply_force(id, Force::central(Vec2::ZERO))
                .expect("valid");
            let before = world.energy();
            for k in 1..=100 {
                let report = world.step(0.0101);
                let body = world.body(id).expect("it stays");
                let t = 0.0101 * f64::from(k);
                let fallen = vec2(0.0, 8.0) + 0.5 * PULL * (t * t);
                let off = (body.centre() - fallen).length();
                assert!(off < 1e-13, "{mode:?}: {off:.1e} m after {t} s");
                assert!(report.is_exact() && report.substeps == 0, "{report:?}");
            }
            let gained = world.energy().mechanical() - before.mechanical();
            let scheme = world.energy().scheme - before.scheme;
            assert!(
                gained.abs() < 1e-11 && scheme.abs() < 1e-11,
                "{gained} J, {scheme} J"
            );
        }
    }
}

/// A sleeper falls from the instant at which its support is taken away.
#[test]
fn a_body_left_in_the_air_falls_at_once() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for wait in [1e-3, 1.0 / 60.0, 1.0] {
            let mut world = world(mode);
            let shelf = floor(&mut world, surface(0.0, 0.5));
            let def = BodyDef::dynamic().at(vec2(0.0, 0.5)).asleep();
            let id = put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.5));
            world.step(wait);
            world.remove(shelf).expect("it is there");
            let report = world.step(0.3);
            let fallen = vec2(0.0, 0.5) + 0.5 * PULL * 0.09;
            let off = (world.body(id).expect("it stays").centre() - fallen).length();
            assert!(off < 1e-13, "{mode:?}, after {wait} s: {off:.1e} m");
            assert!(report.is_exact() && report.substeps == 0, "{report:?}");
        }
    }
}

/// A ball that flies into a sleeper in the air meets a free body: one impact at its instant, and no touch.
#[test]
fn a_blow_on_a_sleeper_in_the_air_strikes_a_free_body() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        let mut world = world(mode);
        let material = surface(1.0, 0.0);
        let def = BodyDef::dynamic().at(vec2(3.0, 0.0)).asleep();
        let sleeper = put(&mut world, def, disc(0.5), material);
        // Its apex is where it strikes: after half a second at 4 m/s along.
        let def = BodyDef::dynamic()
            .at(vec2(0.0, -1.25))
            .moving(vec2(4.0, 5.0));
        let ball = put(&mut world, def, disc(0.5), material);
        let report = world.step(1.0);
        assert!(report.is_exact() && report.substeps == 0, "{report:?}");
        let events: Vec<_> = world.events().iter().collect();
        let kinds: Vec<_> = events.iter().map(|event| event.kind).collect();
        assert!(
            matches!(
                kinds.as_slice(),
                [EventKind::Awake(_), EventKind::Impact { .. }]
            ),
            "{kinds:?}"
        );
        for event in events {
            let off = (event.time - SimTime::from_secs(0.5)).abs();
            assert!(off < 1e-12, "{off:.1e} s");
        }
        let fallen = 0.5 * PULL * 0.25;
        let [ball, sleeper] = [ball, sleeper].map(|id| world.body(id).expect("it stays"));
        assert!((ball.centre() - vec2(2.0, 0.0) - fallen).length() < 1e-12);
        assert!((sleeper.centre() - vec2(5.0, 0.0) - fallen).length() < 1e-12);
        assert!((sleeper.velocity() - vec2(4.0, -5.0)).length() < 1e-11);
    }
}
