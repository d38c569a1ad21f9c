use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use super::strategies::{cloud, ring, star};
use crate::{Aabb, Circle, ConvexPolygon, Polygon, Segment, Shape};

fn point() -> impl Strategy<Value = Vec2> {
    (-1.5..1.5_f64, -1.5..1.5_f64).prop_map(|(x, y)| vec2(x, y))
}

/// Any kind of shape, about 2 m across.
fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        star().prop_map(|ring| Polygon::new(ring).expect("simple").into()),
        cloud().prop_filter_map("on one line", |points| {
            ConvexPolygon::hull(points).ok().map(Shape::from)
        }),
        (point(), 0.01..1.0_f64).prop_map(|(c, r)| Circle::at(c, r).expect("a disc").into()),
        (point(), point()).prop_map(|(a, b)| Segment::new(a, b).expect("some length").into()),
    ]
}

proptest! {
    #[test]
    fn a_point_is_inside_where_a_piece_has_it(ring in ring(), x in -0.1..1.1_f64, y in -0.1..1.1_f64) {
        let polygon = Polygon::new(ring).expect("simple");
        let bounds = Aabb::from_points(polygon.vertices().iter().copied());
        let p = bounds.min + bounds.extents() * vec2(x, y);
        let in_piece = polygon.pieces().iter().any(|piece| {
            ConvexPolygon::new(piece.vertices()).expect("convex").contains(p)
        });
        prop_assert_eq!(polygon.contains(p), in_piece);
        for v in polygon.vertices() {
            prop_assert!(polygon.contains(*v), "the rim belongs to it");
        }
    }

    #[test]
    fn the_closest_point_is_on_the_rim_and_nothing_is_closer(shape in shape(), p in point(), q in point()) {
        let closest = shape.closest_rim_point(p);
        prop_assert!(shape.signed_distance(closest).abs() < 1e-14);
        let distance = shape.signed_distance(p);
        prop_assert!((distance.abs() - closest.distance(p)).abs() < 1e-14);
        // No distance function grows faster than the way.
        prop_assert!((shape.signed_distance(q) - distance).abs() <= q.distance(p) + 1e-14);
        prop_assert_eq!(shape.closest_point(p) == p, distance <= 0.0);
        for v in shape.vertices() {
            prop_assert!(matches!(shape, Shape::Circle(_)) || closest.distance(p) <= v.distance(p) + 1e-15);
        }
    }

    #[test]
    fn a_ray_ends_where_the_shape_begins(shape in shape(), p in point(), angle in 0.0..7.0_f64) {
        let direction = Rot::from_angle(angle).x_axis();
        let max = 10.0;
        match shape.cast_ray(p, direction, max) {
            Some(hit) => {
                prop_assert!(!shape.contains(p));
                prop_assert!((p + direction * hit.distance).distance(hit.point) < 1e-13);
                prop_assert!(shape.signed_distance(hit.point).abs() < 1e-13);
                prop_assert!(hit.normal.dot(direction) <= 1e-15, "against the ray");
                // Nothing lies on the way.
                for part in [0.1, 0.5, 0.9] {
                    let on_way = p + direction * (hit.distance * part);
                    prop_assert!(shape.signed_distance(on_way) > -1e-14);
                }
                prop_assert_eq!(shape.cast_ray(p, direction, hit.distance * (1.0 - 1e-12)), None);
            }
            None => for step in 0..100 {
                let on_way = p + direction * (0.03 * f64::from(step));
                prop_assert!(shape.contains(p) || shape.signed_distance(on_way) > -1e-14);
            },
        }
    }

    #[test]
    fn no_ray_slips_through_a_corner(ring in star(), far in 0.1..3.0_f64) {
        let shape = Shape::from(Polygon::new(ring.clone()).expect("simple"));
        for corner in ring {
            // Straight at the origin, about which the star is one.
            let hit = shape.cast_ray(corner * (1.0 + far), -corner, 2.0 + far);
            prop_assert!(hit.is_some(), "past corner {}", corner);
        }
    }

    #[test]
    fn box_reach_and_support_bound_the_shape(shape in shape(), p in point(), angle in 0.0..7.0_f64) {
        let pose = Pose::new(p, Rot::from_angle(angle));
        let bounds = shape.aabb(pose).grown(1e-14);
        let reach = shape.reach_about(p) + 1e-14;
        let direction = pose.rotation.x_axis();
        let farthest = shape.support(direction).dot(direction) + 1e-14;
        for towards in 0..32 {
            let q = Rot::from_angle(f64::from(towards) * 0.2).x_axis() * 9.0;
            let rim = shape.closest_rim_point(q);
            prop_assert!(bounds.contains_point(pose.point(rim)));
            prop_assert!(rim.distance(p) <= reach);
            prop_assert!(rim.dot(direction) <= farthest);
        }
    }
}

#[test]
fn what_lies_on_an_edge_is_inside_and_what_lies_beside_it_is_not() {
    let triangle = Shape::from(
        ConvexPolygon::new([vec2(0.0, 0.0), vec2(24.0, 0.0), vec2(24.0, 24.0)]).expect("convex"),
    );
    assert!(triangle.contains(vec2(0.5, 0.5)));
    assert!(
        !triangle.contains(vec2(0.5, 0.5_f64.next_up())),
        "the plain product says 0 here"
    );
    let wall = Shape::from(Segment::new(Vec2::ZERO, vec2(24.0, 24.0)).expect("some length"));
    assert!(wall.contains(vec2(0.5, 0.5)) && !wall.contains(vec2(0.5, 0.5_f64.next_down())));
    assert!(!wall.contains(vec2(25.0, 25.0)));
}
