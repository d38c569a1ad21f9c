//! The errors of the documents, each with the right answer. Numbers are those of the list of errors
//! that was kept when the documents were checked.

use carom_collision::{
    Convex, VertexEdgeKind, collide, minimum_push, separating_axis, vertex_edge_contacts,
};
use carom_geometry::{Circle, ConvexPolygon};
use carom_math::{Pose, Rot, Vec2, vec2};

use crate::vertex_edge::{polygon, rectangle};

#[test]
fn error_4_a_vertex_that_went_through_the_whole_body_is_not_inside() {
    // Both edges at the tip cross the top of the plate, so the thesis has the tip inside; it is
    // half a metre below the bottom.
    let plate = rectangle(8.0, 1.0);
    let spike = polygon(&[(0.0, -1.0), (0.25, 2.0), (-0.25, 2.0)]);
    let found = vertex_edge_contacts(&plate, &spike, Pose::IDENTITY);
    assert!(!found.is_empty(), "they do overlap");
    for contact in &found {
        let at_tip = contact.kind == VertexEdgeKind::VertexOnEdge && contact.overlap < 1.0;
        assert!(!at_tip, "the tip is not inside: {contact:?}");
    }
}

#[test]
fn error_4_a_vertex_with_edges_that_cross_two_edges_is_inside() {
    // A wide corner over the narrow end of a wedge: its edges leave by the wedge's two sides.
    let wedge = polygon(&[(-1.0, -4.0), (1.0, -4.0), (0.25, 0.0), (-0.25, 0.0)]);
    let roof = polygon(&[(0.0, 0.0), (4.0, 1.0), (4.0, 3.0), (-4.0, 3.0), (-4.0, 1.0)]);
    let found = vertex_edge_contacts(&wedge, &roof, Pose::at(vec2(0.0, -0.125)));
    assert!(!found.is_empty());
    assert!(found.iter().all(|c| c.normal.y > 0.9), "{found:?}");
}

#[test]
fn error_5_a_vertex_on_a_vertex_takes_the_least_overlap_whatever_the_order_of_storage() {
    let base = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let turned = |k: usize| {
        let mut points = base;
        points.rotate_left(k);
        polygon(&points)
    };
    let pose = Pose::at(vec2(1.75, 1.875));
    for i in 0..4 {
        for j in 0..4 {
            let found = vertex_edge_contacts(&turned(i), &turned(j), pose);
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!(
                (found[0].normal, found[0].overlap),
                (Vec2::Y, 0.125),
                "stored from {i} and {j}"
            );
        }
    }
    // A tie goes between the two, in any order.
    for i in 0..4 {
        for j in 0..4 {
            let turn = Rot::from_degrees(45.0);
            let (p, q) = (
                Pose::new(vec2(0.0, 2.7), turn),
                Pose::new(vec2(0.0, 0.0), turn),
            );
            let found = vertex_edge_contacts(&turned(i), &turned(j), p.seen_from(q));
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!(found[0].kind, VertexEdgeKind::VertexOnVertex);
            assert!(
                (turn * found[0].normal - Vec2::Y).length() < 1e-12,
                "stored from {i} and {j}: {found:?}"
            );
        }
    }
}

#[test]
fn error_6_the_minimum_push_points_away_and_uses_the_edges_of_both() {
    let square = ConvexPolygon::square(2.0).expect("above zero");
    for (x, y, want) in [
        (1.5, 0.0, Vec2::X),
        (-1.5, 0.0, -Vec2::X),
        (0.0, 1.5, Vec2::Y),
        (0.0, -1.5, -Vec2::Y),
    ] {
        let push = minimum_push(&square.hull(), &square.hull(), Pose::at(vec2(x, y)));
        assert_eq!(push, Some(want * 0.5), "at ({x}, {y})");
    }
    // Only B's edges separate a square from a diamond beside its corner.
    let diamond = Pose::new(vec2(1.75, 1.75), Rot::from_degrees(45.0));
    let axis = separating_axis(&square.hull(), &square.hull(), diamond);
    assert!(axis.separation > 0.0, "{axis:?}");
    assert!(
        (axis.normal - Vec2::ONE.normalize()).length() < 1e-15,
        "{axis:?}"
    );
    assert_eq!(minimum_push(&square.hull(), &square.hull(), diamond), None);
}

#[test]
fn error_10_coincident_centres_have_a_normal() {
    let (one, two) = (
        Circle::new(1.0).expect("above zero"),
        Circle::new(0.5).expect("above zero"),
    );
    let contact = collide(&one, &two, Pose::IDENTITY);
    assert_eq!(contact.normal, Vec2::X);
    assert_eq!(contact.points[0].separation, -1.5);
    assert!(contact.points[0].point.is_finite());
}

#[test]
fn error_14_signs_between_minus_one_and_one_are_signs() {
    // The cross products of millimetre shapes were cut to the integer 0, "collinear".
    for size in [1e-6, 1e-3, 1.0, 1e6] {
        let cube = rectangle(2.0 * size, 2.0 * size);
        let pose = Pose::new(vec2(0.25, 2.25) * size, Rot::from_degrees(45.0));
        let found = vertex_edge_contacts(&cube, &cube, pose);
        assert_eq!(found.len(), 1, "size {size}: {found:?}");
        let want = (core::f64::consts::SQRT_2 - 1.25) * size;
        assert!((found[0].overlap - want).abs() < 1e-15 * size);
    }
}

#[test]
fn error_16_crossing_bars_and_boxes_at_one_place_overlap() {
    let bar = rectangle(8.0, 1.0);
    let cross = vertex_edge_contacts(&bar, &bar, Pose::new(Vec2::ZERO, Rot::from_degrees(90.0)));
    assert!(!cross.is_empty(), "no corner of either is inside the other");
    let same = vertex_edge_contacts(&bar, &bar, Pose::IDENTITY);
    assert_eq!(same.len(), 1, "{same:?}");
    assert_eq!(same[0].overlap, 1.0);
    let convex = ConvexPolygon::rectangle(8.0, 1.0).expect("above zero");
    assert!(!collide(&convex, &convex, Pose::IDENTITY).points.is_empty());
}

#[test]
fn error_17_normals_of_concave_bodies_do_not_come_from_their_centres() {
    // A ball's worth of a box inside a C, above its lower arm: the line between the centroids is
    // nearly horizontal, the contact is not.
    let c = polygon(&[
        (0.0, 0.0),
        (6.0, 0.0),
        (6.0, 1.0),
        (1.0, 1.0),
        (1.0, 5.0),
        (6.0, 5.0),
        (6.0, 6.0),
        (0.0, 6.0),
    ]);
    let found = vertex_edge_contacts(&c, &rectangle(1.0, 1.0), Pose::at(vec2(5.0, 1.4375)));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].normal, found[0].overlap), (Vec2::Y, 0.0625));
    // The upper arm pushes down.
    let found = vertex_edge_contacts(&c, &rectangle(1.0, 1.0), Pose::at(vec2(5.0, 4.5625)));
    assert_eq!((found[0].normal, found[0].overlap), (-Vec2::Y, 0.0625));
}

#[test]
fn error_17_parallel_is_an_angle_far_below_eight_degrees_and_no_length() {
    let floor = rectangle(8.0, 2.0);
    let tilted = |degrees: f64| {
        let pose = Pose::new(vec2(0.0, 1.9375), Rot::from_degrees(degrees));
        let found = vertex_edge_contacts(&floor, &rectangle(2.0, 2.0), pose);
        found
            .iter()
            .any(|c| c.kind == VertexEdgeKind::ParallelEdges)
    };
    assert!(tilted(0.0));
    assert!(!tilted(7.0) && !tilted(0.1) && !tilted(1e-4));
    for size in [1e-6, 1e6] {
        let (floor, cube) = (
            rectangle(8.0 * size, 2.0 * size),
            rectangle(2.0 * size, 2.0 * size),
        );
        let found = vertex_edge_contacts(&floor, &cube, Pose::at(vec2(0.0, 1.9375 * size)));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].kind, VertexEdgeKind::ParallelEdges, "size {size}");
    }
}

#[test]
fn error_18_a_long_overlap_is_reported_in_full() {
    let big = rectangle(200.0, 200.0);
    let found = vertex_edge_contacts(&big, &big, Pose::at(vec2(50.0, 150.0)));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].normal, found[0].overlap), (Vec2::Y, 50.0));
}
