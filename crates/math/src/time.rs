//! Simulated time that keeps its digits.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Sub};

use crate::{two_product, two_sum};

/// An instant of simulated time: whole units of 2⁻⁶ s and a rest.
///
/// The rest lies in 0..2⁻⁶ s, so an instant is right to 3.5e-18 s however late it is, and the
/// difference of two near instants is exact: one ulp of a plain `f64` is 1.8e-12 s after 10,000 s.
///
/// # Examples
/// ```
/// use carom_math::SimTime;
/// let late = SimTime::from_secs(10_000.0);
/// assert_eq!((late + 1e-15) - late, 1e-15);                   // plain doubles give 0
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimTime {
    units: i64,
    rest: f64,
}

const UNITS_PER_SECOND: f64 = 64.0;

impl SimTime {
    /// Seconds of a unit: the rest is rounded as a part of it.
    pub const UNIT: f64 = 1.0 / UNITS_PER_SECOND;

    /// The start of time.
    pub const ZERO: Self = Self {
        units: 0,
        rest: 0.0,
    };

    /// Later than any instant that a world reaches (4.6e16 s).
    pub const NEVER: Self = Self {
        units: i64::MAX,
        rest: 0.0,
    };

    /// The instant `secs` seconds after the start; +∞ and what is no number are [`SimTime::NEVER`].
    #[must_use]
    pub fn from_secs(secs: f64) -> Self {
        Self::ZERO + secs
    }

    /// The instant `count · interval`, rounded once: no error adds up over the counts.
    #[must_use]
    pub fn multiple(count: u64, interval: f64) -> Self {
        #[expect(
            clippy::cast_precision_loss,
            reason = "the high part is a multiple of 2^32, the low part below it: both are exact"
        )]
        let (high, low) = ((count >> 32 << 32) as f64, (count & 0xFFFF_FFFF) as f64);
        let (product, error) = two_product(low, interval);
        let (upper, upper_error) = two_product(high, interval);
        Self::ZERO + upper + product + (error + upper_error)
    }

    /// Whole units of 2⁻⁶ s since the start.
    #[must_use]
    pub const fn units(self) -> i64 {
        self.units
    }

    /// Seconds since the last whole unit: in 0..2⁻⁶ s.
    #[must_use]
    pub const fn rest(self) -> f64 {
        self.rest
    }

    /// Number of the interval of 2⁻⁶ s / 2^`shift` that the instant lies in, counted from the start;
    /// 0 before it. `shift` is at most 20.
    ///
    /// # Examples
    /// ```
    /// use carom_math::SimTime;
    /// assert_eq!(SimTime::from_secs(1.0).bin(2), 256);
    /// assert_eq!(SimTime::from_secs(0.999).bin(0), 63);
    /// ```
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the rest is below one unit, which holds 2^20 intervals at most"
    )]
    pub fn bin(self, shift: u32) -> u64 {
        let units = self.units.max(0) as u64;
        let within = (self.rest * (UNITS_PER_SECOND * (1_u64 << shift) as f64)) as u64;
        (units.saturating_mul(1 << shift)).saturating_add(within)
    }

    /// Seconds since the start, rounded to one `f64`.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "units stay below 2^53 for 4 million years"
    )]
    pub fn as_secs(self) -> f64 {
        self.units as f64 * Self::UNIT + self.rest
    }
}

/// `f64::floor`, which without SSE4.1 is a call: most numbers fit an integer.
fn floor(x: f64) -> f64 {
    const EXACT: f64 = (1_u64 << 52) as f64;
    if x.abs() >= EXACT || x.is_nan() {
        return x.floor();
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "below 2^52"
    )]
    let whole = x as i64 as f64;
    if whole > x { whole - 1.0 } else { whole }
}

impl Add<f64> for SimTime {
    type Output = Self;

    /// The instant `secs` later (earlier if negative), right to one rounding of the rest. What is too late
    /// to be told, +∞ and what is no number lead to [`SimTime::NEVER`], and nothing leads from there; −∞ is
    /// the earliest instant.
    ///
    /// # Examples
    /// ```
    /// use carom_math::SimTime;
    /// assert_eq!(SimTime::NEVER + -1.0, SimTime::NEVER);
    /// assert_eq!(SimTime::ZERO + f64::INFINITY, SimTime::NEVER);
    /// assert_eq!(SimTime::ZERO + f64::NAN, SimTime::NEVER);
    /// ```
    #[expect(
        clippy::cast_possible_truncation,
        reason = "below 2^63 but where it saturates at the earliest instant"
    )]
    fn add(self, secs: f64) -> Self {
        /// 2⁶³ units.
        const TOO_LATE: f64 = 144_115_188_075_855_872.0;
        if self.units == i64::MAX || secs.is_nan() || secs >= TOO_LATE {
            return Self::NEVER;
        }
        if secs <= -TOO_LATE {
            let (units, rest) = (i64::MIN, 0.0);
            return Self { units, rest };
        }
        let whole = floor(secs * UNITS_PER_SECOND);
        // Exact: both terms are multiples of the last bit of `secs`, and the result is smaller.
        let part = secs - whole * Self::UNIT;
        let units = self.units.saturating_add(whole as i64);
        if units == i64::MAX {
            return Self::NEVER;
        }
        // The rest may reach past the unit; its rounding error would be lost at the border.
        let (rest, error) = two_sum(self.rest, part);
        if rest >= Self::UNIT {
            let over = (rest - Self::UNIT) + error;
            if over >= 0.0 {
                let units = units + 1;
                let rest = if units == i64::MAX { 0.0 } else { over };
                return Self { units, rest };
            }
        }
        let rest = if rest < Self::UNIT {
            rest
        } else {
            Self::UNIT.next_down()
        };
        Self { units, rest }
    }
}

impl AddAssign<f64> for SimTime {
    fn add_assign(&mut self, secs: f64) {
        *self = *self + secs;
    }
}

impl Sub for SimTime {
    type Output = f64;

    /// Seconds from `earlier` to `self`.
    #[expect(
        clippy::cast_precision_loss,
        reason = "differences stay below 2^53 units for 4 million years"
    )]
    fn sub(self, earlier: Self) -> f64 {
        self.units.saturating_sub(earlier.units) as f64 * Self::UNIT + (self.rest - earlier.rest)
    }
}

impl Eq for SimTime {}

impl PartialOrd for SimTime {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for SimTime {
    fn cmp(&self, other: &Self) -> Ordering {
        self.units
            .cmp(&other.units)
            // Never negative: the order of the bits is that of the numbers.
            .then(self.rest.to_bits().cmp(&other.rest.to_bits()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_day_of_sixtieths_ends_on_the_day() {
        let ticks = 24 * 3600 * 60;
        let day = SimTime::multiple(ticks, 1.0 / 60.0);
        // 1/60 is not a double; its error times the count is all that is left.
        assert!((day - SimTime::from_secs(86400.0)).abs() < 2e-12);
        assert_eq!(SimTime::multiple(ticks, 0.25).as_secs(), 0.25 * 5_184_000.0);
    }

    #[test]
    fn nothing_is_later_than_never_and_nothing_leads_from_there() {
        let never = SimTime::NEVER;
        for secs in [f64::NAN, f64::INFINITY, f64::MAX, 1.5e17] {
            assert_eq!(SimTime::from_secs(secs), never, "{secs} s");
            assert_eq!(SimTime::from_secs(1.0) + secs, never, "{secs} s");
        }
        for secs in [
            0.0,
            0.01,
            -0.01,
            1.0,
            -1.0,
            1e300,
            -1e300,
            f64::NEG_INFINITY,
            f64::NAN,
        ] {
            assert_eq!(never + secs, never, "{secs} s");
        }
        let last = SimTime {
            units: i64::MAX - 1,
            rest: 0.015,
        };
        assert_eq!(last + 0.015, never);
        assert!(SimTime::from_secs(1e17) < never);
        assert!(SimTime::from_secs(f64::NEG_INFINITY) <= SimTime::from_secs(-1e300));
    }

    proptest! {
        #[test]
        fn whole_units_are_those_of_the_standard_library(x in -1e4..1e4_f64, power in -10..60_i32) {
            let x = x * crate::trig::pow(2.0, f64::from(power));
            prop_assert_eq!(floor(x), x.floor());
            prop_assert_eq!(floor(x.floor()), x.floor());
        }

        #[test]
        fn differences_are_exact_when_near(start in 0.0..1e4_f64, dt in 0.0..1.0_f64) {
            let at = SimTime::from_secs(start);
            prop_assert!(((at + dt) - at - dt).abs() <= 4e-18);
        }

        #[test]
        fn order_follows_seconds(a in 0.0..1e4_f64, b in 0.0..1e4_f64) {
            prop_assert_eq!(SimTime::from_secs(a).cmp(&SimTime::from_secs(b)), a.total_cmp(&b));
        }

        #[test]
        fn there_and_back(start in 0.0..1e4_f64, dt in -1e3..1e3_f64) {
            let at = SimTime::from_secs(start);
            prop_assert!((((at + dt) + -dt) - at).abs() <= 8e-18);
        }
    }
}
