//! The area two shapes share: against sums over a grid, and laws.

use carom_collision::{overlap_area, shape_distance};
use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Shape};
use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::shapes::{concave, convex, pair, turn};

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        convex().prop_map(Shape::from),
        concave().prop_map(Shape::from),
        (0.2..1.0_f64).prop_map(|r| Circle::new(r).expect("a disc").into()),
    ]
}

/// Points of a grid in both, times the area of a cell.
fn counted(a: &Shape, b: &Shape, pose: Pose) -> f64 {
    let bounds = a.aabb(Pose::IDENTITY);
    let cells = 160;
    let cell = bounds.extents() / f64::from(cells);
    let mut count = 0.0;
    for i in 0..cells {
        for j in 0..cells {
            let p = bounds.min + cell * vec2(f64::from(i) + 0.5, f64::from(j) + 0.5);
            if a.contains(p) && b.contains(pose.inverse_point(p)) {
                count += 1.0;
            }
        }
    }
    count * cell.x * cell.y
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn it_is_the_area_that_a_grid_counts(a in shape(), b in shape(), x in -1.5..1.5_f64, y in -1.5..1.5_f64, rotation in turn()) {
        let pose = Pose::new(vec2(x, y), rotation);
        let area = overlap_area(&a, &b, pose);
        let bounds = a.aabb(Pose::IDENTITY).extents();
        // Cells along the rims are counted wrong at random: a few rows of the grid at most.
        let slack = bounds.x * bounds.y * 0.02;
        prop_assert!((area - counted(&a, &b, pose)).abs() < slack, "{area}");
    }
}

proptest! {
    #[test]
    fn it_is_symmetric_and_at_most_that_of_either(a in shape(), b in shape(), x in -1.5..1.5_f64, y in -1.5..1.5_f64, rotation in turn()) {
        let pose = Pose::new(vec2(x, y), rotation);
        let area = overlap_area(&a, &b, pose);
        prop_assert!((area - overlap_area(&b, &a, pose.inverse())).abs() < 1e-13);
        let whole = |shape: &Shape| shape.area_properties().expect("bounded").area;
        prop_assert!((0.0..=whole(&a).min(whole(&b)) + 1e-13).contains(&area));
        if shape_distance(&a, &b, pose).distance > 0.0 {
            prop_assert!(area < 1e-15);
        }
        // All of it, when the other one is everywhere.
        let everywhere = HalfPlane::new(vec2(0.0, 10.0), Vec2::Y).expect("a line").into();
        prop_assert!((overlap_area(&everywhere, &a, pose) - whole(&a)).abs() < 1e-13);
        let line: Shape = HalfPlane::new(vec2(x, y), rotation.x_axis()).expect("a line").into();
        let other: Shape = HalfPlane::new(vec2(x, y), -rotation.x_axis()).expect("a line").into();
        let halves = overlap_area(&a, &line, Pose::IDENTITY) + overlap_area(&a, &other, Pose::IDENTITY);
        prop_assert!((halves - whole(&a)).abs() < 1e-13);
    }

    #[test]
    fn convex_shapes_share_area_exactly_when_they_overlap(pair in pair()) {
        let area = overlap_area(&pair.a.clone().into(), &pair.b.clone().into(), pair.pose);
        let depth = -carom_collision::separating_axis(&crate::shapes::hull(&pair.a), &crate::shapes::hull(&pair.b), pair.pose).separation;
        if depth > 1e-9 * pair.size {
            prop_assert!(area > 0.0, "depth {depth:e}");
        } else if depth < 0.0 {
            prop_assert!(area < 1e-14 * pair.size * pair.size);
        }
    }
}

#[test]
fn two_discs_share_a_lens() {
    let disc = |r: f64| -> Shape { Circle::new(r).expect("a disc").into() };
    let at = |x: f64| Pose::at(vec2(x, 0.0));
    // Unit discs a unit apart: 2π/3 − √3/2.
    let want = 2.0 * core::f64::consts::FRAC_PI_3 - 0.75_f64.sqrt();
    assert!((overlap_area(&disc(1.0), &disc(1.0), at(1.0)) - want).abs() < 1e-15);
    assert_eq!(overlap_area(&disc(1.0), &disc(2.0), at(3.0)), 0.0);
    assert!((overlap_area(&disc(1.0), &disc(2.0), at(0.5)) - core::f64::consts::PI).abs() < 1e-15);
    let square: Shape = ConvexPolygon::square(2.0).expect("a square").into();
    let turned = Pose::new(Vec2::ZERO, Rot::from_degrees(45.0));
    // Two squares at 45 degrees share a regular octagon of inradius 1: 8 tan(22.5°).
    let octagon = 8.0 * (core::f64::consts::SQRT_2 - 1.0);
    assert!((overlap_area(&square, &square, turned) - octagon).abs() < 1e-14);
}
