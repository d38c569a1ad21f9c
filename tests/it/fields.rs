//! Flight in fields and with damping: by the calendar, piece by piece, and as exact as without.

use carom_dynamics::{
    BodyDef, BodyId, EventKind, Field, Material, RadialField, Settings, StepReport, World,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane};
use carom_math::{SimTime, Vec2, trig, vec2};
use carom_tests::elastic;
use carom_tests::gas::{Molecule, Watch, deepest, gas, numbers};
use carom_tests::scenes::{block, disc, put, surface};

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

/// A gas whose molecules are slowed down: every other one faster than it turns, the rest the other way round.
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
fn nobody_is_stepped_and_nothing_is_missed() {
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

fn first_impact(world: &mut World) -> f64 {
    for _ in 0..1000 {
        world.step_to_next_event(100.0);
        for event in world.events() {
            if let EventKind::Impact { .. } = event.kind {
                return event.time.as_secs();
            }
        }
    }
    panic!("nothing struck");
}

fn wall(world: &mut World, at: Vec2, normal: Vec2, material: Material) {
    let wall = HalfPlane::new(at, normal).expect("a wall");
    put(world, BodyDef::fixed(), wall, material);
}

/// `v/c (1 − e^(−ct)) = d` at `t = −ln(1 − c d/v)/c`.
#[test]
fn a_coasting_disc_strikes_a_wall_at_the_instant_of_its_closed_form() {
    for (c, v, d) in [
        (0.1, 3.0, 20.0),
        (0.5, 4.0, 7.5),
        (1.0, 2.0, 1.99),
        (3.0, 40.0, 1.0),
    ] {
        let mut world = still();
        wall(&mut world, vec2(d + 0.25, 0.0), -Vec2::X, elastic());
        let def = BodyDef::dynamic().moving(vec2(v, 0.3)).damped(c, 0.0);
        let ball = put(&mut world, def, disc(0.25), elastic());
        let found = first_impact(&mut world);
        let exact = -trig::ln(1.0 - c * d / v) / c;
        // The disc comes with v − c d.
        let off = (found - exact).abs() * (v - c * d);
        assert!(
            off < 1e-12 * 0.25,
            "{c}, {v}, {d}: {off:e} m, {:e} s",
            found - exact
        );
        let speed = world.body(ball).expect("there").velocity().x;
        assert!((speed + v - c * d).abs() < 1e-13 * v, "{speed}");
    }
}

/// A disc that falls against the air: x(t) by both exponentials, bounce after bounce.
#[test]
fn a_ball_bounces_in_the_air_as_its_closed_form_says() {
    let mut world = World::new(Settings::default()).expect("valid");
    wall(&mut world, Vec2::ZERO, Vec2::Y, surface(0.0, 0.0));
    let (c, g, r, e) = (0.4, 9.81, 0.3, 0.9);
    let def = BodyDef::dynamic().at(vec2(0.0, 5.0 + r)).damped(c, 0.0);
    put(&mut world, def, disc(r), surface(e, 0.0));
    let place = |t: f64, v: f64| (v + g / c) * (-trig::exp_m1(-c * t)) / c - g / c * t;
    let speed = |t: f64, v: f64| (v + g / c) * trig::exp(-c * t) - g / c;
    let (mut start, mut height, mut v) = (0.0, 5.0, 0.0);
    for bounce in 0..20 {
        // The root by bisection, from above the top of the arc.
        let (mut low, mut high) = (if v > 0.0 { v / g } else { 0.0 }, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if height + place(middle, v) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let found = first_impact(&mut world);
        let exact = start + low;
        let off = (found - exact).abs() * speed(low, v).abs();
        assert!(
            off < 1e-12 * r * f64::from(bounce + 1),
            "bounce {bounce}: {off:e} m"
        );
        (start, height, v) = (exact, 0.0, -e * speed(low, v));
    }
}

/// Nothing but a spring of the caller's own, followed to `error`, in m/s.
fn swing(error: f64) -> World {
    let mut world = World::new(Settings {
        gravity: Vec2::ZERO,
        field_error: error,
        ..Settings::default()
    })
    .expect("valid");
    world.add_field(Dish { ripple: 0.0 });
    world
}

#[test]
fn a_field_of_the_callers_own_is_followed_to_the_stated_error() {
    for error in [1e-6, 1e-9, 1e-12] {
        let mut world = swing(error);
        let circles = BodyDef::dynamic().at(Vec2::X).moving(vec2(0.0, 2.0));
        let id = put(&mut world, circles, disc(0.25), elastic());
        for _ in 0..100 {
            world.step(0.317);
        }
        let (sin, cos) = trig::sin_cos(2.0 * world.time().as_secs());
        let off = (world.body(id).expect("there").centre() - vec2(cos, sin)).length();
        assert!(
            off < 100.0 * 0.317 * error + 1e-12,
            "{off:e} m at {error:e} m/s"
        );
    }
}

/// A field of the caller's own: a swing that strikes a wall at `cos 2t = d`.
#[test]
fn a_swing_strikes_at_its_cosine_to_the_stated_error() {
    for error in [1e-6, 1e-9, 1e-12] {
        let mut world = swing(error);
        wall(&mut world, vec2(-0.75, 0.0), Vec2::X, elastic());
        put(
            &mut world,
            BodyDef::dynamic().at(Vec2::X),
            disc(0.25),
            elastic(),
        );
        for bounce in 0..10 {
            // From 1 m to −0.5 m: 2π/3 of the phase, and twice that to and fro.
            let phase = core::f64::consts::PI * (2.0 / 3.0) * f64::from(2 * bounce + 1);
            let found = first_impact(&mut world);
            let off = (found - 0.5 * phase).abs();
            assert!(
                off < error * 0.5 * phase + 4e-13 * 0.25,
                "{error:e}: {off:e} s after {found}"
            );
        }
    }
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

/// Up, by 20 m/s².
#[derive(Debug)]
struct Lift;

impl Field for Lift {
    fn acceleration(&self, _: Vec2) -> Vec2 {
        vec2(0.0, 20.0)
    }
    fn potential(&self, at: Vec2) -> f64 {
        -20.0 * at.y
    }
    fn gradient_bound(&self, _: Vec2, _: f64) -> f64 {
        0.0
    }
}

/// Whatever rests, slides or rolls on the ground in closed form.
#[test]
fn a_field_lifts_what_lies_on_the_ground_at_once() {
    for (speed, round) in [(0.0, false), (0.0, true), (2.0, false), (2.0, true)] {
        let mut world = World::new(Settings {
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        })
        .expect("valid settings");
        let stone = surface(0.0, 0.6);
        let floor = HalfPlane::new(Vec2::ZERO, vec2(0.0, 1.0)).expect("a floor");
        put(&mut world, BodyDef::fixed(), floor, stone);
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5));
        let def = def.moving(vec2(speed, 0.0));
        let id = if round {
            put(&mut world, def, disc(0.5), stone)
        } else {
            put(&mut world, def, block(1.0, 1.0), stone)
        };
        for wait in [0.1, 1.0] {
            world.step(wait);
        }
        world.add_field(Lift);
        world.step(0.5);
        let height = world.body(id).expect("it stays").centre().y;
        assert!(
            (height - 1.75).abs() < 1e-9,
            "{speed} m/s, round: {round}: {height} m"
        );
    }
}
