//! Boxes of four `f32`, rounded outwards.

use carom_geometry::Aabb;
use carom_math::{Vec2, vec2};

/// Beyond this, in metres, a box counts as reaching to infinity: no perimeter overflows.
const FAR: f64 = 1e37;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    min: [f32; 2],
    max: [f32; 2],
}

impl Bounds {
    /// The smallest `f32` box around an `f64` one.
    pub(super) fn around(bounds: Aabb) -> Self {
        Self {
            min: [down(bounds.min.x), down(bounds.min.y)],
            max: [up(bounds.max.x), up(bounds.max.y)],
        }
    }

    pub(super) fn widened(self) -> Aabb {
        let wide = |p: [f32; 2]| vec2(f64::from(p[0]), f64::from(p[1]));
        Aabb::new(wide(self.min), wide(self.max))
    }

    pub(super) fn overlaps(self, other: Self) -> bool {
        self.min[0] <= other.max[0]
            && other.min[0] <= self.max[0]
            && self.min[1] <= other.max[1]
            && other.min[1] <= self.max[1]
    }

    pub(super) fn contains(self, other: Self) -> bool {
        self.min[0] <= other.min[0]
            && other.max[0] <= self.max[0]
            && self.min[1] <= other.min[1]
            && other.max[1] <= self.max[1]
    }

    pub(super) fn union(self, other: Self) -> Self {
        let low = |i: usize| {
            if other.min[i] < self.min[i] {
                other.min[i]
            } else {
                self.min[i]
            }
        };
        let high = |i: usize| {
            if other.max[i] > self.max[i] {
                other.max[i]
            } else {
                self.max[i]
            }
        };
        Self {
            min: [low(0), low(1)],
            max: [high(0), high(1)],
        }
    }

    /// Half of the way around.
    pub(super) fn perimeter(self) -> f32 {
        (self.max[0] - self.min[0]) + (self.max[1] - self.min[1])
    }

    /// Where a ray enters the box, in lengths of its direction; `None` if it misses it before `max`.
    ///
    /// The slab test, with a slack of a few roundings, so that a leaf that is touched is found.
    pub(super) fn entry(self, ray: &Ray, max: f64) -> Option<f64> {
        let (mut enter, mut leave) = (0.0_f64, max);
        for axis in [0, 1] {
            let low = f64::from(self.min[axis]) - ray.origin[axis];
            let high = f64::from(self.max[axis]) - ray.origin[axis];
            if ray.inverse[axis].is_infinite() {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (first, second) = (low * ray.inverse[axis], high * ray.inverse[axis]);
            let (near, far) = if first < second {
                (first, second)
            } else {
                (second, first)
            };
            // Relative 2^-50: the difference, the inverse and the product round once each.
            const SLACK: f64 = 1.0 / (1u64 << 50) as f64;
            enter = enter.max(near - near.abs() * SLACK);
            leave = leave.min(far + far.abs() * SLACK);
        }
        (enter <= leave).then_some(enter)
    }
}

/// A ray with the inverse of its direction.
pub(super) struct Ray {
    origin: [f64; 2],
    inverse: [f64; 2],
}

impl Ray {
    pub(super) fn new(origin: Vec2, direction: Vec2) -> Self {
        Self {
            origin: origin.to_array(),
            inverse: [1.0 / direction.x, 1.0 / direction.y],
        }
    }
}

/// The largest `f32` that is not above `x`; NaN counts as −∞.
fn down(x: f64) -> f32 {
    // Written so that NaN takes the first way.
    let x = if x > -FAR { x.min(FAR) } else { -FAR };
    #[expect(clippy::cast_possible_truncation, reason = "corrected below")]
    let near = x as f32;
    if f64::from(near) > x {
        near.next_down()
    } else {
        near
    }
}

/// The smallest `f32` that is not below `x`; NaN counts as +∞.
fn up(x: f64) -> f32 {
    -down(-x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rounding_goes_outwards_and_no_farther_than_one_step(x in -1e30..1e30_f64, scale in 1e-40..1.0_f64) {
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
        assert!(all.contains(Bounds::around(Aabb::new(vec2(-1e12, 0.0), vec2(1e12, 1.0)))));
        assert!(all.perimeter().is_finite());
    }
}
