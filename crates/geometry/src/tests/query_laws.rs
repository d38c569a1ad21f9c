use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use super::strategies::{cloud, ring, star};
use crate::{
    Aabb, Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Segment, Shape, ShapeError,
};

fn point() -> impl Strategy<Value = Vec2> {
    (-1.5..1.5_f64, -1.5..1.5_f64).prop_map(|(x, y)| vec2(x, y))
}

/// A place in or near one of the shapes of [`shape`].
fn place() -> impl Strategy<Value = Vec2> {
    prop_oneof![3 => point(), 1 => point().prop_map(|p| p + vec2(4.3, 0.0))]
}

/// Any kind of shape, about 2 m across, or two of them side by side.
fn shape() -> impl Strategy<Value = Shape> {
    let two = (single(), single(), 0.0..7.0_f64).prop_map(|(left, right, angle)| {
        // No point of a shape is farther than 3 √2 m from its origin.
        let away = vec2(4.3, 0.0);
        let turned = Pose::new(away, Rot::from_angle(angle));
        let parts = [(left, Pose::at(-away)), (right, turned)];
        Compound::new(parts).expect("bounded").into()
    });
    let wall = (point(), 0.0..7.0_f64).prop_map(|(p, angle)| {
        let normal = Rot::from_angle(angle).x_axis() * 3.0;
        HalfPlane::new(p, normal).expect("a direction").into()
    });
    prop_oneof![4 => single(), 1 => two, 1 => wall]
}

/// A shape of one part.
fn single() -> impl Strategy<Value = Shape> {
    prop_oneof![
        star().prop_map(|ring| Polygon::new(ring).expect("simple").into()),
        cloud().prop_filter_map("on one line", |points| {
            ConvexPolygon::hull(points).ok().map(Shape::from)
        }),
        (point(), 0.01..1.0_f64).prop_map(|(c, r)| Circle::at(c, r).expect("a disc").into()),
        (point(), point()).prop_map(|(a, b)| Segment::new(a, b).expect("some length").into()),
    ]
}

fn has_disc(shape: &Shape) -> bool {
    match shape {
        Shape::Circle(_) => true,
        Shape::Compound(compound) => compound.parts().iter().any(has_disc),
        _ => false,
    }
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
    fn the_closest_point_is_on_the_rim_and_nothing_is_closer(shape in shape(), p in place(), q in place()) {
        let closest = shape.closest_rim_point(p);
        prop_assert!(shape.signed_distance(closest).abs() < 1e-14);
        let distance = shape.signed_distance(p);
        prop_assert!((distance.abs() - closest.distance(p)).abs() < 1e-14);
        // No distance function grows faster than the way.
        prop_assert!((shape.signed_distance(q) - distance).abs() <= q.distance(p) + 1e-14);
        prop_assert_eq!(shape.closest_point(p) == p, distance <= 0.0);
        for v in shape.vertices() {
            prop_assert!(has_disc(&shape) || closest.distance(p) <= v.distance(p) + 1e-14);
        }
    }

    #[test]
    fn a_ray_ends_where_the_shape_begins(shape in shape(), p in place(), angle in 0.0..7.0_f64) {
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
        let farthest = shape.support(direction).map_or(f64::INFINITY, |p| p.dot(direction) + 1e-14);
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

#[test]
fn a_compound_is_where_its_parts_are() {
    let square = Shape::from(ConvexPolygon::square(2.0).expect("a square"));
    let quarter = Pose::new(vec2(4.0, 0.0), Rot::from_degrees(90.0));
    let pair = Compound::new([
        (square.clone(), Pose::IDENTITY),
        (square.clone(), Pose::at(vec2(4.0, 0.0))),
    ])
    .expect("two squares");
    // A compound in a compound is taken apart.
    let four = Compound::new([
        (pair.clone().into(), Pose::IDENTITY),
        (pair.into(), quarter),
    ])
    .expect("four squares");
    assert_eq!(four.parts().len(), 4);
    let shape = Shape::from(four);
    assert!(shape.contains(vec2(4.0, 4.0)) && !shape.contains(vec2(2.0, 0.0)));
    assert_eq!(shape.signed_distance(vec2(2.0, 0.0)), 1.0);
    assert_eq!(shape.vertices().len(), 16);
    assert_eq!(
        shape.aabb(Pose::IDENTITY),
        Aabb::new(vec2(-1.0, -1.0), vec2(5.0, 5.0))
    );
    let hit = shape
        .cast_ray(vec2(-9.0, 0.5), Vec2::X, 99.0)
        .expect("in the way");
    assert_eq!((hit.distance, hit.normal), (8.0, -Vec2::X));
}

#[test]
fn overlapping_parts_weigh_twice() {
    let square = Shape::from(ConvexPolygon::square(2.0).expect("a square"));
    let twice = [
        (square.clone(), Pose::IDENTITY),
        (square.clone(), Pose::IDENTITY),
    ];
    let both = Compound::new(twice).expect("two squares").area_properties();
    let one = square.area_properties().expect("bounded");
    assert_eq!((both.area, both.polar), (2.0 * one.area, 2.0 * one.polar));
}

#[test]
fn a_half_plane_has_no_end_and_no_mass() {
    let ground = Shape::from(HalfPlane::new(vec2(3.0, 1.0), vec2(0.0, 1e-200)).expect("up"));
    assert_eq!(ground.area_properties(), Err(ShapeError::Unbounded));
    assert_eq!(ground.reach_about(Vec2::ZERO), f64::INFINITY);
    assert_eq!(ground.signed_distance(vec2(-7.0, -1.0)), -2.0);
    let tilted = ground.aabb(Pose::new(Vec2::ZERO, Rot::from_angle(1e-9)));
    assert_eq!(tilted, Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY));
    let upside_down = ground.aabb(Pose::new(Vec2::ZERO, Rot::from_degrees(180.0)));
    assert_eq!(upside_down.min.y, -1.0);
    let refused = Compound::new([(ground, Pose::IDENTITY)]).expect_err("no end");
    assert_eq!(refused, ShapeError::Unbounded);
    assert_eq!(Compound::new([]).expect_err("nothing"), ShapeError::NoParts);
    let nowhere = HalfPlane::new(Vec2::ZERO, Vec2::ZERO).expect_err("no direction");
    assert_eq!(
        nowhere.to_string(),
        "normal is (0, 0), which points nowhere"
    );
}
