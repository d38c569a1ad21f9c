//! In stepped mode the work of a kinematic body that lifts or pushes was energy that the scheme had made: 9.81 J a metre and kilogram, and
//! nothing from outside.

use carom_dynamics::{BodyDef, EnergyLedger, Material, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, put, surface};

/// What a second changes in the ledger once half a second has passed: (from outside, friction, mechanical, by the scheme), in J.
fn second(world: &mut World) -> [f64; 4] {
    let columns = |energy: EnergyLedger| {
        [
            energy.external,
            energy.friction,
            energy.mechanical(),
            energy.scheme,
        ]
    };
    world.step(0.5);
    let begun = columns(world.energy());
    world.step(1.0);
    let ended = columns(world.energy());
    [0, 1, 2, 3].map(|k| ended[k] - begun[k])
}

#[test]
fn what_a_kinematic_body_did_is_its_work() {
    for mode in [Mode::Stepped, Mode::Hybrid] {
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        let stand = |kind: BodyDef, velocity: Vec2, count: u32| {
            let mut world = World::new(settings).expect("valid settings");
            let def = kind.at(vec2(0.0, -0.5)).moving(velocity);
            put(&mut world, def, block(40.0, 1.0), Material::default());
            for k in 0..count {
                let def = BodyDef::dynamic().at(vec2(0.0, 0.5 + f64::from(k)));
                put(&mut world, def, block(1.0, 1.0), Material::default());
            }
            world
        };

        let mut lift = stand(BodyDef::kinematic(), vec2(0.0, 2.0), 3);
        let [driven, friction, gained, scheme] = second(&mut lift);
        let work = 3.0 * 9.81 * 2.0;
        assert!((driven - work).abs() < 1e-5 * work, "{mode:?}: {driven} J");
        assert!(
            (gained - driven).abs() < 1e-5 * work,
            "{mode:?}: {gained} J"
        );
        assert!(friction.abs() < 1e-5 * work && scheme.abs() < 1e-5 * work);

        let mut push = stand(BodyDef::fixed(), Vec2::ZERO, 1);
        let smooth = surface(0.0, 0.0);
        let def = BodyDef::kinematic().at(vec2(-1.0, 0.5));
        put(
            &mut push,
            def.moving(vec2(2.0, 0.0)),
            block(1.0, 0.5),
            smooth,
        );
        let [driven, friction, gained, _] = second(&mut push);
        let work = Material::default().friction * 9.81 * 2.0;
        assert!((driven - work).abs() < 1e-3 * work, "{mode:?}: {driven} J");
        assert!(gained.abs() < 1e-5 * work, "{mode:?}: {gained} J");
        // Heat is to first order in the sub-step.
        assert!(
            (friction - work).abs() < 2e-2 * work,
            "{mode:?}: {friction} J"
        );
    }
}
