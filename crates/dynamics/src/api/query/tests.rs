//! Queries through the tree against a look at every shape.

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon};
use carom_math::vec2;
use proptest::prelude::*;

use super::*;
use crate::{BodyDef, Material, PairSearch, Settings};

/// Every shape with its body and its place there, in order.
fn all_shapes(world: &World) -> impl Iterator<Item = (&BodyState, usize, &Collider)> {
    world.bodies.iter().flat_map(move |body| {
        let places = body.colliders.iter().enumerate();
        places.map(move |(i, at)| (body, i, &world.bodies.colliders[*at]))
    })
}

fn scan_ray(world: &World, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
    let direction = direction.try_normalize()?;
    let mut best: Option<RayHit> = None;
    for (body, shape, collider) in all_shapes(world) {
        let pose = body.centre_pose(world.clock.now);
        let local = (pose.inverse_point(origin), pose.inverse_vector(direction));
        if let Some(hit) = collider.solid.cast_ray(local.0, local.1, max)
            && best.is_none_or(|known| hit.distance < known.distance)
        {
            best = Some(RayHit {
                body: body.id,
                shape,
                distance: hit.distance,
                point: pose.point(hit.point),
                normal: pose.vector(hit.normal),
            });
        }
    }
    best
}

fn scan_cast(world: &World, shape: &Shape, pose: Pose, way: Vec2) -> Option<ShapeHit> {
    let mut best: Option<ShapeHit> = None;
    for (body, index, collider) in all_shapes(world) {
        let target = body.centre_pose(world.clock.now);
        if let Some(hit) = cast(shape, pose, way, &collider.solid, target)
            && best.is_none_or(|known| hit.fraction < known.fraction)
        {
            best = Some(ShapeHit {
                body: body.id,
                shape: index,
                fraction: hit.fraction,
                point: hit.point,
                normal: hit.normal,
            });
        }
    }
    best
}

fn scan(world: &World, matches: impl Fn(Pose, &Shape) -> bool) -> Vec<BodyId> {
    let mut found: Vec<BodyId> = all_shapes(world)
        .filter(|(body, _, c)| matches(body.centre_pose(world.clock.now), &c.solid))
        .map(|(body, _, _)| body.id)
        .collect();
    found.dedup();
    found
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.05..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
        (0.05..1.0_f64, 0.5..2.0_f64)
            .prop_map(|(w, h)| ConvexPolygon::rectangle(w, h).expect("a box").into()),
        (3..6_usize, 0.3..1.0_f64)
            .prop_map(|(n, r)| Polygon::star(n, r, 0.4 * r).expect("a star").into()),
    ]
}

/// A place on a coarse grid, so that shapes touch and answers are equal now and then.
fn place() -> impl Strategy<Value = Vec2> {
    prop_oneof![
        (-8..8_i32, 0..8_i32).prop_map(|(x, y)| vec2(f64::from(x), f64::from(y))),
        (-8.0..8.0_f64, 0.0..8.0_f64).prop_map(|(x, y)| vec2(x, y)),
    ]
}

#[derive(Clone, Debug)]
struct Put {
    at: Vec2,
    velocity: Vec2,
    angle: f64,
    fixed: bool,
    shapes: Vec<Shape>,
}

fn put() -> impl Strategy<Value = Put> {
    let shapes = prop::collection::vec(shape(), 1..3);
    let turned = prop_oneof![Just(0.0), -3.0..3.0_f64];
    let rest = (any::<bool>(), shapes);
    (place(), (-9.0..9.0_f64, -9.0..9.0_f64), turned, rest).prop_map(
        |(at, velocity, angle, (fixed, shapes))| Put {
            at,
            velocity: Vec2::from(velocity),
            angle,
            fixed,
            shapes,
        },
    )
}

/// Bodies above a floor that never ends, some time later; one is gone, one was put elsewhere.
fn world(bodies: &[Put], search: PairSearch, offset: Vec2, time: f64) -> World {
    let settings = Settings {
        gravity: vec2(0.0, -10.0),
        pair_search: search,
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("settings");
    let floor = HalfPlane::new(vec2(0.0, -1.0), Vec2::Y).expect("a floor");
    let floor_at = BodyDef::fixed().at(offset);
    world
        .insert(floor_at, floor, Material::default())
        .expect("a floor");
    let mut ids = Vec::new();
    for body in bodies {
        let def = if body.fixed {
            BodyDef::fixed()
        } else {
            BodyDef::dynamic().moving(body.velocity).spinning(1.0)
        };
        let def = def.at(offset + body.at).turned(body.angle);
        let shapes: Vec<_> = body
            .shapes
            .iter()
            .map(|s| (s.clone(), Material::default()))
            .collect();
        ids.push(world.insert_compound(def, shapes).expect("a body"));
    }
    world.step(time);
    if let [first, second, ..] = ids[..] {
        world.remove(first).expect("it is there");
        world
            .teleport(second, Pose::at(offset + vec2(0.5, 3.0)))
            .expect("a place");
        world.step(0.3 * time);
    }
    world
}

fn offset() -> impl Strategy<Value = Vec2> {
    prop_oneof![
        Just(Vec2::ZERO),
        Just(Vec2::splat((1u64 << 30) as f64)),
        Just(vec2(-1e6, 0.1)),
    ]
}

fn search() -> impl Strategy<Value = PairSearch> {
    prop_oneof![
        Just(PairSearch::Indexed),
        Just(PairSearch::AllPairs),
        Just(PairSearch::None),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_tree_answers_as_a_look_at_every_shape(
        bodies in prop::collection::vec(put(), 0..16),
        (search, offset, time) in (search(), offset(), 0.0..0.4_f64),
        asked in prop::collection::vec((place(), place(), shape()), 8),
    ) {
        let world = world(&bodies, search, offset, time);
        for (from, to, shape) in asked {
            let (from, way) = (offset + from, to - from);
            prop_assert_eq!(world.cast_ray(from, way, f64::INFINITY), scan_ray(&world, from, way, f64::INFINITY));
            prop_assert_eq!(world.cast_ray(from, way, 2.0), scan_ray(&world, from, way, 2.0));
            prop_assert_eq!(world.bodies_at(from), scan(&world, |pose, s| s.contains(pose.inverse_point(from))));
            let bounds = Aabb::from_points([from, offset + to]);
            prop_assert_eq!(world.bodies_in(bounds), scan(&world, |pose, s| s.aabb(pose).overlaps(bounds)));
            let pose = Pose::at(from);
            prop_assert_eq!(world.cast_shape(&shape, pose, way), scan_cast(&world, &shape, pose, way));
        }
    }
}

/// A body that is pushed out of another one by the solver, some hundredths of its size in a sub-step, was sought where it had been.
#[test]
fn bodies_that_are_pushed_out_are_found_within_the_same_sub_step() {
    for mode in [Mode::Exact, Mode::Hybrid, Mode::Stepped] {
        let mut world = World::new(Settings {
            mode,
            ..Settings::default()
        })
        .expect("settings");
        let (def, material) = (BodyDef::fixed(), Material::default());
        let block = ConvexPolygon::square(2.0).expect("a block");
        world.insert(def, block, material).expect("a body");
        let plank = ConvexPolygon::rectangle(0.05, 1.0).expect("a plank");
        for k in 0..5 {
            let turned = 0.2 * f64::from(k);
            let def = BodyDef::dynamic().at(vec2(0.9, 0.0)).turned(turned);
            let id = world.insert(def, plank.clone(), material).expect("a body");
            for call in 0..100 {
                world.step(0.21 * world.clock.h);
                let state = world.bodies.get(id.index);
                let pose = state.centre_pose(world.clock.now);
                let corners = plank.vertices().iter();
                for corner in corners.map(|corner| pose.point(*corner * 0.999_999)) {
                    let found = world.bodies_at(corner);
                    assert!(found.contains(&id), "{mode:?}, plank {k}, call {call}");
                }
            }
            world.remove(id).expect("it is there");
        }
    }
}

/// The engine has boxes of convex pieces, and a corner of a star's box is in none of them.
#[test]
fn bodies_are_found_by_the_boxes_of_whole_shapes_in_every_mode() {
    for mode in [Mode::Exact, Mode::Hybrid, Mode::Stepped] {
        let mut world = World::new(Settings {
            mode,
            gravity: vec2(0.0, -10.0),
            ..Settings::default()
        })
        .expect("settings");
        let material = Material::default();
        let floor = HalfPlane::new(vec2(0.0, 0.0), Vec2::Y).expect("a floor");
        world
            .insert(BodyDef::fixed(), floor, material)
            .expect("a body");
        let star = Polygon::star(4, 1.0, 0.4).expect("a star");
        // No closed form is tried for so many.
        for k in 0..24 {
            let def = BodyDef::dynamic().at(vec2(0.5 * f64::from(k), 1.5));
            world.insert(def, star.clone(), material).expect("a body");
        }
        world.step(0.05);
        let has_members = world.bodies.iter().any(|body| body.in_engine());
        assert_eq!(has_members, mode != Mode::Stepped);
        for (body, _, collider) in all_shapes(&world) {
            if !collider.solid.is_bounded() {
                continue;
            }
            let bounds = collider.solid.aabb(body.centre_pose(world.clock.now));
            for corner in [bounds.min, bounds.max] {
                let found = world.bodies_in(Aabb::new(corner, corner));
                assert!(found.contains(&body.id), "{mode:?}, {:?}", body.id);
            }
        }
    }
}

#[test]
fn of_two_equal_hits_the_first_body_counts() {
    let mut world = World::new(Settings::default()).expect("settings");
    let square = ConvexPolygon::square(2.0).expect("a square");
    let mut put = |x: f64, y: f64| {
        let def = BodyDef::fixed().at(vec2(x, y));
        let material = Material::default();
        world.insert(def, square.clone(), material).expect("a body")
    };
    // Side by side, met along their common border.
    let (first, _second) = (put(5.0, 1.0), put(5.0, -1.0));
    let hit = world.cast_ray(Vec2::ZERO, Vec2::X, 9.0).expect("a hit");
    assert_eq!((hit.body, hit.distance), (first, 4.0));
    let shape = Shape::from(square);
    let hit = world
        .cast_shape(&shape, Pose::IDENTITY, vec2(6.0, 0.0))
        .expect("a hit");
    assert_eq!((hit.body, hit.fraction), (first, 0.5));
}

#[test]
fn questions_without_sense_have_no_answer() {
    let mut world = World::new(Settings::default()).expect("settings");
    let disc = Circle::new(1.0).expect("a disc");
    let (def, material) = (BodyDef::fixed(), Material::default());
    world.insert(def, disc, material).expect("a body");
    let nan = vec2(f64::NAN, 0.0);
    let from = vec2(-5.0, 0.0);
    assert_eq!(world.cast_ray(nan, Vec2::X, 9.0), None);
    assert_eq!(world.cast_ray(from, nan, 9.0), None);
    assert_eq!(world.cast_ray(from, Vec2::ZERO, 9.0), None);
    assert_eq!(world.cast_ray(from, Vec2::X, f64::NAN), None);
    assert_eq!(world.cast_ray(from, Vec2::X, -1.0), None);
    assert_eq!(world.bodies_at(nan), []);
    assert_eq!(world.bodies_in(Aabb::new(nan, nan)), []);
    assert_eq!(world.bodies_in(Aabb::EMPTY), []);
}
