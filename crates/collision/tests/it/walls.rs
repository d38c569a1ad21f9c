//! Half-planes: what a very wide box would say, without its ends.

use carom_collision::{
    Motion, TimeOfImpact, cast, contacts, minimum_push, shape_distance, time_of_impact,
};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Segment, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, turn};

fn ground() -> Shape {
    HalfPlane::new(vec2(0.25, 0.0), Vec2::Y)
        .expect("a line")
        .into()
}

/// The ground as a box, 64 m wide and 32 m deep.
fn slab() -> Shape {
    let corners = [
        vec2(-32.0, -32.0),
        vec2(32.0, -32.0),
        vec2(32.0, 0.0),
        vec2(-32.0, 0.0),
    ];
    ConvexPolygon::new(corners).expect("a box").into()
}

fn body() -> impl Strategy<Value = Shape> {
    prop_oneof![
        convex().prop_map(Shape::from),
        concave().prop_map(Shape::from),
        (0.1..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
        (0.1..1.0_f64).prop_map(|r| Segment::new(vec2(-r, 0.0), vec2(r, 0.1))
            .expect("a wall")
            .into()),
    ]
}

proptest! {
    #[test]
    fn the_ground_is_a_box_without_ends(b in body(), x in -3.0..3.0_f64, y in -1.5..3.0_f64, rotation in turn()) {
        let pose = Pose::new(vec2(x, y), rotation);
        let (line, slab) = (ground(), slab());
        let (to_line, to_slab) = (shape_distance(&line, &b, pose), shape_distance(&slab, &b, pose));
        prop_assert!((to_line.distance - to_slab.distance).abs() < 1e-13);
        prop_assert_eq!(to_line.distance == 0.0, to_slab.distance == 0.0);
        if to_line.distance > 0.0 {
            prop_assert_eq!(to_line.normal, Vec2::Y);
            prop_assert!(to_line.point_a.y.abs() < 1e-13 && (to_line.point_b.y - to_line.distance).abs() < 1e-13);
        }
        let all = |a: &Shape, b: &Shape, pose| {
            let mut found = Vec::new();
            contacts(a, b, pose, 0.0, &mut found);
            let mut points: Vec<(Vec2, f64, Vec2)> = found.iter()
                .flat_map(|c| c.manifold.points.iter().map(move |p| (p.point, p.separation, c.manifold.normal)))
                .collect();
            points.sort_by(|p, q| p.0.x.total_cmp(&q.0.x));
            points
        };
        let (on_line, on_slab) = (all(&line, &b, pose), all(&slab, &b, pose));
        prop_assert!(on_line.iter().all(|p| p.2 == Vec2::Y));
        // A steep and narrow piece leaves the slab sideways, through one of its own edges.
        let upwards = |points: &[(Vec2, f64, Vec2)]| points.iter().all(|p| p.2 == Vec2::Y);
        if upwards(&on_slab) && !on_slab.is_empty() {
            prop_assert_eq!(on_line.len(), on_slab.len(), "{:?} {:?}", on_line, on_slab);
            for (p, q) in on_line.iter().zip(&on_slab) {
                prop_assert!((p.0 - q.0).length() < 1e-12 && (p.1 - q.1).abs() < 1e-13);
            }
        }
        let deepest = |points: &[(Vec2, f64, Vec2)]| points.iter().map(|p| p.1).fold(0.0, f64::min);
        let lowest = -b.aabb(pose).min.y;
        prop_assert!((deepest(&on_line) + lowest.max(0.0)).abs() < 1e-13);
        // The other way round.
        for (p, q) in all(&b, &line, pose.inverse()).iter().zip(all(&line, &b, pose)) {
            prop_assert!((pose.vector(p.2) + q.2).length() < 1e-14 || on_line.len() > 1);
        }
    }

    #[test]
    fn what_falls_or_is_pushed_meets_the_ground_as_it_meets_a_slab(b in body(), x in -3.0..3.0_f64, y in 2.0..6.0_f64, rotation in turn(), spin in -5.0..5.0_f64, push in -3.0..3.0_f64) {
        let pose = Pose::new(vec2(x, y), rotation);
        let way = vec2(push, -9.0);
        let (line, slab) = (cast(&b, pose, way, &ground(), Pose::IDENTITY), cast(&b, pose, way, &slab(), Pose::IDENTITY));
        let (line, slab) = (line.expect("it gets there"), slab.expect("it gets there"));
        prop_assert!((line.fraction - slab.fraction).abs() < 1e-14);
        prop_assert!((line.normal + Vec2::Y).length() < 1e-15);
        let falling = Motion { velocity: vec2(push, 0.0), acceleration: vec2(0.0, -9.81), spin, rotation, ..Motion::resting(pose.position) };
        let floor = Motion::resting(Vec2::ZERO);
        let hits = [ground(), self::slab()].map(|floor_shape| time_of_impact(&floor_shape, &floor, &b, &falling, 3.0));
        match hits {
            [TimeOfImpact::Hit(line), TimeOfImpact::Hit(slab)] => {
                prop_assert!((line.time - slab.time).abs() < 1e-12);
                prop_assert_eq!(line.normal, Vec2::Y);
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }
}

#[test]
fn two_half_planes_face_each_other_or_overlap_without_end() {
    let (up, down) = (
        ground(),
        HalfPlane::new(vec2(7.0, 3.0), -Vec2::Y)
            .expect("a line")
            .into(),
    );
    let apart = shape_distance(&up, &down, Pose::IDENTITY);
    assert_eq!((apart.distance, apart.normal), (3.0, Vec2::Y));
    let tilted = Pose::new(Vec2::ZERO, Rot::from_angle(1e-3));
    let crossing = shape_distance(&up, &down, tilted);
    assert_eq!(crossing.distance, 0.0);
    assert!(crossing.point_a.is_finite() && crossing.point_a.y.abs() < 1e-9);
    let mut found = Vec::new();
    contacts(&up, &down, tilted, 1.0, &mut found);
    assert!(found.is_empty());
    let hulls = (
        carom_collision::part(&up, 0),
        carom_collision::part(&down, 0),
    );
    assert_eq!(minimum_push(&hulls.0, &hulls.1, tilted), None);
    let still = Motion::resting(Vec2::ZERO);
    assert_eq!(
        time_of_impact(&up, &still, &down, &still, 1.0),
        TimeOfImpact::Clear
    );
}
