//! Within a sub-step a body went by the mean of the velocities that it had before and has afterwards, and ended where it was: a
//! body that was stopped there set out from elsewhere than it was, by up to its way in a sub-step (0.25 m at 90 m/s).

use carom_dynamics::{BodyDef, BodyId, Settings, World};
use carom_geometry::Shape;
use carom_math::{SimTime, Vec2, vec2};
use carom_tests::scenes::{block, disc, put, stepped, surface};

/// A body of this shape that is thrown at a wall with its face at x = 0.
fn thrown(shape: Shape, speed: f64, restitution: f64, history: usize) -> (World, BodyId) {
    let mut world = stepped(Settings {
        gravity: Vec2::ZERO,
        // Whole ticks are exact, and equal however they are cut.
        tick: 1.0 / 64.0,
        history,
        ..Settings::default()
    });
    let material = surface(restitution, 0.3);
    let wall = BodyDef::fixed().at(vec2(0.5, 0.0));
    put(&mut world, wall, block(1.0, 20.0), material);
    let def = BodyDef::dynamic()
        .at(vec2(-1.3, 0.0))
        .moving(vec2(speed, 0.1 * speed))
        .spinning(3.0);
    let id = put(&mut world, def, shape, material);
    (world, id)
}

#[test]
fn looking_back_finds_no_jump_where_a_sub_step_stopped_a_body() {
    for speed in [5.0, 20.0, 90.0, 700.0] {
        for restitution in [0.0, 0.5, 1.0] {
            for shape in [disc(0.1).into(), block(0.3, 0.2).into()] {
                let (mut world, id) = thrown(shape, speed, restitution, 1000);
                let seconds = 3.0 / speed + 0.05;
                for part in [0.3, 0.3, 0.4] {
                    world.step(part * seconds);
                }
                let samples = 20_000;
                let dt = world.time().as_secs() / f64::from(samples);
                let at = |k: i32| {
                    let time = SimTime::from_secs(f64::from(k) * dt);
                    world.pose_at(id, time).expect("the log reaches")
                };
                let mut before = at(0);
                for k in 1..samples {
                    let now = at(k);
                    let way = (now.position - before.position).length();
                    // No body gets faster; what friction turns moves a corner of 0.2 m.
                    assert!(
                        way <= 1.01 * speed * dt + 1e-9,
                        "{speed} m/s, restitution {restitution}: {way:.2e} m in {dt:.1e} s after {:.6} s",
                        f64::from(k) * dt
                    );
                    let turn = (now.rotation * before.rotation.inverse()).angle().abs();
                    let fastest = 3.0 + 1.5 * speed / 0.1;
                    assert!(turn <= fastest * dt + 1e-9, "{turn:.2e} rad in {dt:.1e} s");
                    before = now;
                }
            }
        }
    }
}

/// The same of poses read while it happens; and reading them changes nothing.
#[test]
fn looks_within_a_sub_step_find_no_jump_and_change_nothing() {
    for speed in [20.0, 90.0] {
        for restitution in [0.0, 1.0] {
            let build = || thrown(block(0.3, 0.2).into(), speed, restitution, 0);
            let ((mut whole, _), (mut parts, id)) = (build(), build());
            let (tick, cuts) = (whole.settings().tick, 40);
            let mut before = parts.body(id).expect("it stays").pose();
            for step in 1..=12_u32 {
                whole.step(tick);
                let end = SimTime::from_secs(f64::from(step) * tick);
                for k in 1..=cuts {
                    let cut = f64::from(k) / f64::from(cuts) - 1.0;
                    let dt = end - parts.time() + cut * tick;
                    parts.step(dt);
                    let now = parts.body(id).expect("it stays").pose();
                    let way = (now.position - before.position).length();
                    assert!(
                        way <= 1.01 * speed * dt + 1e-9,
                        "{speed} m/s: {way} m in {dt} s"
                    );
                    before = now;
                }
                let states = [&whole, &parts].map(|world| {
                    let body = world.body(id).expect("it stays");
                    (body.pose(), body.velocity(), body.angular_velocity())
                });
                assert_eq!(states[0], states[1], "{speed} m/s after step {step}");
            }
        }
    }
}
