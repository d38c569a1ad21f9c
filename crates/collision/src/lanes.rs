//! Corners and edges of a hull, four at a time where it has them in blocks.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_geometry::EdgeBlock;
use carom_math::{Rot, Vec2};

use crate::Hull;

/// The smaller of two numbers that are none of them NaN: one instruction, unlike `f64::min`.
#[inline(always)]
pub(crate) fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

/// The larger of two numbers that are none of them NaN.
#[inline(always)]
pub(crate) fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The vertex with the smallest `direction · q` (the first of equals), and that, in m for a unit direction.
pub(crate) fn lowest(hull: &Hull<'_>, direction: Vec2) -> (usize, f64) {
    if hull.blocks.is_empty() {
        let mut best = (0, f64::INFINITY);
        for (i, q) in hull.vertices.iter().enumerate() {
            let along = direction.dot(*q);
            if along < best.1 {
                best = (i, along);
            }
        }
        return best;
    }
    let along = |block: &EdgeBlock| {
        [0, 1, 2, 3].map(|lane| direction.x * block.x[lane] + direction.y * block.y[lane])
    };
    let mut low = along(&hull.blocks[0]);
    let mut at = [0, 1, 2, 3_usize];
    for (number, block) in hull.blocks.iter().enumerate().skip(1) {
        let next = along(block);
        for lane in 0..4 {
            let less = next[lane] < low[lane];
            low[lane] = if less { next[lane] } else { low[lane] };
            at[lane] = if less { 4 * number + lane } else { at[lane] };
        }
    }
    let first = |i: (usize, f64), j: (usize, f64)| {
        if j.1 < i.1 || (j.1 <= i.1 && j.0 < i.0) {
            j
        } else {
            i
        }
    };
    let lane = |k: usize| (at[k], low[k]);
    first(first(lane(0), lane(1)), first(lane(2), lane(3)))
}

/// Largest distance of a vertex from the origin, in m.
pub(crate) fn farthest(hull: &Hull<'_>) -> f64 {
    let Some((first, rest)) = hull.blocks.split_first() else {
        let squares = hull.vertices.iter().map(|q| q.length_squared());
        return squares.fold(0.0, larger).sqrt();
    };
    let square = |block: &EdgeBlock, lane: usize| {
        block.x[lane] * block.x[lane] + block.y[lane] * block.y[lane]
    };
    let mut most = [0, 1, 2, 3].map(|lane| square(first, lane));
    for block in rest {
        for (lane, most) in most.iter_mut().enumerate() {
            *most = larger(square(block, lane), *most);
        }
    }
    larger(larger(most[0], most[1]), larger(most[2], most[3])).sqrt()
}

/// The smallest `direction · q` of all vertices but one, in m for a unit direction.
pub(crate) fn lowest_other(hull: &Hull<'_>, direction: Vec2, vertex: usize) -> f64 {
    let others = hull
        .vertices
        .iter()
        .enumerate()
        .filter(|(i, _)| *i != vertex);
    others.fold(f64::INFINITY, |low, (_, q)| smaller(direction.dot(*q), low))
}

/// The largest of all edges but one of how far the lower of two points is over the edge's line, in m: no edge
/// separates a hull with these points from this one by more.
pub(crate) fn highest_over(hull: &Hull<'_>, points: [Vec2; 2], but: Option<usize>) -> f64 {
    let mut high = f64::NEG_INFINITY;
    let [p, q] = points;
    for (number, block) in hull.blocks.iter().enumerate() {
        let over = [0, 1, 2, 3].map(|lane| smaller(over(block, lane, p), over(block, lane, q)));
        for (lane, height) in over.into_iter().enumerate() {
            let edge = 4 * number + lane;
            if height > high && edge < hull.normals.len() && Some(edge) != but {
                high = height;
            }
        }
    }
    high
}

/// How far a point is over the line of an edge, in m.
#[inline(always)]
pub(crate) fn over(block: &EdgeBlock, lane: usize, p: Vec2) -> f64 {
    block.normal_x[lane] * (p.x - block.x[lane]) + block.normal_y[lane] * (p.y - block.y[lane])
}

/// How far each of four edges separates its hull from `facing`, in m, without radii: the height of the
/// lowest vertex of `facing` over the edge's line.
///
/// `turn` and `offset` are the pose of `facing` in the edges' frame.
pub(crate) fn heights(block: &EdgeBlock, facing: &Hull<'_>, turn: Rot, offset: Vec2) -> [f64; 4] {
    let (cos, sin) = (turn.cos(), turn.sin());
    let mut x = [0.0; 4];
    let mut y = [0.0; 4];
    let mut low = [f64::INFINITY; 4];
    // n·(R q + d − p) = (R⁻¹ n)·q + n·(d − p)
    for lane in 0..4 {
        x[lane] = cos * block.normal_x[lane] + sin * block.normal_y[lane];
        y[lane] = cos * block.normal_y[lane] - sin * block.normal_x[lane];
    }
    for q in facing.vertices {
        for lane in 0..4 {
            low[lane] = smaller(x[lane] * q.x + y[lane] * q.y, low[lane]);
        }
    }
    [0, 1, 2, 3].map(|lane| low[lane] + over(block, lane, offset))
}

/// Which edge of `own` is farthest from `facing`, the first of equals, and its height: see [`heights`].
pub(crate) fn widest_edge(
    own: &Hull<'_>,
    facing: &Hull<'_>,
    turn: Rot,
    offset: Vec2,
) -> (usize, f64) {
    let mut best = (0, f64::NEG_INFINITY);
    if own.blocks.is_empty() {
        each_height(own, facing, turn, offset, |edge, height| {
            if height > best.1 {
                best = (edge, height);
            }
        });
        return best;
    }
    let mut high = heights(&own.blocks[0], facing, turn, offset);
    let mut at = [0, 1, 2, 3_usize];
    for (number, block) in own.blocks.iter().enumerate().skip(1) {
        let next = heights(block, facing, turn, offset);
        for lane in 0..4 {
            let more = next[lane] > high[lane];
            high[lane] = if more { next[lane] } else { high[lane] };
            at[lane] = if more { 4 * number + lane } else { at[lane] };
        }
    }
    let first = |i: (usize, f64), j: (usize, f64)| {
        if j.1 > i.1 || (j.1 >= i.1 && j.0 < i.0) {
            j
        } else {
            i
        }
    };
    let lane = |k: usize| (at[k], high[k]);
    // Edges that pad the last block repeat the last one, which comes before them.
    first(first(lane(0), lane(1)), first(lane(2), lane(3)))
}

/// Visits every edge of `own` with its height under `facing`, in order: see [`heights`].
pub(crate) fn each_height(
    own: &Hull<'_>,
    facing: &Hull<'_>,
    turn: Rot,
    offset: Vec2,
    mut visit: impl FnMut(usize, f64),
) {
    if own.blocks.is_empty() {
        for (edge, normal) in own.normals.iter().enumerate() {
            let base = normal.dot(offset - own.vertices[edge]);
            visit(edge, lowest(facing, turn.inverse_mul(*normal)).1 + base);
        }
        return;
    }
    for (number, block) in own.blocks.iter().enumerate() {
        let four = heights(block, facing, turn, offset);
        for (lane, height) in four.into_iter().enumerate() {
            visit(4 * number + lane, height);
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;
    use proptest::prelude::*;

    use super::*;
    use crate::Convex;

    proptest! {
        #[test]
        fn four_at_a_time_are_one_by_one(
            sides in 3..14_usize, other in 3..14_usize, angle in -4.0..4.0_f64, x in -3.0..3.0_f64, y in -3.0..3.0_f64,
        ) {
            let (own, facing) = (ConvexPolygon::regular(sides, 1.0).unwrap(), ConvexPolygon::regular(other, 0.7).unwrap());
            let without = |polygon| Hull { blocks: &[], ..polygon };
            let direction = Rot::from_angle(angle) * vec2(1.0, 0.0);
            prop_assert_eq!(lowest(&own.hull(), direction), lowest(&without(own.hull()), direction));

            let (turn, offset) = (Rot::from_angle(angle), vec2(x, y));
            let mut slow = Vec::new();
            each_height(&without(own.hull()), &without(facing.hull()), turn, offset, |edge, height| slow.push((edge, height)));
            let mut fast = Vec::new();
            each_height(&own.hull(), &facing.hull(), turn, offset, |edge, height| fast.push((edge, height)));
            prop_assert_eq!(&fast[..slow.len()], &slow[..]);
            let widest = slow.iter().fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { *next } else { best });
            prop_assert_eq!(widest_edge(&own.hull(), &facing.hull(), turn, offset), widest);
            // The last edge again, as padding.
            prop_assert!(fast[slow.len()..].iter().all(|(_, height)| *height == slow[slow.len() - 1].1));
        }
    }
}
