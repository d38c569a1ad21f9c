//! Concave shapes: contact on the true outline only, and no seam is felt.

use carom_collision::{
    Motion, PartManifold, TimeOfImpact, contacts, shape_distance, shape_push,
    time_of_impact_beside, time_of_impact_from,
};
use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Rot, SimTime, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, from_outline, placed};

fn all(a: &Shape, b: &Shape, pose: Pose, margin: f64) -> Vec<PartManifold> {
    let mut found = Vec::new();
    contacts(a, b, pose, margin, &mut found);
    found
}

fn polygon(points: &[(f64, f64)]) -> Shape {
    let points: Vec<Vec2> = points.iter().map(|p| vec2(p.0, p.1)).collect();
    Polygon::new(points).expect("simple").into()
}

proptest! {
    #[test]
    fn every_contact_is_on_both_outlines(a in concave(), b in concave(), x in -2.5..2.5_f64, y in -2.5..2.5_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let (ring_a, ring_b) = (a.vertices(), placed(b.vertices(), pose));
        for contact in all(&a.clone().into(), &b.clone().into(), pose, 0.05) {
            let n = contact.manifold.normal;
            prop_assert!((n.length() - 1.0).abs() < 1e-14);
            for p in &contact.manifold.points {
                // Now; or, in deep, after the way out.
                let half = n * (0.5 * p.separation);
                let now = (from_outline(ring_a, p.point - half), from_outline(&ring_b, p.point + half));
                let way = shape_push(&a.clone().into(), &b.clone().into(), pose).unwrap_or_default();
                let (half, middle) = (n * (0.5 * (p.separation + n.dot(way))), p.point + 0.5 * way);
                let then = (from_outline(ring_a, middle - half), from_outline(&ring_b, middle + half - way));
                let on = |off: (f64, f64)| off.0 < 1e-9 && off.1 < 1e-9;
                prop_assert!(on(now) || on(then), "{now:?} {then:?} {contact:?}");
            }
        }
    }

    #[test]
    fn a_shallow_overlap_is_always_felt(a in concave(), b in prop_oneof![convex().prop_map(Shape::from), concave().prop_map(Shape::from)], towards in -4.0..4.0_f64, turn in -4.0..4.0_f64) {
        // Brought to touching, then pressed by a millimetre.
        let a: Shape = a.into();
        let way = Rot::from_angle(towards).x_axis();
        let mut pose = Pose::new(way * 5.0, Rot::from_angle(turn));
        let hit = carom_collision::cast(&b, pose, -way * 6.0, &a, Pose::IDENTITY);
        if let Some(hit) = hit {
            pose.position -= way * (6.0 * hit.fraction);
            let outward = -hit.normal;
            pose.position -= outward * 1e-3;
            let found = all(&a, &b, pose, 0.0);
            // At a thin tip the least overlap may be sideways; it is never more than the press.
            let felt = found.iter().any(|c| c.manifold.deepest().is_some_and(|d| d >= -1e-3 - 1e-12));
            prop_assert!(felt || shape_distance(&a, &b, pose).distance > 0.0, "normal {outward:?}: {found:?}");
        }
    }

    #[test]
    fn swapping_concave_shapes_flips_every_contact(a in concave(), b in concave(), x in -2.5..2.5_f64, y in -2.5..2.5_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let (a, b): (Shape, Shape) = (a.into(), b.into());
        let one = all(&a, &b, pose, 0.01);
        let two = all(&b, &a, pose.inverse(), 0.01);
        prop_assert_eq!(one.len(), two.len());
        for contact in &one {
            let twin = two.iter().find(|t| (t.part_b, t.part_a) == (contact.part_a, contact.part_b));
            prop_assert!(twin.is_some_and(|t| (pose.vector(t.manifold.normal) + contact.manifold.normal).length() < 1e-9), "{one:#?} {two:#?} {pose:?}");
        }
    }

    #[test]
    fn many_parts_meet_like_few(spikes in prop::collection::vec((0.3..0.6_f64, 1.0..1.5_f64), 40..50), x in -2.5..2.5_f64, turn in -4.0..4.0_f64) {
        // Sorted boxes against all pairs of parts, one by one; every spike is a part.
        let radii: Vec<f64> = spikes.iter().flat_map(|s| [s.0, s.1]).collect();
        let n = f64::from(u32::try_from(radii.len()).expect("a few"));
        let points: Vec<Vec2> = (0u32..).zip(&radii).map(|(i, r)| Rot::from_angle(f64::from(i) / n * core::f64::consts::TAU).x_axis() * *r).collect();
        let star: Shape = Polygon::new(points).expect("a star").into();
        let pose = Pose::new(vec2(x, 0.1), Rot::from_angle(turn));
        let fast = all(&star, &star, pose, 0.01);
        let count = carom_collision::part_count(&star);
        prop_assert!(count * count > 1024, "too few parts to sort: {count}");
        for i in 0..count {
            for j in 0..count {
                let (a, b) = (carom_collision::part(&star, i), carom_collision::part(&star, j));
                let manifold = carom_collision::collide_within(&a, &b, pose, 0.01);
                // Left out if it is over once another part's overlap is.
                let over = |c: &PartManifold| {
                    let depth = c.manifold.deepest().map_or(0.0, |d| -d);
                    let then = Pose::new(pose.position + c.manifold.normal * depth, pose.rotation);
                    depth > 0.0 && carom_collision::separating_axis(&a, &b, then).separation >= -1e-6 * depth
                };
                let covered = fast.iter().any(over);
                if !manifold.points.is_empty() && !covered {
                    let known = fast.iter().find(|c| (c.part_a as usize, c.part_b as usize) == (i, j));
                    // Or if another part has the very same point.
                    let same = |c: &&PartManifold| c.manifold.points[0].point == manifold.points[0].point;
                    prop_assert!(known.is_some_and(|c| c.manifold == manifold) || fast.iter().any(|c| same(&c)));
                }
            }
        }
    }
}

/// The lower right corner of a U in one side of a star: the U's bottom, which the star's wall passes through, too, took
/// part and left again as they turned by a hundredth, 211 mm deep, and rattled.
#[test]
fn a_corner_pressed_into_a_wall_is_pushed_out_of_it_only() {
    let u = polygon(&[
        (0.518, -0.457),
        (0.518, 0.578),
        (0.207, 0.578),
        (0.207, -0.147),
        (-0.207, -0.147),
        (-0.207, 0.578),
        (-0.518, 0.578),
        (-0.518, -0.457),
    ]);
    let star = polygon(&[
        (0.580, 0.000),
        (0.211, 0.153),
        (0.179, 0.551),
        (-0.081, 0.248),
        (-0.469, 0.341),
        (-0.261, 0.000),
        (-0.469, -0.341),
        (-0.081, -0.248),
        (0.179, -0.551),
        (0.211, -0.153),
    ]);
    for turn in -20..=20 {
        let turn = f64::from(turn) * 1e-3;
        let rotation = Rot::from_angle(-1.7948 + turn);
        let pose = Pose::new(vec2(0.683, -0.779), rotation);
        for (one, other, in_one, sign) in
            [(&u, &star, pose, 1.0), (&star, &u, pose.inverse(), -1.0)]
        {
            let found = all(one, other, in_one, 0.02);
            assert!(!found.is_empty(), "{turn}");
            for contact in found {
                let n = contact.manifold.normal * sign;
                let in_u = if sign > 0.0 { n } else { pose.vector(n) };
                assert!(in_u.x > 0.99, "turned by {turn}: {contact:?}");
            }
        }
    }
}

/// Floors that are cut into pieces under a straight top at y = 0.
fn floors() -> Vec<(&'static str, Shape)> {
    vec![
        (
            "an L",
            polygon(&[
                (-6.0, -1.0),
                (8.0, -1.0),
                (8.0, 3.0),
                (6.0, 3.0),
                (6.0, 0.0),
                (-6.0, 0.0),
            ]),
        ),
        (
            "a U",
            polygon(&[
                (-6.0, 2.0),
                (-7.0, 2.0),
                (-7.0, -1.0),
                (7.0, -1.0),
                (7.0, 2.0),
                (6.0, 2.0),
                (6.0, 0.0),
                (-6.0, 0.0),
            ]),
        ),
        (
            "teeth below",
            polygon(&[
                (-6.0, 0.0),
                (-6.0, -1.0),
                (-4.0, -0.125),
                (-2.0, -1.0),
                (0.0, -0.125),
                (2.0, -1.0),
                (4.0, -0.125),
                (6.0, -1.0),
                (6.0, 0.0),
            ]),
        ),
        (
            "corners on the top",
            polygon(&[
                (-6.0, 0.0),
                (-6.0, -1.0),
                (0.0, -0.25),
                (6.0, -1.0),
                (6.0, 0.0),
                (3.0, 0.0),
                (1.0, 0.0),
                (-2.0, 0.0),
            ]),
        ),
    ]
}

#[test]
fn a_box_that_slides_over_seams_feels_the_floor_and_nothing_else() {
    let cube: Shape = ConvexPolygon::square(1.0).expect("above zero").into();
    let flat: Shape = Polygon::new(vec![
        vec2(-0.5, -0.5),
        vec2(0.5, -0.5),
        vec2(0.5, 0.5),
        vec2(-0.5, 0.5),
    ])
    .expect("simple")
    .into();
    for (name, floor) in floors() {
        assert!(carom_collision::part_count(&floor) > 1, "{name} has a seam");
        for (depth, margin) in [
            (1e-3, 0.0),
            (1e-6, 0.01),
            (0.0, 0.0),
            (0.02, 0.0),
            (-1e-3, 0.01),
        ] {
            for i in 0..=1000 {
                let x = -5.0 + 10.0 * f64::from(i) / 1000.0;
                let pose = Pose::at(vec2(x, 0.5 - depth));
                for cube in [&cube, &flat] {
                    let found = all(&floor, cube, pose, margin);
                    assert!(
                        !found.is_empty(),
                        "{name}: nothing at x = {x}, depth {depth}"
                    );
                    for contact in &found {
                        let n = contact.manifold.normal;
                        assert!(
                            (n - Vec2::Y).length() < 1e-12,
                            "{name}: normal {n} at x = {x}, depth {depth}"
                        );
                    }
                    // From the left end of the box to its right end.
                    let points = || found.iter().flat_map(|c| &c.manifold.points);
                    let left = points().map(|p| p.point.x).fold(f64::INFINITY, f64::min);
                    let right = points()
                        .map(|p| p.point.x)
                        .fold(f64::NEG_INFINITY, f64::max);
                    assert!(
                        (left - (x - 0.5)).abs() < 1e-12 && (right - (x + 0.5)).abs() < 1e-12,
                        "{name}: carried from {left} to {right} at x = {x}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_ball_that_rolls_over_seams_feels_the_floor_and_nothing_else() {
    let ball: Shape = Circle::new(0.5).expect("above zero").into();
    for (name, floor) in floors() {
        for depth in [1e-3, 0.0, 0.1, 0.5, 0.6] {
            for i in 0..=1000 {
                let x = -5.0 + 10.0 * f64::from(i) / 1000.0;
                let found = all(&floor, &ball, Pose::at(vec2(x, 0.5 - depth)), 0.0);
                // Where the floor is thin the way out of a deep overlap may be downwards.
                if depth > 0.1 && !["an L", "a U"].contains(&name) {
                    continue;
                }
                assert!(
                    !found.is_empty(),
                    "{name}: nothing at x = {x}, depth {depth}"
                );
                for contact in &found {
                    let n = contact.manifold.normal;
                    assert!(
                        (n - Vec2::Y).length() < 1e-12,
                        "{name}: normal {n} at x = {x}, depth {depth}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_nearly_flat_floor_has_no_steps() {
    // Corners that bend by 1e-7 either way: pieces end there, cones are thin.
    let mut points = vec![(10.0, -1.0), (10.0, 0.0)];
    for i in (-9..=9).rev() {
        let bend = if i % 2 == 0 { 1e-7 } else { -1e-7 };
        points.push((f64::from(i), bend));
    }
    points.extend([(-10.0, 0.0), (-10.0, -1.0)]);
    let floor = polygon(&points);
    let cube: Shape = ConvexPolygon::square(1.0).expect("above zero").into();
    for i in 0..=4000 {
        let x = -8.0 + 16.0 * f64::from(i) / 4000.0;
        let found = all(&floor, &cube, Pose::at(vec2(x, 0.5 - 1e-3)), 0.0);
        assert!(!found.is_empty(), "nothing at x = {x}");
        for contact in &found {
            assert!(
                (contact.manifold.normal - Vec2::Y).length() < 1e-6,
                "{contact:?} at x = {x}"
            );
            assert!(
                contact.manifold.deepest().is_some_and(|d| d > -1.1e-3),
                "{contact:?} at x = {x}"
            );
        }
    }
}

#[test]
fn nothing_is_felt_in_the_hollow_of_a_u() {
    // liabru/matter-js#842, #1299: bodies inside a concave one.
    let u = polygon(&[
        (-2.0, -2.0),
        (2.0, -2.0),
        (2.0, 2.0),
        (1.0, 2.0),
        (1.0, -1.0),
        (-1.0, -1.0),
        (-1.0, 2.0),
        (-2.0, 2.0),
    ]);
    let ball: Shape = Circle::new(0.9).expect("above zero").into();
    for i in 0..100 {
        let y = 0.0 + 0.03 * f64::from(i);
        assert!(
            all(&u, &ball, Pose::at(vec2(0.0, y)), 0.0).is_empty(),
            "felt at {y}"
        );
    }
}

/// A table slides on its feet, and sinks by rounding, to the step of a floor: whatever its feet do hides no step.
#[test]
fn a_touch_by_rounding_hides_no_other() {
    let floor = polygon(&[
        (-9.0, -1.0),
        (9.0, -1.0),
        (9.0, 3.0),
        (2.0, 3.0),
        (2.0, 0.0),
        (-9.0, 0.0),
    ]);
    let table = polygon(&[
        (-0.5, 0.0),
        (-0.3, 0.0),
        (-0.3, 0.4),
        (0.3, 0.4),
        (0.3, 0.0),
        (0.5, 0.0),
        (0.5, 0.6),
        (-0.5, 0.6),
    ]);
    let still = Motion::resting(Vec2::ZERO);
    let slides = Motion {
        velocity: vec2(2.0, -1e-11),
        ..Motion::resting(Vec2::ZERO)
    };
    let from = (SimTime::ZERO, 1e-10);
    let found = time_of_impact_beside(from, &floor, &still, &table, &slides, 5.0);
    let TimeOfImpact::Hit(hit) = found else {
        panic!("it meets the step: {found:?}");
    };
    assert!((hit.time - 0.75).abs() < 1e-12, "{hit:?}");
    let first = time_of_impact_from(SimTime::ZERO, None, &floor, &still, &table, &slides, 5.0);
    let (TimeOfImpact::Hit(feet) | TimeOfImpact::Touching(feet)) = first else {
        panic!("its feet sink: {first:?}");
    };
    assert!(feet.time < 0.75, "{feet:?}");
}
