//! Settings that are changed as a whole while a world runs, in each mode.

use carom_dynamics::{
    BodyDef, BodyId, ImpactLaw, Mode, PairSearch, Settings, SettingsError, Several, World,
};
use carom_geometry::HalfPlane;
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

use crate::setters::{MODES, boxes, run, world};

#[test]
fn equal_settings_change_nothing() {
    for mode in MODES {
        for steps in [0, 7, 180] {
            let mut world = world(mode, vec2(0.0, -10.0));
            boxes(&mut world, 3, false, 0.0);
            run(&mut world, steps);
            let mut other = world.clone();
            let settings = *world.settings();
            world.set_settings(settings).expect("its own");
            // Nor do those that say what is kept; in stepped mode motions for a log are written in other pieces, to other last digits.
            let kept = Settings {
                history: if mode == Mode::Stepped { 0 } else { 100 },
                work: 1_000_000,
                ..settings
            };
            world.set_settings(kept).expect("valid settings");
            for _ in 0..60 {
                assert_eq!(world.state_hash(), other.state_hash(), "{mode:?}, {steps}");
                world.step(1.0 / 60.0);
                other.step(1.0 / 60.0);
            }
            let told = |world: &World| world.events().iter().copied().collect::<Vec<_>>();
            assert_eq!(told(&world), told(&other), "{mode:?}, {steps}");
        }
    }
}

#[test]
fn settings_that_cannot_change_are_named_and_nothing_changes() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        boxes(&mut world, 3, false, 0.0);
        run(&mut world, 30);
        let (before, settings) = (world.state_hash(), *world.settings());
        let other = if mode == Mode::Exact {
            Mode::Hybrid
        } else {
            Mode::Exact
        };
        let refused = world.set_settings(Settings {
            mode: other,
            tick: 0.02,
            substep: 0.001,
            pair_search: PairSearch::AllPairs,
            gravity: Vec2::X,
            ..settings
        });
        let fields = vec!["tick", "substep", "mode", "pair_search"];
        assert_eq!(refused, Err(SettingsError::Fixed { fields }));
        assert_eq!(
            refused.unwrap_err().to_string(),
            "settings.tick, settings.substep, settings.mode, settings.pair_search cannot change once a world is made: make another one"
        );
        let refused = world.set_settings(Settings {
            gravity: vec2(f64::NAN, 0.0),
            ..settings
        });
        assert!(
            matches!(
                refused,
                Err(SettingsError::NotFinite {
                    field: "gravity.x",
                    ..
                })
            ),
            "{refused:?}"
        );
        assert_eq!((world.state_hash(), *world.settings()), (before, settings));
    }
}

#[test]
fn sleep_that_is_switched_off_wakes_all_and_on_again_lets_them_sleep() {
    for mode in MODES {
        for (rows, is_pyramid) in [(3, false), (6, true)] {
            let mut world = world(mode, vec2(0.0, -10.0));
            let pile = boxes(&mut world, rows, is_pyramid, 0.0);
            let sleepers = |world: &World| {
                let asleep = |id: &&BodyId| world.body(**id).is_some_and(|body| body.is_asleep());
                pile.iter().filter(asleep).count()
            };
            run(&mut world, 180);
            assert_eq!(sleepers(&world), pile.len(), "{mode:?}");
            let settings = *world.settings();
            world
                .set_settings(Settings {
                    sleep: None,
                    ..settings
                })
                .expect("valid settings");
            assert_eq!(sleepers(&world), 0, "{mode:?}");
            run(&mut world, 180);
            assert_eq!(sleepers(&world), 0, "{mode:?}");
            world.set_settings(settings).expect("valid settings");
            run(&mut world, 180);
            assert_eq!(sleepers(&world), pile.len(), "{mode:?}");
        }
    }
}

#[test]
fn settings_that_are_changed_act_as_those_of_the_start() {
    for mode in MODES {
        let stock = Settings {
            mode,
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        };
        let soft = Settings {
            gravity: vec2(0.0, -5.0),
            impact_law: ImpactLaw::Newton,
            several: Several::Reflections,
            contact: Settings::calm().contact,
            sleep: None,
            ..stock
        };
        let drop = |settings: Settings| {
            let mut world = World::new(settings).expect("valid settings");
            let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a unit normal");
            put(&mut world, BodyDef::fixed(), floor, surface(0.5, 0.5));
            let thrown = BodyDef::dynamic().at(vec2(0.0, 3.0)).turned(0.7);
            let thrown = thrown.moving(vec2(3.0, 0.0));
            let thrown = put(&mut world, thrown, block(1.0, 0.5), surface(0.5, 0.5));
            (world, thrown)
        };
        let (mut changed, thrown) = drop(stock);
        changed.set_settings(soft).expect("valid settings");
        assert_eq!(*changed.settings(), soft);
        let (mut made, _) = drop(soft);
        run(&mut changed, 150);
        run(&mut made, 150);
        let [one, other] = [&changed, &made].map(|world| world.body(thrown).expect("it is there"));
        let off = (one.centre() - other.centre()).length();
        assert!(off < 1e-9, "{mode:?}: {off} m off");
        let energy = changed.energy();
        assert!(energy.residual().abs() < 1e-9, "{mode:?}: {energy:?}");
    }
}

#[test]
fn what_is_kept_can_be_changed() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let pile = boxes(&mut world, 2, false, 0.0);
        let settings = *world.settings();
        let with = |history, events| Settings {
            history,
            events,
            ..settings
        };
        world.set_settings(with(0, 0)).expect("valid settings");
        let mut dropped = 0;
        for _ in 0..30 {
            world.step(1.0 / 60.0);
            assert!(world.events().is_empty(), "{mode:?}");
            dropped += world.events().dropped();
        }
        assert!(dropped > 0, "{mode:?}");
        let then = world.time();
        world.set_settings(with(1000, 100)).expect("valid settings");
        for id in &pile {
            world
                .set_velocity(*id, vec2(0.0, 2.0), 0.0)
                .expect("finite");
        }
        run(&mut world, 60);
        let place = |world: &World| {
            world
                .pose_at(pile[0], then + 0.1)
                .map(|pose| pose.position.y)
        };
        // 0.5 + 2 · 0.1 − 10/2 · 0.1² m
        let y = place(&world).expect("the log goes back so far");
        assert!((y - 0.65).abs() < 0.02, "{mode:?}: {y}");
        world.set_settings(with(0, 100)).expect("valid settings");
        assert_eq!(place(&world), None, "{mode:?}");
    }
}
