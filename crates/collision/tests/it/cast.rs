//! Casts against small steps and known answers.

use carom_collision::{cast, shape_distance};
use carom_geometry::{Circle, ConvexPolygon, Segment, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex};

fn any_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        3 => convex().prop_map(Shape::from),
        2 => concave().prop_map(Shape::from),
        2 => (0.05..1.0_f64).prop_map(|r| Circle::at(vec2(0.1, 0.2), r).expect("above zero").into()),
        1 => (0.1..1.0_f64).prop_map(|x| Segment::new(vec2(-x, 0.1), vec2(x, 0.3)).expect("a length").into()),
    ]
}

proptest! {
    #[test]
    fn the_way_up_to_a_hit_is_free_and_ends_in_contact(
        moving in any_shape(), target in any_shape(),
        from in (-4.0..4.0_f64, -4.0..4.0_f64), way in (-6.0..6.0_f64, -6.0..6.0_f64),
        turns in (-4.0..4.0_f64, -4.0..4.0_f64),
    ) {
        let pose = Pose::new(vec2(from.0, from.1), Rot::from_angle(turns.0));
        let target_pose = Pose::new(vec2(0.5, -0.25), Rot::from_angle(turns.1));
        let way = vec2(way.0, way.1);
        let gap = |fraction: f64| {
            let moved = Pose::new(pose.position + way * fraction, pose.rotation);
            shape_distance(&moving, &target, target_pose.seen_from(moved)).distance
        };
        let hit = cast(&moving, pose, way, &target, target_pose);
        let free = hit.map_or(1.0, |hit| hit.fraction);
        prop_assert!((0.0..=1.0).contains(&free));
        for i in 0..100 {
            let fraction = free * f64::from(i) / 100.0 - 1e-9;
            prop_assert!(fraction < 0.0 || gap(fraction) > 0.0, "overlap at {fraction} before {free}");
        }
        if let Some(hit) = hit {
            prop_assert!(gap(hit.fraction) < 1e-13, "{:e} m short", gap(hit.fraction));
            prop_assert!((hit.normal.length() - 1.0).abs() < 1e-14);
            if hit.fraction > 0.0 {
                prop_assert!(hit.normal.dot(way) > -1e-12, "hit from behind: {hit:?}");
                let dot: Shape = Circle::new(1e-9).expect("above zero").into();
                let moved = Pose::new(pose.position + way * hit.fraction, pose.rotation);
                let off = |s: &Shape, p: Pose| shape_distance(&dot, s, p.seen_from(Pose::at(hit.point))).distance;
                prop_assert!(off(&moving, moved) < 1e-13 && off(&target, target_pose) < 1e-13, "{hit:?}");
            }
        }
    }

    #[test]
    fn the_other_one_moving_back_gives_the_same_hit(
        a in any_shape(), b in any_shape(), from in (-4.0..4.0_f64, -4.0..4.0_f64), way in (-6.0..6.0_f64, -6.0..6.0_f64), turn in -4.0..4.0_f64,
    ) {
        let (pose, way) = (Pose::new(vec2(from.0, from.1), Rot::from_angle(turn)), vec2(way.0, way.1));
        let one = cast(&a, pose, way, &b, Pose::IDENTITY);
        let two = cast(&b, Pose::IDENTITY, -way, &a, pose);
        match (one, two) {
            (Some(one), Some(two)) => prop_assert!((one.fraction - two.fraction).abs() < 1e-13),
            (None, None) => {}
            (one, two) => prop_assert!(false, "{one:?} against {two:?}"),
        }
    }
}

fn ball(r: f64) -> Shape {
    Circle::new(r).expect("above zero").into()
}

#[test]
fn a_ball_reaches_boxes_of_any_size_without_loss() {
    // dimforge/parry#429: up to 139 mm short on a box of 500 m.
    for half in [5.0, 50.0, 500.0] {
        let wall: Shape = ConvexPolygon::square(2.0 * half)
            .expect("above zero")
            .into();
        let start = Pose::at(vec2(-half - 8.5, 0.25));
        let hit =
            cast(&ball(0.5), start, vec2(16.0, 0.0), &wall, Pose::IDENTITY).expect("in the way");
        assert_eq!(hit.fraction, 0.5);
        assert_eq!(hit.point, vec2(-half, 0.25));
    }
}

#[test]
fn a_square_meets_a_segment_from_every_start() {
    // dimforge/parry#180: lost for some shifts of 1e-6.
    let square: Shape = ConvexPolygon::square(2.0).expect("above zero").into();
    let floor: Shape = Segment::new(vec2(-100.0, 0.0), vec2(100.0, 0.0))
        .expect("a length")
        .into();
    for i in 0..2000 {
        let start = Pose::at(vec2(15.689465, 54.00709 + 1e-6 * f64::from(i)));
        let way = vec2(0.0081385, -0.999966) * 100.0;
        let hit = cast(&square, start, way, &floor, Pose::IDENTITY).expect("in the way");
        let want = (start.position.y - 1.0) / 99.9966;
        assert!(
            (hit.fraction - want).abs() < 1e-15,
            "{} against {want}",
            hit.fraction
        );
    }
}

#[test]
fn touching_counts_only_when_pressed() {
    let floor: Shape = ConvexPolygon::rectangle(8.0, 2.0)
        .expect("above zero")
        .into();
    let cube: Shape = ConvexPolygon::square(2.0).expect("above zero").into();
    let on = Pose::at(vec2(0.0, 2.0));
    let hit = |way: Vec2| cast(&cube, on, way, &floor, Pose::IDENTITY);
    assert_eq!(
        hit(vec2(1.0, -1.0)).map(|h| (h.fraction, h.normal)),
        Some((0.0, -Vec2::Y))
    );
    assert_eq!(hit(vec2(1.0, 0.0)), None);
    assert_eq!(hit(vec2(1.0, 1.0)), None);
    let sunk = Pose::at(vec2(0.0, 1.5));
    let away = cast(&cube, sunk, vec2(0.0, 9.0), &floor, Pose::IDENTITY).expect("they overlap");
    assert_eq!((away.fraction, away.normal), (0.0, -Vec2::Y));
    // The same for discs.
    let ball = ball(1.0);
    let roll = |way: Vec2| cast(&ball, on, way, &floor, Pose::IDENTITY).map(|h| h.fraction);
    assert_eq!(
        (
            roll(vec2(1.0, -1.0)),
            roll(vec2(1.0, 0.0)),
            roll(vec2(0.0, 1.0))
        ),
        (Some(0.0), None, None)
    );
}

#[test]
fn parallel_segments_pass_beside_each_other() {
    let bar: Shape = Segment::new(vec2(0.0, 0.0), vec2(1.0, 0.0))
        .expect("a length")
        .into();
    let fall = |x: f64| {
        cast(
            &bar,
            Pose::at(vec2(x, 1.0)),
            vec2(0.0, -2.0),
            &bar,
            Pose::IDENTITY,
        )
    };
    assert_eq!(fall(0.5).map(|h| h.fraction), Some(0.5));
    assert_eq!(fall(1.5), None);
    // End on end along their common line.
    let slide = cast(
        &bar,
        Pose::at(vec2(-3.0, 0.0)),
        vec2(4.0, 0.0),
        &bar,
        Pose::IDENTITY,
    );
    assert_eq!(slide.map(|h| (h.fraction, h.normal)), Some((0.5, Vec2::X)));
}

#[test]
fn a_segment_met_by_the_end_of_another_is_touched_there() {
    let upright = Shape::from(Segment::new(vec2(0.0, -0.5), vec2(0.0, 0.5)).expect("a segment"));
    let level = Shape::from(Segment::new(vec2(1.0, 0.25), vec2(3.0, 0.25)).expect("a segment"));
    let way = vec2(2.0, 0.125);
    let there = cast(&upright, Pose::IDENTITY, way, &level, Pose::IDENTITY).expect("it is met");
    let back = cast(&level, Pose::IDENTITY, -way, &upright, Pose::IDENTITY).expect("it is met");
    assert!(
        (there.point - vec2(1.0, 0.25)).length() < 1e-15,
        "{there:?}"
    );
    assert!(
        (back.point - vec2(0.0, 0.1875)).length() < 1e-15,
        "{back:?}"
    );
}
