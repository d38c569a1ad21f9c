//! What touches at the instant of an impact.

use carom_collision::{
    AxisFeature, Impact, ImpactFeature, Motion, Side, TimeOfImpact, part, time_of_impact,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon, Segment, Shape};
use carom_math::{Pose, Rot, SimTime, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, turn};

/// From its lower left corner, counter-clockwise: edges 0 below, 1 right, 2 above, 3 left.
fn box_(width: f64, height: f64) -> Shape {
    ConvexPolygon::rectangle(width, height)
        .expect("a box")
        .into()
}

fn falling(place: Vec2) -> Motion {
    Motion {
        velocity: vec2(0.0, -1.0),
        ..Motion::resting(place)
    }
}

fn hit(a: &Shape, motion_a: &Motion, b: &Shape, motion_b: &Motion) -> Impact {
    match time_of_impact(a, motion_a, b, motion_b, 10.0) {
        TimeOfImpact::Hit(hit) => hit,
        other => panic!("no hit: {other:?}"),
    }
}

fn features(impact: &Impact) -> Vec<AxisFeature> {
    impact.features.iter().map(|f| f.feature).collect()
}

/// The features that are named, and the same with A and B exchanged.
fn assert_features(b: &Shape, motion: &Motion, wanted: &[AxisFeature]) {
    let floor = box_(4.0, 1.0);
    let still = Motion::resting(Vec2::ZERO);
    let found = hit(&floor, &still, b, motion);
    assert_eq!(found.points.len(), found.features.len());
    let mut given = features(&found);
    let mut back: Vec<AxisFeature> = features(&hit(b, motion, &floor, &still))
        .into_iter()
        .map(AxisFeature::swapped)
        .collect();
    let order = |f: &AxisFeature| format!("{f:?}");
    given.sort_by_key(order);
    back.sort_by_key(order);
    let mut wanted = wanted.to_vec();
    wanted.sort_by_key(order);
    assert_eq!(given, wanted);
    assert_eq!(back, wanted, "B and A");
}

const fn edge_of(owner: Side, edge: usize, vertex: usize) -> AxisFeature {
    AxisFeature::Edge {
        owner,
        edge,
        vertex,
    }
}

#[test]
fn a_corner_lands_on_an_edge() {
    let lean = Motion {
        rotation: Rot::from_degrees(30.0),
        ..falling(vec2(0.5, 3.0))
    };
    // Turned to the left by less than 45°, its lower left corner goes first.
    assert_features(&box_(1.0, 1.0), &lean, &[edge_of(Side::A, 2, 0)]);
}

#[test]
fn both_corners_of_an_edge_land_flat() {
    let wanted = [edge_of(Side::A, 2, 0), edge_of(Side::A, 2, 1)];
    assert_features(&box_(1.0, 1.0), &falling(vec2(0.5, 3.0)), &wanted);
}

#[test]
fn over_the_rim_the_floor_s_corner_touches_the_box_s_edge() {
    // From 1.5 to 2.5 m, over a floor that ends at 2 m with corner 2.
    let wanted = [edge_of(Side::A, 2, 0), edge_of(Side::B, 0, 2)];
    assert_features(&box_(1.0, 1.0), &falling(vec2(2.0, 3.0)), &wanted);
    // Wider than the floor on both sides.
    let wanted = [edge_of(Side::B, 0, 3), edge_of(Side::B, 0, 2)];
    assert_features(&box_(6.0, 1.0), &falling(vec2(0.5, 3.0)), &wanted);
}

#[test]
fn a_disc_lands_on_an_edge_and_on_a_corner() {
    let ball = Shape::from(Circle::new(0.5).expect("a disc"));
    assert_features(&ball, &falling(vec2(0.5, 3.0)), &[edge_of(Side::A, 2, 0)]);
    let corner = AxisFeature::Vertices { a: 2, b: 0 };
    assert_features(&ball, &falling(vec2(2.25, 3.0)), &[corner]);
}

#[test]
fn parts_that_land_together_name_their_own_corners() {
    // An arch with two feet.
    let arch = Polygon::new([
        vec2(-1.0, 0.0),
        vec2(-0.75, 0.0),
        vec2(-0.75, 1.0),
        vec2(0.75, 1.0),
        vec2(0.75, 0.0),
        vec2(1.0, 0.0),
        vec2(1.0, 1.5),
        vec2(-1.0, 1.5),
    ]);
    let arch = Shape::from(arch.expect("simple"));
    let found = hit(
        &box_(4.0, 1.0),
        &Motion::resting(Vec2::ZERO),
        &arch,
        &falling(vec2(0.0, 1.5)),
    );
    assert_eq!((found.points.len(), found.features.len()), (2, 2));
    let feet = found.features.iter().map(|touch| {
        let AxisFeature::Edge {
            owner: Side::A,
            edge: 2,
            vertex,
        } = touch.feature
        else {
            panic!("{touch:?}");
        };
        part(&arch, touch.parts.1 as usize).vertices[vertex]
    });
    let mut feet: Vec<f64> = feet.map(|foot| foot.x).collect();
    feet.sort_by(f64::total_cmp);
    assert_eq!(feet, [-1.0, 1.0], "the outer ends");
}

/// How far a point is from what is said to touch there, in m.
fn off(touch: &ImpactFeature, point: Vec2, sides: [(&Shape, Pose); 2]) -> f64 {
    let parts = [touch.parts.0, touch.parts.1];
    let hulls = [0, 1].map(|k| part(sides[k].0, parts[k] as usize));
    let from_vertex = |k: usize, vertex: usize| {
        let place = sides[k].1.point(hulls[k].vertices[vertex]);
        ((point - place).length() - hulls[k].radius).abs()
    };
    match touch.feature {
        AxisFeature::Vertices { a, b } => from_vertex(0, a).max(from_vertex(1, b)),
        AxisFeature::Edge {
            owner,
            edge,
            vertex,
        } => {
            let own = usize::from(owner == Side::B);
            let (from, to) = hulls[own].edge(edge);
            let (from, to) = (sides[own].1.point(from), sides[own].1.point(to));
            let share = (point - from).dot(to - from) / (to - from).length_squared();
            let from_edge = (point - from.lerp(to, share.clamp(0.0, 1.0))).length();
            from_edge.max(from_vertex(1 - own, vertex))
        }
    }
}

/// A box thrown out of a floor that it overlaps lands when it touches again, not when it is as deep as before.
#[test]
fn what_leaves_an_overlap_lands_on_the_surface() {
    let floor = Shape::from(HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor"));
    let slab = box_(20.0, 2.0);
    for (ground, top) in [(&floor, 0.0), (&slab, 1.0)] {
        for spin in [0.0, 1e-3] {
            // y = top + 0.45 + 3 t − 5 t² is back at top + 0.5 after (3 + √8) / 10 s.
            let thrown = Motion {
                velocity: vec2(0.0, 3.0),
                acceleration: vec2(0.0, -10.0),
                spin,
                ..Motion::resting(vec2(0.0, top + 0.45))
            };
            let still = Motion::resting(Vec2::ZERO);
            let found = time_of_impact(ground, &still, &box_(1.0, 1.0), &thrown, 2.0);
            let TimeOfImpact::Hit(hit) = found else {
                panic!("it falls back: {found:?}");
            };
            let late = hit.time - 0.1 * (3.0 + 8.0_f64.sqrt());
            assert!(
                late.abs() < 1e-14 + 0.2 * spin,
                "{late:e} s late with {spin} rad/s"
            );
        }
    }
}

/// A needle's tip at the nearly straight corner of another one: it touches beyond the end of the edge that closes last,
/// and was named after the corner, 2 mm away.
#[test]
fn a_tip_beside_a_nearly_straight_corner_touches_the_edge_that_it_is_over() {
    let needle = |corners: [(f64, f64); 3]| {
        let corners = corners.map(Vec2::from).to_vec();
        Shape::from(ConvexPolygon::new(corners).expect("a triangle"))
    };
    let a = needle([
        (-0.5163486265338328, 0.4585700911147092),
        (-0.22431042693758343, 0.19921052273180515),
        (-0.39716093398236707, 0.3527193913695989),
    ]);
    let b = needle([
        (-0.5519295297410103, -0.09840449676465209),
        (0.2953425559480826, 0.052657142403036684),
        (-0.2931306395408151, -0.05226276603640013),
    ]);
    let motion_a = Motion {
        rotation: Rot::from_direction(vec2(-0.9812017929683443, -0.19298456279118884))
            .expect("not 0"),
        spin: 2.2782693771404956,
        ..Motion::resting(vec2(-3.0, 0.0))
    };
    let motion_b = Motion {
        rotation: Rot::from_degrees(90.0),
        spin: -3.1199171593778035,
        velocity: vec2(-1.4176113197186069, 0.0),
        ..Motion::resting(vec2(3.0, -0.11144633720570168))
    };
    let TimeOfImpact::Hit(hit) = time_of_impact(&a, &motion_a, &b, &motion_b, 8.0) else {
        panic!("they meet");
    };
    let time = SimTime::from_secs(hit.time);
    let sides = [(&a, motion_a.pose_at(time)), (&b, motion_b.pose_at(time))];
    for (point, touch) in hit.points.iter().zip(&hit.features) {
        let off = off(touch, *point, sides);
        assert!(off < 1e-8, "{off:e} m off {touch:?} of {hit:?}");
    }
}

/// What turns ever faster or slower was followed by two of its sizes at a time: 100 m at 1 mm were beyond the budget.
#[test]
fn a_small_body_with_a_changing_spin_is_followed_over_a_long_way() {
    let still = Motion::resting(Vec2::ZERO);
    let plane = Shape::from(HalfPlane::new(Vec2::ZERO, Vec2::Y).expect("a floor"));
    let slab = box_(4.0, 1.0);
    let disc = Shape::from(Circle::new(1e-3).expect("a disc"));
    for (floor, top) in [(&plane, 0.0), (&slab, 0.5)] {
        for body in [&disc, &box_(1e-3, 1e-3)] {
            let motion = Motion {
                velocity: vec2(0.0, -10.0),
                spin: 1.0,
                angular_acceleration: -0.01,
                ..Motion::resting(vec2(0.0, 200.0))
            };
            let TimeOfImpact::Hit(hit) = time_of_impact(floor, &still, body, &motion, 30.0) else {
                panic!("it falls onto the floor");
            };
            let lowest = body
                .aabb(motion.pose_at(SimTime::from_secs(hit.time)))
                .min
                .y;
            assert!((lowest - top).abs() < 1e-12, "{:e} m off", lowest - top);
        }
    }
}

fn body() -> impl Strategy<Value = Shape> {
    prop_oneof![
        convex().prop_map(Shape::from),
        concave().prop_map(Shape::from),
        (0.1..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_point_of_impact_is_where_its_features_are(
        a in body(), b in body(), y in -1.0..1.0_f64, speed in 1.0..5.0_f64,
        rotations in (turn(), turn()), spins in (-5.0..5.0_f64, -5.0..5.0_f64),
    ) {
        let motion_a = Motion { rotation: rotations.0, spin: spins.0, ..Motion::resting(vec2(-3.0, 0.0)) };
        let velocity = vec2(-speed, 0.0);
        let motion_b = Motion { rotation: rotations.1, spin: spins.1, velocity, ..Motion::resting(vec2(3.0, y)) };
        if let TimeOfImpact::Hit(hit) = time_of_impact(&a, &motion_a, &b, &motion_b, 8.0) {
            prop_assert_eq!(hit.points.len(), hit.features.len());
            let time = SimTime::from_secs(hit.time);
            let sides = [(&a, motion_a.pose_at(time)), (&b, motion_b.pose_at(time))];
            for (point, touch) in hit.points.iter().zip(&hit.features) {
                let off = off(touch, *point, sides);
                prop_assert!(off < 1e-8, "{off:e} m off {touch:?} of {hit:?}");
            }
        }
    }
}

#[test]
fn shapes_that_touch_or_overlap_and_do_not_approach_are_clear_and_those_that_approach_touch() {
    let disc = Shape::from(Circle::new(1.0).expect("a disc"));
    let square = Shape::from(ConvexPolygon::square(2.0).expect("a square"));
    for shape in [disc, square] {
        for apart in [1.9, 2.0] {
            let at = |speed: f64| {
                let moving = Motion {
                    velocity: vec2(speed, 0.0),
                    ..Motion::resting(vec2(apart, 0.0))
                };
                time_of_impact(&shape, &Motion::resting(Vec2::ZERO), &shape, &moving, 2.0)
            };
            assert_eq!(at(0.0), TimeOfImpact::Clear, "at rest, {apart} m");
            assert_eq!(at(1.0), TimeOfImpact::Clear, "parting, {apart} m");
            let TimeOfImpact::Touching(impact) = at(-1.0) else {
                panic!("{:?} at {apart} m", at(-1.0));
            };
            assert!((impact.gap_rate + 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn a_disc_that_comes_down_on_a_corner_touches_one_point() {
    // Its centre comes over the end of the edge, to rounding: along that way both ends of the edge are as low.
    let bar = Shape::from(Segment::new(vec2(0.0, 0.0), vec2(-0.5, 0.0)).expect("a bar"));
    let turned = Motion {
        velocity: vec2(2.0, 0.0),
        rotation: Rot::from_cos_sin(-1.0, 0.0),
        ..Motion::resting(vec2(-1.0, -1.0))
    };
    let disc = Shape::from(Circle::at(vec2(1.0, 0.5), 0.75).expect("a disc"));
    let flying = Motion {
        velocity: vec2(-2.0, -2.0),
        ..Motion::resting(Vec2::ZERO)
    };
    let end = vec2(0.25, -1.0);
    for impact in [
        hit(&disc, &flying, &bar, &turned),
        hit(&bar, &turned, &disc, &flying),
    ] {
        assert!((impact.time - 0.375).abs() < 1e-15);
        assert_eq!(impact.points.len(), 1, "{impact:?}");
        assert!((impact.points[0] - end).length() < 1e-14, "{impact:?}");
        let [AxisFeature::Vertices { a, b }] = features(&impact)[..] else {
            panic!("a corner: {impact:?}");
        };
        // The bar is turned by half a turn.
        assert_eq!(a + b, 1);
    }
}
