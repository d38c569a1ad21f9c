//! The errors of the three documents that touch geometry: each test says what the document had,
//! shows that it is wrong, and holds the right value.

use carom_math::{Vec2, cross, orient2d, vec2};

use crate::{ConvexPolygon, Polygon, inertia, ring_properties};

fn points<const N: usize>(points: [(f64, f64); N]) -> [Vec2; N] {
    points.map(|(x, y)| vec2(x, y))
}

fn step() -> [Vec2; 6] {
    points([
        (0.0, 0.0),
        (2.0, 0.0),
        (2.0, 1.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (0.0, 3.0),
    ])
}

fn trough() -> [Vec2; 8] {
    points([
        (0.0, 0.0),
        (3.0, 0.0),
        (3.0, 3.0),
        (2.0, 3.0),
        (2.0, 1.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (0.0, 3.0),
    ])
}

/// The house of the thesis's own scene.
fn house() -> [Vec2; 5] {
    points([
        (0.0, 0.0),
        (100.0, 0.0),
        (100.0, 100.0),
        (50.0, 150.0),
        (0.0, 100.0),
    ])
}

/// The H of the thesis's own scene, about the origin.
fn h_shape() -> [Vec2; 12] {
    points([
        (40.0, 20.0),
        (40.0, 40.0),
        (80.0, 40.0),
        (80.0, -40.0),
        (40.0, -40.0),
        (40.0, -20.0),
        (-40.0, -20.0),
        (-40.0, -40.0),
        (-80.0, -40.0),
        (-80.0, 40.0),
        (-40.0, 40.0),
        (-40.0, 20.0),
    ])
}

/// What the thesis calls the barycentre, in its code.
fn vertex_mean(ring: &[Vec2]) -> Vec2 {
    ring.iter().sum::<Vec2>() / ring.len() as f64
}

fn edges(ring: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> {
    ring.iter()
        .zip(ring.iter().cycle().skip(1))
        .map(|(a, b)| (*a, *b))
}

/// Sum of the areas of the triangles of `centre` and each edge, without their signs.
fn unsigned_area(centre: Vec2, ring: &[Vec2]) -> f64 {
    edges(ring)
        .map(|(a, b)| 0.5 * cross(a - centre, b - centre).abs())
        .sum()
}

#[track_caller]
fn assert_close(found: f64, right: f64) {
    assert!(
        (found - right).abs() <= 1e-13 * right.abs(),
        "{found} instead of {right}"
    );
}

// ---- 1: thesis, A.1

#[test]
fn thesis_a1_has_h_cubed_where_h_squared_is_right() {
    let (w, h) = (2.0, 3.0);
    let as_printed = w * h / 12.0 * (w * w + h * h * h);
    assert_eq!(as_printed, 15.5);
    let found = ConvexPolygon::rectangle(w, h)
        .expect("a rectangle")
        .area_properties();
    assert_close(found.with_density(1.0).inertia, 6.5);
    assert_close(inertia::rectangle(w * h, w, h), 6.5);
}

// ---- 2: thesis, (3.14)

#[test]
fn thesis_3_14_has_unsigned_areas_where_signed_ones_are_right() {
    for (ring, right, too_much) in [
        (step().to_vec(), 4.0, 1.083),
        (trough().to_vec(), 7.0, 1.39),
        (h_shape().to_vec(), 9600.0, 1.33),
    ] {
        let ratio = unsigned_area(vertex_mean(&ring), &ring) / right;
        assert!(
            (ratio - too_much).abs() < 0.01,
            "unsigned area is {ratio} of the true one"
        );
        let found = ring_properties(&ring).expect("an area");
        assert_eq!(found.area, right);
        // The same sum with signs gives what exact integration gives.
        assert_close(
            inertia::fan(5.0, found.centroid, &ring),
            found.with_mass(5.0).inertia,
        );
    }
}

// ---- 3: thesis, the barycentre

#[test]
fn thesis_has_the_mean_of_the_vertices_where_the_centroid_of_the_area_is_right() {
    assert_eq!(vertex_mean(&house()), vec2(50.0, 70.0));
    let house = Polygon::new(house()).expect("simple").area_properties();
    assert_close(house.centroid.x, 50.0);
    assert_close(house.centroid.y, 190.0 / 3.0);
    assert_eq!(vertex_mean(&step()).x, 1.0);
    let step = Polygon::new(step()).expect("simple").area_properties();
    assert_eq!(step.centroid, vec2(0.75, 1.25));
}

// ---- 12: the thesis's engine, triangle()

#[test]
fn engine_triangle_has_base_times_height_cubed_where_the_squares_of_the_sides_are_right() {
    let mass = 0.6;
    let as_coded: f64 = mass * 3.0 * 4.0 * 4.0 * 4.0 / 36.0;
    assert!((as_coded - 3.2).abs() < 1e-15);
    let right = ConvexPolygon::triangle(3.0, 4.0, std::f64::consts::FRAC_PI_2).expect("a triangle");
    assert_close(
        right.area_properties().with_mass(mass).inertia,
        0.6 * 50.0 / 36.0,
    );
    assert_close(inertia::triangle(mass, 3.0, 4.0, 5.0), 0.6 * 50.0 / 36.0);
}

// ---- 13: the thesis's engine, centroid() and area_of_triangle()

#[test]
fn engine_has_vertex_mean_and_absolute_areas_where_weighted_and_signed_ones_are_right() {
    // Its H is symmetric, so the mean is right and the area alone is wrong: by a third.
    let h = h_shape();
    assert_eq!(vertex_mean(&h), Vec2::ZERO);
    assert_eq!(unsigned_area(Vec2::ZERO, &h), 12_800.0);
    let found = Polygon::new(h).expect("simple").area_properties();
    assert_eq!((found.area, found.centroid), (9600.0, Vec2::ZERO));
    // Two slabs 40 × 80 at ±60, one 80 × 40 at 0.
    let slabs = 2.0 * 3200.0 * ((40.0 * 40.0 + 80.0 * 80.0) / 12.0 + 60.0 * 60.0);
    assert_close(
        found.polar,
        slabs + 3200.0 * (80.0 * 80.0 + 40.0 * 40.0) / 12.0,
    );
}

// ---- 14: the thesis's engine, orientation()

#[test]
#[expect(
    clippy::cast_possible_truncation,
    reason = "it is the error that is shown"
)]
fn engine_orientation_has_an_int_where_the_sign_of_a_double_is_right() {
    let small = points([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)]);
    let as_coded = cross(small[1] - small[0], small[2] - small[0]) as i32;
    assert_eq!(as_coded, 0, "collinear, it says");
    assert!(orient2d(small[0], small[1], small[2]) > 0.0);
    assert_eq!(
        ConvexPolygon::new(small)
            .expect("a triangle")
            .area_properties()
            .area,
        0.125
    );
    // And where a double's own sign fails, the exact one does not.
    let thin = [
        vec2(0.5, 0.5_f64.next_up()),
        vec2(12.0, 12.0),
        vec2(24.0, 24.0),
    ];
    assert_eq!(cross(thin[1] - thin[0], thin[2] - thin[0]), 0.0);
    assert!(Polygon::new(thin).is_ok());
}

// ---- 24, 25, 26: engine article

/// Does not contain the origin: right triangle of legs 1 at (1, 1).
fn aside() -> [Vec2; 3] {
    points([(1.0, 1.0), (2.0, 1.0), (1.0, 2.0)])
}

#[test]
fn engine_article_has_lost_a_dot_b_in_the_inertia_of_a_triangle() {
    let (a, b) = (vec2(2.0, 0.0), vec2(1.0, 1.0));
    let mass = 6.0;
    let as_printed = mass * (a.length_squared() + b.length_squared()) / 6.0;
    let right = mass * (a.length_squared() + b.length_squared() + a.dot(b)) / 6.0;
    assert_eq!((as_printed, right), (6.0, 8.0));
    let found = ring_properties(&[Vec2::ZERO, a, b])
        .expect("an area")
        .with_mass(mass);
    assert_close(found.inertia_about(Vec2::ZERO), right);
}

#[test]
fn engine_article_has_absolute_face_areas_where_signed_ones_are_right() {
    let as_printed = unsigned_area(Vec2::ZERO, &aside());
    assert_eq!(as_printed, 2.5);
    assert_eq!(
        ConvexPolygon::new(aside())
            .expect("a triangle")
            .area_properties()
            .area,
        0.5
    );
}

#[test]
fn engine_article_centroid_mixes_signed_faces_with_the_absolute_area() {
    let signed_faces = edges(&aside())
        .map(|(a, b)| (a + b) * 0.5 * cross(a, b))
        .sum::<Vec2>();
    let as_printed = signed_faces / (3.0 * unsigned_area(Vec2::ZERO, &aside()));
    assert!(
        (as_printed - vec2(4.0 / 15.0, 4.0 / 15.0)).length() < 1e-15,
        "{as_printed}"
    );
    let found = ConvexPolygon::new(aside())
        .expect("a triangle")
        .area_properties();
    assert!((found.centroid - vec2(4.0 / 3.0, 4.0 / 3.0)).length() < 1e-15);
}

// ---- 28 to 33: triangle article

#[test]
fn triangle_article_has_twice_the_area_over_the_height_where_over_the_base_is_right() {
    let [p1, p2, p3] = points([(0.0, 0.0), (4.0, 0.0), (1.0, 3.0)]);
    let product = cross(p2 - p1, p3 - p1).abs();
    let w = (p2 - p1).length();
    let as_printed = product.sqrt(); // h = product / h
    assert!((as_printed - 12.0_f64.sqrt()).abs() < 1e-15);
    let height = product / w;
    assert_eq!(height, 3.0);
    let found = ring_properties(&[p1, p2, p3]).expect("an area");
    assert_eq!(found.area, 0.5 * w * height);
}

#[test]
fn triangle_article_has_the_projection_the_wrong_way_round() {
    let (v1, v2) = (vec2(4.0, 0.0), vec2(1.0, 3.0));
    let of_v1_on_v2 = v2 * (v1.dot(v2) / v2.length_squared());
    assert!(
        of_v1_on_v2.distance(vec2(0.4, 1.2)) < 1e-15,
        "not on the base"
    );
    let foot = v1 * (v2.dot(v1) / v1.length_squared());
    assert_eq!(foot, vec2(1.0, 0.0));
    // Two right triangles over this foot make up the whole.
    let halves = [[Vec2::ZERO, foot, v2], [foot, v1, v2]];
    let [left, right] = halves.map(|half| ring_properties(&half).expect("an area"));
    let whole = ring_properties(&[Vec2::ZERO, v1, v2]).expect("an area");
    assert_eq!(left.area + right.area, whole.area);
    assert_close((left + right).polar, whole.polar);
}

#[test]
fn triangle_article_text_has_the_legs_swapped_about_p3() {
    let (w, h) = (1.7, 0.6);
    let as_printed: f64 = h * w * w * w / 4.0 + h * h * h * w / 12.0;
    assert!((as_printed - 0.768).abs() < 1e-3);
    let right = w * h * h * h / 4.0 + w * w * w * h / 12.0;
    assert!((right - 0.337).abs() < 1e-3);
    // p3 at the far end of the height, the right angle between p1 and p3.
    let (p1, foot, p3) = (vec2(w, 0.0), Vec2::ZERO, vec2(0.0, h));
    let found = ring_properties(&[p1, p3, foot]).expect("an area");
    assert_close(found.polar_about(p3), right);
    assert_close(
        inertia::right_triangle_about_corner(0.5 * w * h, h, w),
        right,
    );
}

/// The article's code, with or without its two errors.
fn fotino(ring: &[Vec2], as_printed: bool) -> f64 {
    let mut total = 0.0;
    for pair in ring[1..].windows(2) {
        let (p1, p2, p3) = (ring[0], pair[0], pair[1]);
        let w = p1.distance(p2);
        let along = (p1 - p2).dot(p3 - p2) / w;
        let w1 = if as_printed { along.abs() } else { along };
        let w2 = (w - w1).abs();
        let h = cross(p3 - p1, p2 - p1).abs() / w;
        let p4 = p2 + (p1 - p2) * (w1 / w);
        let part = |w: f64, corner: Vec2| {
            let mass = 0.5 * w * h;
            let centre = (corner + p3 + p4) / 3.0;
            w * h * (h * h / 4.0 + w * w / 12.0) - mass * centre.distance_squared(p3)
                + mass * centre.length_squared()
        };
        let (part1, part2) = (part(w1.abs(), p2), part(w2, p1));
        let (of_1, of_2) = (cross(p1 - p3, p4 - p3), cross(p4 - p3, p2 - p3));
        let (sign_1, sign_2) = if as_printed {
            (of_1, of_2)
        } else {
            (of_2, of_1)
        };
        let signed = |part: f64, sign: f64| if sign > 0.0 { part } else { -part };
        total += signed(part1, sign_1) + signed(part2, sign_2);
    }
    total.abs()
}

#[test]
fn triangle_article_code_takes_the_sign_of_each_half_from_the_other() {
    let square = ConvexPolygon::square(1.0)
        .expect("a square")
        .vertices()
        .to_vec();
    let pentagon = ConvexPolygon::regular(5, 1.0)
        .expect("regular")
        .vertices()
        .to_vec();
    for (ring, printed, right) in [
        (square, 0.0, 1.0 / 6.0),
        (pentagon, 0.634, 0.915),
        (step().to_vec(), 6.333, 38.0 / 3.0),
    ] {
        let as_printed = fotino(&ring, true);
        assert!(
            (as_printed - printed).abs() < 1e-3,
            "as printed it gives {as_printed}"
        );
        let whole = ring_properties(&ring)
            .expect("an area")
            .polar_about(Vec2::ZERO);
        assert!((whole - right).abs() < 1e-3, "{whole}");
        assert_close(fotino(&ring, false), whole);
        assert_close(inertia::polygon_by_right_triangles(&ring), whole);
    }
}

#[test]
fn triangle_article_code_has_the_length_of_w1_where_its_sign_counts() {
    // An obtuse angle at p2.
    let ring = points([(0.0, 0.0), (1.0, 0.0), (5.0, 1.0)]);
    let as_printed = fotino(&ring, true);
    assert!(
        (as_printed - 8.0 / 3.0).abs() > 1.0,
        "as printed it gives {as_printed}"
    );
    assert_close(
        ring_properties(&ring)
            .expect("an area")
            .polar_about(Vec2::ZERO),
        8.0 / 3.0,
    );
    assert_close(inertia::polygon_by_right_triangles(&ring), 8.0 / 3.0);
}

#[test]
fn triangle_article_has_the_moment_about_the_origin_where_the_centroid_is_meant() {
    let ring: Vec<Vec2> = step().iter().map(|p| *p + vec2(3.0, 0.0)).collect();
    let found = ring_properties(&ring).expect("an area");
    let about_origin = inertia::polygon_by_right_triangles(&ring);
    assert_close(about_origin, found.polar_about(Vec2::ZERO));
    assert!(about_origin > 10.0 * found.polar);
    // Right once the points are moved; its area and density from mass are right as they are.
    let moved: Vec<Vec2> = ring.iter().map(|p| *p - found.centroid).collect();
    assert_close(inertia::polygon_by_right_triangles(&moved), found.polar);
    assert_eq!(found.density(8.0), 2.0);
}
