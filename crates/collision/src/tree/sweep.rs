//! How far a box is from another: along a way, or at all. Never more than it is.

use carom_geometry::Aabb;
use carom_math::{Vec2, vec2};

use super::bounds::{Bounds, Opposite};

/// More than the few roundings of a distance can lose, of its size.
const SLACK: f32 = 1.0 / (1u32 << 20) as f32;

/// The same for an end of the way, which is found in `f64`.
const END_SLACK: f64 = 1.0 / (1u64 << 50) as f64;

/// A way that leads along an axis by less than this part of its length counts as not leading along
/// it: its end then lies within a few metres of its start even at the far end of the world.
const LEVEL: f64 = 1.0 / (1u64 << 60) as f64;

/// A box on its way along a line.
pub(super) struct Sweep {
    /// The box at the start.
    start: Opposite,
    /// The box around the whole way.
    path: Opposite,
    /// Inverse of the direction along both axes; 0 where it is level.
    inverse: [f32; 2],
    /// By how much the stretch between two sides is longer at both ends: infinity along a level
    /// axis, where the path tells all.
    blur: [f32; 2],
    /// Power of two by which the direction was divided: distances are longer by it.
    pub(super) unit: f64,
}

impl Sweep {
    pub(super) fn new(bounds: Aabb, direction: Vec2, max: f64) -> Self {
        let unit = power_of_two(direction.x.abs().max(direction.y.abs()));
        let scaled = direction / unit;
        let start = Bounds::around(bounds);
        let there = vec2(
            travel(direction.x, max, bounds.min.x.abs().max(bounds.max.x.abs())),
            travel(direction.y, max, bounds.min.y.abs().max(bounds.max.y.abs())),
        );
        let end = Bounds::around(Aabb::new(bounds.min + there, bounds.max + there));
        // Written so that NaN is level.
        let level = scaled.to_array().map(|d| d.abs().max(LEVEL) <= LEVEL);
        let inverse = |d: f64, level: bool| {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "at most 2^60, and SLACK counts its rounding"
            )]
            let inverse = d.recip() as f32;
            if level { 0.0 } else { inverse }
        };
        Self {
            start: start.opposite(),
            path: start.union(end).opposite(),
            inverse: [inverse(scaled.x, level[0]), inverse(scaled.y, level[1])],
            // What is lost below the smallest numbers.
            blur: level.map(|level| {
                if level {
                    f32::INFINITY
                } else {
                    f32::MIN_POSITIVE
                }
            }),
            unit,
        }
    }

    /// Where the box meets another, in units of the way; infinity if it does not.
    #[inline]
    pub(super) fn entry(&self, bounds: Bounds) -> f32 {
        if !bounds.meets(self.path) {
            return f32::INFINITY;
        }
        let sides = bounds.beyond(self.start);
        let (mut enter, mut leave) = (0.0_f32, f32::INFINITY);
        for axis in [0, 1] {
            // Signs of differences are exact: what is touched at the start has far ≥ 0.
            let one = sides[axis] * self.inverse[axis];
            let two = -sides[axis + 2] * self.inverse[axis];
            let (near, far) = if one < two { (one, two) } else { (two, one) };
            let near = near * (1.0 - SLACK) - self.blur[axis];
            let far = far * (1.0 + SLACK) + self.blur[axis];
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        if enter <= leave { enter } else { f32::INFINITY }
    }
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

/// A box to which others are near.
pub(super) struct Near(Opposite);

impl Near {
    pub(super) fn new(bounds: Aabb) -> Self {
        Self(Bounds::around(bounds).opposite())
    }

    /// Distance of a box, in m; 0 if they overlap.
    #[inline]
    pub(super) fn distance(&self, bounds: Bounds) -> f32 {
        let sides = bounds.beyond(self.0);
        let along = |axis: usize| sides[axis].max(sides[axis + 2]).max(0.0);
        let (x, y) = (along(0), along(1));
        let square = x * x + y * y;
        if square < f32::INFINITY {
            square.sqrt() * (1.0 - SLACK)
        } else {
            x.max(y)
        }
    }
}
