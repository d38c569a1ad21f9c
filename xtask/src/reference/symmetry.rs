//! Exact symmetries of a case: what is asked in another guise must get the same answer.
//!
//! Mirroring and quarter turns move signs and swap coordinates; a shift is taken only where every coordinate stays
//! exact. So the bounds of the case hold unchanged.

use carom_math::{Vec2, two_sum, vec2};

use crate::random::SplitMix;

/// One guise of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Symmetry {
    /// x becomes −x first.
    pub(super) mirrored: bool,
    /// Then turned so often by +90 degrees.
    pub(super) quarter_turns: u8,
    /// Then moved, in m.
    pub(super) shift: Vec2,
    /// A number to choose other labels by.
    pub(super) label: u64,
}

impl Symmetry {
    /// The case as it is.
    pub(super) const NONE: Self = Self {
        mirrored: false,
        quarter_turns: 0,
        shift: Vec2::ZERO,
        label: 0,
    };

    /// A guise that depends on the seed and the name of the case; `points` must stay exact.
    pub(super) fn choose(seed: u64, id: &str, points: &[Vec2]) -> Self {
        // FNV-1a of the name, then SplitMix64.
        let name = id.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = SplitMix::new(seed ^ name);
        let mut symmetry = Self {
            mirrored: random.next().is_multiple_of(2),
            quarter_turns: [0, 1, 2, 3][random.below(4)],
            shift: Vec2::ZERO,
            label: random.next(),
        };
        let placed: Vec<Vec2> = points.iter().map(|&p| symmetry.vector(p)).collect();
        // Sixteen sizes at most: far out the answer itself would lose digits that the bounds count on.
        let from = placed.first().copied().unwrap_or_default();
        let size = placed
            .iter()
            .map(|p| (*p - from).abs().max_element())
            .fold(0.0, f64::max);
        let mut axis = |coordinates: Vec<f64>| {
            let mut tries = (0..12).map(|_| {
                let power = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0][random.below(8)];
                let sign = [-1.0, 1.0][random.below(2)];
                sign * power * power_of_two_below(size)
            });
            let exact = |shift: &f64| coordinates.iter().all(|&x| stays_exact(x, *shift));
            tries.find(exact).unwrap_or(0.0)
        };
        symmetry.shift = vec2(
            axis(placed.iter().map(|p| p.x).collect()),
            axis(placed.iter().map(|p| p.y).collect()),
        );
        symmetry
    }

    /// A direction, velocity or local vertex in the new guise.
    pub(super) fn vector(&self, v: Vec2) -> Vec2 {
        let start = if self.mirrored { vec2(-v.x, v.y) } else { v };
        (0..self.quarter_turns).fold(start, |v, _| vec2(-v.y, v.x))
    }

    /// A place in the new guise.
    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.vector(p) + self.shift
    }

    /// A turning rate or tangential impulse: mirroring changes its sign.
    pub(super) fn turning(&self, w: f64) -> f64 {
        if self.mirrored { -w } else { w }
    }

    /// A vector of the new guise in the old one.
    pub(super) fn vector_back(&self, v: Vec2) -> Vec2 {
        let turned = (0..self.quarter_turns).fold(v, |v, _| vec2(v.y, -v.x));
        if self.mirrored {
            vec2(-turned.x, turned.y)
        } else {
            turned
        }
    }

    /// A place of the new guise in the old one.
    pub(super) fn point_back(&self, p: Vec2) -> Vec2 {
        self.vector_back(p - self.shift)
    }
}

/// Whether x + shift is a double, and so is the way back.
#[expect(clippy::float_cmp, reason = "exactness is the question")]
fn stays_exact(x: f64, shift: f64) -> bool {
    let (sum, lost) = two_sum(x, shift);
    lost == 0.0 && sum - shift == x
}

fn power_of_two_below(size: f64) -> f64 {
    if !(size > 0.0 && size.is_finite()) {
        return 1.0;
    }
    // Clearing the fraction leaves the power of two.
    f64::from_bits(size.to_bits() & (0x7ff << 52))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_exact() {
        let points = [vec2(0.5, -1.25), vec2(3.0, 0.1), vec2(-2.0, 7.0)];
        let mut seen = [false; 2];
        for seed in 0..200 {
            let symmetry = Symmetry::choose(seed, "case", &points);
            seen[usize::from(symmetry.mirrored)] = true;
            for p in points {
                assert_eq!(symmetry.point_back(symmetry.point(p)), p, "{symmetry:?}");
                assert_eq!(symmetry.vector_back(symmetry.vector(p)), p, "{symmetry:?}");
            }
        }
        assert_eq!(seen, [true, true]);
    }

    #[test]
    fn coordinates_that_fit_are_moved() {
        let corners = [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(2.0, 1.0)];
        let moved =
            (0..50).filter(|&seed| Symmetry::choose(seed, "box", &corners).shift != Vec2::ZERO);
        assert!(moved.count() > 45);
    }
}
