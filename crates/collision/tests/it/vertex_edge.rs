//! Vertex–edge detection: agreement with the other methods, and its three kinds.

use carom_collision::{VertexEdgeKind, shape_distance, vertex_edge_contacts};
use carom_geometry::Polygon;
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, placed};

pub(crate) fn polygon(points: &[(f64, f64)]) -> Polygon {
    let points: Vec<Vec2> = points.iter().map(|p| vec2(p.0, p.1)).collect();
    Polygon::new(points).expect("simple")
}

pub(crate) fn rectangle(w: f64, h: f64) -> Polygon {
    polygon(&[
        (-0.5 * w, -0.5 * h),
        (0.5 * w, -0.5 * h),
        (0.5 * w, 0.5 * h),
        (-0.5 * w, 0.5 * h),
    ])
}

proptest! {
    #[test]
    fn something_is_found_exactly_when_the_polygons_overlap(a in concave(), b in concave(), x in -2.5..2.5_f64, y in -2.5..2.5_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let found = vertex_edge_contacts(&a, &b, pose);
        let apart = shape_distance(&a.into(), &b.into(), pose).distance > 0.0;
        if apart {
            prop_assert!(found.is_empty(), "{found:?}");
        }
        for contact in &found {
            prop_assert!((contact.normal.length() - 1.0).abs() < 1e-14);
            prop_assert!(contact.overlap >= 0.0);
        }
    }

    #[test]
    fn swapping_flips_every_normal(a in concave(), b in concave(), x in -2.5..2.5_f64, y in -2.5..2.5_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let one = vertex_edge_contacts(&a, &b, pose);
        let two = vertex_edge_contacts(&b, &a, pose.inverse());
        prop_assert_eq!(one.len(), two.len());
        for contact in &one {
            let twin = two.iter().find(|t| {
                t.kind == contact.kind
                    && (pose.point(t.point) - contact.point).length() < 1e-12
                    && (pose.vector(t.normal) + contact.normal).length() < 1e-12
                    && (t.overlap - contact.overlap).abs() < 1e-12
                    && t.owner == contact.owner.other()
            });
            prop_assert!(twin.is_some(), "no twin of {contact:?} in {two:?}");
        }
    }

    #[test]
    fn a_shallow_press_is_found_with_its_depth(a in concave(), b in concave(), towards in -4.0..4.0_f64, turn in -4.0..4.0_f64, k in -6.0..6.0_f64) {
        let size = crate::shapes::exp10(k);
        let scaled = |p: &Polygon| {
            Polygon::new(p.vertices().iter().map(|v| *v * size).collect::<Vec<_>>()).expect("simple")
        };
        let (a, b) = (scaled(&a), scaled(&b));
        let way = Rot::from_angle(towards).x_axis() * size;
        let mut pose = Pose::new(way * 5.0, Rot::from_angle(turn));
        let hit = carom_collision::cast(&b.clone().into(), pose, -way * 6.0, &a.clone().into(), Pose::IDENTITY);
        if let Some(hit) = hit {
            let outward = -hit.normal;
            pose.position -= way * (6.0 * hit.fraction) + outward * (1e-6 * size);
            let found = vertex_edge_contacts(&a, &b, pose);
            let felt = found.iter().any(|c| {
                let as_pressed = c.normal.dot(outward) > 0.999 && (c.overlap / size - 1e-6).abs() < 1e-9;
                // Corner beside corner: the edge around it may be nearer.
                let beside = |corners: &[Vec2]| corners.iter().any(|v| (*v - c.point).length() < 1e-4 * size);
                let corners = beside(a.vertices()) && beside(&placed(b.vertices(), pose));
                as_pressed || (corners && c.normal.dot(outward) > 0.0 && c.overlap <= 1.001e-6 * size)
            });
            prop_assert!(felt, "{found:?} for {outward}");
        }
    }
}

#[test]
fn the_three_kinds_of_the_thesis() {
    let floor = rectangle(8.0, 2.0);
    // A corner down: one vertex behind the top edge.
    let tip = vertex_edge_contacts(
        &floor,
        &rectangle(2.0, 2.0),
        Pose::new(vec2(0.5, 1.0 + 1.25), Rot::from_degrees(45.0)),
    );
    assert_eq!(tip.len(), 1);
    assert_eq!(tip[0].kind, VertexEdgeKind::VertexOnEdge);
    assert_eq!(tip[0].normal, Vec2::Y);
    assert!((tip[0].overlap - (core::f64::consts::SQRT_2 - 1.25)).abs() < 1e-15);

    // Flat down: the middle of what the edges share, not of one of them.
    let flat = vertex_edge_contacts(&floor, &rectangle(2.0, 2.0), Pose::at(vec2(3.5, 1.875)));
    assert_eq!(flat.len(), 1, "{flat:?}");
    assert_eq!(flat[0].kind, VertexEdgeKind::ParallelEdges);
    assert_eq!(
        (flat[0].point, flat[0].normal, flat[0].overlap),
        (vec2(3.25, 0.9375), Vec2::Y, 0.125)
    );

    // Corner in corner, both turned: each has a vertex in the other.
    let cube = rectangle(2.0, 2.0);
    let pose = Pose::new(vec2(1.9, 1.8), Rot::from_degrees(3.0));
    let corner = vertex_edge_contacts(&cube, &cube, pose);
    assert_eq!(corner.len(), 1, "{corner:?}");
    assert_eq!(corner[0].kind, VertexEdgeKind::VertexOnVertex);
}

#[test]
fn a_corner_in_a_corner_touches_both_walls() {
    let l = polygon(&[
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 1.0),
        (1.0, 1.0),
        (1.0, 4.0),
        (0.0, 4.0),
    ]);
    let found = vertex_edge_contacts(&l, &rectangle(2.0, 2.0), Pose::at(vec2(1.9375, 1.875)));
    let mut normals: Vec<_> = found
        .iter()
        .map(|c| (c.normal.x, c.normal.y, c.overlap))
        .collect();
    normals.sort_by(|p, q| p.0.total_cmp(&q.0));
    assert_eq!(
        normals,
        [(0.0, 1.0, 0.125), (1.0, 0.0, 0.0625)],
        "{found:?}"
    );
}

#[test]
fn touching_is_found_and_a_gap_is_not() {
    for size in [1e-6, 1.0, 1e6] {
        let cube = rectangle(2.0 * size, 2.0 * size);
        let at = |y: f64| vertex_edge_contacts(&cube, &cube, Pose::at(vec2(0.25 * size, y * size)));
        assert_eq!(at(2.0).len(), 1, "size {size}");
        assert_eq!(at(2.0)[0].kind, VertexEdgeKind::ParallelEdges);
        assert_eq!(at(2.0)[0].overlap, 0.0);
        assert!(at(2.0 + 1e-9).is_empty(), "size {size}");
    }
}
