//! Forces of a caller in steps that are no whole sub-steps, on bodies of the engine.
//!
//! Each step changed what pulled a body, and with that its motion within a sub-step: the body lost what the force would have given
//! it in the rest. In steps of 1/240 s a force had 0.83 of its effect, in such of 1 ms 0.2.

use carom_dynamics::{BodyDef, BodyId, Force, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{block, put, surface};

const STEPS: [f64; 6] = [1.0 / 60.0, 0.01, 1.0 / 144.0, 1.0 / 240.0, 1e-3, 1e-4];

/// Steps until `time`, each with 5 N on a body.
fn push(world: &mut World, id: BodyId, dt: f64, time: f64) {
    while world.time().as_secs() < time - 0.5 * dt {
        let force = Force::central(vec2(5.0, 0.0));
        world.apply_force(id, force).expect("it is there");
        world.step(dt);
    }
}

#[test]
fn a_force_acts_for_all_of_its_step() {
    for dt in STEPS {
        let settings = Settings {
            mode: Mode::Stepped,
            gravity: vec2(0.0, -10.0),
            sleep: None,
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let ice = surface(0.0, 0.0);
        put(&mut world, BodyDef::fixed(), block(20.0, 1.0), ice);
        let def = BodyDef::dynamic().at(vec2(0.0, 0.75)).with_mass(1.0);
        let id = put(&mut world, def, block(0.5, 0.5), ice);
        world.step(0.5);
        let from = world.time();
        let ledger = world.energy();
        push(&mut world, id, dt, 0.7);
        let acted = world.time() - from;
        // What acted since the last sub-step began acts in the next one.
        world.step(1.0 / 60.0);
        let v = world.body(id).expect("it is there").velocity().x;
        let right = 5.0 * acted;
        assert!((v - right).abs() < 1e-9, "{dt} s: {v} not {right} m/s");
        let work = world.energy().forces - ledger.forces;
        let gained = world.energy().kinetic - ledger.kinetic;
        assert!(
            (work - gained).abs() < 1e-3 * gained,
            "{dt} s: {work} not {gained} J"
        );
    }
}

/// A member of the engine that a force lifts off leaves it under that force.
#[test]
fn a_force_goes_on_where_a_body_leaves_the_engine() {
    for dt in STEPS {
        let settings = Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        };
        let mut world = World::new(settings).expect("settings");
        let rough = surface(0.0, 0.5);
        put(&mut world, BodyDef::fixed(), block(20.0, 1.0), rough);
        let mut last = None;
        for k in 0..8 {
            let at = vec2(0.1 * f64::from(k % 3), 0.8 + 0.6 * f64::from(k));
            let def = BodyDef::dynamic().at(at).spinning(2.0).with_mass(1.0);
            last = Some(put(&mut world, def, block(0.5, 0.5), rough));
        }
        let id = last.expect("eight boxes");
        let mut moved = false;
        while !moved || world.time().as_secs() < 1.5 {
            moved = world.step(1.0 / 60.0).substeps > 0;
        }
        let mut begun = None;
        let until = world.time().as_secs() + 0.6;
        while world.time().as_secs() < until {
            let force = Force::central(vec2(0.0, 40.0));
            world.apply_force(id, force).expect("it is there");
            let report = world.step(dt);
            let v = world.body(id).expect("it is there").velocity();
            if begun.is_none() && world.time().as_secs() > until - 0.3 {
                begun = Some((world.time(), v));
            }
            assert!(report.advanced > 0.0);
        }
        let (from, before) = begun.expect("0.3 s");
        let after = world.body(id).expect("it is there").velocity();
        let (gained, right) = (after.y - before.y, 30.0 * (world.time() - from));
        assert!(
            (gained - right).abs() < 1e-9,
            "{dt} s: {gained} not {right}"
        );
        assert!((after.x - before.x).abs() < 1e-12, "{dt} s: it flies");
        world.step(0.1);
        let last = world.body(id).expect("it is there").velocity();
        assert!((last.y - after.y + 1.0).abs() < 1e-9, "{dt} s: it pulls on");
        let left = world.energy().residual();
        assert!(left.abs() < 1e-9, "{dt} s: {left} J");
    }
}
