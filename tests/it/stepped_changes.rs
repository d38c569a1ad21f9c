//! Stepped mode and its callers: what they change, when they look, and what they look back at.

use carom_dynamics::{BodyDef, EventKind, PairMaterial, Settings};
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::{boxed, disc, floor, put, stepped, surface};

#[test]
fn a_material_given_to_two_in_touch_holds_at_once() {
    let mut world = stepped(Settings {
        gravity: vec2(1.0, -10.0),
        sleep: None,
        ..Settings::default()
    });
    let floor = floor(&mut world, surface(0.0, 0.5));
    let block = boxed(&mut world, vec2(0.0, 0.5), surface(0.0, 0.5));
    run(&mut world, 1.0, |_| {});
    let speed = world.body(block).expect("it stays").velocity().x;
    assert!(speed.abs() < 1e-9, "friction holds it, at {speed} m/s");
    let smooth = PairMaterial {
        friction: 0.0,
        restitution: 0.0,
        tangent_speed: 0.0,
    };
    world
        .set_pair_material(floor, block, smooth)
        .expect("both are there");
    run(&mut world, 1.0, |_| {});
    let speed = world.body(block).expect("it stays").velocity().x;
    assert!(
        (speed - 1.0).abs() < 1e-6,
        "1 m/s² for 1 s, not {speed} m/s"
    );
}

#[test]
fn rest_is_told_by_time_however_often_a_caller_changes_others() {
    let settings = Settings::default();
    let sleep = settings.sleep.expect("on by default");
    let substep = settings.substep;
    let mut world = stepped(settings);
    floor(&mut world, surface(0.0, 0.5));
    let block = boxed(&mut world, vec2(0.0, 0.5), surface(0.0, 0.5));
    let ball = BodyDef::dynamic().at(vec2(9.0, 50.0));
    let ball = put(&mut world, ball, disc(0.25), surface(0.0, 0.5));
    for _ in 0..2000 {
        world
            .set_velocity(ball, Vec2::ZERO, 0.0)
            .expect("it is there");
        world.step(substep);
        let asleep = |event: &carom_dynamics::Event| event.kind == EventKind::Asleep(block);
        if let Some(event) = world.events().iter().find(|event| asleep(event)) {
            let after = event.time.as_secs();
            assert!(after >= sleep.time, "asleep after {after} s at rest");
            return;
        }
    }
    panic!("it fell asleep at no time");
}

#[test]
fn poses_within_a_step_are_those_of_its_sub_steps() {
    let settings = Settings {
        history: 1000,
        ..Settings::default()
    };
    let (tick, substep) = (settings.tick, settings.substep);
    let build = || {
        let mut world = stepped(settings);
        floor(&mut world, surface(1.0, 0.5));
        let def = BodyDef::dynamic()
            .at(vec2(0.0, 1.0))
            .moving(vec2(3.0, -20.0))
            .spinning(5.0);
        let ball = put(&mut world, def, disc(0.25), surface(1.0, 0.5));
        (world, ball)
    };
    let ((mut whole, ball), (mut parts, same)) = (build(), build());
    for step in 0..12_u64 {
        whole.step(tick);
        for k in 1..=6 {
            parts.step(substep);
            if k == 6 {
                continue;
            }
            // The end of a sub-step, not the start of the next: a bounce lies between.
            let time = SimTime::multiple(6 * step + k, substep) + -1e-9;
            let before = whole.pose_at(ball, time).expect("the log reaches").position;
            let then = parts.body(same).expect("it stays").centre();
            assert!(
                (before - then).length() < 1e-7,
                "{before} instead of {then} after {} s",
                time.as_secs()
            );
        }
    }
}
