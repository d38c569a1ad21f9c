//! What is too large for the grid of free bodies is found by the boxes of its shapes. Its bounding circle met the other one's
//! long before its box did, so at the end of a look the pair was taken for one that had been followed since its circles
//! met: a box flew through a wall of 10 m, and nothing was reported.

use carom_dynamics::{BodyDef, BodyKind, EventKind, Mode, Settings, World};
use carom_math::{Vec2, vec2};
use carom_tests::elastic;
use carom_tests::scenes::{block, disc, put};

fn empty(mode: Mode) -> World {
    let settings = Settings {
        gravity: Vec2::ZERO,
        mode,
        ..Settings::default()
    };
    World::new(settings).expect("valid settings")
}

#[test]
fn a_box_stops_at_a_long_moving_wall_that_was_inserted_first() {
    for mode in [Mode::Hybrid, Mode::Exact] {
        for kind in [BodyKind::Kinematic, BodyKind::Dynamic] {
            for speed in [1.0, 10.0, 200.0] {
                let mut world = empty(mode);
                let wall = match kind {
                    BodyKind::Kinematic => BodyDef::kinematic(),
                    _ => BodyDef::dynamic(),
                };
                put(&mut world, wall, block(0.1, 10.0), elastic());
                let def = BodyDef::dynamic()
                    .at(vec2(-3.0, 0.0))
                    .moving(vec2(speed, 0.0));
                put(&mut world, def, block(0.2, 0.2), elastic());
                world.step(4.0 / speed);
                let struck = world.events().iter().filter_map(|event| match event.kind {
                    EventKind::Impact { .. } => Some(event.time.as_secs()),
                    _ => None,
                });
                let struck: Vec<f64> = struck.collect();
                assert_eq!(struck.len(), 1, "{mode:?}, {kind:?} at {speed} m/s");
                let expected = 2.85 / speed;
                assert!(
                    (struck[0] - expected).abs() < 1e-12 * expected,
                    "{struck:?}"
                );
            }
        }
    }
}

/// From wherever a disc comes, and however long the plank is that it meets.
#[test]
fn a_disc_stops_at_a_plank_from_every_distance() {
    for length in [6.0, 8.0, 10.0, 20.0] {
        for steps in 1..30 {
            let from = 0.5 * f64::from(steps);
            for radius in [0.05, 0.2, 0.4] {
                let mut world = empty(Mode::Exact);
                put(
                    &mut world,
                    BodyDef::dynamic(),
                    block(0.1, length),
                    elastic(),
                );
                let def = BodyDef::dynamic()
                    .at(vec2(-from - radius, 0.3))
                    .moving(vec2(1.0, 0.0));
                put(&mut world, def, disc(radius), elastic());
                let report = world.step(from + 1.0);
                assert_eq!(
                    report.impacts, 1,
                    "a disc of {radius} m from {from} m, a plank of {length} m"
                );
            }
        }
    }
}
