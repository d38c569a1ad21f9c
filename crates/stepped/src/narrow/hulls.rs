//! Pieces of any kind to their manifold, by `carom-collision`: half-planes, more corners.

use carom_collision::{Hull, collide_within};
use carom_math::{Pose, cross, perp};

use super::Manifold;
use crate::pieces::Piece;

/// The contact of two pieces if their gap is below `limit`, in m.
pub(crate) fn collide_any(a: (&Piece, Pose), b: (&Piece, Pose), limit: f64) -> Option<Manifold> {
    let ((a, pose_a), (b, pose_b)) = (a, b);
    let radii = a.rounding + b.rounding;
    let b_in_a = pose_b.seen_from(pose_a);
    let mut hulls = [a.hull(), b.hull()];
    if hulls.iter().any(Hull::is_half_plane) {
        // Its normal is the only one. A corner at the end of a cut belongs to both pieces: if the plane met one of them, a body
        // that stands on that corner would change pieces as it rocks, and lose its impulse.
        hulls = hulls.map(|hull| Hull {
            boundary: None,
            ..hull
        });
    }
    let found = collide_within(&hulls[0], &hulls[1], b_in_a, limit + radii);
    let d = pose_b.position - pose_a.position;
    let n = pose_a.vector(found.normal);
    let arm = |k: usize| pose_a.vector(found.points[k].point);
    let gap = |k: usize| found.points[k].separation - radii;
    match found.points.len() {
        0 => None,
        1 => Some(Manifold::single(n, [arm(0), arm(0) - d], gap(0))),
        _ => {
            let along = |k: usize| perp(n).dot(arm(k));
            let (first, second) = if along(0) >= along(1) { (0, 1) } else { (1, 0) };
            let nearest = if gap(1) < gap(0) { 1 } else { 0 };
            let (height, half) = (arm(nearest).dot(n), 0.5 * gap(nearest).max(0.0));
            Some(Manifold {
                normal: n,
                arm_a: cross(arm(first), n),
                arm_b: cross(arm(first) - d, n),
                length: along(first) - along(second),
                points: 2,
                tangent_a: height - half,
                tangent_b: height + half - d.dot(n),
                gaps: [gap(first), gap(second)],
            })
        }
    }
}

/// Whether two pieces, of which a cut bounds one, are in each other by more than a margin as convex shapes.
pub(super) fn overlaps_across_cuts(a: (&Piece, Pose), b: (&Piece, Pose), margin: f64) -> bool {
    let ((a, pose_a), (b, pose_b)) = (a, b);
    let hulls = [a.hull(), b.hull()];
    if hulls.iter().all(|hull| hull.boundary.is_none()) || hulls.iter().any(Hull::is_half_plane) {
        return false;
    }
    let [first, second] = hulls.map(|hull| Hull {
        boundary: None,
        ..hull
    });
    let found = collide_within(&first, &second, pose_b.seen_from(pose_a), 0.0);
    let deepest = a.rounding + b.rounding - margin;
    found.points.iter().any(|point| point.separation < deepest)
}
