//! What went wrong in other engines' worlds, by the number of the list: tunnels, endless impacts, gained energy.

use carom_dynamics::{Body, BodyDef, BodyId, EventKind, Impulse, Settings, World};
use carom_geometry::{Polygon, Shape};
use carom_math::{Rot, Vec2, vec2};
use carom_tests::gas::{deepest, kinetic, numbers};
use carom_tests::scenes::{block, disc, hollow, put, surface};
use carom_tests::{elastic, run};

fn space() -> World {
    world(0.0)
}

fn world(gravity: f64) -> World {
    World::new(Settings {
        gravity: vec2(0.0, -gravity),
        sleep: None,
        ..Settings::default()
    })
    .expect("valid settings")
}

fn see(world: &World, id: BodyId) -> Body<'_> {
    world.body(id).expect("it is there")
}

/// dimforge/rapier#984, liabru/matter-js#5 and #309: bullets that miss each other, and a box between boxes.
#[test]
fn case_20_bullets_strike_each_other_in_a_world_at_their_instant() {
    for k in 0..200 {
        let apart = 16.0 + f64::from(k) / 64.0;
        let mut world = space();
        let [left, right] = [-1.0, 1.0].map(|side| {
            let def = BodyDef::dynamic()
                .at(vec2(side * apart, 0.0))
                .moving(vec2(-800.0 * side, 0.0));
            put(&mut world, def, disc(0.01), elastic())
        });
        world.step(0.05);
        let times: Vec<f64> = world.events().iter().map(|e| e.time.as_secs()).collect();
        let [time] = times[..] else {
            panic!("{} events from {apart} m", times.len());
        };
        assert!((time - (2.0 * apart - 0.02) / 1600.0).abs() < 1e-15);
        assert_eq!(see(&world, left).velocity(), vec2(-800.0, 0.0));
        assert_eq!(see(&world, right).velocity(), vec2(800.0, 0.0));
    }
    // It fits exactly between two that do not move: up it goes, aside it does not.
    for (velocity, free) in [(Vec2::Y, true), (Vec2::X, false), (-Vec2::X, false)] {
        let mut world = space();
        for x in [-1.0, 1.0] {
            let def = BodyDef::fixed().at(vec2(x, 0.0));
            put(&mut world, def, block(1.0, 4.0), surface(0.0, 0.0));
        }
        let def = BodyDef::dynamic().moving(velocity);
        let id = put(&mut world, def, block(1.0, 1.0), surface(0.0, 0.0));
        run(&mut world, 1.0, |_| {});
        let want = if free { velocity } else { Vec2::ZERO };
        assert!((see(&world, id).centre() - want).length() < 1e-12);
        assert!((see(&world, id).velocity() - want).length() < 1e-12);
    }
}

/// dimforge/rapier#421, godotengine/godot#6664, erincatto/box2d#1009: pushed through a wall by impulses.
#[test]
fn case_21_huge_impulses_drive_nothing_through_a_wall() {
    for (shape, e) in [
        (Shape::from(disc(0.5)), 0.0),
        (disc(0.5).into(), 0.5),
        (block(1.0, 1.0).into(), 0.0),
        (block(1.0, 1.0).into(), 0.5),
    ] {
        for mass in [None, Some(1e-3), Some(1e6)] {
            let mut world = world(9.81);
            let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
            put(&mut world, floor, block(40.0, 2.0), surface(e, 0.3));
            // So high that no box gets over it: friction throws a box up at 85 km/s.
            let wall = BodyDef::fixed().at(vec2(5.0, 0.0));
            put(&mut world, wall, block(0.001, 4e6), surface(e, 0.3));
            let mut def = BodyDef::dynamic().at(vec2(0.0, 0.5));
            if let Some(mass) = mass {
                def = def.with_mass(mass);
            }
            let id = put(&mut world, def, shape.clone(), surface(e, 0.3));
            for push in 0..120 {
                let at = see(&world, id).centre();
                let strength = 1e6 * see(&world, id).mass();
                world
                    .apply(id, Impulse::at(at, vec2(strength, 0.0)))
                    .expect("a finite impulse");
                world.step(1.0 / 240.0);
                let x = see(&world, id).centre().x;
                let front = see(&world, id).aabb().max.x;
                assert!(
                    x < 5.0 && front <= 4.9995 + 1e-9,
                    "in the wall at push {push}: {x}, up to {front}, mass {mass:?}"
                );
                // Back to the middle, with what velocity it has.
                if x < -30.0 {
                    let home = carom_math::Pose::at(vec2(0.0, 0.5));
                    world.teleport(id, home).expect("it is there");
                }
            }
        }
    }
}

/// liabru/matter-js#1049: a triangle with a repeated vertex did not collide.
#[test]
fn case_31_a_triangle_with_a_repeated_vertex_moves_as_without_it() {
    let corners = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.25, 1.0)];
    let plain = Polygon::new(corners).expect("a triangle");
    let repeated = [corners[0], corners[1], corners[1], corners[2], corners[2]];
    let repeated = Polygon::new(repeated).expect("a triangle");
    let [one, two] = [plain, repeated].map(|triangle| {
        let mut world = world(9.81);
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        put(&mut world, floor, block(40.0, 2.0), surface(0.5, 0.3));
        let def = BodyDef::dynamic().at(vec2(0.0, 2.0)).spinning(3.0);
        let id = put(&mut world, def, triangle, surface(0.5, 0.3));
        let mut impacts = 0;
        for _ in 0..300 {
            impacts += world.step(1.0 / 60.0).impacts;
        }
        assert!(impacts > 3 && see(&world, id).centre().y > 0.0);
        (world.state_hash(), impacts)
    });
    assert_eq!(one, two);
}

/// liabru/matter-js#842, #1299: a body in the hollow of another was pushed, or went through its wall.
#[test]
fn case_32_a_ball_in_a_spinning_hollow_is_left_alone_and_kept() {
    // A ball of 1.2 m does not pass its gap of 1 m.
    let c = hollow();
    let spinning = |e: f64, at: Vec2| {
        let mut world = space();
        let def = BodyDef::kinematic().spinning(20.0);
        put(&mut world, def, c.clone(), surface(e, 0.3));
        let def = BodyDef::dynamic().at(at);
        let id = put(&mut world, def, disc(0.6), surface(e, 0.3));
        (world, id)
    };
    // Within 0.9 m of the centre no wall reaches it.
    let (mut world, id) = spinning(0.5, vec2(0.5, 0.2));
    run(&mut world, 10.0, |world| assert!(world.events().is_empty()));
    assert_eq!(see(&world, id).velocity(), Vec2::ZERO);
    assert_eq!(see(&world, id).centre(), vec2(0.5, 0.2));
    // With e = 0 it stays in the corner that it is pressed into.
    let least = |e: f64| if e == 0.0 { 3 } else { 10 };
    // Further out it is struck again and again, and stays in.
    for e in [0.0, 0.5, 1.0] {
        let (mut world, id) = spinning(e, vec2(0.95, 0.0));
        let mut impacts = 0;
        for _ in 0..2400 {
            impacts += world.step(1.0 / 240.0).impacts;
            let ring = world.bodies().next().expect("the ring").pose();
            let out = ring.inverse_point(see(&world, id).centre()).abs();
            assert!(out.max_element() < 1.5, "left at {out}, e = {e}");
        }
        assert!(impacts > least(e), "{impacts} impacts, e = {e}");
    }
    // A ring that the ball moves in turn: nothing puts energy in.
    for (e, friction) in [(0.0, 0.3), (1.0, 0.3), (1.0, 0.0)] {
        let mut world = space();
        let def = BodyDef::dynamic().spinning(20.0);
        let ring = put(&mut world, def, c.clone(), surface(e, friction));
        let def = BodyDef::dynamic()
            .at(vec2(0.3, -0.4))
            .moving(vec2(3.0, 1.0));
        let id = put(&mut world, def, disc(0.6), surface(e, friction));
        let start = kinetic(&world);
        let (mut before, mut impacts) = (start, 0);
        for _ in 0..2400 {
            impacts += world.step(1.0 / 240.0).impacts;
            let now = kinetic(&world);
            let gain = (now - before) / start;
            assert!(gain < 1e-13, "gained {gain:e}, e = {e}, µ = {friction}");
            before = now;
            let out = see(&world, ring).pose();
            let out = out.inverse_point(see(&world, id).centre()).abs();
            assert!(out.max_element() < 1.5, "left at {out}, e = {e}");
        }
        assert!(
            impacts > least(e),
            "{impacts} impacts, e = {e}, µ = {friction}"
        );
        assert!(
            e < 1.0 || friction > 0.0 || (before / start - 1.0).abs() < 1e-13,
            "{before} J of {start}"
        );
    }
}

/// dimforge/rapier.js#79: friction at a slip speed of exactly 0 gave NaN.
#[test]
fn case_38_friction_without_slip_does_nothing() {
    for e in [0.0, 0.5, 1.0] {
        let mut world = world(9.81);
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        put(&mut world, floor, block(40.0, 2.0), surface(e, 0.8));
        let def = BodyDef::dynamic().at(vec2(0.25, 2.0));
        let id = put(&mut world, def, disc(0.5), surface(e, 0.8));
        run(&mut world, 10.0, |world| {
            let body = see(world, id);
            assert!(body.centre().is_finite());
            assert_eq!((body.centre().x, body.velocity().x), (0.25, 0.0));
            assert_eq!(body.angular_velocity(), 0.0);
        });
    }
    // Nor where what rolls touches at no slip.
    for (speed, e) in [(1.0, 0.0), (-3.0, 0.0), (1.0, 0.5), (2.5, 1.0)] {
        let mut world = world(9.81);
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        put(&mut world, floor, block(400.0, 2.0), surface(e, 0.8));
        let start = BodyDef::dynamic().at(vec2(0.25, 0.5));
        let def = start.moving(vec2(speed, 0.0)).spinning(-2.0 * speed);
        let id = put(&mut world, def, disc(0.5), surface(e, 0.8));
        run(&mut world, 10.0, |world| {
            let body = see(world, id);
            assert_eq!(body.velocity(), vec2(speed, 0.0));
            assert_eq!(body.angular_velocity(), -2.0 * speed);
        });
        let way = see(&world, id).centre() - vec2(0.25, 0.5);
        assert!((way - vec2(10.0 * speed, 0.0)).length() < 1e-12, "{way}");
    }
}

/// godotengine/godot#53391, #25186: a box of e = 0.2 bounces in little jumps for ever.
#[test]
fn case_43_a_box_comes_to_rest_at_the_end_of_its_bounces() {
    for (shape, half) in [(Shape::from(block(1.0, 1.0)), 0.5), (disc(0.5).into(), 0.5)] {
        for e in [0.05, 0.2, 0.5, 0.8] {
            let mut world = world(9.81);
            let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
            put(&mut world, floor, block(40.0, 2.0), surface(e, 0.5));
            let def = BodyDef::dynamic().at(vec2(0.0, 1.0 + half));
            let id = put(&mut world, def, shape.clone(), surface(e, 0.5));
            // t₀ + 2 t₀ (e + e² + …)
            let want = (2.0_f64 / 9.81).sqrt() * (1.0 + e) / (1.0 - e);
            let mut rests = None;
            while world.time().as_secs() < want + 1.0 {
                world.step_to_next_event(1.0);
                let begins = world
                    .events()
                    .iter()
                    .find(|event| matches!(event.kind, EventKind::Begin { .. }));
                rests = rests.or(begins.map(|event| event.time.as_secs()));
            }
            let rests = rests.expect("it comes to rest");
            assert!((rests - want).abs() < 1e-9, "e = {e}: {rests}, not {want}");
            assert_eq!(see(&world, id).velocity(), Vec2::ZERO);
            assert!((see(&world, id).centre().y - half).abs() < 1e-12);
        }
    }
}

/// Discs in a bin under gravity, falling on each other.
fn pile(friction: f64) -> World {
    let mut world = world(9.81);
    let walls = [
        (vec2(0.0, -0.5), (8.0, 1.0)),
        (vec2(-3.5, 10.0), (1.0, 22.0)),
        (vec2(3.5, 10.0), (1.0, 22.0)),
        (vec2(0.0, 20.5), (8.0, 1.0)),
    ];
    for (at, (width, height)) in walls {
        let shape = block(width, height);
        put(
            &mut world,
            BodyDef::fixed().at(at),
            shape,
            surface(1.0, friction),
        );
    }
    let mut next = numbers(44);
    for k in 0..40_u32 {
        let at = vec2(f64::from(k % 5) - 2.0, 0.6 + f64::from(k / 5));
        let def = BodyDef::dynamic().at(at + 0.1 * vec2(next(), next()));
        let radius = 0.25 + 0.15 * next();
        put(&mut world, def, disc(radius), surface(1.0, friction));
    }
    world
}

/// godotengine/godot#29639: an elastic pile gains energy.
#[test]
fn case_44_an_elastic_pile_gains_nothing_in_a_million_impacts() {
    // With friction bounces get lower for ever, and the solver takes them in the end.
    for (friction, count) in [(0.0, 1_000_000), (0.3, 1_500)] {
        let mut world = pile(friction);
        let start = world.energy().mechanical();
        let (mut before, mut impacts) = (start, 0);
        while impacts < count && world.time().as_secs() < 20_000.0 {
            let report = world.step(0.25);
            impacts += report.impacts;
            assert!(report.is_exact(), "{friction} {report:?}");
            let now = world.energy().mechanical();
            let gain = (now - before) / start;
            assert!(gain < 1e-13, "gained {gain:e} in a step, µ = {friction}");
            if friction == 0.0 {
                let drift = (now / start - 1.0).abs();
                assert!(drift < 1e-12, "{drift:e} of the energy after {impacts}");
            }
            before = now;
        }
        assert!(impacts >= count, "only {impacts} impacts, µ = {friction}");
    }
}

/// Galperin 2003: a body of 100^k kg throws one of 1 kg against a wall; the impacts are the digits of π.
#[test]
fn case_45_impacts_count_the_digits_of_pi() {
    let mut mass = 1.0;
    for digits in [3, 31, 314, 3_141, 31_415] {
        let mut world = space();
        let wall = BodyDef::fixed().at(vec2(-1.0, 0.0));
        put(&mut world, wall, block(2.0, 4.0), elastic());
        for (x, mass, speed) in [(1.0, 1.0, 0.0), (3.0, mass, -1.0)] {
            let def = BodyDef::dynamic()
                .at(vec2(x, 0.0))
                .with_mass(mass)
                .moving(vec2(speed, 0.0));
            put(&mut world, def, block(0.5, 0.5), elastic());
        }
        let start = kinetic(&world);
        let report = world.step(30.0);
        assert_eq!(report.impacts, digits, "100^k = {mass}");
        assert!(report.is_exact());
        assert!((kinetic(&world) / start - 1.0).abs() < 1e-12);
        mass *= 100.0;
    }
}

/// P. Painlevé 1895: a slender rod slides on its end with µ > 4/3, and no acceleration obeys Coulomb.
#[test]
fn case_46_a_rod_that_jams_stays_finite_and_only_loses_energy() {
    for (friction, degrees, speed) in [
        (1.6, 60.0, -1.0),
        (1.6, 50.0, -3.0),
        (2.0, 65.0, -2.0),
        (3.0, 70.0, -5.0),
    ] {
        let mut world = world(9.81);
        let floor = BodyDef::fixed().at(vec2(0.0, -1.0));
        put(&mut world, floor, block(400.0, 2.0), surface(0.0, friction));
        let low = Rot::from_degrees(degrees) * vec2(-1.0, -0.005);
        let def = BodyDef::dynamic()
            .at(vec2(0.0, -low.y))
            .turned(degrees.to_radians())
            .moving(vec2(speed, 0.0));
        let id = put(&mut world, def, block(2.0, 0.01), surface(0.0, friction));
        let start = world.energy().mechanical();
        let mut before = start;
        // No force keeps the tip from going down, so an impulse stops its slip at once.
        world.step(1e-9);
        let jam = world.events().iter().find_map(|event| match event.kind {
            EventKind::Impact {
                normal_impulse,
                tangential_impulse,
                ..
            } if event.time.as_secs() == 0.0 => Some((normal_impulse, tangential_impulse)),
            _ => None,
        });
        let (pressed, rubbed) = jam.expect("an impulse without an approach");
        assert!(pressed > 0.0 && rubbed.abs() <= friction * pressed * (1.0 + 1e-12));
        let tip = see(&world, id).velocity()
            + carom_math::cross_scalar(see(&world, id).angular_velocity(), low);
        assert!(tip.x.abs() < 1e-6 * speed.abs(), "the tip slips at {tip}");
        run(&mut world, 3.0, |world| {
            let now = world.energy().mechanical();
            if deepest(world) > 1e-9 {
                eprintln!("deep {:e}", deepest(world));
            }
            assert!(
                now <= before + 1e-13 * start,
                "µ = {friction}: gained {:e} at {}",
                (now - before) / start,
                world.time().as_secs()
            );
            before = now;
        });
        assert!(see(&world, id).centre().is_finite());
    }
}

/// Own cases: inelastic collapse of 3 and of 5 discs in a row.
#[test]
fn case_47_rows_of_discs_collapse_at_their_instant() {
    // Collapse times to 30 digits from an independent computation; of 5 discs doubles know 1.6e-7 s,
    // and the reference allows ten times that.
    let three = (vec![0.0, 1.0, 1.500_976_562_5], vec![1.0, 0.0, -1.0]);
    let five = (
        vec![0.0, 1.5, 2.015_625, 2.531_25, 3.046_875],
        vec![1.0, 0.0, 0.0, 0.0, 0.0],
    );
    for ((centres, velocities), e, want, bound) in [
        (three, 0.031_25, 0.346_207_972_218_510_65, 1e-9),
        (five, 0.25, 1.196_717_917_177_336_8, 1.6e-6),
    ] {
        #[expect(clippy::cast_precision_loss, reason = "a handful of discs")]
        let common = velocities.iter().sum::<f64>() / velocities.len() as f64;
        // Also far out and the other way round: there roundings are up to 11 times larger, and a gap of one
        // lasted microseconds.
        for (shift, side) in [0.0, 16.0, -16.0, 32.0, -32.0]
            .into_iter()
            .flat_map(|shift| [(shift, 1.0), (shift, -1.0)])
        {
            let mut world = space();
            for (x, v) in centres.iter().zip(&velocities) {
                let def = BodyDef::dynamic()
                    .at(vec2(shift + side * x, 0.0))
                    .moving(vec2(side * v, 0.0));
                put(&mut world, def, disc(0.25), surface(e, 0.0));
            }
            let report = world.step(2.0);
            assert!(report.is_exact() && report.impacts < 5000, "{report:?}");
            let ends: Vec<f64> = world
                .events()
                .iter()
                .filter(|event| matches!(event.kind, EventKind::Collapse { .. }))
                .map(|event| event.time.as_secs())
                .collect();
            assert!(!ends.is_empty(), "no end reported, {shift} m out");
            for end in ends {
                let off = (end - want).abs();
                assert!(off < bound, "{end}, not {want}, {shift} m out, to {side}");
            }
            for body in world.bodies() {
                let left = (body.velocity() - vec2(side * common, 0.0)).length();
                assert!(left < 1e-9, "{left:e} m/s, {shift} m out, to {side}");
            }
        }
    }
}

/// Own case: 1e-12 m between parallel edges, both turning slowly.
#[test]
fn case_48_a_picometre_between_edges_in_a_world() {
    let gap = 1e-12;
    for k in 1..=40 {
        let spin = 1e-6 * f64::from(k);
        let first = |below: f64, above: f64, rise: f64| {
            let mut world = space();
            let lower = BodyDef::dynamic().spinning(below);
            put(&mut world, lower, block(1.0, 1.0), elastic());
            let upper = BodyDef::dynamic()
                .at(vec2(0.0, 1.0 + gap))
                .spinning(above)
                .moving(vec2(0.0, rise));
            put(&mut world, upper, block(1.0, 1.0), elastic());
            let report = world.step_to_next_event(0.5);
            assert!(report.is_exact());
            assert!(deepest(&world) < 1e-15);
            (report.impacts > 0).then(|| world.time().as_secs())
        };
        // A corner half a metre out comes down by spin/2 a second, or by twice that.
        let near = |time: Option<f64>, want: f64| {
            let time = time.expect("missed");
            let error = (time - want).abs();
            assert!(error < 1e-3 * want + 4e-15 / spin, "{time}, not {want}");
        };
        near(first(0.0, spin, 0.0), 2.0 * gap / spin);
        near(first(-spin, spin, 0.0), gap / spin);
        assert_eq!(first(0.0, 0.0, 0.0), None, "nothing moves");
        assert_eq!(
            first(0.0, spin, spin),
            None,
            "it leaves faster than it turns down"
        );
    }
}
