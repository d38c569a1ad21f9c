//! Polygons with a box tree over their pieces give the bits of a look at every pair of pieces.

use carom_collision::{
    Distance, Motion, PartManifold, TimeOfImpact, cast, collide_within, contacts, distance,
    earlier, hulls, shape_distance, time_of_impact, time_of_impact_of_parts,
};
use carom_geometry::{ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, turn};

/// Rays of random lengths around a centre: star-shaped, with dozens of pieces.
fn spiky() -> impl Strategy<Value = Shape> {
    prop::collection::vec((0.3..0.7_f64, 0.8..1.5_f64), 20..60).prop_map(|spikes| {
        let step = core::f64::consts::PI / spikes.len() as f64;
        let ray = |i: usize, r: f64| Rot::from_angle(step * i as f64).x_axis() * r;
        let ends = spikes.iter().enumerate();
        let points: Vec<_> = ends
            .flat_map(|(i, (low, high))| [ray(2 * i, *high), ray(2 * i + 1, *low)])
            .collect();
        let polygon = Polygon::new(points).expect("star-shaped");
        assert!(polygon.part_tree().is_some());
        polygon.into()
    })
}

fn any_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        2 => spiky(),
        1 => concave().prop_map(Shape::from),
        1 => convex().prop_map(Shape::from),
        1 => (0.05..1.0_f64).prop_map(|r| carom_geometry::Circle::new(r).expect("a disc").into()),
    ]
}

fn contacts_of_all_parts(a: &Shape, b: &Shape, pose: Pose, margin: f64) -> Vec<PartManifold> {
    let mut found = Vec::new();
    for (part_a, one) in (0..).zip(hulls(a)) {
        for (part_b, other) in (0..).zip(hulls(b)) {
            let manifold = collide_within(&one, &other, pose, margin);
            if !manifold.points.is_empty() {
                found.push(PartManifold {
                    part_a,
                    part_b,
                    manifold,
                });
            }
        }
    }
    found
}

fn overlaps(contact: &PartManifold) -> bool {
    let points = &contact.manifold.points;
    points.iter().any(|point| point.separation <= 0.0)
}

fn distance_of_all_parts(a: &Shape, b: &Shape, pose: Pose) -> Distance {
    let ways = hulls(a).flat_map(|x| hulls(b).map(move |y| distance(&x, &y, pose)));
    ways.reduce(|best, way| {
        if way.distance < best.distance {
            way
        } else {
            best
        }
    })
    .expect("every shape has a part")
}

fn motion() -> impl Strategy<Value = Motion> {
    (
        (-3.0..3.0_f64, -3.0..3.0_f64),
        (-3.0..3.0_f64, -3.0..3.0_f64),
        -4.0..4.0_f64,
        turn(),
    )
        .prop_map(|(place, velocity, spin, rotation)| Motion {
            velocity: velocity.into(),
            acceleration: vec2(0.0, -place.0),
            spin,
            rotation,
            ..Motion::resting(place.into())
        })
}

proptest! {
    #[test]
    fn contacts_are_those_of_all_pairs(a in spiky(), b in any_shape(), x in -2.5..2.5_f64, y in -2.5..2.5_f64, rotation in turn(), margin in 0.0..0.1_f64) {
        let pose = Pose::new(vec2(x, y), rotation);
        for (a, b, pose) in [(&a, &b, pose), (&b, &a, pose.inverse())] {
            let mut found: Vec<PartManifold> = Vec::new();
            contacts(a, b, pose, margin, &mut found);
            let all = contacts_of_all_parts(a, b, pose, margin);
            // So deep that only the whole has a way out: one of two pieces that are near each other, perhaps.
            let is_hidden = !all.iter().any(overlaps);
            for contact in &found {
                let place = (contact.part_a, contact.part_b);
                let alone = all.iter().find(|alone| (alone.part_a, alone.part_b) == place);
                if let Some(alone) = alone && !(is_hidden && overlaps(contact)) {
                    prop_assert_eq!(alone, contact);
                }
            }
            // Left out are contacts that a neighbour has, too: one corner of two pieces.
            prop_assert!(all.is_empty() || !found.is_empty());
            prop_assert!(found.is_sorted_by_key(|c| (c.part_a, c.part_b)));
        }
    }

    #[test]
    fn the_distance_is_that_of_all_pairs(a in spiky(), b in any_shape(), x in -4.0..4.0_f64, y in -4.0..4.0_f64, rotation in turn()) {
        let pose = Pose::new(vec2(x, y), rotation);
        prop_assert_eq!(shape_distance(&a, &b, pose), distance_of_all_parts(&a, &b, pose));
        let pose = pose.inverse();
        prop_assert_eq!(shape_distance(&b, &a, pose), distance_of_all_parts(&b, &a, pose));
    }

    #[test]
    fn a_cast_meets_the_first_of_all_pieces(a in spiky(), b in any_shape(), x in -4.0..4.0_f64, y in -4.0..4.0_f64, rotation in turn(), towards in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), rotation);
        let way = Rot::from_angle(towards).x_axis() * 8.0;
        let whole = cast(&a, pose, way, &b, Pose::IDENTITY).map(|hit| hit.fraction);
        let pieces = |shape: &Shape| -> Vec<Shape> {
            match shape {
                Shape::Polygon(polygon) => polygon.pieces().iter()
                    .map(|piece| ConvexPolygon::new(piece.vertices().to_vec()).expect("convex").into())
                    .collect(),
                other => vec![other.clone()],
            }
        };
        let mut first: Option<f64> = None;
        for x in pieces(&a) {
            for y in pieces(&b) {
                if let Some(hit) = cast(&x, pose, way, &y, Pose::IDENTITY) {
                    first = Some(first.map_or(hit.fraction, |f| f.min(hit.fraction)));
                }
            }
        }
        // Through a cut a piece may meet what its neighbour met before, never earlier.
        prop_assert_eq!(whole, first);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_time_of_impact_is_that_of_all_pairs(a in spiky(), b in any_shape(), motion_a in motion(), motion_b in motion()) {
        let horizon = 1.0;
        let whole = time_of_impact(&a, &motion_a, &b, &motion_b, horizon);
        let mut all = TimeOfImpact::Clear;
        for (i, x) in (0..).zip(hulls(&a)) {
            for (j, y) in (0..).zip(hulls(&b)) {
                let mut next = time_of_impact_of_parts(&x, &motion_a, &y, &motion_b, horizon);
                if let TimeOfImpact::Hit(impact) | TimeOfImpact::Touching(impact) = &mut next {
                    impact.features.iter_mut().for_each(|touch| touch.parts = (i, j));
                }
                all = earlier(all, next);
            }
        }
        match (&whole, &all) {
            (TimeOfImpact::Hit(x), TimeOfImpact::Hit(y)) => prop_assert_eq!((x.time, x.normal), (y.time, y.normal)),
            _ => prop_assert_eq!(&whole, &all),
        }
    }
}
