//! The separating axis against sampled directions.

use carom_collision::{AxisFeature, Convex, minimum_push, separating_axis};
use carom_geometry::{Circle, ConvexPolygon, Segment};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{convex, gap_along, hull, pair};

proptest! {
    #[test]
    fn depth_is_the_least_over_sampled_axes(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let axis = separating_axis(&a, &b, pair.pose);
        prop_assert!((axis.normal.length() - 1.0).abs() < 1e-15);
        prop_assert!((gap_along(&a, &b, pair.pose, axis.normal) - axis.separation).abs() < 1e-14 * pair.size);
        const SAMPLES: u32 = 360;
        let mut most = f64::NEG_INFINITY;
        for i in 0..SAMPLES {
            let turn = f64::from(i) / f64::from(SAMPLES) * core::f64::consts::TAU;
            most = most.max(gap_along(&a, &b, pair.pose, Rot::from_angle(turn).x_axis()));
        }
        if axis.separation <= 0.0 {
            prop_assert!(most <= axis.separation + 1e-14 * pair.size, "{most:e} beats {:e}", axis.separation);
        }
        // A gap changes by no more than the turn times the reach: 1 + 1 + 2.5 sizes.
        prop_assert!(most >= axis.separation - 4.5 * pair.size * core::f64::consts::PI / f64::from(SAMPLES));
    }

    #[test]
    fn swapping_flips_the_normal_and_keeps_the_separation(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let axis = separating_axis(&a, &b, pair.pose);
        let swapped = separating_axis(&b, &a, pair.pose.inverse());
        prop_assert!((axis.separation - swapped.separation).abs() <= 1e-14 * pair.size);
        let back = -pair.pose.vector(swapped.normal);
        // Another normal only if it is as good: two ways out of the same length.
        if (back - axis.normal).length() > 1e-14 {
            prop_assert!((gap_along(&a, &b, pair.pose, back) - axis.separation).abs() <= 1e-14 * pair.size);
        }
    }

    #[test]
    fn swapping_unturned_shapes_is_exact_bit_for_bit(a in convex(), b in convex(), x in -2.0..2.0_f64, y in -2.0..2.0_f64) {
        let pose = Pose::at(vec2(x, y));
        let axis = separating_axis(&hull(&a), &hull(&b), pose);
        let swapped = separating_axis(&hull(&b), &hull(&a), pose.inverse());
        prop_assert_eq!(axis.separation.to_bits(), swapped.separation.to_bits());
        prop_assert_eq!(axis.normal, -swapped.normal);
    }

    #[test]
    fn the_minimum_push_ends_the_overlap_and_nothing_shorter_does(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let apart = separating_axis(&a, &b, pair.pose).separation > 0.0;
        let push = minimum_push(&a, &b, pair.pose);
        prop_assert_eq!(push.is_none(), apart);
        if let Some(push) = push {
            let after = |share: f64| {
                let pose = Pose::new(pair.pose.position + push * share, pair.pose.rotation);
                separating_axis(&a, &b, pose).separation
            };
            prop_assert!(after(1.0).abs() < 1e-14 * pair.size);
            prop_assert!(after(0.5) <= 0.0 || push.length() < 1e-14 * pair.size);
        }
    }

    #[test]
    fn a_disc_sees_the_true_distance(a in convex(), x in -3.0..3.0_f64, y in -3.0..3.0_f64, r in 0.01..1.0_f64) {
        let disc = Circle::new(r).expect("above zero");
        let (hull_a, hull_b) = (hull(&a), disc.hull());
        let pose = Pose::at(vec2(x, y));
        let axis = separating_axis(&hull_a, &hull_b, pose);
        let shape: carom_geometry::Shape = a.clone().into();
        let want = shape.signed_distance(vec2(x, y)) - r;
        prop_assert!((axis.separation - want).abs() < 1e-14, "{} against {want}", axis.separation);
        let swapped = separating_axis(&hull_b, &hull_a, pose.inverse());
        prop_assert_eq!(swapped.separation.to_bits(), axis.separation.to_bits());
        prop_assert_eq!(swapped.normal, -axis.normal);
    }
}

#[test]
fn segments_on_one_line_are_apart_along_it() {
    let one = Segment::new(vec2(0.0, 0.0), vec2(1.0, 0.0)).expect("a length");
    for turn in [0.0, 90.0, 180.0] {
        let pose = Pose::new(vec2(4.0, 0.0), Rot::from_degrees(turn));
        let axis = separating_axis(&one.hull(), &one.hull(), pose);
        let want = if turn == 180.0 { 2.0 } else { 3.0 };
        assert_eq!(axis.separation, want, "turned by {turn}");
        assert_eq!(axis.normal, Vec2::X);
    }
    // Crossing ones overlap by the shorter way out.
    let cross = Pose::new(vec2(0.75, -0.5), Rot::from_degrees(90.0));
    let axis = separating_axis(&one.hull(), &one.hull(), cross);
    assert_eq!((axis.separation, axis.normal), (-0.25, Vec2::X));
}

#[test]
fn a_disc_on_the_line_of_a_segment_meets_its_end() {
    let floor = Segment::new(vec2(-1.0, 0.0), vec2(1.0, 0.0)).expect("a length");
    let disc = Circle::new(0.5).expect("above zero");
    let at = |x, y| separating_axis(&floor.hull(), &disc.hull(), Pose::at(vec2(x, y)));
    assert_eq!(
        (at(3.0, 0.0).separation, at(3.0, 0.0).normal),
        (1.5, Vec2::X)
    );
    assert_eq!(
        (at(0.5, 0.25).separation, at(0.5, 0.25).normal),
        (-0.25, Vec2::Y)
    );
    assert_eq!(
        (at(0.5, -0.25).separation, at(0.5, -0.25).normal),
        (-0.25, -Vec2::Y)
    );
    // On the line itself either side is right, as long as it is one.
    assert_eq!(
        (at(0.5, 0.0).separation, at(0.5, 0.0).normal.x),
        (-0.5, 0.0)
    );
}

#[test]
fn many_vertices_walk_to_the_same_support_as_a_look_at_all() {
    let round = ConvexPolygon::regular(500, 1.0).expect("a polygon");
    let square = ConvexPolygon::square(1.0).expect("a polygon");
    for i in 0..200 {
        let pose = Pose::new(vec2(1.2, 0.3), Rot::from_angle(0.1 * f64::from(i)));
        let axis = separating_axis(&round.hull(), &square.hull(), pose);
        assert!(matches!(axis.feature, AxisFeature::Edge { .. }));
        let slow = gap_along(&round.hull(), &square.hull(), pose, axis.normal);
        assert!((slow - axis.separation).abs() < 1e-15);
        let swapped = separating_axis(&square.hull(), &round.hull(), pose.inverse());
        assert!(
            (swapped.separation - axis.separation).abs() < 1e-15,
            "turn {i}"
        );
    }
}
