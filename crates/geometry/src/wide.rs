//! Numbers of twice the digits, for sums that cancel.

use core::ops::{Add, Mul, Neg, Sub};

use carom_math::{two_product, two_sum};

/// An unevaluated sum of two doubles, about 106 bits (T. J. Dekker, 1971).
///
/// Sums and products are right to 2⁻¹⁰² of the larger operand, or of the product.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide {
    high: f64,
    low: f64,
}

impl Wide {
    pub(crate) const ZERO: Self = Self {
        high: 0.0,
        low: 0.0,
    };

    /// `a − b`, exact.
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Self { high, low }
    }

    /// The two doubles of which it is the sum.
    pub(crate) const fn parts(self) -> [f64; 2] {
        [self.high, self.low]
    }

    /// Rounded once.
    pub(crate) const fn value(self) -> f64 {
        self.high
    }

    /// `self / divisor`, rounded about once.
    pub(crate) fn over(self, divisor: Self) -> f64 {
        let quotient = self.high / divisor.high;
        let rest = self - divisor * quotient;
        quotient + rest.high / divisor.high
    }

    /// The sum of two parts of which the first is the larger.
    fn renormalized(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self {
            high: sum,
            low: low - (sum - high),
        }
    }
}

impl Add for Wide {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        // Both halves by exact sums: the cheaper form loses all where the high halves cancel.
        let (high, error) = two_sum(self.high, b.high);
        let (low, small) = two_sum(self.low, b.low);
        let first = Self::renormalized(high, error + low);
        Self::renormalized(first.high, first.low + small)
    }
}

impl Neg for Wide {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for Wide {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Wide {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        let (high, error) = two_product(self.high, b.high);
        Self::renormalized(high, error + (self.high * b.low + self.low * b.high))
    }
}

impl Mul<f64> for Wide {
    type Output = Self;

    fn mul(self, b: f64) -> Self {
        let (high, error) = two_product(self.high, b);
        Self::renormalized(high, error + self.low * b)
    }
}

impl From<f64> for Wide {
    fn from(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_digits_survive_a_cancellation() {
        // (1 + e)(1 − e) − 1 = −e², with e = 2⁻⁵⁰: plain doubles give 0.
        let e = f64::EPSILON * 4.0;
        let one = Wide::from(1.0);
        let product = (one + Wide::from(e)) * (one - Wide::from(e)) - one;
        assert_eq!(product.value(), -e * e);
    }

    #[test]
    fn a_quotient_is_rounded_about_once() {
        let third = Wide::from(1.0).over(Wide::from(3.0));
        assert_eq!(third, 1.0 / 3.0);
        let tiny = Wide::difference(1.0, 1.0 - f64::EPSILON).over(Wide::from(f64::EPSILON));
        assert_eq!(tiny, 1.0);
    }
}
