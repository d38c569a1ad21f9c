//! Where a free body sweeps: a box rounded outwards, and the cells of the grid that it covers.

use carom_geometry::Aabb;
use carom_math::vec2;

/// A box in four `f32`, rounded outwards: left, bottom, and right and top with the opposite sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sides(pub(crate) [f32; 4]);

impl Sides {
    /// The box of nothing.
    pub(crate) const NOTHING: Self = Self([f32::INFINITY; 4]);

    pub(crate) fn around(bounds: Aabb) -> Self {
        let (min, max) = (bounds.min, bounds.max);
        Self([min.x, min.y, -max.x, -max.y].map(below))
    }

    pub(crate) fn bounds(self) -> Aabb {
        let [left, bottom, right, top] = self.0.map(f64::from);
        Aabb::new(vec2(left, bottom), vec2(-right, -top))
    }

    pub(crate) fn is_finite(self) -> bool {
        self.0.iter().all(|side| side.is_finite())
    }

    pub(crate) fn overlaps(self, bounds: Aabb) -> bool {
        self.bounds().overlaps(bounds)
    }
}

/// An `f32` that is not above `x`, by at most two units in the last place.
#[expect(
    clippy::cast_possible_truncation,
    reason = "less by more than the cast may round up by"
)]
fn below(x: f64) -> f32 {
    let low = x - x.abs() * f64::from(f32::EPSILON) - f64::from(f32::MIN_POSITIVE);
    // Of the sides of nothing, which are infinite, that is no number.
    if low.is_nan() { x as f32 } else { low as f32 }
}

/// A rectangle of cells, corners included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cells {
    pub(crate) low: (i32, i32),
    pub(crate) high: (i32, i32),
}

impl Cells {
    /// How many there are.
    pub(crate) fn count(self) -> u64 {
        let side = |low: i32, high: i32| high.abs_diff(low).saturating_add(1);
        u64::from(side(self.low.0, self.high.0)) * u64::from(side(self.low.1, self.high.1))
    }

    pub(crate) fn each(self) -> impl Iterator<Item = (i32, i32)> {
        (self.low.1..=self.high.1)
            .flat_map(move |y| (self.low.0..=self.high.0).map(move |x| (x, y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_is_the_box_of_nothing() {
        assert_eq!(Sides::around(Aabb::EMPTY), Sides::NOTHING);
        assert_eq!(Sides::NOTHING.bounds(), Aabb::EMPTY);
    }

    proptest! {
        #[test]
        fn a_box_lies_within_its_sides(
            corner in (-1e9..1e9_f64, -1.0..1.0_f64), size in (0.0..1e9_f64, 0.0..1e-9_f64),
        ) {
            let low = vec2(corner.0, corner.1);
            let bounds = Aabb::new(low, low + vec2(size.0, size.1));
            prop_assert!(Sides::around(bounds).bounds().contains(bounds));
        }
    }
}
