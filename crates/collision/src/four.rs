//! Hulls of three or four corners: all edges at once, with nothing to count and nowhere to walk.
//!
//! A block repeats the last corner and edge of a triangle, which changes neither the least nor the first of equals.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_geometry::EdgeBlock;
use carom_math::{Rot, Vec2};

use crate::Hull;
use crate::lanes::{over, smaller};

/// The only block of a hull.
#[inline(always)]
pub(crate) const fn only<'a>(hull: &Hull<'a>) -> Option<&'a EdgeBlock> {
    match hull.blocks {
        [block] => Some(block),
        _ => None,
    }
}

/// [`crate::lanes::heights`] over the corners of a block.
#[inline(always)]
fn heights(block: &EdgeBlock, facing: &EdgeBlock, turn: Rot, offset: Vec2) -> [f64; 4] {
    let (cos, sin) = (turn.cos(), turn.sin());
    let mut x = [0.0; 4];
    let mut y = [0.0; 4];
    for lane in 0..4 {
        x[lane] = cos * block.normal_x[lane] + sin * block.normal_y[lane];
        y[lane] = cos * block.normal_y[lane] - sin * block.normal_x[lane];
    }
    let mut low = [f64::INFINITY; 4];
    for corner in 0..4 {
        for lane in 0..4 {
            let along = x[lane] * facing.x[corner] + y[lane] * facing.y[corner];
            low[lane] = smaller(along, low[lane]);
        }
    }
    for (lane, low) in low.iter_mut().enumerate() {
        *low += over(block, lane, offset);
    }
    low
}

/// Which edge is farthest from the corners of `facing`, the first of equals, and its height.
#[inline]
pub(crate) fn widest_edge(
    block: &EdgeBlock,
    facing: &EdgeBlock,
    turn: Rot,
    offset: Vec2,
) -> (usize, f64) {
    let high = heights(block, facing, turn, offset);
    let later = |i: (usize, f64), j: (usize, f64)| if j.1 > i.1 { j } else { i };
    later(
        later((0, high[0]), (1, high[1])),
        later((2, high[2]), (3, high[3])),
    )
}

/// The corner with the smallest `direction · q`, the first of equals, and that.
#[inline]
pub(crate) fn lowest(block: &EdgeBlock, direction: Vec2) -> (usize, f64) {
    let mut low = [0.0; 4];
    for (lane, low) in low.iter_mut().enumerate() {
        *low = direction.x * block.x[lane] + direction.y * block.y[lane];
    }
    let earlier = |i: (usize, f64), j: (usize, f64)| if j.1 < i.1 { j } else { i };
    earlier(
        earlier((0, low[0]), (1, low[1])),
        earlier((2, low[2]), (3, low[3])),
    )
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;
    use carom_math::vec2;
    use proptest::prelude::*;

    use super::*;
    use crate::{Convex, lanes};

    proptest! {
        #[test]
        fn all_at_once_are_one_by_one(
            corners in (3..5_usize, 3..5_usize), angle in -4.0..4.0_f64, x in -3.0..3.0_f64, y in -3.0..3.0_f64, tidy in any::<bool>(),
        ) {
            let (own, facing) = (ConvexPolygon::regular(corners.0, 1.0).unwrap(), ConvexPolygon::regular(corners.1, 0.7).unwrap());
            let turn = if tidy { Rot::from_degrees((angle * 4.0).round() * 30.0) } else { Rot::from_angle(angle) };
            let (offset, direction) = (vec2(x, y), turn * vec2(1.0, 0.0));
            let without = |polygon| Hull { blocks: &[], ..polygon };
            let [mine, theirs] = [own.hull(), facing.hull()].map(|hull| *only(&hull).unwrap());
            let slow = lanes::widest_edge(&without(own.hull()), &without(facing.hull()), turn, offset);
            prop_assert_eq!(widest_edge(&mine, &theirs, turn, offset), slow);
            prop_assert_eq!(lowest(&mine, direction), lanes::lowest(&without(own.hull()), direction));
        }
    }
}
