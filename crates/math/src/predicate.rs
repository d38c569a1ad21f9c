//! Signs that decide topology: exact, by Shewchuk's adaptive predicates (crate `robust`).

use robust::Coord;

use crate::Vec2;

/// Twice the signed area of the triangle `a b c`; the sign is exact.
///
/// Positive: counter-clockwise. Zero: exactly on one line. The value is right to rounding.
/// Source: J. R. Shewchuk, *Adaptive Precision Floating-Point Arithmetic*, 1997.
#[must_use]
pub fn orient2d(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    robust::orient2d(coord(a), coord(b), coord(c))
}

fn coord(p: Vec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{cross, vec2};

    #[test]
    fn sign_is_exact_where_the_plain_product_rounds_to_zero() {
        // (0.5, 0.5 + 2^-53·k) against the diagonal far away: the naive product cannot tell.
        let c = vec2(24.0, 24.0);
        let b = vec2(12.0, 12.0);
        let on = vec2(0.5, 0.5);
        let above = vec2(0.5, 0.5_f64.next_up());
        assert_eq!(orient2d(on, b, c), 0.0);
        assert!(orient2d(above, b, c) > 0.0);
        assert_eq!(
            cross(b - above, c - above),
            0.0,
            "the plain product is the trap"
        );
    }
}
