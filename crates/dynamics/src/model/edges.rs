//! What of a hull lies along a contact, and where that ends.

use carom_collision::Hull;
use carom_math::{Pose, Vec2, perp};

use crate::impact::ImpactBody;

/// What a body touches with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Feature {
    /// A straight edge along the tangent, from `low` to `high` in m from the touch's first point.
    Edge {
        /// Lower end; −∞ for a line.
        low: f64,
        /// Upper end; +∞ for a line.
        high: f64,
    },
    /// A corner.
    Corner,
    /// A circle about the centre of mass.
    Round,
}

/// Sine of the angle up to which an edge lies along a contact: far above rounding.
const FLUSH: f64 = 1e-9;

/// What two bodies touch with where an edge may end here, by the way that they slide: the end of an edge that a disc leaves is a
/// corner, and a common stretch of two edges that is over is no contact. Otherwise they would leave it a rounding later.
pub(crate) fn at_the_end(
    features: (Feature, Feature),
    (a, b): (ImpactBody, ImpactBody),
    normal: Vec2,
) -> Option<(Feature, Feature)> {
    let slip = (b.velocity - a.velocity).dot(perp(normal));
    let room = end_room(a.centre, b.centre);
    let leaves = |low: f64, high: f64, slip: f64| {
        (slip > 0.0 && high <= room) || (slip < 0.0 && low >= -room)
    };
    match features {
        (Feature::Edge { low, high }, Feature::Round) if leaves(low, high, slip) => {
            Some((Feature::Corner, Feature::Round))
        }
        (Feature::Round, Feature::Edge { low, high }) if leaves(low, high, -slip) => {
            Some((Feature::Round, Feature::Corner))
        }
        (
            Feature::Edge { low, high },
            Feature::Edge {
                low: from,
                high: to,
            },
        ) if leaves(low - to, high - from, slip) => None,
        _ => Some(features),
    }
}

/// The normal from A to B and the point of a corner that a disc touches but for rounding: it goes over the end of an edge, and an impact
/// on another corner in the same place is found that much too soon.
pub(crate) fn corner_under_disc(
    hulls: (&Hull<'_>, &Hull<'_>),
    poses: (Pose, Pose),
    states: (ImpactBody, ImpactBody),
    normal: Vec2,
) -> Option<(Vec2, Vec2)> {
    let of_disc = |own: usize, outward: Vec2| {
        let both = [(hulls.0, poses.0, states.0), (hulls.1, poses.1, states.1)];
        let ((hull, pose, moves), (disc, at, rolls)) = (both[own], both[1 - own]);
        let edge = flush_edge(hull, pose, outward).filter(|_| !hull.is_half_plane())?;
        let (centre, t) = (at.point(disc.vertices[0]), perp(outward));
        let slip = t.dot(rolls.velocity_of(centre) - moves.velocity_of(centre));
        let (from, to) = hull.edge(edge);
        let ends = [from, to].map(|vertex| pose.point(vertex));
        let ahead = usize::from((t.dot(ends[1] - ends[0]) > 0.0) == (slip > 0.0));
        let corner = ends[ahead];
        let near = t.dot(corner - centre).abs() <= disc_room(disc.radius, pose, at);
        (near && slip != 0.0).then(|| ((centre - corner).normalize(), corner))
    };
    match (hulls.0.normals.is_empty(), hulls.1.normals.is_empty()) {
        (false, true) => of_disc(0, normal),
        (true, false) => of_disc(1, -normal).map(|(outward, at)| (-outward, at)),
        _ => None,
    }
}

/// How near to the end of an edge a disc touches the corner there but for rounding, in m: d²/2r is no more than that.
pub(crate) fn disc_room(radius: f64, edge: Pose, disc: Pose) -> f64 {
    (2.0 * radius * end_room(edge.position, disc.position)).sqrt()
}

/// The edge of a hull that lies along a contact; `outward` is the way out of it.
pub(crate) fn flush_edge(hull: &Hull<'_>, pose: Pose, outward: Vec2) -> Option<usize> {
    let local = pose.inverse_vector(outward);
    (0..hull.normals.len()).find(|edge| (hull.normals[*edge] - local).length() <= FLUSH)
}

/// How near to the end of an edge is at its end but for the rounding of where both bodies are, in m.
pub(crate) fn end_room(a: Vec2, b: Vec2) -> f64 {
    16.0 * f64::EPSILON * (a.length() + b.length())
}

/// What of a hull lies along a contact: `outward` is the way out of it, `normal` the touch's own.
pub(crate) fn feature(
    hull: &Hull<'_>,
    pose: Pose,
    outward: Vec2,
    normal: Vec2,
    origin: Vec2,
) -> Feature {
    if hull.normals.is_empty() {
        return if hull.vertices[0] == Vec2::ZERO {
            Feature::Round
        } else {
            Feature::Corner
        };
    }
    let Some(edge) = flush_edge(hull, pose, outward) else {
        return Feature::Corner;
    };
    if hull.is_half_plane() {
        return Feature::Edge {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
    }
    let (from, to) = hull.edge(edge);
    let along = |vertex: Vec2| (pose.point(vertex) - origin).dot(perp(normal));
    let (x, y) = (along(from), along(to));
    Feature::Edge {
        low: if x < y { x } else { y },
        high: if x < y { y } else { x },
    }
}
