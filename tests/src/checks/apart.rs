//! How deep convex parts lie in each other: projections on all directions that can part them.

use carom_dynamics::{Body, BodyKind};
use carom_geometry::Shape;
use carom_math::{Pose, Vec2, vec2};

/// A convex part of a body: corners, rounded by a radius; or all that is behind its one corner, along `outward`.
#[derive(Clone, Debug)]
pub struct Part {
    corners: Vec<Vec2>,
    radius: f64,
    outward: Option<Vec2>,
}

/// The convex parts of a body where it is.
#[must_use]
pub fn parts(body: &Body<'_>) -> Vec<Part> {
    let mut found = Vec::new();
    for (shape, _) in body.shapes() {
        collect(shape, body.pose(), &mut found);
    }
    found
}

fn collect(shape: &Shape, pose: Pose, found: &mut Vec<Part>) {
    let placed = |corners: &[Vec2]| corners.iter().map(|corner| pose.point(*corner)).collect();
    let solid = |corners: &[Vec2], radius| Part {
        corners: placed(corners),
        radius,
        outward: None,
    };
    match shape {
        Shape::Circle(disc) => found.push(solid(&[disc.centre()], disc.radius())),
        Shape::Segment(wall) => found.push(solid(&[wall.a(), wall.b()], 0.0)),
        Shape::Convex(polygon) => found.push(solid(polygon.vertices(), 0.0)),
        Shape::Polygon(polygon) => {
            found.extend(polygon.pieces().iter().map(|p| solid(p.vertices(), 0.0)));
        }
        Shape::Compound(whole) => {
            for part in whole.parts() {
                collect(part, pose, found);
            }
        }
        Shape::HalfPlane(plane) => found.push(Part {
            outward: Some(pose.vector(plane.normal())),
            ..solid(&[plane.point()], 0.0)
        }),
        other => panic!("a shape without a check: {other:?}"),
    }
}

/// Depth of the deepest overlap of two bodies' convex parts, in m, ≥ 0.
#[must_use]
pub fn depth(a: &Body<'_>, b: &Body<'_>) -> f64 {
    deepest(&parts(a), &parts(b))
}

pub(super) fn deepest(a: &[Part], b: &[Part]) -> f64 {
    let mut deepest = 0.0_f64;
    for p in a {
        for q in b {
            deepest = deepest.max(-separation(p, q));
        }
    }
    deepest
}

/// The widest gap along any direction, in m; below 0 the least way out. Between half-planes, which cannot be told apart, 0.
fn separation(a: &Part, b: &Part) -> f64 {
    match (a.outward, b.outward) {
        (Some(_), Some(_)) => 0.0,
        (Some(outward), None) => above(b, a.corners[0], outward),
        (None, Some(outward)) => above(a, b.corners[0], outward),
        (None, None) => {
            let mut widest = f64::NEG_INFINITY;
            for (one, other) in [(a, b), (b, a)] {
                for axis in axes(one, other) {
                    widest = widest.max(gap(a, b, axis));
                }
            }
            widest
        }
    }
}

/// How high the lowest point of a part is.
fn above(part: &Part, ground: Vec2, outward: Vec2) -> f64 {
    let heights = part
        .corners
        .iter()
        .map(|corner| (*corner - ground).dot(outward));
    heights.fold(f64::INFINITY, f64::min) - part.radius
}

/// Normals of the edges of `one`, and if it is a disc the direction to the nearest corner of the other.
fn axes(one: &Part, other: &Part) -> Vec<Vec2> {
    let count = one.corners.len();
    if count == 1 {
        let centre = one.corners[0];
        let offs = other.corners.iter().map(|corner| *corner - centre);
        let near = offs.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        // Of two discs in one place every direction is as good.
        let axis = near.map(|off| off / off.length()).filter(|v| v.is_finite());
        return vec![axis.unwrap_or(Vec2::X)];
    }
    (0..count)
        .map(|k| one.corners[(k + 1) % count] - one.corners[k])
        .map(|edge| vec2(edge.y, -edge.x) / edge.length())
        .filter(|normal| normal.is_finite())
        .collect()
}

/// The gap of two shadows on an axis, on the side that is wider.
fn gap(a: &Part, b: &Part, axis: Vec2) -> f64 {
    // Seen from one corner, so that nothing is lost far out.
    let origin = a.corners[0];
    let shadow = |part: &Part| {
        let spots = part
            .corners
            .iter()
            .map(|corner| (*corner - origin).dot(axis));
        let (low, high) = spots.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), spot| {
            (low.min(spot), high.max(spot))
        });
        (low - part.radius, high + part.radius)
    };
    let ((low_a, high_a), (low_b, high_b)) = (shadow(a), shadow(b));
    (low_b - high_a).max(low_a - high_b)
}

/// Distance of the farthest point of a body from its centre of mass, in m; a half-plane has none.
pub(super) fn size(body: &Body<'_>) -> f64 {
    let mut size = 0.0_f64;
    for part in parts(body) {
        if part.outward.is_some() {
            return f64::INFINITY;
        }
        for corner in part.corners {
            size = size.max((corner - body.centre()).length() + part.radius);
        }
    }
    size
}

/// Whether the centre of a dynamic body is within what does not yield.
pub(super) fn is_behind(body: &Body<'_>, wall: &Body<'_>) -> bool {
    if body.kind() != BodyKind::Dynamic || wall.kind() == BodyKind::Dynamic {
        return false;
    }
    let point = Part {
        corners: vec![body.centre()],
        radius: 0.0,
        outward: None,
    };
    parts(wall)
        .iter()
        .any(|part| part.corners.len() != 2 && separation(&point, part) < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(corners: &[(f64, f64)], radius: f64) -> Part {
        Part {
            corners: corners.iter().map(|&(x, y)| vec2(x, y)).collect(),
            radius,
            outward: None,
        }
    }

    #[track_caller]
    fn depth_is(a: &Part, b: &Part, depth: f64) {
        for (a, b) in [(a, b), (b, a)] {
            let found = -separation(a, b);
            assert!((found - depth).abs() < 1e-15, "{found}, not {depth}");
        }
    }

    #[test]
    fn depths_are_those_of_a_sketch() {
        let square = part(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)], 0.0);
        depth_is(&square, &part(&[(1.75, 0.0)], 1.0), 0.25);
        // Beyond a corner by 3-4-5.
        depth_is(&square, &part(&[(1.3, 1.4)], 1.0), 0.5);
        depth_is(&square, &part(&[(0.75, -3.0), (0.75, 3.0)], 0.0), 0.25);
        depth_is(&part(&[(0.0, 0.0)], 1.0), &part(&[(1.5, 0.0)], 1.0), 0.5);
        depth_is(&part(&[(0.0, 0.0)], 1.0), &part(&[(0.0, 0.0)], 1.0), 2.0);
        let ground = Part {
            outward: Some(Vec2::Y),
            ..part(&[(7.0, -0.9)], 0.0)
        };
        depth_is(&square, &ground, 0.1 - 1.11e-16);
        depth_is(&part(&[(0.0, 0.0)], 1.0), &ground, 0.1 - 1.11e-16);
    }
}
