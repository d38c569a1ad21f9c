//! The elliptic integral of the first kind, and Jacobi's elliptic functions, its inverse.

use crate::trig;

/// Steps of the mean: eight from a complement of 1e-32 on.
const STEPS: usize = 12;

/// Complements below it count as it: the motions of a pendulum then part by less than rounding.
const LEAST: f64 = 1e-32;

/// A ratio of the two means this near to 1 is followed by one without rounding of its own.
const NEAR: f64 = 1e-8;

/// The incomplete elliptic integral of the first kind and Jacobi's elliptic functions for one parameter m,
///
/// ```text
/// u = F(φ | m) = ∫₀^φ dθ/√(1 − m sin² θ)        sn u = sin φ        cn u = cos φ        dn u = √(1 − m sin² φ)
/// ```
///
/// by the arithmetic–geometric mean, `aₙ₊₁ = (aₙ + bₙ)/2`, `bₙ₊₁ = √(aₙ bₙ)` from 1 and √(1 − m) on.
///
/// Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 16.12 and 17.6.
///
/// # Examples
/// ```
/// use carom_math::Elliptic;
///
/// let half = Elliptic::new(0.5); // m = 1 − m = 1/2
/// let quarter = half.integral(std::f64::consts::FRAC_PI_2);
/// assert!((quarter - 1.854_074_677_301_372).abs() < 1e-15);
/// let [sn, cn, dn] = half.functions(quarter);
/// assert!((sn - 1.0).abs() < 1e-15 && cn.abs() < 1e-15 && (dn - 0.5_f64.sqrt()).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elliptic {
    /// bₙ/aₙ of the steps taken.
    ratios: [f64; STEPS],
    steps: usize,
    /// aₙ after the last one.
    mean: f64,
}

impl Elliptic {
    /// By the complement `1 − m` of the parameter, in 0 to 1: near m = 1 that is what has the digits.
    #[must_use]
    pub fn new(complement: f64) -> Self {
        let (mut a, mut b) = (1.0_f64, complement.clamp(LEAST, 1.0).sqrt());
        let mut ratios = [1.0; STEPS];
        let mut steps = 0;
        while steps < STEPS {
            let ratio = b / a;
            ratios[steps] = ratio;
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
            steps += 1;
            if 1.0 - ratio < NEAR {
                break;
            }
        }
        Self {
            ratios,
            steps,
            mean: a,
        }
    }

    /// F(φ | m) of an amplitude in radians: odd, and more by 2 F(π/2 | m) for each half turn.
    #[must_use]
    pub fn integral(&self, amplitude: f64) -> f64 {
        let mut phi = amplitude;
        for ratio in &self.ratios[..self.steps] {
            // tan(φₙ₊₁ − φₙ) = (bₙ/aₙ) tan φₙ
            let (s, c) = trig::sin_cos(phi);
            phi = 2.0 * phi + trig::atan2((ratio - 1.0) * s * c, c * c + ratio * s * s);
        }
        phi / (f64::from(1_u32 << self.steps) * self.mean)
    }

    /// sn, cn and dn of u: each with its own digits, where it is small, too.
    #[must_use]
    pub fn functions(&self, u: f64) -> [f64; 3] {
        let (mut s, mut c) = trig::sin_cos(self.mean * u);
        let mut d = 1.0;
        for ratio in self.ratios[..self.steps].iter().rev() {
            // Landen's transformation by k = (1 − bₙ/aₙ)/(1 + bₙ/aₙ): no difference of what is nearly equal.
            let part = 1.0 / (1.0 + ratio);
            let (k, rest) = ((1.0 - ratio) * part, 2.0 * ratio * part);
            let per = 1.0 / (1.0 + k * s * s);
            let dn = (rest + k * c * c) * per;
            (s, c, d) = ((1.0 + k) * s * per, c * d * per, dn);
        }
        // Near 1 both have the roundings of all steps, and what the small one leaves of it does not.
        if s.abs() < 0.5 {
            c = ((1.0 - s) * (1.0 + s)).sqrt().copysign(c);
            d = (c * c + (self.ratios[0] * s) * (self.ratios[0] * s)).sqrt();
        }
        [s, c, d]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};
    use proptest::prelude::*;

    /// The integral by Gauss and Legendre in many panels.
    fn quadrature(amplitude: f64, m: f64) -> f64 {
        let at = (0.6_f64).sqrt();
        let panels = 4000_u32;
        let h = amplitude / f64::from(panels);
        let f = |x: f64| {
            let s = trig::sin_cos(x).0;
            1.0 / (1.0 - m * s * s).sqrt()
        };
        (0..panels)
            .map(|k| {
                let middle = (f64::from(k) + 0.5) * h;
                let (low, high) = (middle - 0.5 * h * at, middle + 0.5 * h * at);
                h / 18.0 * (5.0 * f(low) + 8.0 * f(middle) + 5.0 * f(high))
            })
            .sum()
    }

    proptest! {
        #[test]
        fn the_integral_is_that_of_its_integrand(amplitude in -5.0..5.0_f64, m in 0.0..0.99_f64) {
            let (found, wanted) = (Elliptic::new(1.0 - m).integral(amplitude), quadrature(amplitude, m));
            prop_assert!((found - wanted).abs() < 1e-12 * (1.0 + wanted.abs()), "{found} not {wanted}");
        }

        #[test]
        fn the_functions_are_those_of_the_amplitude(amplitude in -20.0..20.0_f64, power in -30.0..0.0_f64) {
            let complement = trig::pow(10.0, power);
            let elliptic = Elliptic::new(complement);
            let [sn, cn, dn] = elliptic.functions(elliptic.integral(amplitude));
            let (sin, cos) = trig::sin_cos(amplitude);
            let delta = (complement + (1.0 - complement) * cos * cos).sqrt();
            // An amplitude known to rounding is an argument known to that over dn.
            for (found, wanted, rate) in [(sn, sin, cos), (cn, cos, sin), (dn, delta, sin * cos / delta)] {
                let room = 1e-14 * (wanted.abs() + 20.0 * rate.abs());
                prop_assert!((found - wanted).abs() < room, "{found} not {wanted}");
            }
        }

        #[test]
        fn a_half_turn_adds_two_quarters(amplitude in -5.0..5.0_f64, complement in 1e-20..1.0_f64) {
            let elliptic = Elliptic::new(complement);
            let more = elliptic.integral(amplitude + PI) - elliptic.integral(amplitude);
            let wanted = 2.0 * elliptic.integral(FRAC_PI_2);
            prop_assert!((more - wanted).abs() < 1e-12 * wanted, "{more} not {wanted}");
        }
    }

    /// cn and dn were off by 1.4e-14 here.
    #[test]
    fn near_a_whole_turn_cosines_have_their_digits() {
        let elliptic = Elliptic::new(5.017_666e-30);
        for turns in [0.0, 4.0] {
            let amplitude = turns * PI - 0.008_744_291;
            let [_, cn, dn] = elliptic.functions(elliptic.integral(amplitude));
            let (_, cos) = trig::sin_cos(amplitude);
            assert!((cn - cos).abs() < 1e-15, "{cn} not {cos}");
            assert!((dn - cos).abs() < 1e-15, "{dn} not {cos}");
        }
    }

    #[test]
    fn circles_and_hyperbolas_are_its_ends() {
        for u in [-2.0, -0.3, 0.0, 1e-9, 0.7, 3.0, 12.0] {
            let (sin, cos) = trig::sin_cos(u);
            let (s, c) = trig::sinh_cosh(u);
            let ends = [(1.0, [sin, cos, 1.0]), (0.0, [s / c, 1.0 / c, 1.0 / c])];
            for (complement, wanted) in ends {
                let found = Elliptic::new(complement).functions(u);
                for (found, wanted) in found.iter().zip(wanted) {
                    let room = 1e-14 * wanted.abs();
                    assert!(
                        (found - wanted).abs() <= room,
                        "{found} not {wanted} of {u}"
                    );
                }
            }
        }
    }
}
