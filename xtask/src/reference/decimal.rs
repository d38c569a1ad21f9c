//! Decimals with more digits than a double, for errors below its rounding.

use carom_math::{two_product, two_sum};

/// A number as the unevaluated sum of two doubles, about 31 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Decimal {
    high: f64,
    low: f64,
}

impl Decimal {
    /// Reads `-1.25e-7` and the like; relative error below 1e-29 while the exponent is within ±250.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let nearest: f64 = text.parse().ok()?;
        if !nearest.is_finite() {
            return None;
        }
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse().ok()?),
            None => (text, 0_i32),
        };
        let negative = mantissa.starts_with('-');
        let mut number = Self::from(0.0);
        let mut behind_point = None;
        for byte in mantissa.bytes() {
            match byte {
                b'0'..=b'9' => {
                    number = number.times(10.0).plus(f64::from(byte - b'0'));
                    behind_point = behind_point.map(|count: i32| count + 1);
                }
                b'.' => behind_point = Some(0),
                _ => {}
            }
        }
        let mut power = exponent - behind_point.unwrap_or(0);
        while power > 0 {
            let step = power.min(22);
            number = number.times(ten_to(step));
            power -= step;
        }
        while power < 0 {
            let step = (-power).min(22);
            number = number.over(ten_to(step));
            power += step;
        }
        Some(if negative { number.negated() } else { number })
    }

    /// The nearest double.
    pub(super) const fn nearest(self) -> f64 {
        self.high
    }

    /// `got` less this number.
    pub(super) fn offset_of(self, got: f64) -> f64 {
        let (difference, lost) = two_sum(got, -self.high);
        difference + (lost - self.low)
    }

    fn plus(self, other: f64) -> Self {
        let (sum, lost) = two_sum(self.high, other);
        Self::normal(sum, lost + self.low)
    }

    fn times(self, factor: f64) -> Self {
        let (product, lost) = two_product(self.high, factor);
        Self::normal(product, lost + self.low * factor)
    }

    fn over(self, divisor: f64) -> Self {
        let quotient = self.high / divisor;
        let (product, lost) = two_product(quotient, divisor);
        let rest = (self.high - product) - lost + self.low;
        Self::normal(quotient, rest / divisor)
    }

    fn normal(high: f64, low: f64) -> Self {
        let (high, low) = two_sum(high, low);
        Self { high, low }
    }

    fn negated(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl From<f64> for Decimal {
    fn from(value: f64) -> Self {
        Self {
            high: value,
            low: 0.0,
        }
    }
}

/// 10^n for n in 0..=22: these powers are doubles.
fn ten_to(n: i32) -> f64 {
    (0..n).fold(1.0, |power, _| power * 10.0)
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;

    #[test]
    fn digits_beyond_a_double_count() {
        // 0.1 as a double is 0.1000000000000000055511151231257827...
        let tenth = Decimal::parse("0.1").unwrap();
        let error = tenth.offset_of(0.1);
        assert!(
            (error / 5.551_115_123_125_783e-18 - 1.0).abs() < 1e-12,
            "{error:e}"
        );
        let exact = Decimal::parse("0.1000000000000000055511151231257827021181583404541015625");
        assert!(exact.unwrap().offset_of(0.1).abs() < 1e-31);
    }

    #[test]
    fn exponents_go_both_ways() {
        for text in [
            "1.5e30", "-2.5e-24", "0.0", "-0.0", "7", "1e-60", "31415926",
        ] {
            let number = Decimal::parse(text).unwrap();
            let double: f64 = text.parse().unwrap();
            assert_eq!(number.nearest(), double, "{text}");
            assert!(
                number.offset_of(double).abs() <= 0.5 * f64::EPSILON * double.abs(),
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_no_number_is_none() {
        for text in ["", "abc", "nan", "inf", "1e999", "1.2.3"] {
            assert_eq!(Decimal::parse(text), None, "{text}");
        }
    }
}
