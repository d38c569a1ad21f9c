//! Two resting shapes against brute force: distance, depth along sampled axes, the shared area.

use carom_collision::{contacts, overlap_area, part, separating_axis, shape_distance};
use carom_geometry::Shape;
use carom_math::{Pose, Rot, vec2};
use proptest::prelude::*;

use super::{naive, ring, shape, solid};

fn pose() -> impl Strategy<Value = Pose> {
    (-2.5..2.5_f64, -2.5..2.5_f64, -4.0..4.0_f64)
        .prop_map(|(x, y, turn)| Pose::new(vec2(x, y), Rot::from_angle(turn)))
}

proptest! {
    #[test]
    fn the_distance_is_that_of_the_nearest_edges(a in shape(), b in shape(), pose in pose()) {
        let way = shape_distance(&a, &b, pose);
        let apart = naive::distance(&solid(&a, Pose::IDENTITY), &solid(&b, pose));
        prop_assert!((way.distance - apart).abs() < 1e-14);
        prop_assert!(((way.point_b - way.point_a).length() - apart).abs() < 1e-14);
        // What shares area overlaps, and is in contact.
        let area = overlap_area(&a, &b, pose);
        let mut found = Vec::new();
        contacts(&a, &b, pose, 0.0, &mut found);
        prop_assert!(area < 1e-15 || apart <= 0.0);
        prop_assert!(area < 1e-15 || !found.is_empty());
        prop_assert!(apart <= 1e-15 || found.is_empty());
    }

    #[test]
    fn no_sampled_axis_overlaps_less(a in shape(), b in shape(), pose in pose()) {
        if let (Shape::Convex(_), Shape::Convex(_)) = (&a, &b) {
            let axis = separating_axis(&part(&a, 0), &part(&b, 0), pose);
            let (p, q) = (ring(&a, Pose::IDENTITY), ring(&b, pose));
            let (own, back) = (ring(&b, Pose::IDENTITY), ring(&a, pose.inverse()));
            let least = naive::least_overlap((&p, &q), (&own, &back));
            prop_assert!((least + axis.separation).abs() < 1e-14);
            for k in 0..720 {
                let direction = Rot::from_degrees(0.5 * f64::from(k)).x_axis();
                let overlap = naive::overlap_along(&p, &q, direction);
                // Apart, a sampled axis between two corners may separate a little more.
                prop_assert!(axis.separation > 0.0 || overlap >= -axis.separation - 1e-14);
            }
        }
    }
}
