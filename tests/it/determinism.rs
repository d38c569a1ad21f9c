//! Equal input, equal bits.

use carom_dynamics::{BodyDef, PairSearch, Settings, World};
use carom_geometry::Circle;
use carom_math::{Vec2, vec2};
use carom_tests::{elastic, run};

fn hash_of(name: &str, seconds: f64) -> u64 {
    let scene = carom_scenes::find(name).expect("a built-in scene");
    let mut world = scene.build().expect("it builds").world;
    run(&mut world, seconds, |_| {});
    world.state_hash()
}

#[test]
fn every_built_in_scene_runs_to_the_same_bits_twice() {
    for scene in carom_scenes::list().iter().filter(|info| !info.large) {
        assert_eq!(
            hash_of(scene.name, 2.0),
            hash_of(scene.name, 2.0),
            "{}",
            scene.name
        );
    }
}

/// Discs in a row of boxes of walls, inserted in the order given.
fn gas(order: &[usize], search: PairSearch) -> World {
    let settings = Settings {
        gravity: Vec2::ZERO,
        pair_search: search,
        sleep: None,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("valid settings");
    for &i in order {
        let k = f64::from(u32::try_from(i).expect("a few discs"));
        let at = vec2(1.1 * (k % 6.0) - 2.7, 1.1 * (k / 6.0).floor() - 2.7);
        let v = vec2((k * 7.0) % 5.0 - 2.0, (k * 3.0) % 4.0 - 1.5);
        let disc = Circle::new(0.4).expect("a disc");
        world
            .insert(
                BodyDef::dynamic().at(at).moving(v).tagged(i as u64),
                disc,
                elastic(),
            )
            .expect("valid");
    }
    for (x, y, w, h) in [
        (-5.0, 0.0, 1.0, 12.0),
        (5.0, 0.0, 1.0, 12.0),
        (0.0, -5.0, 12.0, 1.0),
        (0.0, 5.0, 12.0, 1.0),
    ] {
        let wall = carom_geometry::ConvexPolygon::rectangle(w, h).expect("a wall");
        world
            .insert(BodyDef::fixed().at(vec2(x, y)), wall, elastic())
            .expect("valid");
    }
    world
}

#[test]
fn the_order_of_insertion_does_not_change_a_gas() {
    let forth: Vec<usize> = (0..30).collect();
    let back: Vec<usize> = (0..30).rev().collect();
    let (mut a, mut b) = (
        gas(&forth, PairSearch::Indexed),
        gas(&back, PairSearch::Indexed),
    );
    run(&mut a, 1.0, |_| {});
    run(&mut b, 1.0, |_| {});
    for body in a.bodies().filter(|body| body.mass().is_finite()) {
        let twin = b
            .bodies()
            .find(|other| other.tag() == body.tag() && other.mass().is_finite());
        let twin = twin.expect("the same discs");
        // Not bit for bit: A and B swap roles in a pair, and chaos has a second to work.
        assert!(
            (twin.centre() - body.centre()).length() < 1e-9,
            "disc {}",
            body.tag()
        );
    }
}

#[test]
fn all_pairs_and_the_tree_find_the_same_impacts() {
    let order: Vec<usize> = (0..30).collect();
    let mut fast = gas(&order, PairSearch::Indexed);
    let mut slow = gas(&order, PairSearch::AllPairs);
    for step in 0..300 {
        let (a, b) = (fast.step(1.0 / 60.0), slow.step(1.0 / 60.0));
        assert_eq!(a.impacts, b.impacts, "step {step}");
        assert_eq!(fast.state_hash(), slow.state_hash(), "step {step}");
    }
    assert!(fast.energy().kinetic > 0.0);
}
