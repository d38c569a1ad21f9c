//! Boxes of four `f32`, rounded outwards.

use carom_geometry::Aabb;
use carom_math::vec2;

/// Beyond this, in metres, a box counts as reaching to infinity: no perimeter overflows, not even
/// the sum of those of 2^31 leaves.
const FAR: f64 = 1e24;

/// A side beyond all others, and not only by a rounding.
const NOWHERE: f32 = 4e24;

/// A box as (x₀, y₀, −x₁, −y₁): every side counts outwards downwards, so that a union is four
/// minima and a comparison is four of the same kind, one instruction each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds([f32; 4]);

impl Bounds {
    /// Overlaps nothing, and any union leaves it.
    pub(super) const EMPTY: Self = Self([NOWHERE; 4]);

    /// The smallest `f32` box around an `f64` one; a side that is no number is infinitely far out.
    pub(super) fn around(bounds: Aabb) -> Self {
        if bounds.min.x > bounds.max.x || bounds.min.y > bounds.max.y {
            return Self::EMPTY;
        }
        Self([
            down(bounds.min.x),
            down(bounds.min.y),
            down(-bounds.max.x),
            down(-bounds.max.y),
        ])
    }

    /// The box in `f64`; what reaches beyond all numbers of the tree is infinite.
    pub(super) fn widened(self) -> Aabb {
        if self == Self::EMPTY {
            return Aabb::EMPTY;
        }
        let wide = |x: f32| {
            let x = f64::from(x);
            if x <= -FAR { f64::NEG_INFINITY } else { x }
        };
        let [x0, y0, x1, y1] = self.0.map(wide);
        Aabb::new(vec2(x0, y0), vec2(-x1, -y1))
    }

    #[inline]
    pub(super) fn overlaps(self, other: Self) -> bool {
        self.meets(other.opposite())
    }

    /// The box as the largest lower and smallest upper sides of those that overlap it.
    #[inline]
    pub(super) fn opposite(self) -> Opposite {
        let [x0, y0, x1, y1] = self.0;
        Opposite([-x1, -y1, -x0, -y0])
    }

    #[inline]
    pub(super) fn meets(self, other: Opposite) -> bool {
        at_most(self.0, other.0)
    }

    #[inline]
    pub(super) fn contains(self, other: Self) -> bool {
        at_most(self.0, other.0)
    }

    #[inline]
    pub(super) fn union(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        // Not f32::min: that one asks for NaN, and there is none.
        let less = |i: usize| if a[i] < b[i] { a[i] } else { b[i] };
        Self([less(0), less(1), less(2), less(3)])
    }

    /// Half of the way around.
    #[inline]
    pub(super) fn perimeter(self) -> f32 {
        let [x0, y0, x1, y1] = self.0;
        -((x0 + x1) + (y0 + y1))
    }

    /// How far every side is from the one of `other` that it would touch; outwards is above 0.
    #[inline]
    pub(super) fn beyond(self, other: Opposite) -> [f32; 4] {
        let (a, b) = (self.0, other.0);
        [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
    }

    /// Twice the middle.
    #[inline]
    pub(super) fn middle(self) -> [f32; 2] {
        let [x0, y0, x1, y1] = self.0;
        [x0 - x1, y0 - y1]
    }
}

/// A box with its sides as those of the boxes that just touch it; see [`Bounds::opposite`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Opposite([f32; 4]);

/// Whether no number is above its partner: all are compared, without a branch between.
#[inline]
fn at_most(a: [f32; 4], b: [f32; 4]) -> bool {
    (a[0] <= b[0]) & (a[1] <= b[1]) & (a[2] <= b[2]) & (a[3] <= b[3])
}

/// The smallest `f32` that is not below `x`; NaN counts as +∞.
pub(super) fn up(x: f64) -> f32 {
    -down(-x)
}

/// The largest `f32` that is not above `x`; NaN counts as −∞.
fn down(x: f64) -> f32 {
    // Written so that NaN takes the second way.
    let x = if x > -FAR { x.min(FAR) } else { -FAR };
    #[expect(clippy::cast_possible_truncation, reason = "corrected below")]
    let near = x as f32;
    if f64::from(near) > x {
        near.next_down()
    } else {
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rounding_goes_outwards_and_no_farther_than_one_step(x in -1e23..1e23_f64, scale in 1e-40..1.0_f64) {
            let x = x * scale;
            let (low, high) = (down(x), up(x));
            prop_assert!(f64::from(low) <= x && x <= f64::from(high));
            prop_assert!(low == high || low.next_up() == high, "{low:e} {x:e} {high:e}");
        }
    }

    #[test]
    fn what_is_not_finite_reaches_everywhere() {
        let all = Bounds::around(Aabb::new(
            vec2(f64::NAN, -f64::INFINITY),
            vec2(f64::NAN, f64::INFINITY),
        ));
        let wide = Bounds::around(Aabb::new(vec2(-1e12, 0.0), vec2(1e12, 1.0)));
        assert!(all.contains(wide) && all.overlaps(wide) && !wide.contains(all));
        assert!(all.perimeter().is_finite());
        assert_eq!(all.widened().max, vec2(f64::INFINITY, f64::INFINITY));
    }

    #[test]
    fn the_empty_box_is_met_by_nothing() {
        let all = Bounds::around(Aabb::new(
            vec2(f64::NAN, f64::NAN),
            vec2(f64::NAN, f64::NAN),
        ));
        let none = Bounds::around(Aabb::EMPTY);
        assert!(!none.overlaps(all) && !all.overlaps(none) && !none.overlaps(none));
        assert!(none.union(all) == all && none.widened() == Aabb::EMPTY);
    }
}
