//! `dt`, frame rates and looks observe; they change nothing.

use carom_dynamics::{BodyDef, EventKind, Material, Mode, Refusal, Settings, World};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::scenes::{block, floor, put};

fn thesis() -> World {
    let scene = carom_scenes::find("thesis").expect("a built-in scene");
    scene.build().expect("it builds").world
}

#[test]
fn the_caller_s_dt_does_not_change_the_motion() {
    let (mut coarse, mut fine, mut odd) = (thesis(), thesis(), thesis());
    coarse.step(3.0);
    for _ in 0..768 {
        fine.step(3.0 / 768.0);
    }
    let mut left = 3.0;
    while left > 0.0 {
        let dt = f64::min(left, 0.037);
        odd.step(dt);
        left -= dt;
    }
    for (a, b) in coarse.bodies().zip(fine.bodies()) {
        assert_eq!(a.motion(), b.motion(), "{}", a.id());
    }
    for (a, b) in coarse.bodies().zip(odd.bodies()) {
        assert_eq!(a.motion().centre, b.motion().centre, "{}", a.id());
    }
}

/// A step that began and ended within a sub-step of `Mode::Stepped` called itself exact, with bodies 0.1 mm in each other.
#[test]
fn a_part_of_a_sub_step_is_no_more_exact_than_the_whole() {
    for mode in [Mode::Stepped, Mode::Hybrid, Mode::Exact] {
        let mut world = heap(mode, Material::default());
        world.step(0.5);
        for _ in 0..8 {
            let report = world.step(1.0 / 1440.0);
            assert!(!report.is_exact(), "{mode:?}: {report:?}");
        }
    }
}

/// Whether a body leaves the engine was asked of motions as old as the step: bodies that are thrown up from a heap met others where
/// they had been seconds ago.
#[test]
fn a_long_step_lets_members_fly_as_short_ones_do() {
    let [mut coarse, mut fine] = [0.7; 2].map(|e| {
        let lively = Material {
            restitution: e,
            ..Material::default()
        };
        heap(Mode::Hybrid, lively)
    });
    coarse.step(4.0);
    for _ in 0..1024 {
        fine.step(1.0 / 256.0);
    }
    for (a, b) in coarse.bodies().zip(fine.bodies()) {
        assert_eq!(a.motion(), b.motion(), "{}", a.id());
    }
}

/// Forty blocks, turned this way and that, over a floor; none falls asleep.
fn heap(mode: Mode, material: Material) -> World {
    let mut world = World::new(Settings {
        mode,
        sleep: None,
        ..Settings::default()
    })
    .expect("valid");
    floor(&mut world, material);
    for k in 0..40_u32 {
        let at = vec2(1.1 * f64::from(k % 8), 0.6 + 1.1 * f64::from(k / 8));
        let def = BodyDef::dynamic().at(at).turned(0.3 * f64::from(k));
        put(&mut world, def, block(1.0, 0.7), material);
    }
    world
}

#[test]
fn a_look_back_is_what_was_seen() {
    let mut world = World::new(Settings {
        history: 1000,
        ..Settings::default()
    })
    .expect("valid");
    let floor = ConvexPolygon::rectangle(10.0, 1.0).expect("a floor");
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -0.5)),
            floor,
            Material::default(),
        )
        .expect("valid");
    let bouncy = Material {
        restitution: 0.8,
        ..Material::default()
    };
    let ball = world
        .insert(
            BodyDef::dynamic().at(vec2(0.0, 2.0)).spinning(3.0),
            Circle::new(0.2).expect("a ball"),
            bouncy,
        )
        .expect("valid");
    let mut seen = Vec::new();
    for _ in 0..60 {
        world.step(1.0 / 60.0);
        seen.push((world.time(), world.body(ball).expect("it stays").pose()));
    }
    for (time, pose) in seen {
        let back = world.pose_at(ball, time).expect("within the log");
        assert!(
            (back.position - pose.position).length() < 1e-12,
            "at {} s",
            time.as_secs()
        );
    }
    assert_eq!(
        world.pose_at(ball, world.time() + 1.0),
        None,
        "the future is not known"
    );
}

/// Before, frames from before the change were those of the new centre of mass: 0.3 m off.
#[test]
fn a_look_back_past_a_change_of_shapes_sees_the_old_frame() {
    for mode in [Mode::Exact, Mode::Hybrid, Mode::Stepped] {
        let mut world = World::new(Settings {
            history: 100,
            mode,
            ..Settings::default()
        })
        .expect("valid");
        let ball = Shape::from(Circle::new(0.2).expect("a ball"));
        let def = BodyDef::dynamic().at(vec2(0.0, 2.0)).spinning(3.0);
        let body = world
            .insert(def, ball.clone(), Material::default())
            .expect("valid");
        world.step(0.1);
        let (then, pose) = (world.time(), world.body(body).expect("it stays").pose());
        world.step(0.1);
        let moved = ball.translated(vec2(0.3, 0.0));
        world
            .set_shapes(body, vec![(moved, Material::default())])
            .expect("valid");
        world.step(0.1);
        let back = world.pose_at(body, then).expect("within the log");
        let off = (back.position - pose.position).length();
        assert!(off < 1e-12, "{mode:?}: {off} m");
    }
}

#[test]
fn without_a_log_only_the_present_piece_is_known() {
    let mut world = thesis();
    world.step(2.0);
    let moving = world
        .bodies()
        .find(|b| b.mass().is_finite())
        .expect("a body")
        .id();
    assert_eq!(world.pose_at(moving, SimTime::ZERO), None);
    assert!(world.pose_at(moving, world.time()).is_some());
}

#[test]
fn a_bad_dt_moves_nothing_and_says_why() {
    let mut world = thesis();
    world.step(0.5);
    let before = world.state_hash();
    for (dt, expected) in [
        (f64::NAN, "dt is NaN, not a finite number"),
        (f64::INFINITY, "dt is inf, not a finite number"),
        (-0.25, "dt is -0.25 s, below 0"),
        (
            1e9,
            "dt is 1e9 s, more than 1.6666666666666666e5 s (1e7 ticks)",
        ),
    ] {
        let report = world.step(dt);
        let refused: Refusal = report.refused.expect("refused");
        assert_eq!(refused.to_string(), expected);
        assert_eq!(report.advanced, 0.0);
        assert_eq!(world.state_hash(), before);
    }
    assert_eq!(world.step(0.0).refused, None);
    assert_eq!(world.state_hash(), before);
}

#[test]
fn stepping_to_the_next_event_stops_at_the_instant_of_an_impact() {
    let settings = Settings {
        gravity: vec2(0.0, -10.0),
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid");
    let floor = ConvexPolygon::rectangle(10.0, 1.0).expect("a floor");
    world
        .insert(
            BodyDef::fixed().at(vec2(0.0, -0.5)),
            floor,
            Material::default(),
        )
        .expect("valid");
    let ball = Circle::new(0.2).expect("a ball");
    world
        .insert(
            BodyDef::dynamic().at(vec2(0.0, 5.2)),
            ball,
            Material::default(),
        )
        .expect("valid");
    let report = world.step_to_next_event(10.0);
    assert_eq!(report.impacts, 1);
    assert!(
        (world.time().as_secs() - 1.0).abs() < 1e-14,
        "it falls 5 m in 1 s"
    );
    assert!(world.events().iter().any(|event| matches!(event.kind, EventKind::Impact { speed, .. } if (speed - 10.0).abs() < 1e-12)));
}

#[test]
fn events_beyond_the_buffer_are_counted() {
    let mut world = World::new(Settings {
        events: 2,
        ..Settings::default()
    })
    .expect("valid");
    for i in 0..10 {
        let x = f64::from(i);
        let floor = ConvexPolygon::rectangle(0.5, 0.5).expect("a block");
        world
            .insert(
                BodyDef::fixed().at(vec2(x, -0.25)),
                floor,
                Material::default(),
            )
            .expect("valid");
        let ball = Circle::new(0.1).expect("a ball");
        world
            .insert(
                BodyDef::dynamic().at(vec2(x, 0.2)),
                ball,
                Material::default(),
            )
            .expect("valid");
    }
    world.step(0.5);
    assert_eq!(world.events().len(), 2);
    assert!(
        world.events().dropped() >= 18,
        "each ball begins to touch and strikes"
    );
}

#[test]
fn a_stopwatch_times_every_stage_and_changes_nothing() {
    // A clock that counts how often it is read: each lap is one tick long.
    fn ticks() -> f64 {
        use std::cell::Cell;
        thread_local!(static READ: Cell<f64> = const { Cell::new(0.0) });
        READ.with(|read| {
            read.set(read.get() + 1.0);
            read.get()
        })
    }
    // A block that slides, slowed down by itself, which no closed form of contacts knows: 144 sub-steps in 0.4 s.
    let [mut timed, mut plain] = [(); 2].map(|()| {
        let mut world = World::new(Settings::default()).expect("valid");
        let floor = HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor");
        world
            .insert(BodyDef::fixed(), Shape::from(floor), Material::default())
            .expect("valid");
        let def = BodyDef::dynamic().at(vec2(0.0, 0.5)).moving(vec2(9.0, 0.0));
        let block = ConvexPolygon::rectangle(1.0, 1.0).expect("a block");
        world
            .insert(def.damped(0.1, 0.0), block, Material::default())
            .expect("valid");
        world
    });
    timed.set_stopwatch(Some(ticks));
    timed.step(0.4);
    plain.step(0.4);
    assert_eq!(timed.state_hash(), plain.state_hash());
    assert_eq!(plain.profile().total(), 0.0);
    for (stage, seconds) in timed.profile().stages() {
        assert!(seconds >= 144.0, "{stage}: {seconds}");
    }
}
