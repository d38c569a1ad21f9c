//! What went wrong in other engines' shapes and masses, by the number of the list.

use carom_dynamics::{BodyDef, Material, Settings, World};
use carom_geometry::{
    AreaProperties, ConvexPiece, ConvexPolygon, Polygon, PolygonError, Region, inertia,
    ring_properties,
};
use carom_math::{Rot, Vec2, cross, orient2d, vec2};

/// A coordinate in single precision, by its bits: as the reports give them.
fn single(bits: u32) -> f64 {
    f64::from(f32::from_bits(bits))
}

/// The same by its decimal digits.
fn rounded(points: &[(f32, f32)]) -> Vec<Vec2> {
    points
        .iter()
        .map(|(x, y)| vec2(f64::from(*x), f64::from(*y)))
        .collect()
}

/// Area, centroid and polar moment by triangles about the first vertex, each by the lengths of its
/// sides. Single precision leaves the differences exact.
fn by_triangles(ring: &[Vec2]) -> (f64, Vec2, f64) {
    let local: Vec<Vec2> = ring.iter().map(|p| *p - ring[0]).collect();
    let triangles = || local.windows(2).skip(1).map(|edge| (edge[0], edge[1]));
    let area_of = |(p, q): (Vec2, Vec2)| 0.5 * cross(p, q);
    let area: f64 = triangles().map(area_of).sum();
    let centroid = triangles()
        .map(|t| (t.0 + t.1) * (area_of(t) / 3.0))
        .sum::<Vec2>()
        / area;
    let polar: f64 = triangles()
        .map(|(p, q)| {
            let own = inertia::triangle(area_of((p, q)), p.length(), q.length(), p.distance(q));
            own + area_of((p, q)) * ((p + q) / 3.0 - centroid).length_squared()
        })
        .sum();
    (area.abs(), ring[0] + centroid, polar.abs())
}

/// The ring has a mass, in every call, and it is the right one.
#[track_caller]
fn assert_mass(ring: &[Vec2]) {
    let (area, centroid, polar) = by_triangles(ring);
    let check = |name: &str, found: AreaProperties| {
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-13;
        assert!(
            close(found.area, area),
            "{name}: area {} instead of {area}",
            found.area
        );
        assert!(
            close(found.polar, polar),
            "{name}: moment {} instead of {polar}",
            found.polar
        );
        let apart = found.centroid.distance(centroid);
        let ulps = 4.0 * f64::EPSILON * centroid.length();
        assert!(
            apart <= 1e-13 * area.sqrt() + ulps,
            "{name}: centroid {}",
            found.centroid
        );
    };
    check("ring", ring_properties(ring).expect("an area"));
    check(
        "polygon",
        Polygon::new(ring).expect("simple").area_properties(),
    );
    let convex = ConvexPolygon::new(ring).expect("convex");
    check("convex", convex.area_properties());
    check(
        "hull",
        ConvexPolygon::hull(ring).expect("a hull").area_properties(),
    );
    let mut world = World::new(Settings::default()).expect("valid");
    let material = Material {
        density: 1.0,
        ..Material::default()
    };
    let body = world
        .insert(BodyDef::dynamic(), convex, material)
        .expect("a body");
    let body = world.body(body).expect("inserted");
    assert!((body.mass() / area - 1.0).abs() < 1e-13 && body.inertia() > 0.0);
    assert!((body.inertia() / polar - 1.0).abs() < 1e-13);
}

/// erincatto/box2d#1006: five vertices 1126 m from the body's origin had a negative inertia.
#[test]
fn case_01_a_polygon_far_from_its_body_has_an_inertia() {
    assert_mass(&rounded(&[
        (1_125.696_9, -4.0),
        (1_126.171_1, -4.0),
        (1_126.397_6, -3.566_345_2),
        (1_126.115_6, -3.500_198_4),
        (1_125.868_4, -3.486_084),
    ]));
}

/// erincatto/box2d#949: valid in every check, and the inertia of its body was not above 0.
#[test]
fn case_02_what_is_valid_once_is_valid_in_every_call() {
    assert_mass(&rounded(&[
        (48.76, -60.57),
        (48.74, -60.54),
        (48.68, -60.56),
    ]));
}

/// erincatto/box2d#756: a triangle 7 cm high at x = −71, by its bits.
#[test]
fn case_03_a_small_triangle_by_its_bits_has_an_inertia() {
    assert_mass(&[
        vec2(single(0xc28e_8d90), single(0x4210_0000)),
        vec2(single(0xc28e_b4be), single(0x4210_4e5f)),
        vec2(single(0xc28e_bf3e), single(0x4210_0000)),
    ]);
}

/// erincatto/box2d#728: gift wrapping went round and round; a first mend failed for the second one.
#[test]
fn case_04_hulls_of_nearly_straight_hexagons_end() {
    let nearly_straight = [
        (0xc107_8533, 0x3f0b_ab5e),
        (0xc0f5_b2e8, 0x3f28_af8c),
        (0xc0e2_b14a, 0x3f3e_72ae),
        (0xc0eb_c298, 0x402e_521e),
        (0xc115_8ea9, 0x401c_2f82),
        (0xc111_0602, 0x3eeb_d078),
    ];
    let box_with_a_belly = [
        (0x3f80_0000, 0xbf80_0000),
        (0x3f80_0000, 0x3f80_0000),
        (0xbf80_0000, 0x3f80_0000),
        (0xbf80_0000, 0xbf80_0000),
        (0xbf09_f775, 0xbf87_6e83),
        (0x3f37_87c5, 0xbf81_f4d7),
    ];
    for bits in [nearly_straight, box_with_a_belly] {
        let ring = bits.map(|(x, y)| vec2(single(x), single(y)));
        let hull = ConvexPolygon::hull(ring).expect("a hull");
        let v = hull.vertices();
        let turns =
            (0..v.len()).map(|i| orient2d(v[i], v[(i + 1) % v.len()], v[(i + 2) % v.len()]));
        assert!(v.len() <= 6 && turns.into_iter().all(|turn| turn > 0.0));
        assert!(
            ring.iter().all(|p| hull.contains(*p)),
            "a corner lies outside"
        );
        // Whichever way they are put, the hull is the same.
        for start in 0..6 {
            let mut other = ring;
            other.rotate_left(start);
            other.reverse();
            assert_eq!(ConvexPolygon::hull(other).expect("a hull"), hull);
        }
        let (area, _, polar) = by_triangles(hull.vertices());
        let found =
            Polygon::new(ring).map_or_else(|_| hull.area_properties(), |p| p.area_properties());
        assert!(
            (found.area / area - 1.0).abs() < 1e-6,
            "hull and ring differ by a hair at most"
        );
        assert!((hull.area_properties().polar / polar - 1.0).abs() < 1e-13);
    }
}

/// erincatto/box2d#326, #296, #364: points on one line overran the stack.
#[test]
fn case_05_points_on_one_line_are_named_and_near_ones_are_exact() {
    let line = [(0.0, 0.0), (10.0, 10.0), (5.0, 5.0), (3.0, 3.0)].map(|(x, y)| vec2(x, y));
    for refused in [
        Polygon::new(line).expect_err("a line"),
        ConvexPolygon::new(line).expect_err("a line"),
        ConvexPolygon::hull(line).expect_err("a line"),
        ring_properties(&line).expect_err("a line"),
    ] {
        assert_eq!(refused, PolygonError::Degenerate);
    }
    // The five points of #296: their hull failed.
    let five = rounded(&[
        (-1.700_822_1, -1.432_217_1),
        (0.5, -0.5),
        (0.104_992_87, 0.974_008_56),
        (-0.658_002_85, 0.926_608_1),
        (-0.994_554_8, 0.165_337_86),
    ]);
    let hull = ConvexPolygon::hull(five.clone()).expect("a hull");
    assert!(five.iter().all(|p| hull.contains(*p)));
    let (area, _, _) = by_triangles(hull.vertices());
    assert!((hull.area_properties().area / area - 1.0).abs() < 1e-15);
    // Fans of ever flatter triangles: what exact signs can tell from a line is a polygon.
    for power in 1..=45 {
        let height = 1.0 / (1_u64 << power) as f64;
        let fan: Vec<Vec2> = (0..=8_i32)
            .map(|i| vec2(f64::from(i), -height * f64::from(i * (8 - i))))
            .collect();
        let convex = ConvexPolygon::new(fan.clone()).expect("convex by a hair");
        assert_eq!(convex.vertices().len(), 9);
        // Under the parabola h x (8 − x), by its chords: h (n³ − n)/6.
        assert!((convex.area_properties().area / (height * 84.0) - 1.0).abs() < 1e-15);
        assert_eq!(
            ConvexPolygon::hull(fan).expect("a hull").vertices().len(),
            9
        );
    }
}

/// erincatto/box2d#726: vertices nearer than half the slop were welded, and no error told it.
#[test]
fn case_06_near_vertices_are_kept() {
    for near in [2e-3, 1e-6, 1e-9, 1e-12] {
        let ring = [
            vec2(0.0, 0.0),
            vec2(1.0, 0.0),
            vec2(1.0 + near, near),
            vec2(1.0, 1.0),
            vec2(0.0, 1.0),
        ];
        let kept = ConvexPolygon::new(ring).expect("convex");
        assert_eq!(kept.vertices(), ring);
        assert_eq!(Polygon::new(ring).expect("simple").vertices(), ring);
    }
    // What is at one place is one vertex; what is welded to nothing is told.
    let twice = [Vec2::ZERO, Vec2::X, Vec2::X, vec2(1.0, 1.0)];
    assert_eq!(
        ConvexPolygon::new(twice)
            .expect("a triangle")
            .vertices()
            .len(),
        3
    );
    let one_place = [vec2(1.0, 1.0); 4];
    assert_eq!(
        Polygon::new(one_place).expect_err("a point"),
        PolygonError::TooFewVertices { count: 1 }
    );
}

/// erincatto/box2d#292: a polygon around the origin, or clockwise, had a negative area.
#[test]
fn case_07_both_windings_around_the_origin_have_an_area() {
    let ring = [(-1.0, -0.5), (0.5, -1.0), (1.5, 0.25), (0.25, 1.0)].map(|(x, y)| vec2(x, y));
    for start in 0..4 {
        let mut ring = ring;
        ring.rotate_left(start);
        assert_mass(&ring);
        ring.reverse();
        assert_mass(&ring);
    }
}

/// dimforge/parry#49: the hull of points of size 1e-23 ended in a panic.
#[test]
fn case_28_the_hull_of_tiny_points_is_a_hull_or_an_error() {
    // x and y of the four points of the report.
    let points = rounded(&[
        (2.362_402_9e-23, 1.377_198_4e-23),
        (1.380_743_9e-23, 1.859_694_5e-23),
        (1.417_489_6e-23, -3.200_329e-24),
        (1.368_589_7e-23, 4.640_298_8e-24),
    ]);
    let hull = ConvexPolygon::hull(points.clone()).expect("far above the limit");
    assert!(points.iter().all(|p| hull.contains(*p)));
    assert_mass(hull.vertices());
    // As tiny as it can be, and a little tinier.
    for size in [1e-29, 1e-31, 1e-160, 1e-310] {
        let tiny = [
            vec2(0.0, 0.0),
            vec2(size, 0.0),
            vec2(0.0, size),
            vec2(size, size),
        ];
        match ConvexPolygon::hull(tiny) {
            Ok(hull) => assert!(size > 1e-30 && hull.vertices().len() == 4),
            Err(error) => assert!(
                size < 1e-30 && matches!(error, PolygonError::TooSmall { .. }),
                "{size:e}: {error}"
            ),
        }
    }
}

fn is_convex(piece: &ConvexPiece) -> bool {
    let v = piece.vertices();
    (0..v.len()).all(|i| orient2d(v[i], v[(i + 1) % v.len()], v[(i + 2) % v.len()]) > 0.0)
}

/// Pieces are convex and are the polygon: area, centroid and moments.
#[track_caller]
fn assert_pieces(name: &str, polygon: &Polygon) {
    let whole = polygon.area_properties();
    let pieces = polygon.pieces().iter();
    assert!(pieces.clone().all(is_convex), "{name}");
    let sum: AreaProperties = pieces
        .map(|piece| ring_properties(piece.vertices()).expect("an area"))
        .sum();
    for (what, part, all) in [
        ("areas", sum.area, whole.area),
        ("moments", sum.polar, whole.polar),
    ] {
        assert!(
            (part / all - 1.0).abs() < 1e-13,
            "{name}: {what} {part} and {all}"
        );
    }
    let size = polygon
        .vertices()
        .iter()
        .map(|v| v.distance(whole.centroid))
        .fold(0.0, f64::max);
    assert!(
        sum.centroid.distance(whole.centroid) < 1e-13 * size,
        "{name}"
    );
}

/// The outlines on which approximate decompositions panicked.
fn reported_outlines() -> [(&'static str, Vec<Vec2>); 2] {
    [
        (
            "dimforge/parry#65",
            rounded(&[
                (0.042_968_75, -0.021_484_375),
                (0.041_015_625, -0.023_437_5),
                (0.039_062_5, -0.025_390_625),
                (0.037_109_375, -0.027_343_75),
                (0.035_156_25, -0.025_390_625),
                (0.033_203_125, -0.023_437_5),
                (0.029_296_875, -0.023_437_5),
                (0.027_343_75, -0.021_484_375),
                (0.029_296_875, -0.019_531_25),
                (0.033_203_125, -0.019_531_25),
                (0.037_109_375, -0.019_531_25),
                (0.041_015_625, -0.019_531_25),
                (0.042_968_75, -0.021_484_375),
            ]),
        ),
        (
            "dimforge/rapier#223",
            rounded(&[
                (2.413_099_3, -1.586_323_7),
                (5.319_112_3, 2.147_785_2),
                (8.482_585, 8.418_664),
                (-0.225_563_05, 13.561_576),
                (-6.181_478_5, 5.825_167_7),
                (-6.716_458, 3.516_636_8),
                (-6.397_316, 1.137_943_3),
                (-1.948_629_4, -1.072_050_1),
                (-0.547_918_3, -3.383_477_2),
            ]),
        ),
    ]
}

/// dimforge/rapier#223, #377, dimforge/parry#65, #347: decompositions that panicked.
#[test]
fn case_29_pieces_of_anything_are_convex_and_complete() {
    for (name, ring) in reported_outlines() {
        assert_pieces(name, &Polygon::new(ring).expect(name));
    }
    for corners in (3..=200).chain([333, 500, 777, 1000]) {
        let circle: Vec<Vec2> = (0..corners)
            .map(|i| Rot::from_degrees(360.0 * f64::from(i) / f64::from(corners)).x_axis())
            .collect();
        let circle = Polygon::new(circle).expect("simple");
        assert_eq!(circle.pieces().len(), 1);
        assert_pieces("a circle", &circle);
    }
    // Zigzag bands, down to a picometre.
    for width in [1e-3, 1e-6, 1e-9, 1e-12] {
        let zigzag = |i: i32| vec2(f64::from(i), 0.5 * f64::from(i & 1));
        let below = (0..40).map(zigzag);
        let above = (0..40).rev().map(|i| zigzag(i) + vec2(0.0, width));
        let band: Vec<Vec2> = below.chain(above).collect();
        assert_pieces("a band", &Polygon::new(band).expect("simple"));
    }
}

/// `dimforge/bevy_rapier#364`, liabru/matter-js#339, #812: pieces filled cavities, or lay elsewhere.
#[test]
fn case_30_pieces_lie_where_the_polygon_lies_and_leave_its_cavities() {
    // The concave flank of #339, which became a triangle, 64 px away.
    let flank = [
        (0.0, 0.0),
        (32.0, 96.0),
        (64.0, 160.0),
        (96.0, 192.0),
        (160.0, 224.0),
        (256.0, 256.0),
        (0.0, 256.0),
        (0.0, 0.0),
    ];
    let flank: Vec<Vec2> = flank.iter().map(|(x, y)| vec2(*x, *y)).collect();
    for away in [Vec2::ZERO, vec2(3200.0, 2464.0)] {
        let moved: Vec<Vec2> = flank.iter().map(|p| *p + away).collect();
        let polygon = Polygon::new(moved).expect("simple");
        assert_pieces("the flank", &polygon);
        // Corners of 7 and less: it is no triangle any more.
        assert!(polygon.pieces().len() > 1);
        let in_a_piece = |p: Vec2| {
            polygon.pieces().iter().any(|piece| {
                ConvexPolygon::new(piece.vertices())
                    .expect("convex")
                    .contains(p)
            })
        };
        for x in 0..=26 {
            for y in 0..=26 {
                let p = away + 10.0 * vec2(f64::from(x) + 0.03, f64::from(y) + 0.07);
                assert_eq!(in_a_piece(p), polygon.contains(p), "at {p}");
            }
        }
    }
    // A ring with a gap of 1 mm: its hollow stays hollow, its mass is that of the ring.
    let circle = |radius: f64, from: i32, to: i32| {
        let at = move |i: i32| radius * Rot::from_degrees(f64::from(i)).x_axis();
        let step = if from < to { 1 } else { -1 };
        (0..=(to - from).abs()).map(move |i| at(from + step * i))
    };
    let gap = 1e-3_f64;
    let mut hollow: Vec<Vec2> = circle(2.0, 1, 359).chain(circle(1.5, 359, 1)).collect();
    hollow.extend([vec2(1.5, 0.5 * gap), vec2(2.0, 0.5 * gap)]);
    let hollow = Polygon::new(hollow).expect("simple");
    assert_pieces("a hollow ring", &hollow);
    assert!(!hollow.contains(Vec2::ZERO));
    let full = |radius: f64| circle(radius, 0, 359).collect::<Vec<Vec2>>();
    let closed = Region::new(full(2.0), [full(1.5)]).expect("one in the other");
    let missing = closed.area_properties().area - hollow.area_properties().area;
    // Open are a slice of one degree, (2² − 1.5²)/2 · sin 1°, and half the gap along 0.5 m.
    let open = 0.875 * Rot::from_degrees(1.0).sin() + 0.5 * gap * 0.5;
    assert!((missing - open).abs() < 1e-5, "{missing} instead of {open}");
}
