//! How much area two shapes share, by clipping convex parts.

use carom_geometry::{ConvexPolygon, Shape};
use carom_math::{Pose, Sum, Vec2, cross, trig};

use crate::parts::near_parts;
use crate::{Convex, Hull, part, separating_axis};

/// The area that two shapes share, in m².
///
/// Right to a few roundings of the larger part's area. Segments share none. Where parts of a compound
/// overlap each other they count as often as they do in its own area; two half-planes share an area
/// without end, unless they face each other.
///
/// # Examples
/// ```
/// use carom_collision::overlap_area;
/// use carom_geometry::{Circle, ConvexPolygon, HalfPlane};
/// use carom_math::{Pose, Vec2, vec2};
/// let square = ConvexPolygon::square(2.0)?.into();                             // m
/// assert_eq!(overlap_area(&square, &square, Pose::at(vec2(1.5, 1.0))), 0.5);   // m², 0.5 · 1
/// // A disc of 1 m, half under water.
/// let water = HalfPlane::new(vec2(0.0, 0.0), Vec2::Y)?.into();
/// let wet = overlap_area(&water, &Circle::new(1.0)?.into(), Pose::IDENTITY);
/// assert!((wet - std::f64::consts::FRAC_PI_2).abs() < 1e-15);                  // m²
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn overlap_area(a: &Shape, b: &Shape, b_in_a: Pose) -> f64 {
    let mut area = Sum::ZERO;
    near_parts(a, b, b_in_a, Vec2::ZERO, 0.0, |i, j| {
        area.add(shared(&part(a, i), &part(b, j), b_in_a));
    });
    area.value()
}

/// The area that two convex parts share.
fn shared(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> f64 {
    let has_area = |hull: &Hull<'_>| hull.normals.len() != 2;
    if !has_area(a) || !has_area(b) {
        return 0.0;
    }
    if separating_axis(a, b, b_in_a).separation >= 0.0 {
        return 0.0;
    }
    let a_in_b = b_in_a.inverse();
    match (a.is_disc(), b.is_disc()) {
        (true, true) => lens(
            (b_in_a.point(b.vertices[0]) - a.vertices[0]).length(),
            a.radius,
            b.radius,
        ),
        (false, true) => disc_in(a, b_in_a.point(b.vertices[0]), b.radius),
        (true, false) => disc_in(b, a_in_b.point(a.vertices[0]), a.radius),
        (false, false) => match (a.is_half_plane(), b.is_half_plane()) {
            (true, true) => f64::INFINITY,
            (true, false) => clipped(b.vertices, a, a_in_b.inverse()),
            _ => clipped(a.vertices, b, a_in_b),
        },
    }
}

/// Corners of what two convex polygons have in common, counter-clockwise in A's frame, in m; empty if that has no area.
///
/// # Examples
/// ```
/// use carom_collision::intersection;
/// use carom_geometry::ConvexPolygon;
/// use carom_math::{Pose, vec2};
/// let square = ConvexPolygon::square(2.0)?;
/// let common = intersection(&square, &square, Pose::at(vec2(1.5, 0.0)));
/// assert_eq!(common.len(), 4);
/// assert!(common.iter().all(|corner| corner.x >= 0.5 && corner.x <= 1.0));    // m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn intersection(a: &ConvexPolygon, b: &ConvexPolygon, b_in_a: Pose) -> Vec<Vec2> {
    common_ring(b.vertices(), &a.hull(), b_in_a)
}

/// Area of a convex ring behind all edges of a hull; the ring is at `pose` in the hull's frame.
fn clipped(ring: &[Vec2], hull: &Hull<'_>, pose: Pose) -> f64 {
    let points = common_ring(ring, hull, pose);
    let Some(&first) = points.first() else {
        return 0.0;
    };
    let corners = points.windows(2);
    let twice: Sum = corners
        .map(|pair| cross(pair[0] - first, pair[1] - first))
        .collect();
    (0.5 * twice.value()).max(0.0)
}

/// A convex ring, at `pose` in a hull's frame, behind all edges of the hull; empty if less than a triangle is left.
///
/// Source: I. Sutherland, G. Hodgman, *Reentrant polygon clipping*, 1974; for convex rings.
fn common_ring(ring: &[Vec2], hull: &Hull<'_>, pose: Pose) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = ring.iter().map(|v| pose.point(*v)).collect();
    let mut rest = Vec::with_capacity(points.len() + hull.normals.len());
    for (normal, corner) in hull.normals.iter().zip(hull.vertices) {
        let height = |p: Vec2| normal.dot(p - *corner);
        let before = points.last().into_iter().chain(&points).copied();
        for (p, q) in before.zip(points.iter().copied()) {
            let (low, high) = (height(p), height(q));
            if (low < 0.0 && high > 0.0) || (low > 0.0 && high < 0.0) {
                rest.push(p + (q - p) * (low / (low - high)));
            }
            if high <= 0.0 {
                rest.push(q);
            }
        }
        core::mem::swap(&mut points, &mut rest);
        rest.clear();
        if points.len() < 3 {
            return Vec::new();
        }
    }
    points
}

/// Area that a disc shares with a polygon or a half-plane, in the frame of that.
fn disc_in(hull: &Hull<'_>, centre: Vec2, radius: f64) -> f64 {
    if hull.is_half_plane() {
        let height = hull.normals[0].dot(centre - hull.vertices[0]);
        return cap(height, radius);
    }
    let mut area = Sum::ZERO;
    for i in 0..hull.vertices.len() {
        let (p, q) = hull.edge(i);
        area.add(wedge(p - centre, q - centre, radius));
    }
    area.value().max(0.0)
}

/// Area of a disc below a line that runs `height` under its centre; all of it from −r on.
fn cap(height: f64, radius: f64) -> f64 {
    let share = (height / radius).clamp(-1.0, 1.0);
    let half = trig::acos(share);
    // r² (α − sin α cos α), α half the angle of the arc.
    radius * radius * (half - share * ((1.0 - share) * (1.0 + share)).sqrt())
}

/// Area that a disc about the origin shares with the triangle (0, p, q), signed by its turn.
///
/// Outside the disc the edge sees an arc, inside it cuts a triangle.
fn wedge(p: Vec2, q: Vec2, radius: f64) -> f64 {
    let sector = |u: Vec2, v: Vec2| 0.5 * radius * radius * trig::atan2(cross(u, v), u.dot(v));
    let along = q - p;
    let square = along.length_squared();
    let across = cross(p, q);
    // |p + s along|² = r²: s = (−p·along ± √(along² r² − (p × q)²)) / along².
    let discriminant = square * radius * radius - across * across;
    if discriminant <= 0.0 {
        return sector(p, q);
    }
    let (middle, half) = (-p.dot(along) / square, discriminant.sqrt() / square);
    let (enter, leave) = (middle - half, middle + half);
    if leave <= 0.0 || enter >= 1.0 {
        return sector(p, q);
    }
    let from = if enter > 0.0 { p + along * enter } else { p };
    let to = if leave < 1.0 { p + along * leave } else { q };
    let mut area = 0.5 * cross(from, to);
    if enter > 0.0 {
        area += sector(p, from);
    }
    if leave < 1.0 {
        area += sector(to, q);
    }
    area
}

/// Area that two discs at a distance share: a cap of each.
fn lens(distance: f64, r: f64, s: f64) -> f64 {
    if distance >= r + s {
        return 0.0;
    }
    let small = r.min(s);
    if distance <= (r - s).abs() {
        return core::f64::consts::PI * small * small;
    }
    // The common chord is at x from the first centre: x² − (d − x)² = r² − s².
    let x = 0.5 * (distance + (r - s) * (r + s) / distance);
    cap(x, r) + cap(distance - x, s)
}
