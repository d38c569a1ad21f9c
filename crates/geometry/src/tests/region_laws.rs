use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

use super::random_laws::numbers;
use crate::{AreaProperties, ConvexPolygon, Polygon, Region, ring_properties};

fn square(side: f64, centre: Vec2) -> Vec<Vec2> {
    let square = ConvexPolygon::square(side)
        .expect("a square")
        .translated(centre);
    square.vertices().to_vec()
}

/// A rock with up to nine rocks missing in its middle, either way round.
fn rings() -> impl Strategy<Value = (Vec<Vec2>, Vec<Vec<Vec2>>)> {
    (any::<u64>(), 0..=9_usize, 4..40_usize).prop_map(|(seed, holes, corners)| {
        let mut next = numbers(seed);
        let mut rock = |inner: f64, outer: f64, centre: Vec2| {
            let rock = Polygon::random_star(corners, inner, outer, &mut next).expect("simple");
            let mut ring = rock.translated(centre).vertices().to_vec();
            if next() < 0.5 {
                ring.reverse();
            }
            ring
        };
        // Neighbours are at most 171 degrees apart: no edge is nearer than 30 cos 85.5° = 2.35 m.
        let outer = rock(30.0, 31.0, Vec2::ZERO);
        let place = |i: usize| vec2((i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0);
        let holes = (0..holes).map(|i| rock(0.1, 0.4, place(i))).collect();
        (outer, holes)
    })
}

proptest! {
    #[test]
    fn a_region_is_the_outer_ring_without_its_holes((outer, holes) in rings(), x in -2.0..2.0_f64, y in -2.0..2.0_f64, w in 0.0..7.0_f64) {
        let region = Region::new(outer.clone(), holes.clone()).expect("apart");
        let of = |ring: &[Vec2]| ring_properties(ring).expect("an area");
        let (all, missing) = (of(&outer), holes.iter().map(|hole| of(hole)));
        let filled = missing.fold(region.area_properties(), |sum, hole| sum + hole);
        prop_assert!((filled.area / all.area - 1.0).abs() < 1e-14);
        prop_assert!((filled.polar / all.polar - 1.0).abs() < 1e-14);
        prop_assert!((filled.centroid - all.centroid).length() < 1e-13);

        let p = vec2(x, y);
        let inside = |ring: &Vec<Vec2>| Polygon::new(ring.clone()).expect("simple").contains(p);
        prop_assert_eq!(region.contains(p), inside(&outer) && !holes.iter().any(inside));
        let (closest, distance) = (region.closest_rim_point(p), region.signed_distance(p));
        prop_assert!((distance.abs() - closest.distance(p)).abs() < 1e-14);
        prop_assert!(region.signed_distance(closest).abs() < 1e-14);
        if let Some(hit) = region.cast_ray(p, Rot::from_angle(w).x_axis(), 100.0) {
            prop_assert!(distance > 0.0 && hit.distance >= distance - 1e-13, "out of a hole");
            prop_assert!(region.signed_distance(hit.point).abs() < 1e-13);
        } else {
            prop_assert!(distance <= 0.0, "all around a hole there is something");
        }
    }

    #[test]
    fn a_hole_that_leaves_the_outer_ring_is_named((outer, holes) in rings(), which in 0..9_usize) {
        prop_assume!(which < holes.len());
        let mut holes = holes;
        let moved = |by: Vec2| holes[which].iter().map(|p| *p + by).collect::<Vec<Vec2>>();
        let away = moved(vec2(100.0, 0.0));
        // Half a radius beyond the last corner to the right.
        let right = outer.iter().copied().reduce(|a, b| if b.x > a.x { b } else { a }).expect("corners");
        let centre = vec2((which % 3) as f64 - 1.0, (which / 3) as f64 - 1.0);
        let across = moved(right - centre);
        holes[which] = away;
        let error = Region::new(outer.clone(), holes.clone()).expect_err("outside").to_string();
        prop_assert_eq!(error, format!("ring {}, a hole, lies outside of the outer ring", which + 1));
        holes[which] = across;
        let error = Region::new(outer, holes).expect_err("across").to_string();
        let end = format!(" of ring {}", which + 1);
        prop_assert!(error.contains(" of ring 0 meets edge ") && error.ends_with(&end), "{}", error);
    }
}

#[test]
fn a_thin_frame_far_away_keeps_its_digits() {
    // 2⁻²⁶ m thin, 2²⁶ m out: all corners are doubles.
    let (far, thin) = (
        vec2(67_108_864.0, -67_108_864.0),
        1.0 / (1_u64 << 26) as f64,
    );
    let frame = Region::new(square(2.0, far), [square(2.0 - 2.0 * thin, far)]).expect("apart");
    let found = frame.area_properties();
    let inner = 2.0 - 2.0 * thin;
    // 4 − inner² and (2⁴ − inner⁴)/6, multiplied out.
    let area = 2.0 * thin * (2.0 + inner);
    assert!(
        (found.area / area - 1.0).abs() < 2e-13,
        "{} instead of {area}",
        found.area
    );
    let polar = area * (4.0 + inner * inner) / 6.0;
    assert!(
        (found.polar / polar - 1.0).abs() < 2e-13,
        "{} instead of {polar}",
        found.polar
    );
    assert_eq!(found.centroid, far);
}

#[test]
fn rings_that_do_not_fit_are_named() {
    let refused = |outer: Vec<Vec2>, holes: Vec<Vec<Vec2>>| {
        Region::new(outer, holes)
            .expect_err("no region")
            .to_string()
    };
    let outer = square(8.0, Vec2::ZERO);
    let at = |x: f64| square(2.0, vec2(x, 0.0));
    assert_eq!(
        refused(outer.clone(), vec![at(-2.0), square(1.0, vec2(-2.0, 0.0))]),
        "ring 2, a hole, lies inside of ring 1, another"
    );
    // A common corner is contact.
    assert_eq!(
        refused(outer.clone(), vec![at(-1.0), square(2.0, vec2(1.0, 2.0))]),
        "edge 1 of ring 1 meets edge 0 of ring 2"
    );
    assert_eq!(
        refused(outer.clone(), vec![square(8.0, vec2(0.0, 1.0))]),
        "edge 1 of ring 0 meets edge 0 of ring 1"
    );
    assert_eq!(
        refused(outer.clone(), vec![vec![Vec2::ZERO, Vec2::X]]),
        "ring 1: a polygon needs 3 distinct vertices, got 2"
    );
    let bow_tie = vec![
        vec2(0.0, 0.0),
        vec2(1.0, 1.0),
        vec2(1.0, 0.0),
        vec2(0.0, 1.0),
    ];
    assert_eq!(
        refused(outer.clone(), vec![at(2.5), bow_tie]),
        "ring 2: the polygon intersects itself: edge 0 meets edge 2"
    );
    let whole = Polygon::new(outer.clone()).expect("simple");
    let none: [Vec<Vec2>; 0] = [];
    assert_eq!(
        Region::from(whole),
        Region::new(outer, none).expect("no holes")
    );
}

#[test]
fn many_parts_add_up_as_well_as_few() {
    // A hundred thousand unit squares in a row, 1e8 m away: n² h / 12 alone has eleven digits.
    let count = 100_000;
    let parts = (0..count).map(|i| AreaProperties {
        area: 1.0,
        centroid: vec2(1e8 + f64::from(i), 0.5),
        polar: 1.0 / 6.0,
        ixx: 1.0 / 12.0,
        iyy: 1.0 / 12.0,
        ixy: 0.0,
    });
    let sum: AreaProperties = parts.sum();
    let n = f64::from(count);
    assert_eq!(
        (sum.area, sum.centroid),
        (n, vec2(1e8 + 0.5 * (n - 1.0), 0.5))
    );
    let polar = n * (n * n + 1.0) / 12.0;
    assert!(
        (sum.polar / polar - 1.0).abs() < 4e-16,
        "{} instead of {polar}",
        sum.polar
    );
    assert!((sum.iyy / (n * n * n / 12.0) - 1.0).abs() < 4e-16);
}
