//! Sine and cosine to the nearest double, for numbers that must be those of other programs.
//!
//! Good libraries differ in the last bit of a few results in a hundred; the nearest double is what nearly all of them
//! mean. In double-double: a number is the unevaluated sum of two doubles, about 106 bits.

use carom_math::{two_product, two_sum};

/// A number as the sum of a double and what it lacks.
#[derive(Clone, Copy, Debug)]
struct Wide {
    high: f64,
    low: f64,
}

/// Cosine and sine of an angle within ±1000 rad, each with what the nearest double lacks.
pub(super) fn cos_sin(angle: f64) -> [(f64, f64); 2] {
    // π/2 in three parts of which quarter turns take exact products (sum of the parts: 161 bits).
    const QUARTER: [f64; 3] = [
        core::f64::consts::FRAC_PI_2,
        6.123_233_995_736_766e-17,
        -1.497_384_904_859_169_8e-33,
    ];
    let quarters = (angle / QUARTER[0]).round();
    let mut rest = Wide::from(angle);
    for part in QUARTER {
        let (high, low) = two_product(-quarters, part);
        rest = rest.plus(Wide { high, low });
    }
    let (sine, cosine) = (odd_series(rest), even_series(rest));
    // A quarter turn takes (cos, sin) to (−sin, cos).
    let [cosine, sine] = match quarters.rem_euclid(4.0) {
        0.0 => [cosine, sine],
        1.0 => [sine.negative(), cosine],
        2.0 => [cosine.negative(), sine.negative()],
        _ => [sine, cosine.negative()],
    };
    [(cosine.high, cosine.low), (sine.high, sine.low)]
}

/// sin x = x (1 − x²/(2·3) (1 − x²/(4·5) (1 − …))), |x| ≤ π/4: the term after 28 is below 2^-110.
fn odd_series(x: Wide) -> Wide {
    x.times(series(x.times(x), 26.0))
}

/// cos x = 1 − x²/(1·2) (1 − x²/(3·4) (1 − …)).
fn even_series(x: Wide) -> Wide {
    series(x.times(x), 27.0)
}

/// The nested brackets outwards from the one with a divisor that begins with `first`.
fn series(square: Wide, first: f64) -> Wide {
    let mut sum = Wide::from(1.0);
    let mut n = first;
    while n > 0.0 {
        let term = square.times(sum).over(n * (n + 1.0));
        sum = Wide::from(1.0).plus(term.negative());
        n -= 2.0;
    }
    sum
}

impl From<f64> for Wide {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Wide {
    fn plus(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, lost) = two_sum(self.low, other.low);
        let (high, error) = two_sum(high, error + low);
        let (high, low) = two_sum(high, error + lost);
        Self { high, low }
    }

    fn times(self, other: Self) -> Self {
        let (high, error) = two_product(self.high, other.high);
        let (high, low) = two_sum(
            high,
            error + (self.high * other.low + self.low * other.high),
        );
        Self { high, low }
    }

    fn over(self, divisor: f64) -> Self {
        let quotient = self.high / divisor;
        let (high, low) = two_product(quotient, divisor);
        let (high, low) = two_sum(quotient, ((self.high - high) - low + self.low) / divisor);
        Self { high, low }
    }

    fn negative(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::trig;

    #[test]
    fn squares_add_up_to_one_in_twice_the_digits() {
        for i in -2000..2000 {
            let angle = f64::from(i) * 0.0173;
            let [cosine, sine] = cos_sin(angle).map(|(high, low)| Wide { high, low });
            let one = cosine.times(cosine).plus(sine.times(sine));
            let error = (one.high - 1.0) + one.low;
            assert!(error.abs() < 1e-31, "{angle}: {error:e}");
            let (near_sine, near_cosine) = trig::sin_cos(angle);
            assert!((sine.high - near_sine).abs() < 2e-16, "{angle}");
            assert!((cosine.high - near_cosine).abs() < 2e-16, "{angle}");
        }
    }

    #[test]
    fn known_digits_are_met() {
        // sin 1 = 0.841470984807896506652502321630298999…, cos 1 = 0.540302305868139717400936607442976603…
        let [cosine, sine] = cos_sin(1.0);
        assert_eq!(sine.0, 0.841_470_984_807_896_5);
        assert_eq!(cosine.0, 0.540_302_305_868_139_8);
        let difference = |a: f64, b: f64| (a - b).abs();
        assert!(
            difference(sine.1, 1.776_845_092_935_536e-18) < 1e-32,
            "{:e}",
            sine.1
        );
        assert!(
            difference(cosine.1, -4.760_954_612_604_417e-17) < 1e-32,
            "{:e}",
            cosine.1
        );
    }
}
