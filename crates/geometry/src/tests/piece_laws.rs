use carom_math::{Vec2, orient2d, vec2};
use proptest::prelude::*;

use super::random_laws::numbers;
use super::strategies::{cloud, ring};
use crate::ears::{OUTLINE, Triangles};
use crate::ring::corners;
use crate::{AreaProperties, ConvexPolygon, Polygon, monotone, ring_properties};

/// A simple ring on so small a grid that edges along an axis and points on one line abound.
fn grid_ring() -> impl Strategy<Value = Vec<Vec2>> {
    (any::<u64>(), 4..12_usize).prop_filter_map("simple", |(seed, count)| {
        let mut next = numbers(seed);
        (0..200).find_map(|_| {
            let mut place = || (6.0 * next()).floor();
            let ring: Vec<Vec2> = (0..count).map(|_| vec2(place(), place())).collect();
            Some(Polygon::new(ring).ok()?.vertices().to_vec())
        })
    })
}

/// Everything that triangles of a ring without straight corners promise.
fn assert_triangles(ring: &[Vec2], triangles: &Triangles) {
    let Triangles { origins, twins } = triangles;
    assert_eq!(
        (origins.len(), twins.len()),
        (3 * (ring.len() - 2), origins.len())
    );
    let end = |edge: usize| origins[edge - edge % 3 + (edge + 1) % 3];
    let mut sum = 0.0;
    for (t, corners) in origins.chunks_exact(3).enumerate() {
        let [a, b, c] = [ring[corners[0]], ring[corners[1]], ring[corners[2]]];
        assert!(
            orient2d(a, b, c) > 0.0,
            "triangle {t} of {ring:?} is {a} {b} {c}"
        );
        sum += ring_properties(&[a, b, c]).expect("an area").area;
    }
    // Counter-clockwise triangles of the ring's own area that share edges cannot overlap.
    let whole = ring_properties(ring).expect("an area").area;
    assert!((sum / whole - 1.0).abs() < 2e-13, "areas {sum} and {whole}");
    for (edge, &twin) in twins.iter().enumerate() {
        if twin == OUTLINE {
            assert_eq!(end(edge), (origins[edge] + 1) % ring.len());
        } else {
            assert_eq!(
                (twins[twin], origins[twin], end(twin)),
                (edge, end(edge), origins[edge])
            );
        }
    }
}

/// Everything that pieces promise.
fn assert_pieces(polygon: &Polygon) {
    let outline = polygon.vertices();
    let n = outline.len();
    let straight =
        |i: usize| orient2d(outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]) == 0.0;
    let corners: Vec<Vec2> = (0..n)
        .filter(|i| !straight(*i))
        .map(|i| outline[i])
        .collect();
    let reflex = (0..n)
        .filter(|&i| orient2d(outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]) < 0.0)
        .count();

    let mut parts = Vec::new();
    let mut boundary: Vec<[u64; 4]> = Vec::new();
    let mut cuts: Vec<[u64; 4]> = Vec::new();
    for piece in polygon.pieces() {
        let vertices = piece.vertices();
        let m = vertices.len();
        assert_eq!((piece.normals().len(), piece.cones().len()), (m, m));
        for i in 0..m {
            let (a, b, c) = (vertices[i], vertices[(i + 1) % m], vertices[(i + 2) % m]);
            assert!(
                orient2d(a, b, c) > 0.0,
                "piece {vertices:?} is not convex at {b}"
            );
            let list = if piece.is_boundary(i) {
                &mut boundary
            } else {
                &mut cuts
            };
            list.push([a.x, a.y, b.x, b.y].map(f64::to_bits));
            let normal = piece.normals()[i];
            assert!((normal.length() - 1.0).abs() < 1e-15);
            assert!(normal.dot(b - a).abs() <= 1e-15 * (b - a).length());
            if piece.is_boundary(i) && !piece.cones()[i].is_empty() {
                assert!(
                    piece.cones()[i].contains(normal),
                    "an edge's normal is at its corner"
                );
            }
        }
        parts.push(ring_properties(vertices).expect("a piece has an area"));
    }
    let sum: AreaProperties = parts.into_iter().sum();
    let whole = polygon.area_properties();
    assert!(
        (sum.area / whole.area - 1.0).abs() <= 1e-13,
        "areas {} and {}",
        sum.area,
        whole.area
    );
    assert!(
        (sum.polar / whole.polar - 1.0).abs() <= 1e-13,
        "moments {} and {}",
        sum.polar,
        whole.polar
    );

    let mut edges: Vec<[u64; 4]> = (0..corners.len())
        .map(|i| (corners[i], corners[(i + 1) % corners.len()]))
        .map(|(a, b)| [a.x, a.y, b.x, b.y].map(f64::to_bits))
        .collect();
    edges.sort_unstable();
    boundary.sort_unstable();
    assert_eq!(
        boundary, edges,
        "true edges of the pieces are those of the outline"
    );
    let mut back: Vec<[u64; 4]> = cuts.iter().map(|[a, b, c, d]| [*c, *d, *a, *b]).collect();
    cuts.sort_unstable();
    back.sort_unstable();
    assert_eq!(cuts, back, "each cut has two sides");
    assert!(
        polygon.pieces().len() <= 2 * reflex + 1,
        "{} pieces",
        polygon.pieces().len()
    );
}

proptest! {
    #[test]
    fn pieces_are_convex_and_make_up_the_polygon(ring in ring(), clockwise in any::<bool>()) {
        let mut ring = ring;
        if clockwise {
            ring.reverse();
        }
        assert_pieces(&Polygon::new(ring).expect("simple"));
    }

    #[test]
    fn the_sweep_cuts_any_ring_into_triangles(ring in prop_oneof![ring(), grid_ring()]) {
        let ring = Polygon::new(ring).expect("simple").vertices().to_vec();
        let bent: Vec<Vec2> = corners(&ring)
            .filter(|(before, here, after)| orient2d(*before, *here, *after) != 0.0)
            .map(|(_, here, _)| here)
            .collect();
        let triangles = monotone::triangulate(&bent).expect("no predicate underflows");
        assert_triangles(&bent, &triangles);
    }

    #[test]
    fn pieces_of_random_outlines_make_them_up(seed in any::<u64>(), count in 3..300_usize) {
        assert_pieces(&Polygon::random(count, 2.0, 1.0, &mut numbers(seed)).expect("simple"));
    }

    #[test]
    fn a_hull_is_convex_and_contains_its_points(points in cloud()) {
        let Ok(hull) = ConvexPolygon::hull(points.clone()) else {
            // All on one line: as far as exact signs can tell.
            let (a, b) = (points[0], points.iter().copied().find(|p| *p != points[0]));
            let b = b.unwrap_or(a);
            prop_assert!(points.iter().all(|p| orient2d(a, b, *p) == 0.0));
            return Ok(());
        };
        prop_assert!(points.iter().all(|p| hull.contains(*p)));
        prop_assert!(hull.vertices().iter().all(|v| points.contains(v)));
        let again = ConvexPolygon::new(hull.vertices()).expect("strictly convex");
        prop_assert_eq!(&again, &hull);
        prop_assert_eq!(ConvexPolygon::hull(again.vertices()).expect("a hull"), hull);
    }
}

#[test]
fn large_outlines_of_every_kind_are_cut() {
    let count = 2_000;
    let spiral = |i: usize, r: f64| {
        let turn = i as f64 * 0.02;
        carom_math::Rot::from_angle(turn) * vec2(r + turn, 0.0)
    };
    let there = (0..count).map(|i| spiral(i, 10.0));
    let back = (0..count).rev().map(|i| spiral(i, 14.0));
    assert_pieces(&Polygon::new(there.chain(back).collect::<Vec<Vec2>>()).expect("simple"));
    assert_pieces(&Polygon::star(count, 1.0, 0.1).expect("simple"));
    assert_pieces(&Polygon::star(count, 1.0, 0.999_999).expect("simple"));
    // All reflex corners on one line: a search that looks at long cuts too early is quadratic here.
    let mut comb = vec![
        vec2(8.0 * count as f64, -1.0),
        vec2(8.0 * count as f64, 0.0),
    ];
    for i in (0..8 * count).rev().step_by(2) {
        let x = i as f64;
        comb.extend([
            vec2(x, 0.0),
            vec2(x, 50.0),
            vec2(x - 1.0, 50.0),
            vec2(x - 1.0, 0.0),
        ]);
    }
    comb.push(vec2(-1.0, -1.0));
    assert_pieces(&Polygon::new(comb).expect("simple"));
    let saw = |i: usize| vec2(i as f64, if i.is_multiple_of(2) { 0.0 } else { 1000.0 });
    let below = (0..count).map(|i| saw(i) - vec2(0.0, 1.0));
    let above = (0..count).rev().map(saw);
    assert_pieces(&Polygon::new(below.chain(above).collect::<Vec<Vec2>>()).expect("simple"));
}

#[test]
fn few_pieces_where_few_are_enough() {
    let plus = [
        (-0.5, -1.5),
        (0.5, -1.5),
        (0.5, -0.5),
        (1.5, -0.5),
        (1.5, 0.5),
        (0.5, 0.5),
        (0.5, 1.5),
        (-0.5, 1.5),
        (-0.5, 0.5),
        (-1.5, 0.5),
        (-1.5, -0.5),
        (-0.5, -0.5),
    ];
    let plus = Polygon::new(plus.map(|(x, y)| vec2(x, y))).expect("simple");
    assert_pieces(&plus);
    assert!(
        plus.pieces().len() <= 5,
        "{} pieces of a plus",
        plus.pieces().len()
    );
    let regular = ConvexPolygon::regular(1000, 1.0).expect("convex");
    assert_eq!(Polygon::from(regular).pieces().len(), 1);
}

#[test]
fn cones_are_those_of_the_outline_not_of_the_piece() {
    // A step: its reflex corner cannot be touched, its tips have a quarter turn of normals.
    let l = [
        (0.0, 0.0),
        (3.0, 0.0),
        (3.0, 1.0),
        (1.0, 1.0),
        (1.0, 2.0),
        (0.0, 2.0),
    ];
    let l = Polygon::new(l.map(|(x, y)| vec2(x, y))).expect("simple");
    for piece in l.pieces() {
        for (vertex, cone) in piece.vertices().iter().zip(piece.cones()) {
            let reflex = *vertex == vec2(1.0, 1.0);
            assert_eq!(cone.is_empty(), reflex, "at {vertex}");
            if *vertex == vec2(3.0, 1.0) {
                assert!(cone.contains(Vec2::X) && cone.contains(Vec2::Y));
                assert!(cone.contains(vec2(0.6, 0.8)));
                assert!(!cone.contains(-Vec2::X) && !cone.contains(vec2(1.0, -1e-8)));
                assert!(!cone.contains(vec2(-0.6, -0.8)));
            }
        }
    }
}
