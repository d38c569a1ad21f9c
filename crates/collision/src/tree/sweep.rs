//! How far a box is from another: along a way, or at all. Never more than it is.

use carom_geometry::Aabb;
use carom_math::{Vec2, vec2};

use super::bounds::{Bounds, Opposite, up};

/// More than the few roundings of a distance can lose, of its size.
const SLACK: f32 = 1.0 / (1u32 << 20) as f32;

/// The same for an end of the way, which is found in `f64`.
const END_SLACK: f64 = 1.0 / (1u64 << 50) as f64;

/// A way that leads along an axis by less than this part of its length counts as not leading along
/// it: its end then lies within a few metres of its start even at the far end of the world.
const LEVEL: f64 = 1.0 / (1u64 << 60) as f64;

/// What a level axis has for the inverse of its direction: all that is a roundable way off its
/// sides is farther than the end of the world.
const STEEP: f32 = 1e37;

/// A box on its way along a line.
pub(super) struct Sweep {
    /// The box at the start; along a level axis, a little more than on the whole way.
    start: Opposite,
    /// The box around the whole way.
    path: Opposite,
    /// Inverse of the direction along both axes.
    inverse: [f32; 2],
    /// Power of two by which the direction was divided: distances are longer by it.
    pub(super) unit: f64,
}

impl Sweep {
    pub(super) fn new(bounds: Aabb, direction: Vec2, max: f64) -> Self {
        let unit = power_of_two(direction.x.abs().max(direction.y.abs()));
        let scaled = (direction / unit).to_array();
        let size = bounds.min.abs().max(bounds.max.abs());
        let there = vec2(
            travel(direction.x, max, size.x),
            travel(direction.y, max, size.y),
        );
        let path = bounds.union(Aabb::new(bounds.min + there, bounds.max + there));
        // Written so that NaN is level.
        let level = scaled.map(|d| d.abs().max(LEVEL) <= LEVEL);
        let mut start = bounds;
        for axis in [0, 1] {
            if level[axis] {
                // Whatever meets the path lies on both sides of this one, and is met all the time.
                let room = 1.0 + size[axis] * f64::from(SLACK);
                start.min[axis] = path.min[axis] - room;
                start.max[axis] = path.max[axis] + room;
            }
        }
        let inverse = |axis: usize| {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "at most 2^60, and SLACK counts its rounding"
            )]
            let inverse = scaled[axis].recip() as f32;
            if level[axis] { STEEP } else { inverse }
        };
        Self {
            start: Bounds::around(start).opposite(),
            path: Bounds::around(path).opposite(),
            inverse: [inverse(0), inverse(1)],
            unit,
        }
    }

    /// Where the box meets another, in units of the way; infinity if it does not.
    #[inline]
    pub(super) fn entry(&self, bounds: Bounds) -> f32 {
        // Signs of differences are exact: what is touched at the start has a stretch that ends at
        // 0 or later, along both axes.
        let [low_x, low_y, high_x, high_y] = bounds.beyond(self.start);
        let (x0, x1) = (low_x * self.inverse[0], -high_x * self.inverse[0]);
        let (y0, y1) = (low_y * self.inverse[1], -high_y * self.inverse[1]);
        let enter = larger(larger(less(x0, x1), less(y0, y1)), 0.0) * (1.0 - SLACK);
        let leave = less(larger(x0, x1), larger(y0, y1)) * (1.0 + SLACK) + f32::MIN_POSITIVE;
        if (enter <= leave) & bounds.meets(self.path) {
            enter
        } else {
            f32::INFINITY
        }
    }
}

/// Not `f32::min`, which asks for NaN: there is none.
#[inline]
pub(super) fn less(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The largest power of two that is not above `x`; 1 if there is none.
fn power_of_two(x: f64) -> f64 {
    let power = f64::from_bits(x.to_bits() & f64::INFINITY.to_bits());
    if power > 0.0 && power < f64::INFINITY {
        power
    } else {
        1.0
    }
}

/// How far a side goes along an axis, and a little farther for its roundings.
fn travel(direction: f64, max: f64, from: f64) -> f64 {
    if direction == 0.0 {
        return 0.0;
    }
    let way = direction * max;
    way + (way.abs() + from).copysign(way) * END_SLACK
}

/// In this unit of length, in 1/m, no square of a distance overflows, and none above (1e-13 m)²
/// underflows.
const UNIT: f32 = 1.0 / (1u32 << 20) as f32;

/// A box to which others are near.
pub(super) struct Near(Opposite);

impl Near {
    pub(super) fn new(bounds: Aabb) -> Self {
        Self(Bounds::around(bounds).opposite())
    }

    /// Square of the distance of a box, in (2^20 m)²; 0 if they overlap.
    #[inline]
    pub(super) fn square(&self, bounds: Bounds) -> f32 {
        let sides = bounds.beyond(self.0);
        let along = |axis: usize| larger(larger(sides[axis], sides[axis + 2]), 0.0) * UNIT;
        let (x, y) = (along(0), along(1));
        x * x + y * y
    }

    /// The largest of these squares at a distance, in m.
    pub(super) fn limit(distance: f64) -> f32 {
        if distance < 0.0 {
            return -1.0;
        }
        let units = up(distance) * UNIT;
        units * units * (1.0 + 4.0 * SLACK) + 2.0 * f32::MIN_POSITIVE
    }
}
