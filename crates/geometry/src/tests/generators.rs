use std::f64::consts::{FRAC_PI_2, PI};

use carom_math::{Vec2, trig, vec2};

use crate::{Circle, ConvexPolygon, Polygon, PolygonError, VERTEX_LIMIT, inertia};

fn close(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-14
}

#[test]
fn regular_polygons_meet_their_closed_forms() {
    for sides in [3_usize, 4, 5, 6, 7, 8, 64, 1000] {
        let polygon = ConvexPolygon::regular(sides, 2.0).expect("regular");
        assert_eq!(polygon.vertices().len(), sides);
        let found = polygon.area_properties();
        let (sin, _) = trig::sin_cos(PI / sides as f64);
        let side = 4.0 * sin;
        assert!(
            close(
                found.with_mass(3.0).inertia,
                inertia::regular(3.0, sides, side)
            ),
            "{sides}"
        );
        assert!(found.centroid.length() < 1e-15);
        assert!(
            (found.ixx - found.iyy).abs() < 1e-14 * found.polar,
            "round from all sides"
        );
    }
    let square = ConvexPolygon::regular(4, 1.0).expect("regular");
    assert_eq!(
        square.vertices(),
        [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y],
        "exact at quarter turns"
    );
    let round = ConvexPolygon::regular(100_000, 1.0).expect("regular");
    assert_eq!(
        ConvexPolygon::new(round.vertices()).expect("strictly convex"),
        round
    );
}

#[test]
fn rectangles_and_triangles_meet_their_closed_forms() {
    let plank = ConvexPolygon::rectangle(3.0, 0.2)
        .expect("a plank")
        .area_properties();
    assert!(close(
        plank.with_mass(5.0).inertia,
        inertia::rectangle(5.0, 3.0, 0.2)
    ));
    assert!(close(plank.ixx, 3.0 * 0.2 * 0.2 * 0.2 / 12.0) && close(plank.iyy, 0.2 * 27.0 / 12.0));
    for angle in [0.1, 1.0, FRAC_PI_2, 2.0, 3.0] {
        let (_, cos) = trig::sin_cos(angle);
        let c = (9.0 + 4.0 - 12.0 * cos).sqrt();
        let triangle = ConvexPolygon::triangle(3.0, 2.0, angle).expect("a triangle");
        let found = triangle.area_properties();
        assert!(
            close(
                found.with_mass(1.5).inertia,
                inertia::triangle(1.5, 3.0, 2.0, c)
            ),
            "{angle}"
        );
        assert!(found.centroid.length() < 1e-15);
    }
    let disc = Circle::new(0.5).expect("a disc").area_properties();
    assert_eq!(disc.with_mass(4.0).inertia, inertia::circle(4.0, 0.5));
}

#[test]
fn a_star_has_its_tips_and_notches() {
    let star = Polygon::star(5, 2.0, 0.5).expect("a star");
    assert_eq!(star.vertices().len(), 10);
    assert_eq!(star.vertices()[0], vec2(2.0, 0.0));
    let (sin, _) = trig::sin_cos(PI / 5.0);
    assert!(close(star.area_properties().area, 5.0 * 2.0 * 0.5 * sin));
}

#[test]
fn random_polygons_are_strictly_convex_whatever_the_numbers() {
    for (name, numbers) in [
        ("least", vec![0.0]),
        ("most", vec![1.0]),
        ("far apart and close", vec![1.0, 0.0]),
        ("no numbers", vec![f64::NAN, -3.0, 7.0]),
    ] {
        for sides in [3, 4, 5, 40, 1000] {
            let mut from = numbers.iter().copied().cycle();
            let mut next = || from.next().unwrap_or(0.0);
            let polygon = ConvexPolygon::random(sides, 2.0, &mut next).expect(name);
            assert_eq!(polygon.vertices().len(), sides, "{name}");
        }
    }
}

#[test]
fn trapezoids_and_gears_meet_their_closed_forms() {
    for (bottom, top, height, lean) in [
        (6.0, 2.0, 3.0, 0.0),
        (1.0, 5.0, 0.5, 7.0),
        (2.0, 2.0, 1.0, -3.0),
    ] {
        let found = ConvexPolygon::trapezoid(bottom, top, height, lean).expect("a trapezoid");
        let area = found.area_properties();
        assert!(close(area.area, 0.5 * (bottom + top) * height));
        assert!(area.centroid.length() < 1e-15, "{}", area.centroid);
        // About the line through the centroid: h³ (b² + 4 b t + t²) / (36 (b + t)).
        let sum = bottom * bottom + 4.0 * bottom * top + top * top;
        assert!(close(
            area.ixx,
            height * height * height * sum / (36.0 * (bottom + top))
        ));
    }
    let gear = Polygon::gear(20, 2.0, 1.5)
        .expect("a gear")
        .area_properties();
    // Triangles from the centre: tip, gap, and two flanks a tooth.
    let sin = |pitches: f64| trig::sin_cos(pitches * PI / 10.0).0;
    let tooth = 4.0 * sin(0.3) + 2.25 * sin(0.4) + 2.0 * 3.0 * sin(0.15);
    assert!(close(gear.area, 20.0 * 0.5 * tooth));
    assert!((gear.ixx - gear.iyy).abs() < 1e-14 * gear.polar);
}

#[test]
fn generators_name_what_they_refuse() {
    let refused = |result: Result<ConvexPolygon, PolygonError>| {
        result.expect_err("a number is wrong").to_string()
    };
    let above = "not a finite number above 0";
    assert_eq!(
        refused(ConvexPolygon::rectangle(0.0, 1.0)),
        format!("width is 0, {above}")
    );
    assert_eq!(
        refused(ConvexPolygon::rectangle(1.0, -2.0)),
        format!("height is -2, {above}")
    );
    assert_eq!(
        refused(ConvexPolygon::square(f64::NAN)),
        format!("side is NaN, {above}")
    );
    assert_eq!(
        refused(ConvexPolygon::regular(6, f64::INFINITY)),
        format!("circumradius is inf, {above}")
    );
    assert_eq!(
        refused(ConvexPolygon::regular(2, 1.0)),
        "a polygon needs 3 distinct vertices, got 2"
    );
    assert_eq!(
        refused(ConvexPolygon::regular(usize::MAX, 1.0)),
        format!(
            "a polygon has at most {VERTEX_LIMIT} vertices, got {}",
            usize::MAX
        )
    );
    assert!(refused(ConvexPolygon::triangle(1.0, 1.0, PI)).starts_with("angle is 3.14159"));
    assert!(refused(ConvexPolygon::triangle(1.0, 1.0, 0.0)).starts_with("angle is 0, outside"));
    assert!(
        refused(ConvexPolygon::trapezoid(1.0, 1.0, 1.0, f64::NAN))
            .starts_with("lean is NaN, outside")
    );
    assert_eq!(
        refused(ConvexPolygon::ellipse(1.0, 2.0, 0.0)),
        format!("sagitta is 0, {above}")
    );
    assert!(refused(ConvexPolygon::ellipse(1.0, 2.0, 1e-30)).starts_with("a polygon has at most"));
    assert_eq!(
        ConvexPolygon::ellipse(1.0, 2.0, 9.0)
            .expect("a rhomb")
            .vertices()
            .len(),
        4
    );
    let root = Polygon::gear(5, 1.0, 1.0).expect_err("no gear").to_string();
    assert!(root.starts_with("root is 1, outside"), "{root}");
    let inner = Polygon::star(5, 1.0, -1.0)
        .expect_err("no star")
        .to_string();
    assert_eq!(inner, format!("inner is -1, {above}"));
}
