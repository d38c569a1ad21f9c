//! Random shapes and poses: slivers, touching, nearly parallel, from micrometres to megametres.

use carom_collision::{Hull, separating_axis};
use carom_geometry::{ConvexPolygon, Polygon};
use carom_math::{Pose, Rot, Vec2, orient2d, vec2};
use proptest::prelude::*;

/// Two convex polygons of about `size` metres, and B in A's frame.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) a: ConvexPolygon,
    pub(crate) b: ConvexPolygon,
    pub(crate) pose: Pose,
    pub(crate) size: f64,
}

/// A convex polygon of about one metre: round, lean, or thin as 1e-8 of its length.
pub(crate) fn convex() -> impl Strategy<Value = ConvexPolygon> {
    let corner = (0.0..1.0_f64, 0.3..1.0_f64);
    let thin = prop_oneof![6 => Just(1.0), 3 => 0.01..1.0_f64, 1 => (1.0..8.0_f64).prop_map(|k| exp10(-k))];
    (prop::collection::vec(corner, 3..9), thin, -4.0..4.0_f64).prop_filter_map(
        "points on one line",
        |(corners, thin, turn)| {
            let rot = Rot::from_angle(turn);
            let points: Vec<Vec2> = corners
                .iter()
                .map(|(turn, r)| Rot::from_angle(turn * core::f64::consts::TAU).x_axis() * *r)
                .map(|p| rot * vec2(p.x, p.y * thin))
                .collect();
            ConvexPolygon::hull(points).ok()
        },
    )
}

/// 10^k without the platform's own power.
pub(crate) fn exp10(k: f64) -> f64 {
    carom_math::trig::exp(k * core::f64::consts::LN_10)
}

fn scaled(shape: &ConvexPolygon, size: f64) -> ConvexPolygon {
    let points: Vec<Vec2> = shape.vertices().iter().map(|v| *v * size).collect();
    ConvexPolygon::hull(points).expect("a scaled polygon is one")
}

/// A rotation that makes edges parallel as often as not.
pub(crate) fn turn() -> impl Strategy<Value = Rot> {
    prop_oneof![
        4 => (-4.0..4.0_f64).prop_map(Rot::from_angle),
        2 => (0..4i32).prop_map(|q| Rot::from_degrees(90.0 * f64::from(q))),
        1 => (0..4i32, -1e-12..1e-12_f64)
            .prop_map(|(q, tilt)| Rot::from_degrees(90.0 * f64::from(q)).turned(tilt)),
    ]
}

/// Pairs that are apart, touch or overlap.
pub(crate) fn pair() -> impl Strategy<Value = Pair> {
    let boxes = (0.2..2.0_f64, 0.2..2.0_f64)
        .prop_map(|(w, h)| ConvexPolygon::rectangle(w, h).expect("above zero"));
    let shape = || prop_oneof![3 => convex(), 1 => boxes.clone()];
    let reach = prop_oneof![3 => 0.0..2.5_f64, 1 => Just(-1.0)];
    (
        shape(),
        shape(),
        turn(),
        -4.0..4.0_f64,
        reach,
        -6.0..6.0_f64,
    )
        .prop_map(|(a, b, rot, towards, reach, k)| {
            let size = exp10(k);
            let (a, b) = (scaled(&a, size), scaled(&b, size));
            let way = Rot::from_angle(towards).x_axis();
            let mut pose = Pose::new(way * (reach.max(2.5) * size), rot);
            if reach >= 0.0 {
                pose.position = way * (reach * size);
            } else {
                // Up to touching along the separating axis.
                let axis = separating_axis(&hull(&a), &hull(&b), pose);
                pose.position -= axis.normal * axis.separation;
            }
            Pair { a, b, pose, size }
        })
}

/// A simple polygon around the origin, usually concave: a star with random radii.
pub(crate) fn concave() -> impl Strategy<Value = Polygon> {
    prop::collection::vec(0.3..1.5_f64, 4..14).prop_map(|radii| {
        let n = f64::from(u32::try_from(radii.len()).expect("a few"));
        let points: Vec<Vec2> = (0u32..)
            .zip(&radii)
            .map(|(i, r)| Rot::from_angle(f64::from(i) / n * core::f64::consts::TAU).x_axis() * *r)
            .collect();
        Polygon::new(points).expect("a star is simple")
    })
}

pub(crate) fn hull(polygon: &ConvexPolygon) -> Hull<'_> {
    carom_collision::Convex::hull(polygon)
}

/// Gap of two hulls along a unit direction from A to B.
pub(crate) fn gap_along(a: &Hull<'_>, b: &Hull<'_>, pose: Pose, direction: Vec2) -> f64 {
    let (_, of_a) = a.support(direction);
    let (_, of_b) = b.support(pose.inverse_vector(-direction));
    direction.dot(pose.position) - of_b - of_a - a.radius - b.radius
}

/// Whether two closed outlines have a point in common, by exact signs on rounded vertices.
pub(crate) fn outlines_meet(a: &[Vec2], b: &[Vec2]) -> bool {
    let edges = |ring: &[Vec2]| -> Vec<[Vec2; 2]> {
        ring.iter()
            .zip(ring.iter().cycle().skip(1))
            .map(|(p, q)| [*p, *q])
            .collect()
    };
    let inside = |ring: &[Vec2], p: Vec2| {
        let mut odd = false;
        for [from, to] in edges(ring) {
            if (from.y <= p.y) != (to.y <= p.y) && (orient2d(from, to, p) > 0.0) == (to.y > from.y)
            {
                odd = !odd;
            }
        }
        odd
    };
    let crosses = |[p, q]: [Vec2; 2], [r, s]: [Vec2; 2]| {
        orient2d(p, q, r) * orient2d(p, q, s) < 0.0 && orient2d(r, s, p) * orient2d(r, s, q) < 0.0
    };
    inside(a, b[0])
        || inside(b, a[0])
        || edges(a)
            .iter()
            .any(|e| edges(b).iter().any(|f| crosses(*e, *f)))
}

/// Distance of a point from a closed outline.
pub(crate) fn from_outline(ring: &[Vec2], point: Vec2) -> f64 {
    ring.iter()
        .zip(ring.iter().cycle().skip(1))
        .map(|(p, q)| {
            let along = *q - *p;
            let share = ((point - *p).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (*p + along * share - point).length()
        })
        .fold(f64::INFINITY, f64::min)
}

pub(crate) fn placed(points: &[Vec2], pose: Pose) -> Vec<Vec2> {
    points.iter().map(|p| pose.point(*p)).collect()
}
