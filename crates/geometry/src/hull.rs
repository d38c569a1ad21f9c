//! Convex hulls, exact.

use carom_math::{Vec2, cross, orient2d};

use crate::error::LENGTH_LIMIT;
use crate::{Aabb, PolygonError, ring};

/// Corners of the convex hull, counter-clockwise from the leftmost lowest.
///
/// Monotone chain (A. M. Andrew, 1979) with exact turns: every corner is a true one.
pub(crate) fn convex_hull(points: &[Vec2]) -> Result<Vec<Vec2>, PolygonError> {
    ring::check_points(points)?;
    around(outside_of_the_extremes(points))
}

/// The hull of points of which none is −0.
fn around(mut sorted: Vec<Vec2>) -> Result<Vec<Vec2>, PolygonError> {
    sorted.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
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

/// The points without most of those that are strictly inside the quadrilateral of the leftmost, lowest,
/// rightmost and highest one (S. Akl, G. Toussaint, 1978), in O(n); −0 becomes 0, so that equal
/// points are neighbours.
fn outside_of_the_extremes(points: &[Vec2]) -> Vec<Vec2> {
    /// Fewer points are sorted as fast as they are looked through.
    const FEW: usize = 64;
    /// Above the rounding of a cross product, as a fraction of the lengths in it.
    const ROUNDING: f64 = 1e-14;
    let all = points.iter().map(|p| *p + Vec2::ZERO);
    if points.len() < FEW {
        return all.collect();
    }
    let mut extremes = [points[0] + Vec2::ZERO; 4];
    for p in all.clone() {
        let beyond = [
            p.x < extremes[0].x,
            p.y < extremes[1].y,
            p.x > extremes[2].x,
            p.y > extremes[3].y,
        ];
        for (extreme, beyond) in extremes.iter_mut().zip(beyond) {
            if beyond {
                *extreme = p;
            }
        }
    }
    let [left, low, right, high] = extremes;
    let size = (right.x - left.x) + (high.y - low.y);
    let room = ROUNDING * size * size;
    if left == right || room < f64::MIN_POSITIVE {
        return all.collect();
    }
    // Counter-clockwise; what is left of all sides by more than rounding is no corner. One point may
    // be two of the extremes; the sides that are left go there and back at least.
    let sides = [(left, low), (low, right), (right, high), (high, left)];
    let inside = |p: Vec2| {
        sides
            .iter()
            .filter(|(start, end)| start != end)
            .all(|(start, end)| cross(*end - *start, p - *start) > room)
    };
    all.filter(|p| !inside(*p)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::{Rot, vec2};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn points_that_are_left_out_are_no_corners(
            cloud in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 3..300),
            lattice in 1..=50_i32, thin in 0..30_i32, turn in -4.0..4.0_f64, tidy in any::<bool>(),
        ) {
            let step = 1.0 / f64::from(lattice);
            let flat = (0..thin).fold(1.0, |flat, _| 0.5 * flat);
            let turn = if tidy { Rot::IDENTITY } else { Rot::from_angle(turn) };
            let points: Vec<Vec2> = cloud
                .iter()
                .map(|(x, y)| turn * vec2((x / step).round() * step, (y / step).round() * step * flat))
                .map(|p| p + Vec2::ZERO)
                .collect();
            prop_assert_eq!(convex_hull(&points), around(points));
        }
    }
}
