//! Brute force over corners and edges: it shares nothing with what it checks but vectors.
//!
//! `cargo xtask stress` compiles the same file.

use carom_math::{Vec2, cross, vec2};

/// A shape where it is.
#[derive(Clone, Debug)]
pub(crate) enum Solid {
    /// Everything within a radius.
    Disc(Vec2, f64),
    /// A simple ring, counter-clockwise, and what is in it.
    Ring(Vec<Vec2>),
}

/// Metres between two solids; 0 if they touch or overlap.
pub(crate) fn distance(a: &Solid, b: &Solid) -> f64 {
    match (a, b) {
        (Solid::Disc(p, r), Solid::Disc(q, s)) => ((*q - *p).length() - r - s).max(0.0),
        (Solid::Ring(ring), Solid::Disc(p, r)) | (Solid::Disc(p, r), Solid::Ring(ring)) => {
            if inside(ring, *p) {
                return 0.0;
            }
            (from_rim(ring, *p) - r).max(0.0)
        }
        (Solid::Ring(p), Solid::Ring(q)) => {
            if inside(p, q[0]) || inside(q, p[0]) || rims_cross(p, q) {
                return 0.0;
            }
            let to = |ring: &[Vec2], points: &[Vec2]| {
                let each = points.iter().map(|v| from_rim(ring, *v));
                each.fold(f64::INFINITY, f64::min)
            };
            to(p, q).min(to(q, p))
        }
    }
}

/// Overlap of two convex rings along the best of all their edges' normals; negative if that
/// separates them. Each ring in its own frame, and the other one as seen from there: a short edge that
/// was turned and rounded has lost its normal.
pub(crate) fn least_overlap(p: (&[Vec2], &[Vec2]), q: (&[Vec2], &[Vec2])) -> f64 {
    let along = |(own, other): (&[Vec2], &[Vec2])| {
        edges(own)
            .map(|(from, to)| {
                let way = (to - from) / (to - from).abs().max_element();
                let way = way.normalize();
                overlap_along(own, other, vec2(way.y, -way.x))
            })
            .fold(f64::INFINITY, f64::min)
    };
    along(p).min(along(q))
}

/// How far Q has to go along a unit direction until it is beyond P.
pub(crate) fn overlap_along(p: &[Vec2], q: &[Vec2], direction: Vec2) -> f64 {
    let high = p.iter().map(|v| direction.dot(*v));
    let low = q.iter().map(|v| direction.dot(*v));
    high.fold(f64::NEG_INFINITY, f64::max) - low.fold(f64::INFINITY, f64::min)
}

/// Whether a point is in a ring, by the parity of a ray's crossings.
pub(crate) fn inside(ring: &[Vec2], p: Vec2) -> bool {
    let crossed = edges(ring).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))
    });
    crossed.count() % 2 == 1
}

/// Metres from a point to the rim of a ring.
pub(crate) fn from_rim(ring: &[Vec2], p: Vec2) -> f64 {
    edges(ring)
        .map(|(a, b)| {
            let along = b - a;
            let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (p - a - along * share).length()
        })
        .fold(f64::INFINITY, f64::min)
}

fn rims_cross(p: &[Vec2], q: &[Vec2]) -> bool {
    let sides =
        |a: Vec2, b: Vec2, c: Vec2, d: Vec2| cross(b - a, c - a) * cross(b - a, d - a) < 0.0;
    edges(p).any(|(a, b)| edges(q).any(|(c, d)| sides(a, b, c, d) && sides(c, d, a, b)))
}

fn edges(ring: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> {
    let ends = ring.iter().cycle().skip(1);
    ring.iter().zip(ends).map(|(a, b)| (*a, *b))
}
