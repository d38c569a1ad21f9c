//! Flights in a world, against closed forms.

use carom_geometry::Circle;
use carom_math::{Vec2, trig, vec2};

use crate::{BodyDef, BodyError, BodyId, Material, RadialField, Settings, World};

fn empty() -> World {
    let settings = Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    };
    World::new(settings).expect("valid")
}

fn ball(world: &mut World, def: BodyDef) -> BodyId {
    let disc = Circle::new(0.1).expect("valid");
    world.insert(def, disc, Material::default()).expect("valid")
}

#[test]
fn ellipses_close_after_a_hundred_turns() {
    let strength = 12.0;
    for (speed, inwards) in [(2.0, 0.0), (1.2, 0.0), (2.4, 0.5), (0.9, -0.8)] {
        // Places do not depend on the sub-step: a long one takes less time.
        let mut world = World::new(Settings {
            gravity: Vec2::ZERO,
            tick: 0.25,
            substep: 0.25,
            ..Settings::default()
        })
        .expect("valid");
        world.add_field(RadialField::new(vec2(1.0, -2.0), strength, 0.05).expect("valid"));
        let start = vec2(4.0, -2.0);
        let velocity = vec2(inwards, speed);
        let id = ball(
            &mut world,
            BodyDef::dynamic().at(start).moving(velocity).spinning(0.3),
        );
        let a = 1.0 / (2.0 / 3.0 - velocity.length_squared() / strength);
        let period = 2.0 * core::f64::consts::PI * (a * a * a / strength).sqrt();
        for _ in 0..100 {
            world.step(period);
        }
        let body = world.body(id).expect("there");
        let off = (body.centre() - start).length();
        assert!(off < 1e-10 * a, "{off:e} m off an axis of {a} m");
        let turned = 30.0 * period;
        assert!((body.angle() - turned).abs() < 1e-9 * turned);
    }
}

#[test]
fn a_fall_through_the_core_keeps_its_energy() {
    let mut world = empty();
    world.add_field(RadialField::new(Vec2::ZERO, 12.0, 1.0).expect("valid"));
    let id = ball(
        &mut world,
        BodyDef::dynamic().at(vec2(3.0, 0.0)).moving(vec2(0.0, 0.2)),
    );
    let before = world.energy();
    for _ in 0..600 {
        world.step(1.0 / 60.0);
    }
    let after = world.energy();
    let total = |e: &crate::EnergyLedger| e.kinetic + e.potential;
    let change = total(&after) - total(&before);
    assert!(change.abs() < 1e-9 * before.potential.abs(), "{change:e} J");
    assert!(world.body(id).expect("there").centre().length() < 3.0 + 1e-9);
}

#[test]
fn damping_is_its_exponential() {
    let mut world = World::new(Settings::default()).expect("valid");
    let def = BodyDef::dynamic()
        .moving(vec2(3.0, 40.0))
        .spinning(5.0)
        .damped(0.7, 0.2);
    let id = ball(&mut world, def);
    for _ in 0..37 {
        world.step(0.0417);
    }
    let t = world.time().as_secs();
    let body = world.body(id).expect("there");
    let (decay, terminal) = (trig::exp(-0.7 * t), -9.81 / 0.7);
    let exact = vec2(3.0 * decay, terminal + (40.0 - terminal) * decay);
    assert!(
        (body.velocity() - exact).length() < 1e-12,
        "{}",
        body.velocity() - exact
    );
    let gone = (1.0 - decay) / 0.7;
    let place = vec2(3.0 * gone, terminal * t + (40.0 - terminal) * gone);
    assert!(
        (body.centre() - place).length() < 1e-11,
        "{}",
        body.centre() - place
    );
    assert!((body.angular_velocity() - 5.0 * trig::exp(-0.2 * t)).abs() < 1e-13);
    assert!((body.angle() - 25.0 * (1.0 - trig::exp(-0.2 * t))).abs() < 1e-12);
    // What damping took is in the ledger, as the work of a force.
    let energy = world.energy();
    assert!(energy.forces < -1.0, "{energy:?}");
    assert!(energy.scheme.abs() < 1e-10, "{energy:?}");
}

#[test]
fn how_time_is_cut_does_not_matter_to_the_damped() {
    let run = |cuts: i32| {
        let mut world = World::new(Settings::default()).expect("valid");
        let id = ball(
            &mut world,
            BodyDef::dynamic().moving(vec2(1.0, 9.0)).damped(0.3, 0.0),
        );
        for _ in 0..cuts {
            world.step(1.5 / f64::from(cuts));
        }
        world.body(id).expect("there").centre()
    };
    assert!((run(1) - run(7)).length() < 1e-14);
}

#[test]
fn damping_must_not_be_negative() {
    let disc = || Circle::new(0.1).expect("valid");
    let mut world = empty();
    let growing = BodyDef::dynamic().damped(-0.1, 0.0);
    let refused = world.insert(growing, disc(), Material::default());
    assert!(matches!(
        refused,
        Err(BodyError::Negative {
            field: "linear_damping",
            ..
        })
    ));
}

#[test]
fn a_flight_that_is_not_as_near_as_asked_for_is_not_exact() {
    // A billion turns in the core's rim, and a push of 1e24 m/s²: no piece is short enough.
    for (strength, core, x) in [(1e6, 1e-9, 1e-3), (-1e12, 1e-6, 1e-6)] {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        })
        .expect("settings");
        let field = RadialField::new(Vec2::ZERO, strength, core).expect("a field");
        world.add_field(field);
        let disc = Circle::new(0.5).expect("a disc");
        let def = BodyDef::dynamic().at(vec2(x, 0.0));
        world.insert(def, disc, Material::default()).expect("valid");
        let report = world.step(0.1);
        assert!(report.inaccurate > 0 && !report.is_exact(), "{report:?}");
    }
}
