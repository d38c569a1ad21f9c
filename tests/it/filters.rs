//! Filters: pairs that pass through each other, in every mode and in queries.

use carom_dynamics::{
    BodyDef, BodyError, BodyId, BodyKind, Filter, Material, Mode, Settings, World,
};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2, vec2};
use carom_tests::run;
use carom_tests::scenes::{block, disc, put};

const MODES: [Mode; 3] = [Mode::Hybrid, Mode::Exact, Mode::Stepped];

/// Coins meet walls, ghosts match no mask but their own.
const WALL: Filter = Filter {
    categories: 1,
    mask: u64::MAX,
    group: 0,
};
const COIN: Filter = Filter {
    categories: 2,
    mask: 1,
    group: 0,
};
const GHOST: Filter = Filter {
    categories: 4,
    mask: u64::MAX,
    group: 0,
};

fn world(mode: Mode) -> World {
    World::new(Settings {
        mode,
        ..Settings::default()
    })
    .expect("valid")
}

fn floor(world: &mut World) -> BodyId {
    let def = BodyDef::fixed().at(vec2(0.0, -1.0)).filtered(WALL);
    put(world, def, block(40.0, 2.0), Material::default())
}

fn boxed(world: &mut World, at: Vec2, filter: Filter) -> BodyId {
    let def = BodyDef::dynamic().at(at).filtered(filter);
    put(world, def, block(1.0, 1.0), Material::default())
}

/// A world, its floor, and a coin that sleeps on it.
fn asleep_on_a_floor(mode: Mode) -> (World, BodyId, BodyId) {
    let mut world = world(mode);
    let floor = floor(&mut world);
    let id = boxed(&mut world, vec2(0.0, 0.5), COIN);
    run(&mut world, 2.0, |_| {});
    assert!(world.body(id).expect("it stays").is_asleep(), "{mode:?}");
    (world, floor, id)
}

fn height(world: &World, id: BodyId) -> f64 {
    world.body(id).expect("it stays").centre().y
}

#[test]
fn what_a_mask_leaves_out_falls_through() {
    for mode in MODES {
        let mut world = world(mode);
        floor(&mut world);
        let coins = [2.0, 3.5, 5.0].map(|y| boxed(&mut world, vec2(0.0, y), COIN));
        let ghost = boxed(&mut world, vec2(0.0, 8.0), Filter { mask: 4, ..GHOST });
        run(&mut world, 3.0, |_| {});
        for coin in coins {
            let y = height(&world, coin);
            assert!((y - 0.5).abs() < 2e-3, "{mode:?}: a coin lies at {y}");
        }
        let y = height(&world, ghost);
        assert!((y - (8.0 - 0.5 * 9.81 * 9.0)).abs() < 1e-9, "{mode:?}: {y}");
    }
}

#[test]
fn a_group_outweighs_the_masks() {
    for mode in MODES {
        let mut world = world(mode);
        floor(&mut world);
        let friends = Filter { group: 7, ..COIN };
        let low = boxed(&mut world, vec2(0.0, 0.5), friends);
        let high = boxed(&mut world, vec2(0.0, 2.0), friends);
        let strangers = Filter { group: -3, ..WALL };
        let through = [1.0, 2.5].map(|y| boxed(&mut world, vec2(5.0, y), strangers));
        run(&mut world, 2.0, |_| {});
        assert!((height(&world, low) - 0.5).abs() < 2e-3, "{mode:?}");
        assert!((height(&world, high) - 1.5).abs() < 4e-3, "{mode:?}");
        for id in through {
            assert!((height(&world, id) - 0.5).abs() < 2e-3, "{mode:?}");
        }
    }
}

#[test]
fn a_filter_that_changes_lets_fall_what_it_held() {
    for mode in MODES {
        let (mut world, floor, id) = asleep_on_a_floor(mode);
        world.set_filter(floor, GHOST).expect("it is there");
        run(&mut world, 0.5, |_| {});
        let fallen = 0.5 - height(&world, id);
        assert!(
            (fallen - 0.5 * 9.81 * 0.25).abs() < 0.03,
            "{mode:?}: {fallen}"
        );
        // Back on: what is under way is met again.
        world.teleport(id, Pose::at(vec2(3.0, 2.0))).expect("valid");
        world.set_shape_filter(floor, 0, WALL).expect("it is there");
        run(&mut world, 2.0, |_| {});
        assert!((height(&world, id) - 0.5).abs() < 2e-3, "{mode:?}");
    }
}

#[test]
fn shapes_of_one_body_have_filters_of_their_own() {
    for mode in MODES {
        let mut world = world(mode);
        let beam = |x: f64| Shape::from(block(2.0, 1.0).translated(vec2(x, 0.0)));
        let shapes = vec![
            (beam(-2.0), Material::default()),
            (beam(2.0), Material::default()),
        ];
        let shelf = world
            .insert_compound(BodyDef::fixed(), shapes)
            .expect("valid");
        world
            .set_shape_filter(shelf, 1, GHOST)
            .expect("it is there");
        let held = boxed(&mut world, vec2(-2.0, 1.5), COIN);
        let falls = boxed(&mut world, vec2(2.0, 1.5), COIN);
        run(&mut world, 1.0, |_| {});
        assert!((height(&world, held) - 1.0).abs() < 2e-3, "{mode:?}");
        assert!(height(&world, falls) < -3.0, "{mode:?}");
        let error = world.set_shape_filter(shelf, 2, GHOST);
        assert!(matches!(
            error,
            Err(BodyError::NoSuchShape {
                shape: 2,
                count: 2,
                ..
            })
        ));
    }
}

#[test]
fn a_fixed_support_that_becomes_dynamic_wakes_what_it_held() {
    for mode in MODES {
        let (mut world, floor, id) = asleep_on_a_floor(mode);
        world
            .set_kind(floor, BodyKind::Dynamic)
            .expect("it has mass");
        run(&mut world, 0.5, |_| {});
        assert!(
            height(&world, id) < -0.5,
            "{mode:?}: {}",
            height(&world, id)
        );
    }
}

#[test]
fn questions_see_what_their_filter_touches() {
    for mode in MODES {
        let mut world = world(mode);
        let floor = floor(&mut world);
        let coin = boxed(&mut world, vec2(0.0, 3.0), COIN);
        let ghost = boxed(&mut world, vec2(0.0, 5.0), GHOST);
        world.step(0.0);
        let first = |filter: Filter| {
            let hit = world
                .filtered(filter)
                .cast_ray(vec2(0.0, 9.0), -Vec2::Y, 20.0);
            hit.map(|hit| hit.body)
        };
        assert_eq!(first(WALL), Some(ghost));
        assert_eq!(first(Filter { mask: 2, ..WALL }), Some(coin));
        assert_eq!(first(Filter { mask: 1, ..GHOST }), Some(floor));
        assert_eq!(first(Filter { mask: 8, ..WALL }), None);
        let bounds = Aabb::new(vec2(-1.0, -1.0), vec2(1.0, 9.0));
        assert_eq!(world.filtered(COIN).bodies_in(bounds), [floor]);
        assert_eq!(world.filtered(WALL).bodies_at(vec2(0.0, 3.0)), [coin]);
        assert_eq!(world.filtered(COIN).bodies_at(vec2(0.0, 3.0)), []);
        let ball = Shape::from(disc(0.2));
        let from = Pose::at(vec2(0.0, 9.0));
        let hit = world
            .filtered(COIN)
            .cast_shape(&ball, from, vec2(0.0, -20.0));
        assert_eq!(hit.map(|hit| hit.body), Some(floor));
    }
}
