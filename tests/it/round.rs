//! Groups of discs that sub-steps hold: without springs.

use carom_dynamics::{BodyDef, Material, Mode, Settings, World};
use carom_math::vec2;
use carom_tests::gas::numbers;
use carom_tests::scenes::{block, disc, put, surface};
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

/// A floor with bumps, walls, and discs of many sizes, masses, frictions and restitutions that fall on it.
fn heap(world: &mut World, seed: u64) {
    let mut next = numbers(seed);
    let rough = surface(0.5 * next(), next());
    for (at, size) in [
        (vec2(0.0, -0.5), vec2(8.0, 1.0)),
        (vec2(-3.5, 4.0), vec2(1.0, 10.0)),
        (vec2(3.5, 4.0), vec2(1.0, 10.0)),
    ] {
        let def = BodyDef::fixed().at(at);
        put(world, def, block(size.x, size.y), rough);
    }
    for k in 0..4 {
        let at = vec2(1.6 * f64::from(k) - 2.4, 0.4 * next());
        put(
            world,
            BodyDef::fixed().at(at),
            disc(0.3 + 0.3 * next()),
            rough,
        );
    }
    for k in 0..24_u32 {
        let at = vec2(
            1.2 * f64::from(k % 5) - 2.4 + 0.2 * next(),
            1.8 + 1.1 * f64::from(k / 5),
        );
        let def = BodyDef::dynamic()
            .at(at)
            .moving(vec2(2.0 * next() - 1.0, -2.0 * next()))
            .spinning(6.0 * next() - 3.0);
        let material = surface(0.9 * next(), 1.2 * next());
        put(world, def, disc(0.25 + 0.25 * next()), material);
    }
}

/// Not where springs push apart what was put into each other: one of these 7,200 ticks gains more than 1e-9 of the energy, 2e-8.
/// With springs everywhere it was 879 ticks, by up to 3e-5.
#[test]
fn heaps_of_discs_hardly_ever_gain_energy() {
    let (mut gained, mut worst) = (0, 0.0_f64);
    for seed in 1..=24 {
        let mut world = world();
        heap(&mut world, seed);
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
        gained <= 2 && worst < 1e-6,
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
