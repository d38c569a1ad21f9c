//! Slow twins that share nothing but vectors with what they check.

mod flights;
mod impacts;
mod naive;
mod pairs;

use carom_geometry::{Circle, ConvexPolygon, Polygon, Shape};
use carom_math::{Pose, Vec2, vec2};
use naive::Solid;
use proptest::prelude::*;

fn ring(shape: &Shape, pose: Pose) -> Vec<Vec2> {
    shape.vertices().iter().map(|v| pose.point(*v)).collect()
}

fn solid(shape: &Shape, pose: Pose) -> Solid {
    match shape {
        Shape::Circle(disc) => Solid::Disc(pose.point(disc.centre()), disc.radius()),
        other => Solid::Ring(ring(other, pose)),
    }
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.05..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
        (3..9_usize, 0.1..1.0_f64)
            .prop_map(|(n, r)| ConvexPolygon::regular(n, r).expect("regular").into()),
        (0.01..0.1_f64, 0.5..2.0_f64)
            .prop_map(|(w, h)| ConvexPolygon::rectangle(w, h).expect("a rod").into()),
        (3..20_usize, 0.3..1.0_f64)
            .prop_map(|(n, r)| Polygon::star(n, r, 0.4 * r).expect("a star").into()),
    ]
}

#[test]
fn the_twin_itself_sees_what_overlaps() {
    let square = Solid::Ring(vec![
        vec2(-1.0, -1.0),
        vec2(1.0, -1.0),
        vec2(1.0, 1.0),
        vec2(-1.0, 1.0),
    ]);
    let disc = |x| Solid::Disc(vec2(x, 0.0), 0.5);
    assert_eq!(naive::distance(&square, &disc(1.4)), 0.0);
    assert_eq!(naive::distance(&square, &disc(1.75)), 0.25);
    // Two bars that cross without a corner in each other.
    let bar = |half: Vec2| {
        let corners = [
            vec2(-1.0, -1.0),
            vec2(1.0, -1.0),
            vec2(1.0, 1.0),
            vec2(-1.0, 1.0),
        ];
        corners.map(|c| c * half).to_vec()
    };
    let (lying, standing) = (bar(vec2(2.0, 0.25)), bar(vec2(0.25, 2.0)));
    assert_eq!(
        naive::least_overlap((&lying, &standing), (&standing, &lying)),
        2.25
    );
    assert_eq!(
        naive::distance(&Solid::Ring(lying), &Solid::Ring(standing)),
        0.0
    );
}
