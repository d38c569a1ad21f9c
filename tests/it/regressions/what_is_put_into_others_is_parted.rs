//! A body that was teleported into another one, and moved out of it, took off at once: it flew within it as if nothing were there,
//! and the steps were called exact.

use carom_dynamics::{BodyDef, World};
use carom_math::{Pose, vec2};
use carom_tests::scenes::{block, disc, put, surface};

use crate::setters::{MODES, world};

/// What rested flew on within what left it.
#[test]
fn what_is_put_into_a_flying_body_is_parted_whatever_its_velocity() {
    for (mode, velocity) in MODES
        .into_iter()
        .flat_map(|mode| [(4.0, 0.0), (0.0, 4.0), (-3.0, 3.0)].map(|(x, y)| (mode, vec2(x, y))))
    {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = BodyDef::fixed().at(vec2(0.0, -2.0));
        put(&mut world, floor, block(10.0, 4.0), surface(0.0, 0.6));
        let rests = BodyDef::dynamic().at(vec2(0.0, 0.4));
        let id = put(&mut world, rests, disc(0.4), surface(0.0, 0.6));
        let flies = BodyDef::dynamic()
            .at(vec2(0.0, 50.0))
            .moving(velocity + vec2(0.0, 3.0));
        let other = put(&mut world, flies, disc(0.4), surface(0.0, 0.6));
        world.step(0.3);
        let there = world.body(other).expect("it is there").centre();
        let there = Pose::at(there + vec2(0.1, 0.05));
        world.teleport(id, there).expect("it is there");
        world.step(1.0 / 60.0);
        let report = world.step(1.0 / 60.0);
        assert!(!report.is_exact(), "{mode:?}, {velocity}: {report:?}");
        assert!(
            report.deepest_overlap > 0.1,
            "{mode:?}, {velocity}: {report:?}"
        );
    }
}

#[test]
fn what_is_put_into_a_floor_is_parted_whatever_its_velocity() {
    for mode in MODES {
        let mut world = world(mode, vec2(0.0, -10.0));
        let floor = BodyDef::fixed().at(vec2(0.0, -2.0));
        put(&mut world, floor, block(10.0, 4.0), surface(0.5, 0.0));
        let rises = BodyDef::dynamic().at(vec2(0.0, 5.0)).moving(vec2(0.0, 1.0));
        let id = put(&mut world, rises, block(1.0, 1.0), surface(0.5, 0.0));
        let there = Pose::at(vec2(0.0, 0.1));
        world.teleport(id, there).expect("it is there");
        let report = world.step(0.05);
        assert!(!report.is_exact(), "{mode:?}: {report:?}");
        assert!(report.deepest_overlap > 0.1, "{mode:?}: {report:?}");
        world.step(0.25);
        let height = |world: &World| world.body(id).expect("it is there").centre().y;
        assert!(height(&world) > 0.495, "{mode:?}: {}", height(&world));
    }
}

/// Rows of pieces of a concave body ended while it was deep in another one; both left the engine and flew on, called exact.
#[test]
fn what_overlaps_in_steps_called_exact_is_told() {
    for mode in MODES {
        for seed in 1..=100 {
            carom_tests::thrown_together::watch(mode, seed, |found| {
                let off = found.depth - found.told;
                assert!(
                    !found.exact || off < 1e-4,
                    "{mode:?}, seed {seed}: {found:?}"
                );
            });
        }
    }
}
