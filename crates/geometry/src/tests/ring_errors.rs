use carom_math::{Vec2, vec2};
use proptest::prelude::*;

use super::strategies::ring;
use crate::{
    COORDINATE_LIMIT, Circle, ConvexPolygon, LENGTH_LIMIT, Polygon, PolygonError, Segment,
    ShapeError, ring_properties,
};

fn points<const N: usize>(points: [(f64, f64); N]) -> Vec<Vec2> {
    points.map(|(x, y)| vec2(x, y)).to_vec()
}

fn refused<const N: usize>(ring: [(f64, f64); N]) -> String {
    Polygon::new(points(ring))
        .expect_err("not a simple polygon")
        .to_string()
}

#[test]
fn an_error_names_the_vertex_and_the_number() {
    let nan = [(0.0, 0.0), (1.0, 0.0), (1.0, f64::NAN)];
    assert_eq!(
        refused(nan),
        "vertex 2 is not finite: NaN in its y coordinate"
    );
    let infinite = [(0.0, 0.0), (f64::NEG_INFINITY, 0.0), (1.0, 1.0)];
    assert_eq!(
        refused(infinite),
        "vertex 1 is not finite: -inf in its x coordinate"
    );
    let large = [(0.0, 0.0), (1.0, 0.0), (1.0, -3e12)];
    assert_eq!(
        refused(large),
        "vertex 2 is too large: -3e12 in its y coordinate, limit 1e12"
    );
    for all in [
        ConvexPolygon::new(points(nan)).is_err(),
        ring_properties(&points(large)).is_err(),
    ] {
        assert!(all);
    }
}

#[test]
fn an_error_counts_the_vertices_that_differ() {
    let few = "a polygon needs 3 distinct vertices, got";
    assert_eq!(refused([]), format!("{few} 0"));
    assert_eq!(refused([(1.0, 2.0); 5]), format!("{few} 1"));
    assert_eq!(
        refused([(0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (1.0, 0.0)]),
        format!("{few} 2")
    );
    // −0 and 0 are one place.
    assert_eq!(
        refused([(0.0, 0.0), (1.0, 0.0), (-0.0, -0.0)]),
        format!("{few} 2")
    );
}

#[test]
fn points_on_one_line_are_no_polygon_and_one_ulp_beside_it_are() {
    let degenerate = "the polygon is degenerate: its vertices enclose no area";
    assert_eq!(
        refused([(0.0, 0.0), (10.0, 10.0), (5.0, 5.0), (3.0, 3.0)]),
        degenerate
    );
    let third = 1.0 / 3.0;
    assert_eq!(refused([(0.0, 0.0), (3.0, 1.0), (6.0, 2.0)]), degenerate);
    let beside = points([(0.0, 0.0), (3.0, 1.0), (6.0, 2.0_f64.next_up())]);
    let sliver = Polygon::new(beside).expect("an area of one ulp");
    assert_eq!(sliver.area_properties().area, 1.5 * 2.0 * f64::EPSILON);
    // The nearest double to 1/3 is below it.
    assert!(Polygon::new(points([(0.0, 0.0), (1.0, third), (3.0, 1.0)])).is_ok());
}

#[test]
fn an_error_names_both_edges_as_they_were_given() {
    let meets = |first: usize, second: usize| {
        format!("the polygon intersects itself: edge {first} meets edge {second}")
    };
    let bow_tie = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
    assert_eq!(refused(bow_tie), meets(0, 2));
    let vertex_on_edge = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.0, 0.0), (0.0, 3.0)];
    assert_eq!(refused(vertex_on_edge), meets(0, 2));
    let pinched = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (2.0, 1.0),
        (2.0, 2.0),
        (1.0, 2.0),
        (1.0, 1.0),
        (0.0, 1.0),
    ];
    assert_eq!(refused(pinched), meets(1, 5));
    let spike = [
        (0.0, 0.0),
        (2.0, 0.0),
        (2.0, 2.0),
        (1.0, 2.0),
        (1.0, 5.0),
        (1.0, 2.0),
        (0.0, 2.0),
    ];
    assert_eq!(refused(spike), meets(2, 4));
    let folded = [(0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 2.0)];
    assert_eq!(refused(folded), meets(0, 1));
    let overlapping = [
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 1.0),
        (3.0, 0.0),
        (1.0, 0.0),
        (0.0, 1.0),
    ];
    assert_eq!(refused(overlapping), meets(0, 2));
    // Repetitions count in the numbering, and the winding does not change it.
    let repeated = [
        (0.0, 0.0),
        (0.0, 0.0),
        (2.0, 2.0),
        (2.0, 2.0),
        (2.0, 0.0),
        (0.0, 2.0),
        (0.0, 0.0),
    ];
    assert_eq!(refused(repeated), meets(1, 4));
    let mut clockwise = vertex_on_edge;
    clockwise.reverse();
    assert_eq!(refused(clockwise), meets(0, 3));
}

#[test]
fn the_weakly_simple_have_a_mass_and_no_collision_shape() {
    let keyhole = points([
        (-2.0, -2.0),
        (2.0, -2.0),
        (2.0, 2.0),
        (-2.0, 2.0),
        (-2.0, -2.0),
        (-1.0, -1.0),
        (-1.0, 1.0),
        (1.0, 1.0),
        (1.0, -1.0),
        (-1.0, -1.0),
    ]);
    let found = ring_properties(&keyhole).expect("an area");
    assert_eq!(
        (found.area, found.polar, found.centroid),
        (12.0, 40.0, Vec2::ZERO)
    );
    assert!(Polygon::new(keyhole).is_err());
}

#[test]
fn convex_polygons_are_strict_about_turns_and_lenient_about_order() {
    let clockwise = points([
        (0.0, 0.0),
        (0.0, 2.0),
        (1.0, 2.0),
        (2.0, 2.0),
        (2.0, 2.0),
        (2.0, 0.0),
    ]);
    let square = ConvexPolygon::new(clockwise).expect("a square");
    assert_eq!(
        square.vertices(),
        points([(2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)])
    );
    assert_eq!(square.normals(), [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y]);

    let refused = |ring: Vec<Vec2>| ConvexPolygon::new(ring).expect_err("not convex");
    let dart = points([(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)]);
    assert_eq!(refused(dart.clone()), PolygonError::NotConvex { index: 3 });
    let clockwise_dart = dart.into_iter().rev().collect();
    assert_eq!(
        refused(clockwise_dart),
        PolygonError::NotConvex { index: 0 }
    );
    // Left turns everywhere, but twice around.
    let star = [
        (1.0, 0.0),
        (-0.8, 0.6),
        (0.3, -0.9),
        (0.3, 0.9),
        (-0.8, -0.6),
    ];
    assert!(matches!(
        refused(points(star)),
        PolygonError::SelfIntersecting { .. }
    ));
    let there_and_back = points([(0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 2.0)]);
    let fold = PolygonError::SelfIntersecting {
        first: 0,
        second: 1,
    };
    assert_eq!(refused(there_and_back), fold);
}

#[test]
fn sizes_have_limits_at_both_ends() {
    let scaled = |s: f64| points([(0.0, 0.0), (s, 0.0), (0.0, s)]);
    for s in [COORDINATE_LIMIT, 1.0, 1e-23, LENGTH_LIMIT] {
        let polygon = Polygon::new(scaled(s)).expect("within the limits");
        let area = polygon.area_properties();
        assert!(
            (area.area / (0.5 * s * s) - 1.0).abs() < 1e-15,
            "{s:e}: area {}",
            area.area
        );
        assert!(
            (area.polar / (s * s * s * s / 18.0) - 1.0).abs() < 1e-15,
            "{s:e}"
        );
        assert_eq!(polygon.pieces()[0].normals()[0], -Vec2::Y);
        assert!(ConvexPolygon::hull(scaled(s)).is_ok());
    }
    let small = PolygonError::TooSmall {
        extent: 1e-31,
        limit: LENGTH_LIMIT,
    };
    assert_eq!(Polygon::new(scaled(1e-31)), Err(small));
    assert!(matches!(
        Polygon::new(scaled(2e12)),
        Err(PolygonError::TooLarge { index: 1, .. })
    ));
}

#[test]
fn circles_and_segments_name_their_field() {
    let circle = |radius: f64| Circle::new(radius).expect_err("no circle").to_string();
    assert_eq!(circle(0.0), "radius is 0, not above 0");
    assert_eq!(circle(-1.5), "radius is -1.5, not above 0");
    assert_eq!(circle(f64::INFINITY), "radius is inf, not a finite number");
    assert_eq!(circle(1e13), "radius is 1e13, outside 1e-30..1e12");
    let at = Circle::at(vec2(0.0, f64::NAN), 1.0)
        .expect_err("no place")
        .to_string();
    assert_eq!(at, "centre.y is NaN, not a finite number");
    let point = Segment::new(vec2(1.0, 2.0), vec2(1.0, 2.0)).expect_err("no length");
    assert_eq!(
        point.to_string(),
        "the segment has no length: both ends are at (1, 2)"
    );
    let polygon = ShapeError::from(PolygonError::Degenerate).to_string();
    assert_eq!(polygon, PolygonError::Degenerate.to_string());
}

proptest! {
    #[test]
    fn repetitions_and_winding_make_no_difference(ring in ring(), twice in 0..1000_usize) {
        let plain = Polygon::new(ring.clone()).expect("simple");
        let mut other = ring.clone();
        let at = twice % ring.len();
        other.insert(at, ring[at]);
        other.push(other[0]);
        prop_assert_eq!(&Polygon::new(other.clone()).expect("simple"), &plain);
        other.reverse();
        let reversed = Polygon::new(other).expect("simple");
        prop_assert_eq!(reversed.vertices().len(), plain.vertices().len());
        prop_assert!(reversed.area_properties().area > 0.0);
    }

    #[test]
    fn a_refused_ring_names_two_of_its_edges(ring in ring(), at in 0..1000_usize) {
        // Most swaps make a crossing, some only another polygon.
        let mut other = ring.clone();
        let n = ring.len();
        other.swap(at % n, (at + 1) % n);
        if let Err(error) = Polygon::new(other) {
            let PolygonError::SelfIntersecting { first, second } = error else {
                return Err(TestCaseError::fail(format!("{error}")));
            };
            prop_assert!(first < second && second < n);
        }
    }
}
