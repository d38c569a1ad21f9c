//! Questions to many shapes against the same question to each.

use carom_collision::{NodeId, ShapeTree, cast, shape_distance};
use carom_geometry::{Aabb, Circle, ConvexPolygon, HalfPlane, Polygon, Segment, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        4 => (0.05..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
        4 => (0.05..1.0_f64, 0.5..2.0_f64).prop_map(|(w, h)| ConvexPolygon::rectangle(w, h).expect("a box").into()),
        4 => (3..6_usize, 0.3..1.0_f64).prop_map(|(n, r)| Polygon::star(n, r, 0.4 * r).expect("a star").into()),
        2 => (0.3..2.0_f64).prop_map(|l| Segment::new(Vec2::ZERO, vec2(l, 0.0)).expect("a wall").into()),
        1 => Just(HalfPlane::new(vec2(0.0, -9.0), Vec2::Y).expect("a floor").into()),
    ]
}

/// On a coarse grid, so that shapes touch and answers are equal now and then; near or far out.
fn pose() -> impl Strategy<Value = Pose> {
    let turn = prop_oneof![Just(0.0), -3.0..3.0_f64];
    (-8..8_i32, -8..8_i32, turn)
        .prop_map(|(x, y, turn)| Pose::new(vec2(f64::from(x), f64::from(y)), Rot::from_angle(turn)))
}

fn scene() -> impl Strategy<Value = (Vec<(Shape, Pose)>, Vec2)> {
    let offset = prop_oneof![Just(Vec2::ZERO), Just(Vec2::splat((1u64 << 30) as f64))];
    (prop::collection::vec((shape(), pose()), 0..40), offset)
}

/// A tree after some coming, going and moving, and what it holds, in order of ids.
fn grow(shapes: &[(Shape, Pose)], offset: Vec2) -> (ShapeTree, Vec<(NodeId, Shape, Pose)>) {
    let put = |pose: Pose| Pose::new(pose.position + offset, pose.rotation);
    let (first, second) = shapes.split_at(shapes.len() / 2);
    let mut tree: ShapeTree = first.iter().map(|(s, p)| (s.clone(), put(*p))).collect();
    let old: Vec<NodeId> = tree.ids().collect();
    for (i, id) in old.iter().enumerate() {
        match i % 3 {
            0 => assert!(tree.remove(*id) && !tree.remove(*id) && tree.get(*id).is_none()),
            1 => assert!(tree.set_pose(*id, put(Pose::at(vec2(1.0, 0.5))))),
            _ => {}
        }
    }
    for (shape, pose) in second {
        tree.insert(shape.clone(), put(*pose));
    }
    let list = tree.ids().map(|id| {
        let (shape, pose) = tree.get(id).expect("it is there");
        (id, shape.clone(), pose)
    });
    let list: Vec<_> = list.collect();
    assert_eq!(list.len(), tree.len());
    (tree, list)
}

/// The first of the least.
fn least<T>(all: impl Iterator<Item = (f64, NodeId, T)>) -> Option<(NodeId, T)> {
    all.reduce(|a, b| if b.0 < a.0 { b } else { a })
        .map(|(_, id, answer)| (id, answer))
}

proptest! {
    #[test]
    fn many_shapes_answer_as_each_does(
        (shapes, offset) in scene(),
        asked in prop::collection::vec((shape(), pose(), pose()), 4),
        max in prop_oneof![Just(f64::INFINITY), 0.0..4.0_f64],
    ) {
        let (tree, list) = grow(&shapes, offset);
        for (shape, from, to) in asked {
            let pose = Pose::new(from.position + offset, from.rotation);
            let (origin, way) = (pose.position, to.position - from.position);
            let rays = list.iter().filter_map(|(id, s, p)| {
                let hit = s.cast_ray(p.inverse_point(origin), p.inverse_vector(way), max)?;
                Some((hit.distance, *id, (hit.distance, p.point(hit.point), p.vector(hit.normal))))
            });
            let ray = tree.cast_ray(origin, way, max);
            prop_assert_eq!(ray.map(|(id, hit)| (id, (hit.distance, hit.point, hit.normal))), least(rays));

            let casts = list.iter().filter_map(|(id, s, p)| {
                let hit = cast(&shape, pose, way, s, *p)?;
                Some((hit.fraction, *id, hit))
            });
            prop_assert_eq!(tree.cast_shape(&shape, pose, way), least(casts));

            let points = list.iter().map(|(id, s, p)| {
                let near = p.point(s.closest_point(p.inverse_point(origin)));
                (near.distance(origin), *id, near)
            });
            prop_assert_eq!(tree.closest_point(origin, max), least(points.filter(|p| p.0 <= max)));

            let ways = list.iter().map(|(id, s, p)| {
                let way = shape_distance(&shape, s, p.seen_from(pose));
                (way.distance, *id, way)
            });
            prop_assert_eq!(tree.closest_shape(&shape, pose, max), least(ways.filter(|w| w.0 <= max)));

            let ids = |matches: &dyn Fn(&Shape, Pose) -> bool| -> Vec<NodeId> {
                list.iter().filter(|(_, s, p)| matches(s, *p)).map(|(id, ..)| *id).collect()
            };
            prop_assert_eq!(tree.shapes_at(origin), ids(&|s, p| s.contains(p.inverse_point(origin))));
            let bounds = Aabb::from_points([origin, to.position + offset]);
            prop_assert_eq!(tree.shapes_in(bounds), ids(&|s, p| s.aabb(p).overlaps(bounds)));
            prop_assert_eq!(
                tree.shapes_touching(&shape, pose),
                ids(&|s, p| shape_distance(&shape, s, p.seen_from(pose)).distance <= 0.0)
            );
        }
    }
}
