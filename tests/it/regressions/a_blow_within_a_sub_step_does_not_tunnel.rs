//! What a caller sets moving in the middle of a sub-step of stepped mode flew on to its end without a search for what it would
//! meet: at 365 m/s a body of 5 cm left its box.

use carom_dynamics::{BodyDef, BodyId, Impulse, Settings, World};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::scenes::{block, disc, put, stepped, surface};

/// Seconds into a sub-step of 1/360 s.
const CUTS: [f64; 4] = [1e-6, 1e-4, 0.9e-3, 2.6e-3];

const SPEEDS: [f64; 4] = [60.0, 365.0, 3e3, 1e5];

/// A wall of 1 cm at x = 0, and a bullet of 2 cm that rests on its left; time is in the middle of a sub-step.
fn world(cut: f64, restitution: f64) -> (World, BodyId) {
    let mut world = stepped(Settings {
        gravity: Vec2::ZERO,
        ..Settings::default()
    });
    let material = surface(restitution, 0.0);
    put(&mut world, BodyDef::fixed(), block(0.01, 4.0), material);
    let def = BodyDef::dynamic().at(vec2(-0.1, 0.3));
    let bullet = put(&mut world, def, disc(0.02), material);
    world.step(0.5 + cut);
    (world, bullet)
}

/// Where something is that must stay on the left, however the steps are cut.
fn stays_left(world: &mut World, ids: &[BodyId], seconds: f64, cut: f64, what: &str) {
    let end = world.time() + seconds;
    while world.time() < end {
        world.step(cut);
        for id in ids {
            let x = world.body(*id).expect("it stays").centre().x;
            assert!(x < -0.005, "{what}: x = {x} in steps of {cut:.1e} s");
        }
    }
}

#[test]
fn a_blow_within_a_sub_step_does_not_tunnel() {
    for speed in SPEEDS {
        for cut in CUTS {
            for step in [1e-5, 3e-4, 1.0 / 60.0] {
                for blow in 0..4 {
                    let (mut world, bullet) = world(cut, 0.5);
                    let velocity = vec2(speed, 0.2 * speed);
                    let id = match blow {
                        0 => {
                            world.set_velocity(bullet, velocity, 3.0).expect("valid");
                            bullet
                        }
                        1 => {
                            let mass = world.body(bullet).expect("it stays").mass();
                            let blow = Impulse::central(mass * velocity);
                            world.apply(bullet, blow).expect("valid");
                            bullet
                        }
                        2 => {
                            let def = BodyDef::dynamic()
                                .at(vec2(-0.2, -0.5))
                                .moving(velocity)
                                .spinning(speed);
                            put(&mut world, def, block(0.1, 0.004), surface(0.5, 0.0))
                        }
                        _ => {
                            // What flew along the wall has it in its way now.
                            let def = BodyDef::dynamic().at(vec2(-1.0, -0.1)).moving(velocity);
                            let id = put(&mut world, def, disc(0.02), surface(0.5, 0.0));
                            world.step(1e-5);
                            let x = world.body(id).expect("it is there").centre().x;
                            let def = BodyDef::fixed().at(vec2(x.min(-0.1) + 0.06, 0.0));
                            put(&mut world, def, block(0.01, 400.0), surface(0.5, 0.0));
                            id
                        }
                    };
                    let what = format!("{speed} m/s, {cut:.1e} s into a sub-step, blow {blow}");
                    stays_left(&mut world, &[id], 0.05, step, &what);
                }
            }
        }
    }
}

#[test]
fn a_blow_within_a_sub_step_keeps_its_speed() {
    for speed in SPEEDS {
        for cut in CUTS {
            let (mut world, bullet) = world(cut, 1.0);
            world
                .set_velocity(bullet, vec2(speed, 0.0), 0.0)
                .expect("valid");
            world.step(1e-6);
            assert_eq!(world.body(bullet).expect("it stays").velocity().x, speed);
            world.step(0.05);
            let back = world.body(bullet).expect("it stays").velocity().x;
            assert!((back + speed).abs() < 1e-9 * speed, "{speed} m/s: {back}");
        }
    }
}

/// Both were set moving in the same sub-step, one earlier; and a wall is put into the way of one under way.
#[test]
fn two_that_are_swift_meet_within_a_sub_step() {
    for speed in SPEEDS {
        for cut in CUTS {
            let (mut world, one) = world(cut, 1.0);
            let def = BodyDef::dynamic().at(vec2(-0.15 - 0.4 * speed * 1e-3, 0.3));
            let two = put(&mut world, def, disc(0.02), surface(1.0, 0.0));
            world
                .set_velocity(two, vec2(speed, 0.0), 0.0)
                .expect("valid");
            world.step(1e-6);
            world
                .set_velocity(one, vec2(-speed, 0.0), 0.0)
                .expect("valid");
            for _ in 0..200 {
                world.step(1e-4);
                let [one, two] = [one, two].map(|id| world.body(id).expect("it stays").centre().x);
                assert!(two < one, "{speed} m/s: {two} m has passed {one} m");
            }
        }
    }
}

#[test]
fn how_steps_are_cut_after_a_blow_changes_nothing() {
    for cut in CUTS {
        let run = |cuts: u32| {
            let (mut world, bullet) = world(cut, 0.5);
            world
                .set_velocity(bullet, vec2(365.0, 40.0), 9.0)
                .expect("valid");
            let pose = Pose::at(vec2(0.3, 0.0));
            let wall = world.bodies().next().expect("the wall").id();
            world.teleport(wall, pose).expect("valid");
            // Past the end of the sub-step, on the grid of tenths of milliseconds.
            for _ in 0..cuts {
                world.step(0.0625 / f64::from(cuts));
            }
            world.state_hash()
        };
        assert_eq!(run(1), run(1024), "{cut:.1e} s");
        assert_eq!(run(1), run(2), "{cut:.1e} s");
    }
}
