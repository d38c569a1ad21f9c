//! Overlaps of whole shapes: the shortest way out, and contacts however deep.

use carom_collision::{PartManifold, contacts, hulls, separating_axis, shape_push};
use carom_geometry::{Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, from_outline};

/// Deepest overlap of two parts, in metres.
fn overlap(a: &Shape, b: &Shape, pose: Pose) -> f64 {
    let mut depth = f64::NEG_INFINITY;
    for x in hulls(a) {
        for y in hulls(b) {
            depth = depth.max(-separating_axis(&x, &y, pose).separation);
        }
    }
    depth
}

fn moved(pose: Pose, by: Vec2) -> Pose {
    Pose::new(pose.position + by, pose.rotation)
}

fn all(a: &Shape, b: &Shape, pose: Pose) -> Vec<PartManifold> {
    let mut found = Vec::new();
    contacts(a, b, pose, 0.0, &mut found);
    found
}

fn body() -> impl Strategy<Value = Shape> {
    prop_oneof![
        convex().prop_map(Shape::from),
        concave().prop_map(Shape::from),
    ]
}

proptest! {
    #[test]
    fn the_push_ends_the_overlap_and_nothing_shorter_does(a in concave(), b in body(), x in -1.0..1.0_f64, y in -1.0..1.0_f64, turn in -4.0..4.0_f64) {
        let a: Shape = a.into();
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let Some(push) = shape_push(&a, &b, pose) else {
            prop_assert!(overlap(&a, &b, pose) < 1e-11);
            return Ok(());
        };
        prop_assert!(overlap(&a, &b, moved(pose, push)) < 1e-11);
        for i in 0..96 {
            let way = Rot::from_angle(0.065_449_846_949_787_36 * f64::from(i)).x_axis();
            for share in [0.3, 0.6, 0.9, 0.999] {
                let shorter = moved(pose, way * (push.length() * share));
                prop_assert!(overlap(&a, &b, shorter) > -1e-12, "{push} is not the shortest: {way} {share}");
            }
        }
        let back = shape_push(&b, &a, pose.inverse()).expect("they overlap");
        prop_assert!((pose.vector(back).length() - push.length()).abs() < 1e-9);
    }

    #[test]
    fn the_push_is_the_same_far_from_the_frames(a in concave(), b in body(), x in -1.0..1.0_f64, y in -1.0..1.0_f64, turn in -4.0..4.0_f64) {
        let a: Shape = a.into();
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let far = vec2(1e5, -7e4);
        let near = shape_push(&a, &b, pose).map_or(0.0, |push| push.length());
        let push = shape_push(&a.translated(far), &b, moved(pose, far)).map_or(0.0, |push| push.length());
        prop_assert!((push - near).abs() < 1e-6, "{push} m, {near} m beside the frames");
    }

    #[test]
    fn concave_shapes_are_pushed_out_of_half_planes_along_the_normal(a in concave(), turn in -4.0..4.0_f64, height in -1.0..1.0_f64) {
        let a: Shape = a.into();
        let normal = Rot::from_angle(turn).x_axis();
        let pose = Pose::new(normal * height, Rot::from_angle(2.0 * turn));
        let ground = Shape::from(HalfPlane::new(Vec2::ZERO, normal).expect("a normal"));
        let heights = a.vertices().iter().map(|v| normal.dot(pose.point(*v)));
        let depth = -heights.fold(f64::INFINITY, f64::min);
        let push = shape_push(&ground, &a, pose).unwrap_or(Vec2::ZERO);
        prop_assert!((push - normal * depth.max(0.0)).length() < 1e-11, "{push}, {depth} m deep");
        let back = shape_push(&a, &ground, pose.inverse()).unwrap_or(Vec2::ZERO);
        prop_assert!((pose.vector(back) + push).length() < 1e-11);
    }

    #[test]
    fn whatever_overlaps_has_a_contact(a in concave(), b in concave(), x in -1.5..1.5_f64, y in -1.5..1.5_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let (a, b): (Shape, Shape) = (a.into(), b.into());
        let found = all(&a, &b, pose);
        let deepest = found.iter().filter_map(|c| c.manifold.deepest()).fold(f64::INFINITY, f64::min);
        prop_assert!(deepest <= 0.0 || overlap(&a, &b, pose) < 1e-9);
    }
}

#[test]
fn two_lists_of_conditions_that_meet_in_one_point_are_both_tried() {
    let star = Polygon::new([
        vec2(1.0617386462471468, 0.0),
        vec2(0.2598076211353316, 0.14999999999999997),
        vec2(0.6910006647343596, 1.1968482593837784),
        vec2(8.639900970209296e-17, 1.411002907323929),
        vec2(-0.36020112415008604, 0.6238866479713743),
        vec2(-1.0473059835334686, 0.6046623915169537),
        vec2(-1.0805458599882412, 1.3232870287665237e-16),
        vec2(-0.5253678307550403, -0.30332125850999236),
        vec2(-0.5861857281500457, -1.0153034638276357),
        vec2(-5.510910596163089e-17, -0.3),
        vec2(0.6428336718219758, -1.1134205804117197),
        vec2(0.37321355250597643, -0.21547494500454228),
    ]);
    let other = ConvexPolygon::new([
        vec2(-0.9288816867732413, -0.3594280747975512),
        vec2(0.5815552272688633, -0.3583851041445313),
        vec2(0.4196664832685932, 0.013033796905621176),
        vec2(-0.2984654747584914, 0.9134963264953551),
    ]);
    let (a, b): (Shape, Shape) = (star.expect("a star").into(), other.expect("a kite").into());
    let place = vec2(-0.050102599514584886, -0.08686066007025023);
    let pose = Pose::new(place, Rot::from_angle(-2.6639028725827454));
    let one = shape_push(&a, &b, pose).expect("they overlap");
    let other = shape_push(&b, &a, pose.inverse()).expect("they overlap");
    assert!(
        (one.length() - other.length()).abs() < 1e-12,
        "{one} m and {other} m"
    );
}

#[test]
fn a_small_box_across_a_cut_leaves_through_the_outline() {
    let l = Polygon::new([
        vec2(0.0, 0.0),
        vec2(4.0, 0.0),
        vec2(4.0, 1.0),
        vec2(1.0, 1.0),
        vec2(1.0, 4.0),
        vec2(0.0, 4.0),
    ])
    .expect("an L");
    let small: Shape = ConvexPolygon::square(0.125).expect("a box").into();
    // Along both diagonals of the corner, so that the cut is crossed wherever it is.
    for k in 1..16 {
        let s = f64::from(k) / 16.0;
        for place in [vec2(s, s), vec2(s, 1.0 - s), vec2(0.5, s), vec2(s, 0.5)] {
            let pose = Pose::at(place);
            let found = all(&l.clone().into(), &small, pose);
            assert!(!found.is_empty(), "nothing at {place}");
            for contact in &found {
                let n = contact.manifold.normal;
                assert!(
                    n == Vec2::X || n == Vec2::Y || n == -Vec2::X || n == -Vec2::Y,
                    "{n} at {place}"
                );
            }
            let push = shape_push(&l.clone().into(), &small, pose).expect("it is inside");
            let nearest = from_outline(l.vertices(), place) + 0.0625;
            assert!(
                push.length() <= nearest * core::f64::consts::SQRT_2 + 1e-12,
                "{push} at {place}"
            );
        }
    }
}

#[test]
fn in_the_corner_between_two_arms_both_push() {
    let l: Shape = Polygon::new([
        vec2(0.0, 0.0),
        vec2(4.0, 0.0),
        vec2(4.0, 1.0),
        vec2(1.0, 1.0),
        vec2(1.0, 4.0),
        vec2(0.0, 4.0),
    ])
    .expect("an L")
    .into();
    let small: Shape = ConvexPolygon::square(0.5).expect("a box").into();
    let pose = Pose::at(vec2(1.0, 1.0));
    assert_eq!(shape_push(&l, &small, pose), Some(vec2(0.25, 0.25)));
    let found = all(&l, &small, pose);
    let mut normals: Vec<_> = found
        .iter()
        .map(|c| (c.manifold.normal.x, c.manifold.normal.y))
        .collect();
    normals.sort_by(|p, q| p.0.total_cmp(&q.0));
    normals.dedup();
    assert_eq!(normals, [(0.0, 1.0), (1.0, 0.0)]);
}

#[test]
fn tiles_in_one_body_are_left_as_a_whole() {
    let tile: Shape = ConvexPolygon::square(1.0).expect("a box").into();
    let row = (0..8).map(|i| (tile.clone(), Pose::at(vec2(f64::from(i), 0.0))));
    let row: Shape = Compound::new(row).expect("parts").into();
    let ball: Shape = Circle::new(0.25).expect("a disc").into();
    // On the seam, nearer to the top than to the bottom, far from both ends.
    let pose = Pose::at(vec2(3.5, 0.125));
    assert_eq!(shape_push(&row, &ball, pose), Some(vec2(0.0, 0.625)));
    let found = all(&row, &ball, pose);
    assert!(!found.is_empty());
    for contact in found {
        assert_eq!(contact.manifold.normal, Vec2::Y);
        assert_eq!(contact.manifold.deepest(), Some(-0.625));
    }
}

#[test]
fn a_disc_beside_a_corner_needs_no_push() {
    // In the corner of the square's sides moved out by the radius, but not within the radius.
    let l: Shape = Polygon::new([
        vec2(0.0, 0.0),
        vec2(4.0, 0.0),
        vec2(4.0, 1.0),
        vec2(1.0, 1.0),
        vec2(1.0, 4.0),
        vec2(0.0, 4.0),
    ])
    .expect("an L")
    .into();
    let ball: Shape = Circle::new(1.0).expect("a disc").into();
    assert_eq!(shape_push(&l, &ball, Pose::at(vec2(-0.75, -0.75))), None);
    assert!(all(&l, &ball, Pose::at(vec2(-0.75, -0.75))).is_empty());
    let push = shape_push(&l, &ball, Pose::at(vec2(-0.5, -0.5))).expect("they overlap");
    let way = carom_collision::shape_distance(&l, &ball, Pose::at(vec2(-0.5, -0.5) + push));
    assert!(way.distance < 0.25 && push.length() <= 0.5 + 1e-12);
}

/// How far a disc about a point is from a polygon's outline, in metres; below 0 it overlaps the inside.
fn gap_of_disc(outline: &[Vec2], centre: Vec2, radius: f64) -> f64 {
    let mut inside = false;
    for (i, p) in outline.iter().enumerate() {
        let q = outline[(i + 1) % outline.len()];
        if (p.y > centre.y) != (q.y > centre.y) {
            let x = p.x + (q.x - p.x) * (centre.y - p.y) / (q.y - p.y);
            inside ^= x > centre.x;
        }
    }
    let distance = from_outline(outline, centre);
    if inside {
        -distance - radius
    } else {
        distance - radius
    }
}

/// Whether the push ends the overlap that `gap` tells of, nothing shorter does in 360 directions, and the
/// other shape has the same way to go.
fn is_shortest(a: &Shape, b: &Shape, pose: Pose, gap: impl Fn(Vec2) -> f64) {
    /// Rounding of places of some metres, metres.
    const ROUNDING: f64 = 1e-11;
    let Some(push) = shape_push(a, b, pose) else {
        assert!(gap(Vec2::ZERO) > -ROUNDING, "no push of an overlap");
        return;
    };
    assert!(gap(push) > -ROUNDING, "{push} leaves {} m", gap(push));
    for i in 0..360 {
        let way = Rot::from_degrees(f64::from(i)).x_axis();
        for share in [0.03, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99] {
            let shorter = way * (push.length() * share);
            assert!(gap(shorter) < ROUNDING, "{push} is longer than {shorter}");
        }
    }
    let back = shape_push(b, a, pose.inverse()).expect("they overlap");
    let length = (back.length() - push.length()).abs();
    assert!(length < 1e-9, "{push} m, swapped {back} m");
}

proptest! {
    #[test]
    fn a_disc_leaves_a_polygon_by_the_shortest_way(shape in body(), radius in 0.05..1.5_f64, x in -2.0..2.0_f64, y in -2.0..2.0_f64, turn in -4.0..4.0_f64) {
        let outline = match &shape {
            Shape::Convex(polygon) => polygon.vertices().to_vec(),
            Shape::Polygon(polygon) => polygon.vertices().to_vec(),
            _ => unreachable!("a polygon"),
        };
        let disc: Shape = Circle::new(radius).expect("a disc").into();
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        is_shortest(&shape, &disc, pose, |t| gap_of_disc(&outline, pose.position + t, radius));
    }

    #[test]
    fn a_disc_leaves_a_handful_of_discs_by_the_shortest_way(
        discs in proptest::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, 0.2..1.0_f64), 2..5), radius in 0.05..1.0_f64, x in -1.0..1.0_f64, y in -1.0..1.0_f64,
    ) {
        let parts = discs.iter().map(|(x, y, r)| (Circle::new(*r).expect("a disc").into(), Pose::at(vec2(*x, *y))));
        let Ok(handful) = Compound::new(parts) else { return Ok(()) };
        let disc: Shape = Circle::new(radius).expect("a disc").into();
        let pose = Pose::at(vec2(x, y));
        is_shortest(&handful.into(), &disc, pose, |t| {
            let gaps = discs.iter().map(|(x, y, r)| (pose.position + t - vec2(*x, *y)).length() - r - radius);
            gaps.fold(f64::INFINITY, f64::min)
        });
    }
}

#[test]
fn a_disc_over_the_corner_of_a_square_leaves_past_the_corner() {
    let square: Shape = ConvexPolygon::square(2.0).expect("a square").into();
    let disc: Shape = Circle::new(1.0).expect("a disc").into();
    for turn in [0.0, 0.5, 1.0] {
        let pose = Pose::new(vec2(1.7, 1.7), Rot::from_angle(turn));
        let expected = 1.0 - vec2(0.7, 0.7).length();
        let pushes = [
            shape_push(&square, &disc, pose),
            shape_push(&disc, &square, pose.inverse()),
        ];
        for push in pushes {
            let length = push.expect("they overlap").length();
            assert!((length - expected).abs() < 1e-14, "{length} m");
        }
    }
}
