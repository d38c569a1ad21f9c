use carom_math::{Rot, Vec2, vec2};
use proptest::prelude::*;

use super::strategies::{ring, shift, star};
use crate::{AreaProperties, Polygon, inertia, ring_properties};

/// Bound of the reference cases: relative for area and moments, of the size for the centroid.
const CLOSE: f64 = 2e-13;

fn of(ring: &[Vec2]) -> AreaProperties {
    ring_properties(ring).expect("rings of the strategies enclose an area")
}

fn assert_same(a: &AreaProperties, b: &AreaProperties, size: f64, close: f64) {
    assert!(
        (a.area / b.area - 1.0).abs() <= close,
        "areas {} and {}",
        a.area,
        b.area
    );
    assert!(
        (a.polar / b.polar - 1.0).abs() <= close,
        "moments {} and {}",
        a.polar,
        b.polar
    );
    let apart = (a.centroid - b.centroid).abs().max_element();
    let ulp = 2.0 * f64::EPSILON * a.centroid.abs().max_element();
    assert!(
        apart <= close * size + ulp,
        "centroids {} and {}",
        a.centroid,
        b.centroid
    );
}

fn size_of(ring: &[Vec2]) -> f64 {
    ring.iter()
        .map(|p| (*p - ring[0]).length())
        .fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn winding_and_first_vertex_do_not_count(ring in ring(), start in 0..1000_usize) {
        let whole = of(&ring);
        let mut other = ring.clone();
        other.reverse();
        other.rotate_left(start % ring.len());
        assert_same(&whole, &of(&other), size_of(&ring), CLOSE);
    }

    #[test]
    fn an_exact_shift_moves_the_centroid_and_nothing_else(ring in star(), shift in shift()) {
        let moved: Vec<Vec2> = ring.iter().map(|p| *p + shift).collect();
        assert_same(&of(&ring).translated(shift), &of(&moved), size_of(&ring), CLOSE);
        prop_assert_eq!(of(&ring).area, of(&moved).area, "only differences count");
        prop_assert_eq!(of(&ring).polar, of(&moved).polar, "only differences count");
    }

    #[test]
    fn a_quarter_turn_swaps_the_axes(ring in ring()) {
        let turned: Vec<Vec2> = ring.iter().map(|p| vec2(-p.y, p.x)).collect();
        let (a, b) = (of(&ring).rotated(Rot::from_degrees(90.0)), of(&turned));
        assert_same(&a, &b, size_of(&ring), CLOSE);
        prop_assert!((a.ixx - b.ixx).abs() <= CLOSE * a.polar);
        prop_assert!((a.ixy - b.ixy).abs() <= CLOSE * a.polar);
    }

    #[test]
    fn a_turn_keeps_area_and_polar_moment(ring in star(), angle in -7.0..7.0_f64) {
        // Turned vertices are rounded: each moves by an ulp, which counts along the whole girth.
        let rot = Rot::from_angle(angle);
        let turned: Vec<Vec2> = ring.iter().map(|p| rot * *p).collect();
        let (a, b) = (of(&ring).rotated(rot), of(&turned));
        let girth: f64 = ring.windows(2).map(|e| e[0].distance(e[1])).sum();
        assert_same(&a, &b, 1.0, 8.0 * f64::EPSILON * girth * girth / a.polar.min(a.area));
        let (largest, smallest, axis) = b.principal_axes();
        prop_assert!((largest + smallest - b.polar).abs() <= 1e-14 * b.polar);
        let upright = b.rotated(axis.inverse());
        prop_assert!(upright.ixy.abs() <= 1e-14 * b.polar, "product moment {}", upright.ixy);
        prop_assert!((upright.ixx - largest).abs() <= 1e-14 * b.polar);
    }

    #[test]
    fn both_sides_of_a_diagonal_make_the_whole(ring in ring(), which in 0..1000_usize) {
        let polygon = Polygon::new(ring.clone()).expect("simple");
        let cuts: Vec<(Vec2, Vec2)> = polygon
            .pieces()
            .iter()
            .flat_map(|piece| {
                let n = piece.vertices().len();
                let end = move |i: usize| piece.vertices()[i % n];
                (0..n).filter(|i| !piece.is_boundary(*i)).map(move |i| (end(i), end(i + 1)))
            })
            .collect();
        // A convex ring has no cut: its own diagonal serves.
        let (from, to) = if cuts.is_empty() {
            (0, 2)
        } else {
            let (a, b) = cuts[which % cuts.len()];
            let at = |p: Vec2| ring.iter().position(|q| *q == p).expect("no new vertices");
            (at(a).min(at(b)), at(a).max(at(b)))
        };
        let one = &ring[from..=to];
        let two = [&ring[to..], &ring[..=from]].concat();
        let (Ok(one), Ok(two)) = (ring_properties(one), ring_properties(&two)) else {
            // Three points on one line.
            return Ok(());
        };
        let (sum, whole) = (one + two, of(&ring));
        assert_same(&sum, &whole, size_of(&ring), CLOSE);
        let mass = one.with_density(3.0) + two.with_density(3.0);
        prop_assert!((mass.inertia / whole.with_density(3.0).inertia - 1.0).abs() <= CLOSE);
        prop_assert!((mass.mass / (3.0 * whole.area) - 1.0).abs() <= CLOSE);
    }

    #[test]
    fn the_sums_of_the_documents_agree(ring in star(), mass in 0.1..10.0_f64) {
        let whole = of(&ring);
        let fan = inertia::fan(mass, whole.centroid, &ring);
        let about = vec2(0.3, -0.2);
        let right_triangles = inertia::polygon_by_right_triangles(
            &ring.iter().map(|p| *p - about).collect::<Vec<Vec2>>(),
        );
        // Plain sums: they lose what cancels.
        prop_assert!((fan / whole.with_mass(mass).inertia - 1.0).abs() < 1e-11);
        prop_assert!((right_triangles / whole.polar_about(about) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_bent_strip_keeps_its_thirteen_digits() {
    // 1e-12 thin: the cross products cancel to the last digits of a double.
    let thin = 1.0 / (1_u64 << 40) as f64;
    let ring = [
        vec2(0.0, 0.0),
        vec2(8.0, 8.0),
        vec2(16.0, 0.0),
        vec2(16.0, thin),
        vec2(8.0, 8.0 + thin),
        vec2(0.0, thin),
    ];
    let found = of(&ring);
    assert_eq!(found.area, 16.0 * thin);
    assert_eq!(found.centroid, vec2(8.0, 4.0 + 0.5 * thin));
    // Along x 16²/12 per area, along y the same slope: 8²/12, and thin²/12 across.
    let polar = 16.0 * thin * (256.0 + 64.0 + thin * thin) / 12.0;
    assert!(
        (found.polar / polar - 1.0).abs() < 1e-15,
        "{} instead of {polar}",
        found.polar
    );
}

#[test]
fn a_weight_at_the_end_of_a_long_needle_is_no_less_exact() {
    // Begun at the tip, 1e6 away from all the mass.
    let ring = [
        vec2(1_048_576.0, 0.0),
        vec2(0.0, 0.5),
        vec2(-1.0, 0.5),
        vec2(-1.0, -0.5),
        vec2(0.0, -0.5),
    ];
    let found = of(&ring);
    let square = of(&ring[1..]);
    let needle = of(&[ring[4], ring[0], ring[1]]);
    assert_same(&found, &(square + needle), 1e6, 1e-15);
}

#[test]
fn no_area_is_an_error_and_not_a_small_number() {
    let bow_tie = [
        vec2(0.0, 0.0),
        vec2(1.0, 1.0),
        vec2(1.0, 0.0),
        vec2(0.0, 1.0),
    ];
    let third = 1.0 / 3.0;
    let line = [
        vec2(0.1, 0.1),
        vec2(0.7, 0.7),
        vec2(third, third),
        vec2(1e5 / 3.0, 1e5 / 3.0),
    ];
    for ring in [bow_tie, line] {
        assert!(ring_properties(&ring).is_err(), "{ring:?}");
    }
}
