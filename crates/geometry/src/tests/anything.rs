//! Whatever comes in: an answer or an error, never a panic, never a NaN.

use carom_math::{Pose, Rot, Vec2, vec2};
use proptest::prelude::*;

use crate::{Compound, ConvexPolygon, Polygon, Region, Shape, ring_properties};

fn number() -> impl Strategy<Value = f64> {
    let power = (-320..13_i32, -1.0..1.0_f64)
        .prop_map(|(power, x)| x * carom_math::trig::pow(10.0, f64::from(power)));
    prop_oneof![
        4 => (-4..=4_i32).prop_map(f64::from),
        4 => -1.0..1.0_f64,
        2 => power,
        1 => any::<f64>(),
        1 => prop::sample::select(vec![0.0, -0.0, 1e12, -1e12, 5e-324, 1e-30, f64::EPSILON, 1.0 + f64::EPSILON]),
    ]
}

pub(super) fn points(most: usize) -> impl Strategy<Value = Vec<Vec2>> {
    prop::collection::vec((number(), number()).prop_map(|(x, y)| vec2(x, y)), 0..most)
}

/// Asks a shape everything.
fn ask(shape: &Shape, p: Vec2, angle: f64) -> Result<(), TestCaseError> {
    let pose = Pose::new(p, Rot::from_angle(angle));
    let area = shape.area_properties().expect("bounded");
    prop_assert!(area.area >= 0.0 && area.polar >= 0.0 && area.centroid.is_finite());
    prop_assert!(area.with_mass(1.0).inertia >= 0.0);
    let (largest, smallest, axis) = area.principal_axes();
    prop_assert!(largest >= smallest && smallest >= 0.0 && axis.x_axis().is_finite());
    prop_assert!(shape.aabb(pose).is_finite() && shape.reach_about(p) >= 0.0);
    prop_assert!(shape.closest_point(p).is_finite() && shape.closest_rim_point(p).is_finite());
    prop_assert!(shape.signed_distance(p).is_finite());
    prop_assert!(
        shape
            .support(pose.rotation.x_axis())
            .is_some_and(Vec2::is_finite)
    );
    if let Some(hit) = shape.cast_ray(p, pose.rotation.x_axis(), f64::INFINITY) {
        prop_assert!(hit.point.is_finite() && hit.distance >= 0.0 && hit.normal.is_finite());
    }
    let _inside = shape.contains(p);
    let _moved = shape.placed(pose);
    Ok(())
}

proptest! {
    #[test]
    fn any_points_end_in_a_shape_or_an_error(
        ring in points(12), hole in points(6), p in (-1e6..1e6_f64, -1.0..1.0_f64), angle in -9.0..9.0_f64,
    ) {
        let p = vec2(p.0, p.1);
        if let Ok(polygon) = Polygon::new(ring.clone()) {
            ask(&polygon.into(), p, angle)?;
        }
        if let Ok(convex) = ConvexPolygon::new(ring.clone()) {
            let normals = convex.normals().iter();
            prop_assert!(normals.clone().all(|n| (n.length() - 1.0).abs() < 1e-15));
            ask(&convex.into(), p, angle)?;
        }
        if let Ok(hull) = ConvexPolygon::hull(ring.clone()) {
            let shape = Shape::from(hull);
            ask(&shape, p, angle)?;
            let parts = [(shape.clone(), Pose::IDENTITY), (shape, Pose::new(p, Rot::from_angle(angle)))];
            if let Ok(both) = Compound::new(parts) {
                ask(&both.into(), p, angle)?;
            }
        }
        if let Ok(area) = ring_properties(&ring) {
            prop_assert!(area.area > 0.0 && area.polar > 0.0 && area.centroid.is_finite());
        }
        if let Ok(region) = Region::new(ring, [hole]) {
            prop_assert!(region.signed_distance(p).is_finite() && region.area_properties().area >= 0.0);
        }
    }

    #[test]
    fn any_numbers_end_in_a_generated_polygon_or_an_error(
        count in 0..40_usize, a in number(), b in number(), c in number(), d in number(), given in prop::collection::vec(number(), 1..9),
    ) {
        let mut from = given.iter().copied().cycle();
        let mut next = || from.next().unwrap_or(0.0);
        let convex = [
            ConvexPolygon::regular(count, a),
            ConvexPolygon::rectangle(a, b),
            ConvexPolygon::square(a),
            ConvexPolygon::triangle(a, b, c),
            ConvexPolygon::trapezoid(a, b, c, d),
            // At most as many corners as a square root of the ratio.
            ConvexPolygon::ellipse(a, b, c.max(1e-6 * a.max(b))),
            ConvexPolygon::random(count, a, &mut next),
            ConvexPolygon::random_in_box(count, a, b, &mut next),
        ];
        for polygon in convex.into_iter().flatten() {
            ask(&polygon.into(), vec2(0.1, 0.2), 1.0)?;
        }
        let simple = [
            Polygon::star(count, a, b),
            Polygon::gear(count, a, b),
            Polygon::random(count, a, b, &mut next),
            Polygon::random_star(count, a, b, &mut next),
        ];
        for polygon in simple.into_iter().flatten() {
            ask(&polygon.into(), vec2(0.1, 0.2), 1.0)?;
        }
    }
}
