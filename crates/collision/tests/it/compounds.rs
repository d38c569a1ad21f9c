//! Compounds: one body of many parts, without ghost collisions at their seams.

use carom_collision::{PartManifold, contacts, shape_distance};
use carom_geometry::{Circle, Compound, ConvexPolygon, Segment, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

fn rectangle(width: f64, height: f64) -> Shape {
    ConvexPolygon::rectangle(width, height)
        .expect("above zero")
        .into()
}

fn at(x: f64, y: f64) -> Pose {
    Pose::at(vec2(x, y))
}

fn compound(parts: impl IntoIterator<Item = (Shape, Pose)>) -> Shape {
    Compound::new(parts).expect("parts").into()
}

/// A floor with its top at y = 0, from x = −6 to 6, in several ways.
fn floors() -> Vec<(&'static str, Shape)> {
    let tiles = |turn: f64| {
        (0..12).map(move |i| {
            let place = vec2(-5.5 + f64::from(i), -0.5);
            let quarter = Rot::from_degrees(turn * f64::from(i));
            (rectangle(1.0, 1.0), Pose::new(place, quarter))
        })
    };
    let chain = (0..12).map(|i| {
        let from = -6.0 + f64::from(i);
        let wall = Segment::new(vec2(from, 0.0), vec2(from + 1.0, 0.0)).expect("a wall");
        (wall.into(), Pose::IDENTITY)
    });
    let overlapping = (0..8).map(|i| (rectangle(2.5, 1.0), at(-4.75 + f64::from(i) * 1.3, -0.5)));
    let bricks = tiles(0.0)
        .chain((0..6).map(|i| (rectangle(2.0, 1.0), at(-5.0 + 2.0 * f64::from(i), -1.5))));
    vec![
        ("tiles", compound(tiles(0.0))),
        ("turned tiles", compound(tiles(90.0))),
        ("a chain of walls", compound(chain)),
        ("overlapping slabs", compound(overlapping)),
        ("bricks", compound(bricks)),
    ]
}

fn all(a: &Shape, b: &Shape, pose: Pose, margin: f64) -> Vec<PartManifold> {
    let mut found = Vec::new();
    contacts(a, b, pose, margin, &mut found);
    found
}

proptest! {
    #[test]
    fn what_slides_over_seams_feels_a_flat_floor(x in -4.0..4.0_f64, depth in 1e-9..0.02_f64, sides in 3..8_usize, tilt in -0.3..0.3_f64) {
        let round: Shape = Circle::new(0.5).expect("a disc").into();
        let polygon: Shape = ConvexPolygon::regular(sides, 0.5).expect("sides").into();
        for body in [round, polygon, rectangle(0.7, 0.4)] {
            for (name, floor) in floors() {
                let rotation = Rot::from_angle(tilt);
                let low = body.aabb(Pose::new(Vec2::ZERO, rotation)).min.y;
                let pose = Pose::new(vec2(x, -low - depth), rotation);
                let found = all(&floor, &body, pose, 0.0);
                prop_assert!(!found.is_empty(), "{name}: nothing under {body:?}");
                let mut deepest = 0.0_f64;
                for contact in &found {
                    let normal = contact.manifold.normal;
                    prop_assert!((normal - Vec2::Y).length() < 1e-12, "{name}: {normal} under {body:?} at {pose:?}");
                    deepest = deepest.min(contact.manifold.deepest().expect("a point"));
                }
                // If a vertex penetrates past the seam between two tiles, the reported depth is that at
                // the seam: slightly too small.
                let right = (-depth - 1e-12..=-0.75 * depth).contains(&deepest);
                prop_assert!(right, "{name}: {deepest:e} of {depth:e}");

                // The other way round.
                for contact in all(&body, &floor, pose.inverse(), 0.0) {
                    prop_assert!((pose.vector(contact.manifold.normal) + Vec2::Y).length() < 1e-12, "{name}");
                }
            }
        }
    }

    #[test]
    fn the_distance_is_that_of_the_nearest_part(x in -8.0..8.0_f64, y in -4.0..4.0_f64, turn in -4.0..4.0_f64) {
        let pose = Pose::new(vec2(x, y), Rot::from_angle(turn));
        let hexagon: Shape = ConvexPolygon::regular(6, 0.5).expect("sides").into();
        for (_, floor) in floors() {
            let Shape::Compound(parts) = &floor else { unreachable!() };
            let apart = parts.parts().iter().map(|part| shape_distance(part, &hexagon, pose).distance);
            let nearest = apart.fold(f64::INFINITY, f64::min);
            prop_assert_eq!(shape_distance(&floor, &hexagon, pose).distance, nearest);
            let back = shape_distance(&hexagon, &floor, pose.inverse()).distance;
            prop_assert!((back - nearest).abs() < 1e-13);
        }
    }
}

/// A corner that comes down through the end of one slab, under the next: 0.1 mm across that end, 17 mm deep. It was pushed
/// out along the triangle's own side, too.
#[test]
fn a_corner_beside_the_end_of_an_overlapping_slab_feels_a_flat_floor() {
    let triangle: Shape = ConvexPolygon::regular(3, 0.5).expect("sides").into();
    let slabs = compound([
        (rectangle(2.5, 1.0), at(-4.75, -0.5)),
        (rectangle(2.5, 1.0), at(-3.45, -0.5)),
    ]);
    let rotation = Rot::from_angle(-0.14);
    let low = triangle.aabb(Pose::new(Vec2::ZERO, rotation)).min.y;
    for i in 0..200 {
        let x = -3.2 + 1e-4 * f64::from(i);
        let pose = Pose::new(vec2(x, -low - 0.017), rotation);
        for contact in all(&slabs, &triangle, pose, 0.0) {
            let normal = contact.manifold.normal;
            assert!((normal - Vec2::Y).length() < 1e-12, "{normal} at {x}");
        }
    }
}

#[test]
fn the_corner_of_an_l_of_two_bars_is_felt_from_both_walls() {
    // A ball in the corner between a bar that lies and one that stands on it.
    let l = compound([
        (rectangle(4.0, 1.0), at(2.0, 0.5)),
        (rectangle(1.0, 3.0), at(0.5, 2.5)),
    ]);
    let ball: Shape = Circle::new(1.0).expect("a disc").into();
    let found = all(&l, &ball, at(1.875, 1.875), 0.0);
    let mut normals: Vec<_> = found
        .iter()
        .map(|c| (c.manifold.normal.x, c.manifold.normal.y))
        .collect();
    normals.sort_by(|p, q| p.0.total_cmp(&q.0));
    assert_eq!(normals, [(0.0, 1.0), (1.0, 0.0)]);
}

#[test]
fn an_edge_that_another_part_half_covers_is_still_touched_beside_it() {
    let step = compound([
        (rectangle(4.0, 1.0), at(0.0, -0.5)),
        (rectangle(1.0, 1.0), at(0.0, 0.5)),
    ]);
    let box_ = rectangle(0.5, 0.5);
    let found = all(&step, &box_, at(1.25, 0.25 - 1e-3), 0.0);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].manifold.normal, Vec2::Y);
    assert_eq!(found[0].manifold.points.len(), 2);
}
