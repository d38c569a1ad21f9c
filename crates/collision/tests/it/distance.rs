//! Distance against sampled directions, exact overlap tests and its own witnesses.

use carom_collision::{Convex, distance, shape_distance};
use carom_geometry::{Circle, ConvexPolygon, Segment, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, from_outline, gap_along, hull, outlines_meet, pair, placed};

proptest! {
    #[test]
    fn it_is_zero_exactly_when_the_shapes_overlap(pair in pair()) {
        let way = distance(&hull(&pair.a), &hull(&pair.b), pair.pose);
        let meet = outlines_meet(pair.a.vertices(), &placed(pair.b.vertices(), pair.pose));
        // Within a few roundings of touching the two may differ.
        let depth = carom_collision::separating_axis(&hull(&pair.a), &hull(&pair.b), pair.pose).separation;
        if depth.abs() > 1e-15 * pair.size {
            prop_assert_eq!(way.distance == 0.0, meet, "separation {:e}", depth);
        }
        prop_assert_eq!(way.distance == 0.0, depth <= 0.0);
    }

    #[test]
    fn witnesses_are_on_the_shapes_and_as_far_apart_as_it_says(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let way = distance(&a, &b, pair.pose);
        let tiny = 1e-13 * pair.size;
        prop_assert!(((way.point_b - way.point_a).length() - way.distance).abs() <= tiny);
        let outside = |h: &carom_collision::Hull<'_>, p: Vec2| {
            h.normals.iter().zip(h.vertices).map(|(n, v)| n.dot(p - *v)).fold(f64::MIN, f64::max)
        };
        prop_assert!(outside(&a, way.point_a) <= tiny);
        prop_assert!(outside(&b, pair.pose.inverse_point(way.point_b)) <= tiny);
        if way.distance > 0.0 {
            // The normal of the shortest way separates by all of it: nothing can be shorter.
            // (The closer they are, the less two rounded points tell about the direction.)
            let turn = 1e-15 * pair.size * pair.size / way.distance;
            prop_assert!((gap_along(&a, &b, pair.pose, way.normal) - way.distance).abs() <= tiny + turn);
            prop_assert!((way.normal * way.distance - (way.point_b - way.point_a)).length() <= tiny);
        }
        let swapped = distance(&b, &a, pair.pose.inverse());
        prop_assert!((swapped.distance - way.distance).abs() <= tiny);
    }

    #[test]
    fn discs_and_segments_have_witnesses_too(a in convex(), x in -3.0..3.0_f64, y in -3.0..3.0_f64, r in 0.01..1.0_f64, turn in -4.0..4.0_f64) {
        let disc = Circle::at(vec2(0.25, -0.5), r).expect("above zero");
        let wall = Segment::new(vec2(-0.5, 0.25), vec2(0.75, 0.5)).expect("a length");
        let hulls = [hull(&a), disc.hull(), wall.hull()];
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        for first in &hulls {
            for second in &hulls {
                let way = distance(first, second, pose);
                prop_assert!(((way.point_b - way.point_a).length() - way.distance).abs() <= 1e-14);
                let zero = |p: Vec2| Pose::at(p);
                let dot = Circle::new(1e-9).expect("above zero");
                let off_a = distance(first, &dot.hull(), zero(way.point_a)).distance;
                let off_b = distance(second, &dot.hull(), zero(pose.inverse_point(way.point_b))).distance;
                prop_assert!(off_a <= 1e-14 && off_b <= 1e-14, "{off_a:e} {off_b:e} {way:?}");
            }
        }
    }

    #[test]
    fn concave_shapes_are_as_far_apart_as_their_outlines(a in concave(), b in concave(), x in -4.0..4.0_f64, y in -4.0..4.0_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let ring_b = placed(b.vertices(), pose);
        let way = shape_distance(&a.clone().into(), &b.clone().into(), pose);
        let meet = outlines_meet(a.vertices(), &ring_b);
        prop_assert_eq!(way.distance == 0.0, meet);
        if !meet {
            let to_b = a.vertices().iter().map(|v| from_outline(&ring_b, *v));
            let to_a = ring_b.iter().map(|v| from_outline(a.vertices(), *v));
            let want = to_a.chain(to_b).fold(f64::INFINITY, f64::min);
            prop_assert!((way.distance - want).abs() < 1e-14, "{} against {want}", way.distance);
        }
    }
}

#[test]
fn a_cast_ball_is_as_far_as_it_is_however_large_the_wall() {
    // dimforge/parry#429: 139 mm short on a box of 500 m.
    for half in [5.0, 50.0, 500.0] {
        let wall: Shape = ConvexPolygon::square(2.0 * half)
            .expect("above zero")
            .into();
        let ball: Shape = Circle::new(0.5).expect("above zero").into();
        let way = shape_distance(&wall, &ball, Pose::at(vec2(half + 1.25, 0.3)));
        assert_eq!(way.distance, 0.75);
    }
}

/// The walk to the lowest of more than twelve corners did not end.
#[test]
fn a_pose_without_numbers_has_an_answer() {
    let wheel: Shape = ConvexPolygon::regular(17, 1.0).unwrap().into();
    let triangle: Shape = ConvexPolygon::regular(3, 1.0).unwrap().into();
    for pose in [
        Pose::at(vec2(f64::NAN, 0.0)),
        Pose::new(vec2(0.5, 0.0), Rot::from_angle(f64::NAN)),
        Pose::new(vec2(0.5, 0.0), Rot::from_cos_sin(1.0, f64::INFINITY)),
    ] {
        for (a, b) in [(&wheel, &triangle), (&triangle, &wheel), (&wheel, &wheel)] {
            let _means_nothing = shape_distance(a, b, pose);
        }
    }
}
