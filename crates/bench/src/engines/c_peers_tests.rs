//! The adapters of the engines in C, by laws that each engine documents.

use carom_math::{Vec2, vec2};
use carom_scenes::{PlainBody, PlainKind, PlainScene, PlainShape};

use crate::engine::{Engine, EngineError, Mode, Setup};
use crate::engines::{EngineName, built, open};

const G: f64 = 10.0;

const STOCK: Setup = Setup {
    mode: Mode::Stock,
    hz: 60.0,
    substeps: None,
    threads: 1,
    sleeping: false,
    slop: None,
};

fn engines() -> Vec<EngineName> {
    let in_c = [
        EngineName::Box2dSse2,
        EngineName::Box2dAvx2,
        EngineName::Chipmunk,
    ];
    in_c.into_iter().filter(|e| built().contains(e)).collect()
}

fn single(engine: EngineName) -> bool {
    engine != EngineName::Chipmunk
}

fn scene() -> (PlainScene, usize) {
    let mut scene = PlainScene::empty("test", vec2(0.0, -G));
    let material = scene.material(1.0, 0.6, 0.0);
    (scene, material)
}

fn square(half: f64) -> PlainShape {
    PlainShape::Box {
        half: vec2(half, half),
        offset: Vec2::ZERO,
    }
}

fn floor(scene: &mut PlainScene, material: usize) -> usize {
    let body = PlainBody::new(PlainKind::Fixed, vec2(0.0, -1.0), material);
    let half = vec2(100.0, 1.0);
    let offset = Vec2::ZERO;
    scene.add(body, PlainShape::Box { half, offset })
}

/// Rows of boxes of 1 m, touching, the lowest of `rows` boxes.
fn pyramid(rows: u32) -> PlainScene {
    let (mut scene, material) = scene();
    floor(&mut scene, material);
    for row in 0..rows {
        for column in 0..rows - row {
            let x = f64::from(column) + 0.5 * f64::from(row) - 0.5 * f64::from(rows);
            let at = vec2(1.1 * x, 0.5 + f64::from(row));
            let body = PlainBody::new(PlainKind::Dynamic, at, material);
            scene.add(body, square(0.5));
        }
    }
    scene
}

fn steps(engine: &mut dyn Engine, count: u32) {
    for _ in 0..count {
        engine.step();
    }
}

#[test]
fn a_ball_falls_as_the_integrator_says() {
    for engine in engines() {
        let (mut scene, material) = scene();
        let body = PlainBody::new(PlainKind::Dynamic, vec2(2.0, 0.0), material);
        scene.add(body, PlainShape::Circle { radius: 0.1 });
        let mut world = open(engine, &scene, &STOCK).unwrap();
        steps(world.as_mut(), 60);

        // Box2D: velocity, then position, in four sub-steps: −g t (t + h) / 2. Chipmunk: position first: −g t (t − h) / 2.
        let lag = if single(engine) {
            0.25 / 60.0
        } else {
            -1.0 / 60.0
        };
        let expected = -G * (1.0 + lag) / 2.0;
        let state = world.state(0);
        let tolerance = if single(engine) { 2e-5 } else { 1e-13 };
        let error = (state.position - vec2(2.0, expected)).length();
        assert!(error < tolerance, "{engine}: {error:e} m");
        let error = (state.velocity - vec2(0.0, -G)).length();
        assert!(error < tolerance, "{engine}: {error:e} m/s");
    }
}

#[test]
fn a_box_rests_on_the_floor() {
    for engine in engines() {
        for mode in [Mode::Stock, Mode::Tuned] {
            let (mut scene, material) = scene();
            floor(&mut scene, material);
            let at = vec2(0.0, 0.7);
            let body = PlainBody::new(PlainKind::Dynamic, at, material);
            let body = scene.add(body, square(0.5));
            let slop = Some(0.005);
            let mut world = open(
                engine,
                &scene,
                &Setup {
                    mode,
                    slop,
                    ..STOCK
                },
            )
            .unwrap();
            steps(world.as_mut(), 180);
            let state = world.state(body);
            let sunk = 0.5 - state.position.y;
            assert!(sunk.abs() < 6e-3, "{engine} {mode}: sunk {sunk} m");
            let speed = state.velocity.length();
            assert!(speed < 1e-3, "{engine} {mode}: {speed} m/s");
            // Box2D counts pairs, and so does Chipmunk: the box and the floor are one.
            assert_eq!(world.counters().touching, 1, "{engine} {mode}");
        }
    }
}

#[test]
fn bodies_keep_the_order_of_the_scene() {
    for engine in engines() {
        let (mut scene, material) = scene();
        scene.gravity = Vec2::ZERO;
        let kinds = [PlainKind::Dynamic, PlainKind::Fixed, PlainKind::Kinematic];
        for i in 0..30_u8 {
            let at = vec2(f64::from(i) * 4.0, -0.5 * f64::from(i));
            let kind = kinds[usize::from(i) % 3];
            let velocity = vec2(0.05 * f64::from(i), 1.0);
            let spin = 0.5 - 0.25 * f64::from(i % 2);
            let angle = 0.01 * f64::from(i);
            let body = PlainBody::new(kind, at, material);
            let body = body.turned(angle).moving(velocity).spinning(spin);
            scene.add(body, square(0.5));
        }
        let mut world = open(engine, &scene, &STOCK).unwrap();
        steps(world.as_mut(), 60);
        // 240 sums of an f32 near 128, each off by at most half of 2^-17.
        let tolerance = if single(engine) { 1e-3 } else { 1e-12 };
        for (i, body) in scene.bodies.iter().enumerate() {
            let moves = f64::from(u8::from(body.kind != PlainKind::Fixed));
            let state = world.state(i);
            let error = (state.position - body.position - moves * body.velocity).length();
            assert!(error < tolerance, "{engine}, body {i}: {error} m");
            let error = (state.angle - body.angle - moves * body.spin).abs();
            assert!(error < tolerance, "{engine}, body {i}: {error} rad");
        }
    }
}

#[test]
fn masses_are_those_of_the_shapes() {
    for engine in engines() {
        let (mut scene, _) = scene();
        let heavy = scene.material(3.0, 0.6, 0.0);
        let body = |x| PlainBody::new(PlainKind::Dynamic, vec2(x, 0.0), heavy);
        let r = 0.5;
        let disc = scene.add(body(0.0), PlainShape::Circle { radius: r });
        // An L of two rectangles, 2 × 1 and 1 × 1, about its centroid.
        let c = vec2(5.0 / 6.0, 5.0 / 6.0);
        let part = |hx: f64, x: f64, y: f64| PlainShape::Box {
            half: vec2(hx, 0.5),
            offset: vec2(x, y) - c,
        };
        let l = scene.add(body(9.0), part(1.0, 1.0, 0.5));
        scene.shapes.push(part(0.5, 0.5, 1.5));
        scene.bodies[l].shapes.push(scene.shapes.len() - 1);
        let mut world = open(engine, &scene, &STOCK).unwrap();
        world.step();

        let area = std::f64::consts::PI * r * r;
        // ∫ r² over the L: of each rectangle w h (w² + h²) / 12 about its own middle, and Steiner's area d².
        let inertia = 10.0 / 12.0 + 2.0 / 12.0 + 2.0 * (5.0 / 36.0) + 5.0 / 9.0;
        let expected = [(disc, area, area * r * r / 2.0), (l, 3.0, inertia)];
        for (i, area, inertia) in expected {
            let body = world.body(i);
            let tolerance = if single(engine) { 1e-6 } else { 1e-14 };
            let error = (body.mass / (3.0 * area) - 1.0).abs();
            assert!(
                error < tolerance,
                "{engine}, body {i}: mass off by {error:e}"
            );
            let error = (body.inertia / (3.0 * inertia) - 1.0).abs();
            assert!(
                error < tolerance,
                "{engine}, body {i}: inertia off by {error:e}"
            );
        }
        let error = (world.state(l).position.x - 9.0).abs();
        assert!(error < 1e-6, "{engine}: centre of mass off by {error:e} m");
    }
}

#[test]
fn bodies_that_start_asleep_stay_so_until_they_are_met() {
    for engine in engines() {
        let (mut scene, material) = scene();
        floor(&mut scene, material);
        for i in 0..3_u8 {
            let at = vec2(3.0 * f64::from(i), 0.5);
            let asleep = true;
            let body = PlainBody::new(PlainKind::Dynamic, at, material);
            scene.add(PlainBody { asleep, ..body }, square(0.5));
        }
        let thrown = PlainBody::new(PlainKind::Dynamic, vec2(-8.0, 1.0), material);
        let thrown = thrown.moving(vec2(20.0, 0.0));
        scene.add(thrown, PlainShape::Circle { radius: 0.3 });

        let sleeping = true;
        let mut world = open(engine, &scene, &Setup { sleeping, ..STOCK }).unwrap();
        steps(world.as_mut(), 5);
        assert_eq!(world.counters().awake, 1, "{engine}");
        steps(world.as_mut(), 25);
        assert!(world.counters().awake > 1, "{engine}: no body woke");
        assert!(world.state(1).velocity.x > 0.1, "{engine}: no body was hit");
        steps(world.as_mut(), 600);
        assert_eq!(world.counters().awake, 0, "{engine}: a body is still awake");

        let mut world = open(engine, &scene, &STOCK).unwrap();
        steps(world.as_mut(), 1);
        assert_eq!(world.counters().awake, 4, "{engine}: no body may sleep");
    }
}

#[test]
fn a_kinematic_body_keeps_its_motion_and_carries_others() {
    for engine in engines() {
        let (mut scene, material) = scene();
        let half = vec2(5.0, 0.5);
        let belt = PlainBody::new(PlainKind::Kinematic, vec2(0.0, -0.5), material);
        let offset = Vec2::ZERO;
        scene.add(
            belt.moving(vec2(0.5, 0.0)),
            PlainShape::Box { half, offset },
        );
        let load = PlainBody::new(PlainKind::Dynamic, vec2(0.0, 0.5), material);
        scene.add(load, square(0.5));
        let mut world = open(engine, &scene, &STOCK).unwrap();
        steps(world.as_mut(), 120);
        let belt = world.state(0);
        assert!((belt.position.x - 1.0).abs() < 1e-5, "{engine}: {belt:?}");
        let load = world.state(1);
        assert!((load.velocity.x - 0.5).abs() < 1e-3, "{engine}: {load:?}");
    }
}

#[test]
fn tuned_settings_reach_the_engine() {
    for engine in engines() {
        let speed = |mode| {
            let (mut scene, _) = scene();
            scene.gravity = Vec2::ZERO;
            let elastic = scene.material(1.0, 0.0, 1.0);
            floor(&mut scene, elastic);
            let ball = PlainBody::new(PlainKind::Dynamic, vec2(0.0, 0.4), elastic);
            let ball = ball.moving(vec2(0.0, -0.5));
            let ball = scene.add(ball, PlainShape::Circle { radius: 0.3 });
            let fast = PlainBody::new(PlainKind::Dynamic, vec2(0.0, 50.0), elastic);
            let fast = fast.moving(vec2(1000.0, 0.0)).spinning(100.0);
            let fast = scene.add(fast, PlainShape::Circle { radius: 0.3 });
            let mut world = open(engine, &scene, &Setup { mode, ..STOCK }).unwrap();
            steps(world.as_mut(), 60);
            (world.state(ball).velocity.y, world.state(fast))
        };
        let (bounce, fast) = speed(Mode::Tuned);
        assert!((bounce - 0.5).abs() < 1e-3, "{engine}: {bounce} m/s");
        assert!((fast.velocity.x - 1000.0).abs() < 0.1, "{engine}: {fast:?}");
        assert!((fast.spin - 100.0).abs() < 0.01, "{engine}: {fast:?}");
        if single(engine) {
            // Box2D: nothing bounces below 1 m/s, nothing flies faster than 400, nothing turns faster than 45° a step.
            let (bounce, fast) = speed(Mode::Stock);
            assert!(bounce.abs() < 0.1, "{engine}: {bounce} m/s");
            assert!((fast.velocity.x - 400.0).abs() < 0.1, "{engine}: {fast:?}");
            let cap = 60.0 * std::f64::consts::FRAC_PI_4;
            assert!((fast.spin - cap).abs() < 0.01, "{engine}: {fast:?}");
        }
    }
}

#[test]
fn two_threads_compute_a_world() {
    for engine in engines() {
        let scene = pyramid(12);
        let threads = 2;
        let mut world = match open(engine, &scene, &Setup { threads, ..STOCK }) {
            Ok(world) => world,
            // A library of Chipmunk without its threaded space.
            Err(EngineError::Threads { .. }) => continue,
            Err(error) => panic!("{error}"),
        };
        steps(world.as_mut(), 60);
        for i in 0..scene.bodies.len() {
            let moved = (world.state(i).position - scene.bodies[i].position).length();
            // False for what is not finite as well.
            assert!(moved < 0.5, "{engine}, body {i} moved {moved} m");
        }
    }
}

#[test]
fn poses_read_are_those_of_the_bodies() {
    for engine in engines() {
        let scene = pyramid(3);
        let mut world = open(engine, &scene, &STOCK).unwrap();
        steps(world.as_mut(), 3);
        let moving = (0..scene.bodies.len()).filter(|i| {
            let fixed = scene.bodies[*i].kind == PlainKind::Fixed;
            !(single(engine) && fixed)
        });
        let expected: f64 = moving
            .map(|i| world.state(i).position)
            .map(|p| p.x + p.y)
            .sum();
        let sum = world.read_poses();
        assert!(
            (sum - expected).abs() < 1e-5,
            "{engine}: {sum} for {expected}"
        );
    }
}

#[test]
fn what_an_engine_cannot_do_is_said() {
    for engine in engines() {
        let (mut scene, material) = scene();
        floor(&mut scene, material);
        let body = PlainBody::new(PlainKind::Dynamic, vec2(0.0, f64::NAN), material);
        scene.add(body, square(0.5));
        let error = open(engine, &scene, &STOCK).err().unwrap().to_string();
        let expected = format!("{engine} refuses body 1: position = NaN");
        assert_eq!(error, expected);

        let threads = 0;
        let refused = open(engine, &pyramid(1), &Setup { threads, ..STOCK });
        assert!(matches!(refused, Err(EngineError::Threads { .. })));
        let hz = 0.0;
        let refused = open(engine, &pyramid(1), &Setup { hz, ..STOCK });
        assert!(matches!(refused, Err(EngineError::Settings { .. })));
    }
}

#[test]
fn a_needle_is_refused_by_the_engine_that_welds_corners() {
    let needle = PlainShape::Polygon(vec![vec2(-0.5, 0.0), vec2(0.5, -5e-4), vec2(0.5, 5e-4)]);
    for engine in engines() {
        let (mut scene, material) = scene();
        floor(&mut scene, material);
        let body = PlainBody::new(PlainKind::Dynamic, vec2(0.0, 2.0), material);
        scene.add(body, needle.clone());
        match open(engine, &scene, &STOCK) {
            Err(EngineError::Body {
                body: 1, reason, ..
            }) => {
                assert!(single(engine), "{engine}: {reason}");
                assert!(reason.contains("hull refused"), "{reason}");
            }
            Err(error) => panic!("{error}"),
            Ok(_) => assert!(!single(engine), "{engine} took the needle"),
        }
    }
}

#[test]
fn settings_are_told() {
    for engine in engines() {
        let told = |mode| {
            let setup = Setup { mode, ..STOCK };
            open(engine, &pyramid(1), &setup).unwrap().settings()
        };
        let (stock, tuned) = (told(Mode::Stock), told(Mode::Tuned));
        let expected: &[(&str, &str)] = if single(engine) {
            &[
                ("restitution_threshold=1m/s", "restitution_threshold=0m/s"),
                ("speed_cap=400m/s", "speed_cap=off"),
                ("rotation_cap=on", "rotation_cap=off"),
                ("recycling=0.050m", "recycling=0.000m"),
                ("contact=30Hz damping=10 push=3m/s", "substeps=4"),
            ]
        } else {
            &[
                ("slop=0.100m", "slop=0.001m"),
                ("iterations=10", "iterations=10"),
            ]
        };
        for (in_stock, in_tuned) in expected {
            assert!(stock.contains(in_stock), "{stock}");
            assert!(tuned.contains(in_tuned), "{tuned}");
        }
    }
}
