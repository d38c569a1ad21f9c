//! Contact points: laws for random pairs, known answers for simple ones.

use carom_collision::{Convex, FeatureId, collide, collide_within, separating_axis};
use carom_geometry::{Circle, ConvexPolygon, Segment};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{gap_along, hull, pair};

proptest! {
    #[test]
    fn a_contact_is_there_exactly_when_shapes_overlap_and_as_deep_as_they_do(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let axis = separating_axis(&a, &b, pair.pose);
        let contact = collide(&pair.a, &pair.b, pair.pose);
        prop_assert_eq!(contact.points.is_empty(), axis.separation > 0.0, "separation {:e}", axis.separation);
        if let Some(deepest) = contact.deepest() {
            prop_assert!((deepest - axis.separation).abs() <= 4e-12 * pair.size, "{deepest:e} for {:e}", axis.separation);
            prop_assert!((gap_along(&a, &b, pair.pose, contact.normal) - axis.separation).abs() <= 4e-12 * pair.size);
        }
        // Midway between the surfaces: half the separation outside of each at most.
        for point in &contact.points {
            let room = 0.5 * point.separation.abs() + 1e-12 * pair.size;
            let outside = |h: &carom_collision::Hull<'_>, p: Vec2| {
                h.normals.iter().zip(h.vertices).map(|(n, v)| n.dot(p - *v)).fold(f64::MIN, f64::max)
            };
            prop_assert!(outside(&a, point.point) <= room);
            prop_assert!(outside(&b, pair.pose.inverse_point(point.point)) <= room);
        }
    }

    #[test]
    fn swapping_flips_the_normal_and_mirrors_the_points(pair in pair(), near in any::<bool>()) {
        let margin = if near { 0.3 * pair.size } else { 0.0 };
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let contact = collide_within(&a, &b, pair.pose, margin);
        let swapped = collide_within(&b, &a, pair.pose.inverse(), margin);
        let back = -pair.pose.vector(swapped.normal);
        let doubtful = |s: f64| (s - margin).abs() < 1e-9 * pair.size;
        if contact.points.iter().chain(&swapped.points).any(|p| doubtful(p.separation)) {
            return Ok(());
        }
        prop_assert_eq!(contact.points.is_empty(), swapped.points.is_empty());
        if contact.points.is_empty() {
            return Ok(());
        }
        if (back - contact.normal).length() > 1e-9 {
            // Two ways out of the same length.
            let tie = gap_along(&a, &b, pair.pose, back) - gap_along(&a, &b, pair.pose, contact.normal);
            prop_assert!(tie.abs() <= 4e-12 * pair.size, "tie {tie:e}");
            return Ok(());
        }
        // Edges that share a stretch of rounding size share it or not.
        let stretch = |m: &carom_collision::Manifold| match m.points[..] {
            [p, q] => (q.point - p.point).length(),
            _ => f64::INFINITY,
        };
        if stretch(&contact).min(stretch(&swapped)) < 1e-9 * pair.size {
            return Ok(());
        }
        prop_assert_eq!(contact.points.len(), swapped.points.len());
        for point in &contact.points {
            let twin = swapped.points.iter().find(|p| p.feature == point.feature.mirrored());
            prop_assert!(twin.is_some(), "no twin of {:?} in {:?}", point, swapped);
            if let Some(twin) = twin {
                // A gap read from the other of two edges at 1e-9 differs by that times their length.
                prop_assert!((twin.separation - point.separation).abs() <= 1e-8 * pair.size);
                prop_assert!((pair.pose.point(twin.point) - point.point).length() <= 1e-8 * pair.size);
            }
        }
    }

    #[test]
    fn moving_both_moves_the_contact(pair in pair(), x in -10.0..10.0_f64, turn in -4.0..4.0_f64) {
        let world = Pose::new(vec2(x, -x) * pair.size, Rot::from_angle(turn));
        let moved = (world * pair.pose).seen_from(world);
        let (one, two) = (collide(&pair.a, &pair.b, pair.pose), collide(&pair.a, &pair.b, moved));
        if let (Some(d), Some(e)) = (one.deepest(), two.deepest()) {
            // Flush edges within the tie may change the reference.
            prop_assert!((d - e).abs() <= 4e-12 * pair.size);
        } else if let Some(d) = one.deepest().or(two.deepest()) {
            prop_assert!(d > -4e-12 * pair.size, "a contact of depth {d:e} came or went");
        }
    }

    #[test]
    fn exact_shifts_change_no_bit(pair in pair(), far in 0..31i32) {
        // Both bodies on a grid of 2^-20 m, moved by 2^far m: every coordinate stays exact.
        let grid = |p: Vec2| (p / pair.size * 1024.0).round() / 1024.0;
        let b = Pose::new(grid(pair.pose.position), pair.pose.rotation);
        let shift = vec2(f64::from(1u32 << far), -f64::from(1u32 << far));
        let near = b.seen_from(Pose::IDENTITY);
        let away = Pose::new(b.position + shift, b.rotation).seen_from(Pose::at(shift));
        prop_assert_eq!(near, away);
        prop_assert_eq!(collide(&pair.a, &pair.b, near), collide(&pair.a, &pair.b, away));
    }

    #[test]
    fn every_point_within_the_margin_is_found(pair in pair()) {
        let (a, b) = (hull(&pair.a), hull(&pair.b));
        let way = carom_collision::distance(&a, &b, pair.pose);
        if way.distance > 0.0 {
            let reached = collide_within(&a, &b, pair.pose, way.distance * (1.0 + 1e-9) + 1e-12 * pair.size);
            prop_assert!(!reached.points.is_empty(), "{way:?}");
            let missed = collide_within(&a, &b, pair.pose, way.distance * (1.0 - 1e-9) - 1e-12 * pair.size);
            prop_assert!(missed.deepest().is_none_or(|d| d <= way.distance), "{way:?} {missed:?}");
        }
    }
}

fn square(side: f64) -> ConvexPolygon {
    ConvexPolygon::square(side).expect("above zero")
}

#[test]
fn a_box_on_a_floor_keeps_its_features_while_it_rocks_and_slides() {
    let floor = ConvexPolygon::rectangle(10.0, 1.0).expect("above zero");
    let cube = square(1.0);
    let features = |x: f64, tilt: f64| -> Vec<FeatureId> {
        let pose = Pose::new(vec2(x, 1.0 - 1e-3), Rot::from_angle(tilt));
        let contact = collide_within(&floor.hull(), &cube.hull(), pose, 0.01);
        assert!(contact.normal.y > 0.999);
        let mut found: Vec<_> = contact.points.iter().map(|p| p.feature).collect();
        found.sort_unstable();
        found
    };
    let flat = features(0.0, 0.0);
    assert_eq!(flat.len(), 2);
    for i in -20..=20 {
        let i = f64::from(i);
        assert_eq!(features(0.2 * i, 1e-5 * i), flat, "at {i}");
    }
}

#[test]
fn equal_boxes_keep_their_features_when_the_reference_changes_sides() {
    // Rounding decides which of two equal faces separates more; the features must not care.
    let cube = square(1.0);
    let features = |tilt: f64, x: f64| -> Vec<FeatureId> {
        let pose = Pose::new(vec2(x, 1.0 - 1e-3), Rot::from_angle(tilt));
        let contact = collide(&cube, &cube, pose);
        let mut found: Vec<_> = contact.points.iter().map(|p| p.feature).collect();
        found.sort_unstable();
        found
    };
    let flat = features(0.0, 0.0);
    assert_eq!(flat.len(), 2);
    for i in -20..=20 {
        for j in -3..=3 {
            let (tilt, x) = (1e-5 * f64::from(i), 1e-6 * f64::from(j));
            assert_eq!(features(tilt, x), flat, "tilt {tilt:e}, offset {x:e}");
        }
    }
}

#[test]
fn corner_on_corner_is_one_point_between_them() {
    let cube = square(2.0);
    let contact = collide_within(&cube.hull(), &cube.hull(), Pose::at(vec2(2.25, 2.25)), 0.5);
    assert_eq!(contact.points.len(), 1);
    let diagonal = Vec2::ONE.normalize();
    assert!((contact.normal - diagonal).length() < 1e-15);
    assert!((contact.points[0].separation - 0.25 * core::f64::consts::SQRT_2).abs() < 1e-15);
    assert_eq!(contact.points[0].point, vec2(1.125, 1.125));
    assert!(
        collide(&cube, &cube, Pose::at(vec2(2.25, 2.25)))
            .points
            .is_empty()
    );
    // Touching exactly: one way or the other, but one point and a unit normal.
    let touch = collide(&cube, &cube, Pose::at(vec2(2.0, 2.0)));
    assert_eq!(touch.points.len(), 1, "{touch:?}");
    assert_eq!(touch.points[0].point, vec2(1.0, 1.0));
    assert_eq!(touch.points[0].separation, 0.0);
}

#[test]
fn a_disc_centred_on_an_edge_or_a_corner_is_pushed_out() {
    // dimforge/parry#34, #148.
    let cube = square(2.0);
    let disc = Circle::new(0.5).expect("above zero");
    for (x, y) in [
        (1.0, 0.25),
        (1.0, 1.0),
        (-1.0, 1.0),
        (0.0, -1.0),
        (0.0, 0.0),
    ] {
        let contact = collide(&cube, &disc, Pose::at(vec2(x, y)));
        assert_eq!(contact.points.len(), 1, "at ({x}, {y})");
        assert!((contact.normal.length() - 1.0).abs() < 1e-15);
        let want = -0.5 - (1.0 - x.abs().max(y.abs()));
        assert_eq!(contact.points[0].separation, want, "at ({x}, {y})");
        let swapped = collide(&disc, &cube, Pose::at(vec2(-x, -y)));
        assert_eq!(swapped.normal, -contact.normal);
        assert_eq!(swapped.points[0].separation, want);
    }
}

#[test]
fn a_box_on_a_segment_stands_on_two_points_from_either_side() {
    let wall = Segment::new(vec2(-5.0, 0.0), vec2(5.0, 0.0)).expect("a length");
    let cube = square(1.0);
    for side in [1.0, -1.0] {
        let contact = collide(&wall, &cube, Pose::at(vec2(0.5, side * 0.4375)));
        assert_eq!(contact.normal, vec2(0.0, side));
        assert_eq!(contact.points.len(), 2);
        assert!(contact.points.iter().all(|p| p.separation == -0.0625));
    }
}

#[test]
fn a_deep_sliver_has_a_finite_contact() {
    let needle =
        ConvexPolygon::new([vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1e-12)]).expect("thin");
    let cube = square(4.0);
    let contact = collide(
        &cube,
        &needle,
        Pose::new(vec2(1.5, 0.3), Rot::from_angle(0.7)),
    );
    assert!(!contact.points.is_empty());
    assert!((contact.normal.length() - 1.0).abs() < 1e-15);
    assert!(
        contact
            .points
            .iter()
            .all(|p| p.point.is_finite() && p.separation < 0.0)
    );
}

#[test]
fn features_mirror_twice_into_themselves() {
    let id = FeatureId(0x0001_0203);
    assert_eq!(id.mirrored(), FeatureId(0x0203_0001));
    assert_eq!(id.mirrored().mirrored(), id);
}
