//! Flight in fields and with damping: by the calendar, piece by piece, and as exact as without.

mod alone;

use carom_dynamics::{BodyDef, BodyId, Field, Material, RadialField, Settings, StepReport, World};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{SimTime, Vec2, trig, vec2};
use carom_tests::elastic;
use carom_tests::gas::{Molecule, Watch, deepest, gas, numbers};
use carom_tests::scenes::{disc, put};

fn still() -> World {
    let settings = Settings {
        gravity: Vec2::ZERO,
        sleep: None,
        ..Settings::default()
    };
    World::new(settings).expect("valid settings")
}

/// A spring to the origin of 4 1/s², and a ripple.
#[derive(Debug)]
struct Dish {
    ripple: f64,
}

impl Field for Dish {
    fn acceleration(&self, at: Vec2) -> Vec2 {
        at * -4.0 - vec2(self.ripple * trig::sin_cos(3.0 * at.x).1, 0.0)
    }
    fn potential(&self, at: Vec2) -> f64 {
        2.0 * at.length_squared() + self.ripple * trig::sin_cos(3.0 * at.x).0 / 3.0
    }
    fn gradient_bound(&self, _: Vec2, _: f64) -> f64 {
        4.0 + 3.0 * self.ripple
    }
}

/// A gas of damped molecules: every other one more in velocity than in spin, the rest the other way round.
fn damped_gas(molecule: Molecule, side: u32) -> World {
    let mut world = gas(molecule, side, 11);
    let moving: Vec<BodyId> = world
        .bodies()
        .filter(|b| b.mass().is_finite())
        .map(|b| b.id())
        .collect();
    for (i, id) in moving.into_iter().enumerate() {
        let (linear, angular) = if i % 2 == 0 { (0.3, 0.1) } else { (0.05, 0.6) };
        world.set_damping(id, linear, angular).expect("it is there");
    }
    world
}

fn field_gas(molecule: Molecule, side: u32) -> World {
    let mut world = gas(molecule, side, 5);
    world.add_field(Dish { ripple: 0.7 });
    world
}

/// Discs about a planet of 0.3 m, inside of four walls.
fn planet_gas() -> World {
    let mut world = gas(Molecule::Disc, 4, 3);
    let centre = vec2(0.0, 0.0);
    world.add_field(RadialField::new(centre, 3.0, 0.1).expect("valid"));
    put(
        &mut world,
        BodyDef::fixed().at(centre),
        disc(0.3),
        elastic(),
    );
    world
}

fn worlds() -> [(&'static str, World); 5] {
    [
        ("damped discs", damped_gas(Molecule::Disc, 4)),
        ("damped polygons", damped_gas(Molecule::Polygon, 4)),
        ("discs in a dish", field_gas(Molecule::Disc, 4)),
        ("boxes in a dish", field_gas(Molecule::Box, 3)),
        ("discs about a centre", planet_gas()),
    ]
}

#[test]
fn fields_need_no_sub_steps_and_miss_no_impact() {
    for (name, mut world) in worlds() {
        let (mut report, mut worst) = (StepReport::default(), 0.0_f64);
        for _ in 0..3000 {
            report += world.step(1e-3);
            worst = worst.max(deepest(&world));
        }
        assert!(report.impacts > 40, "{name} is too quiet: {report:?}");
        assert_eq!(report.substeps, 0, "{name}: {report:?}");
        assert!(report.is_exact(), "{name}: {report:?}");
        assert!(worst < 1e-12, "{name}: an overlap of {worst:e} of a size");
    }
}

#[test]
fn steps_only_observe() {
    for (name, world) in worlds() {
        let mut whole = world.clone();
        whole.step(4.0);
        for seed in 0..4 {
            let (mut cut, mut next) = (world.clone(), numbers(seed));
            let end = SimTime::from_secs(4.0);
            while cut.time() < end {
                // Whole microseconds of 2⁻²⁰ s: their sum is the end to the last bit.
                let dt = (0.3 * next() * next() * 1_048_576.0).ceil() / 1_048_576.0;
                let left = end - cut.time();
                cut.step(if dt < left { dt } else { left });
                // Looks are free of consequences, too.
                let _ = cut.energy();
            }
            assert_eq!(whole.time(), cut.time());
            for (a, b) in whole.bodies().zip(cut.bodies()) {
                assert_eq!(a.centre(), b.centre(), "{name}, seed {seed}: {}", a.id());
            }
            assert_eq!(whole.state_hash(), cut.state_hash(), "{name}, seed {seed}");
        }
    }
}

#[test]
fn impacts_in_fields_keep_what_impacts_keep() {
    for (name, mut world) in [
        ("discs", field_gas(Molecule::Disc, 4)),
        ("polygons", field_gas(Molecule::Polygon, 3)),
        ("planet", planet_gas()),
    ] {
        let total = |world: &World| world.energy().kinetic + world.energy().potential;
        let (before, kinetic) = (total(&world), world.energy().kinetic);
        let (mut watch, mut worst) = (Watch::default(), 0.0_f64);
        for _ in 0..40 {
            watch.run(&mut world, 0.5, 0.1, |_, _| {});
            worst = worst.max((total(&world) - before).abs());
        }
        assert!(watch.report.is_exact() && watch.report.substeps == 0);
        assert!(watch.collisions > 50, "{name} is too quiet: {watch:?}");
        assert!(
            worst < 1e-12 * kinetic,
            "{name}: energy {worst:e} J of {kinetic}"
        );
        assert!(
            watch.deepest < 1e-12,
            "{name}: overlap {:.2e}",
            watch.deepest
        );
    }
}

#[test]
fn what_damping_takes_is_in_the_ledger() {
    let mut world = damped_gas(Molecule::Polygon, 4);
    let start = world.energy().kinetic;
    world.step(10.0);
    let energy = world.energy();
    assert!(energy.forces < -0.3 * start, "{energy:?}");
    assert!(energy.scheme.abs() < 1e-10 * start, "{energy:?}");
    assert!(energy.residual().abs() < 1e-12 * start, "{energy:?}");
}

/// A hundred bounces on a planet keep the energy of the orbit.
#[test]
fn a_hundred_bounces_on_a_planet_keep_their_energy() {
    let mut world = still();
    world.add_field(RadialField::new(Vec2::ZERO, 12.0, 0.5).expect("valid"));
    put(&mut world, BodyDef::fixed(), disc(1.0), elastic());
    let def = BodyDef::dynamic().at(vec2(2.0, 0.0)).moving(vec2(0.7, 0.9));
    let ball = put(&mut world, def, disc(0.1), elastic());
    let total = |world: &World| world.energy().kinetic + world.energy().potential;
    let (before, size) = (total(&world), world.energy().kinetic);
    let mut bounces = 0;
    let (mut substeps, mut worst) = (0, 0.0_f64);
    while bounces < 100 {
        let report = world.step_to_next_event(10.0);
        substeps += report.substeps;
        bounces += report.impacts;
        worst = worst.max((total(&world) / before - 1.0).abs());
        let height = world.body(ball).expect("there").centre().length();
        assert!(
            height > 1.1 - 1e-13,
            "{bounces}: sank by {:e}",
            1.1 - height
        );
    }
    assert!(worst < 1e-12, "{worst:e} of {before} J ({size} J)");
    assert_eq!(substeps, 0);
}

/// In and out of a core of 1 cm at 24 m/s, some fifty times: the field has a kink at its rim.
#[test]
fn falls_through_a_small_core_keep_their_energy() {
    let mut world = still();
    world.add_field(RadialField::new(Vec2::ZERO, 3.0, 0.01).expect("valid"));
    for i in 0..10 {
        let def = BodyDef::dynamic().at(vec2(1.0 + f64::from(i), 0.0));
        let def = def.moving(vec2(-0.5, 3e-3 * f64::from(i)));
        put(&mut world, def, disc(0.2), elastic());
    }
    let total = |world: &World| world.energy().kinetic + world.energy().potential;
    let (before, mut worst) = (total(&world), 0.0_f64);
    for _ in 0..200 {
        assert_eq!(world.step(0.05).substeps, 0);
        worst = worst.max((total(&world) - before).abs());
    }
    // What all of them have at the rim: 3/0.01 J/kg.
    let deep = 300.0 * world.bodies().map(|body| body.mass()).sum::<f64>();
    assert!(worst < 1e-12 * deep, "{worst:e} of {deep} J");
}

/// From every direction and with every spin a corner finds its neighbour.
#[test]
fn damped_corners_meet_at_instants_that_dense_sampling_agrees_with() {
    let mut next = numbers(23);
    for case in 0..60 {
        let mut world = still();
        let square = || ConvexPolygon::square(1.0).expect("a square");
        let at = vec2(0.0, 0.0);
        let target = BodyDef::dynamic().at(at).spinning(8.0 * (next() - 0.5));
        put(&mut world, target.damped(0.0, next()), square(), elastic());
        let from = vec2(-2.0, 2.0 * (next() - 0.5));
        let comes = BodyDef::dynamic()
            .at(from)
            .turned(6.0 * next())
            .moving(vec2(3.0 + 3.0 * next(), next() - 0.5))
            .spinning(20.0 * (next() - 0.5))
            .damped(3.0 * next(), 2.0 * next());
        put(&mut world, comes, square(), elastic());
        let mut report = StepReport::default();
        for _ in 0..4000 {
            report += world.step(2.5e-4);
            let depth = deepest(&world);
            assert!(
                depth < 1e-12,
                "case {case}: {depth:e} at {} s",
                world.time().as_secs()
            );
        }
        assert!(
            report.is_exact() && report.substeps == 0,
            "case {case}: {report:?}"
        );
    }
}

#[test]
fn what_changes_in_flight_ends_the_piece() {
    let mut world = still();
    let def = BodyDef::dynamic().moving(vec2(4.0, 0.0)).damped(0.5, 0.0);
    let ball = put(&mut world, def, disc(0.1), Material::default());
    let there = |world: &World| {
        let body = world.body(ball).expect("there");
        (body.centre().x, body.velocity().x)
    };
    world.step(1.0);
    let decay = |c: f64| trig::exp(-c);
    let (x, v) = (8.0 * (1.0 - decay(0.5)), 4.0 * decay(0.5));
    assert!((there(&world).0 - x).abs() < 1e-14);
    // Damping four times as strong.
    world.set_damping(ball, 2.0, 0.0).expect("there");
    world.step(1.0);
    let (x, v) = (x + v * (1.0 - decay(2.0)) / 2.0, v * decay(2.0));
    assert!((there(&world).0 - x).abs() < 1e-14 && (there(&world).1 - v).abs() < 1e-14);
    // None, in a dish: x″ = −4 x.
    world.set_damping(ball, 0.0, 0.0).expect("there");
    world.add_field(Dish { ripple: 0.0 });
    world.step(1.0);
    let (sin, cos) = trig::sin_cos(2.0);
    let (x, v) = (x * cos + 0.5 * v * sin, v * cos - 2.0 * x * sin);
    assert!((there(&world).0 - x).abs() < 1e-12 && (there(&world).1 - v).abs() < 1e-12);
    // And straight on.
    world.clear_fields();
    world.step(1.0);
    assert!((there(&world).0 - x - v).abs() < 1e-12 && (there(&world).1 - v).abs() < 1e-12);
    let refused = world.set_damping(ball, -1.0, 0.0);
    assert!(refused.is_err());
    world.remove(ball).expect("there");
    assert_eq!(world.step(1.0).substeps, 0);
}

#[test]
fn a_look_back_sees_the_law_and_not_its_pieces() {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        history: 64,
        ..Settings::default()
    })
    .expect("valid");
    let def = BodyDef::dynamic().moving(vec2(8.0, 0.0)).damped(0.5, 0.5);
    let ball = put(&mut world, def.spinning(3.0), disc(0.5), elastic());
    world.step(4.0);
    for t in [0.03, 0.3, 1.1, 2.2, 3.3, 3.99] {
        let seen = world.pose_at(ball, SimTime::from_secs(t)).expect("kept");
        let gone = -trig::exp_m1(-0.5 * t) / 0.5;
        let off = (seen.position - vec2(8.0 * gone, 0.0)).length();
        assert!(off < 1e-14, "{off:e} m at {t} s");
        let turned = carom_math::Rot::from_angle(3.0 * gone) * seen.rotation.inverse();
        assert!(turned.angle().abs() < 1e-14, "at {t} s");
    }
}

/// It has a piece a few seconds, whatever the steps.
#[test]
fn a_damped_body_alone_is_left_alone() {
    let mut world = still();
    let def = BodyDef::dynamic().moving(vec2(0.1, 0.0)).damped(0.1, 0.1);
    let ball = put(&mut world, def, disc(0.5), Material::default());
    let before = world.body(ball).expect("there").version();
    world.step(60.0);
    let pieces = world.body(ball).expect("there").version() - before;
    assert!(pieces < 30, "{pieces} pieces in a minute");
}

#[test]
fn circles_are_round() {
    // A ring of discs falls onto a planet from all sides at once: what is symmetric stays so.
    let mut world = still();
    world.add_field(RadialField::new(Vec2::ZERO, 5.0, 0.5).expect("valid"));
    let planet = Circle::new(1.0).expect("a planet");
    put(&mut world, BodyDef::fixed(), planet, elastic());
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
        put(
            &mut world,
            BodyDef::dynamic().at(vec2(x, y) * 3.0),
            disc(0.2),
            elastic(),
        );
    }
    world.step(7.3);
    let heights: Vec<f64> = world
        .bodies()
        .filter(|b| b.mass().is_finite())
        .map(|b| b.centre().length())
        .collect();
    for height in &heights {
        assert!((height - heights[0]).abs() < 1e-11, "{heights:?}");
    }
}
