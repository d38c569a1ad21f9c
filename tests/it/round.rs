//! Islands of discs in exact mode: held without springs.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::scenes::{any_disc, block, disc, heap, put, surface};
use carom_tests::{overlaps, run};

fn world() -> World {
    let settings = Settings {
        gravity: vec2(0.0, -9.81),
        mode: Mode::Exact,
        sleep: None,
        ..Settings::default()
    };
    World::new(settings).expect("valid settings")
}

/// Of these 7,200 ticks none gains more than 1e-15 of the energy. With springs it was 862 ticks, by up to 1e-4.
#[test]
fn heaps_of_discs_never_gain_energy() {
    let (mut gained, mut worst) = (0, 0.0_f64);
    for seed in 1..=24 {
        let mut world = world();
        heap(&mut world, seed, any_disc);
        let start = world.energy().mechanical();
        let mut before = start;
        run(&mut world, 5.0, |world| {
            let energy = world.energy();
            let gain = (energy.mechanical() - before) / start;
            gained += u32::from(gain > 1e-9);
            worst = worst.max(gain);
            before = energy.mechanical();
            assert!(energy.residual().abs() < 1e-10 * start, "seed {seed}");
        });
        let deepest = overlaps(&world).0;
        assert!(deepest < 2e-3, "seed {seed}: {deepest} m deep");
    }
    assert!(
        gained == 0 && worst < 1e-12,
        "{gained} ticks by up to {worst:e} of the energy"
    );
}

/// A belt that starts a disc: force × speed of the belt is what the disc gets, and the heat. The scheme adds nothing.
#[test]
fn a_belt_gives_a_disc_what_it_has_but_the_heat() {
    let mut world = world();
    let belt = Material {
        tangent_speed: 2.0,
        ..surface(0.0, 0.3)
    };
    put(
        &mut world,
        BodyDef::fixed().at(vec2(0.0, -0.5)),
        block(80.0, 1.0),
        belt,
    );
    let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
    let ball = put(&mut world, def, disc(0.5), surface(0.0, 0.3));
    let start = world.energy().mechanical();
    run(&mut world, 0.5, |_| {});
    let energy = world.energy();
    let given = energy.external;
    assert!(energy.mechanical() - start > 0.1, "it is under way");
    assert!(energy.friction > 0.1, "it slipped");
    assert!(
        energy.scheme.abs() < 1e-10 * given.abs(),
        "{:e} J",
        energy.scheme
    );
    assert!(energy.residual().abs() < 1e-12 * given.abs());
    let velocity = world.body(ball).expect("it is there").velocity();
    assert!(velocity.y.abs() < 1e-12);
}
