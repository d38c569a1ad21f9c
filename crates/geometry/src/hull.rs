//! Convex hulls, exact.

use carom_math::{Vec2, orient2d};

use crate::error::LENGTH_LIMIT;
use crate::{Aabb, PolygonError, ring};

/// Corners of the convex hull, counter-clockwise from the leftmost lowest.
///
/// Monotone chain (A. M. Andrew, 1979) with exact turns: every corner is a true one.
pub(crate) fn convex_hull(points: &[Vec2]) -> Result<Vec<Vec2>, PolygonError> {
    ring::check_points(points)?;
    // −0 becomes 0, so that equal points are neighbours.
    let mut sorted: Vec<Vec2> = points.iter().map(|p| *p + Vec2::ZERO).collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return Err(PolygonError::TooFewVertices {
            count: sorted.len(),
        });
    }
    let extent = Aabb::from_points(sorted.iter().copied())
        .extents()
        .max_element();
    if extent < LENGTH_LIMIT {
        return Err(PolygonError::TooSmall {
            extent,
            limit: LENGTH_LIMIT,
        });
    }
    let lower = chain(sorted.iter());
    let upper = chain(sorted.iter().rev());
    let hull = [&lower[..lower.len() - 1], &upper[..upper.len() - 1]].concat();
    if hull.len() < 3 {
        return Err(PolygonError::Degenerate);
    }
    Ok(hull)
}

/// The left-turning chain along points that are sorted.
fn chain<'a>(sorted: impl Iterator<Item = &'a Vec2>) -> Vec<Vec2> {
    let mut chain: Vec<Vec2> = Vec::new();
    for p in sorted {
        while chain.len() > 1 && orient2d(chain[chain.len() - 2], chain[chain.len() - 1], *p) <= 0.0
        {
            chain.pop();
        }
        chain.push(*p);
    }
    chain
}
