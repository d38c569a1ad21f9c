//! Trigonometric polynomials of degree 2, and where they first fall to 0.

use core::ops::{Add, Mul};

use carom_math::trig;

/// Steps after which a zero is as near as it comes; one that is only touched takes sixty.
const STEPS: u32 = 200;

/// Part of a range, in doublings of which a wave that begins at 0 is looked for above it.
const FIRST: f64 = 1.0 / (1_u64 << 40) as f64;

/// `c₀ + c₁ cos δ + c₂ sin δ + c₃ cos 2δ + c₄ sin 2δ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wave([f64; 5]);

/// How a wave goes over a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Course {
    /// It stays above 0, or at it if it `began` there.
    Stays { began: bool },
    /// It begins at 0 and falls.
    Falls,
    /// It falls to 0 so far into the range.
    Zero(f64),
}

impl Wave {
    /// Of degree 1.
    pub(super) const fn new(constant: f64, cos: f64, sin: f64) -> Self {
        Self([constant, cos, sin, 0.0, 0.0])
    }

    /// The product of two of degree 1.
    pub(super) fn product(self, other: Self) -> Self {
        let ([a, b, c, ..], [d, e, f, ..]) = (self.0, other.0);
        Self([
            a * d + 0.5 * (b * e + c * f),
            a * e + b * d,
            a * f + c * d,
            0.5 * (b * e - c * f),
            0.5 * (b * f + c * e),
        ])
    }

    /// Nothing it takes on is larger.
    pub(super) fn size(&self) -> f64 {
        self.0.iter().map(|term| term.abs()).sum()
    }

    /// Value, and what it changes by with the angle.
    fn at(&self, angle: f64) -> (f64, f64) {
        let [constant, a, b, c, d] = self.0;
        let (sin, cos) = trig::sin_cos(angle);
        let (sin2, cos2) = (2.0 * sin * cos, (cos - sin) * (cos + sin));
        (
            constant + a * cos + b * sin + c * cos2 + d * sin2,
            b * cos - a * sin + 2.0 * (d * cos2 - c * sin2),
        )
    }

    /// Where it first falls to 0 on the way from one angle to another, as a part of the way in rad. What is at most `nothing` in
    /// size is 0; if it `began` at 0 it counts once it has been above.
    ///
    /// With M a bound on |f″|, `f(x + s) ≥ f + f′ s − M s²/2`: no step to where that is 0 passes a zero of f, and near one the steps
    /// are those of Newton's method.
    pub(super) fn first_zero(&self, (from, to): (f64, f64), nothing: f64, began: bool) -> Course {
        let (length, way) = ((to - from).abs(), 1.0_f64.copysign(to - from));
        let start = self.at(from).0;
        let mut x = 0.0;
        if began || start <= nothing {
            match self.rise((from, way * length), nothing, start) {
                Ok(risen) => x = risen,
                Err(course) => return course,
            }
        }
        let [_, a, b, c, d] = self.0;
        let bend = (a * a + b * b).sqrt() + 4.0 * (c * c + d * d).sqrt();
        for _ in 0..STEPS {
            let (value, slope) = self.at(from + way * x);
            let slope = slope * way;
            if value <= 0.0 {
                return Course::Zero(x);
            }
            let root = (slope * slope + 2.0 * bend * value).sqrt();
            // The larger one of two quotients is that without the difference of what is nearly equal.
            let step = if slope > 0.0 {
                (slope + root) / bend
            } else {
                2.0 * value / (root - slope)
            };
            if x + step >= length || !step.is_finite() {
                return Course::Stays { began: false };
            }
            if step <= f64::EPSILON * x {
                return Course::Zero(x);
            }
            x += step;
        }
        Course::Zero(x)
    }

    /// How far into the range it has come above 0.
    fn rise(&self, (from, range): (f64, f64), nothing: f64, start: f64) -> Result<f64, Course> {
        let (mut last, mut part) = (start, FIRST);
        while part <= 1.0 {
            let value = self.at(from + range * part).0;
            if value > nothing {
                return Ok((range * part).abs());
            }
            if value < -nothing && value < last {
                return Err(Course::Falls);
            }
            (last, part) = (value, 2.0 * part);
        }
        Err(Course::Stays { began: true })
    }
}

impl Add for Wave {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Mul<f64> for Wave {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|term| term * factor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn wave() -> impl Strategy<Value = Wave> {
        prop::array::uniform5(-1.0..1.0_f64).prop_map(Wave)
    }

    proptest! {
        #[test]
        fn a_product_has_the_product_of_the_values(
            f in prop::array::uniform3(-1.0..1.0_f64), g in prop::array::uniform3(-1.0..1.0_f64), x in -7.0..7.0_f64,
        ) {
            let [f, g] = [f, g].map(|[a, b, c]| Wave::new(a, b, c));
            let wanted = f.at(x).0 * g.at(x).0;
            prop_assert!((f.product(g).at(x).0 - wanted).abs() < 1e-14);
        }

        /// Against a look at many angles: above 0 before, at 0 there.
        #[test]
        fn no_zero_is_passed(wave in wave(), from in -3.0..3.0_f64, to in -3.0..3.0_f64) {
            let wave = wave * wave.at(from).0.signum();
            prop_assume!(wave.at(from).0 > 1e-6);
            let course = wave.first_zero((from, to), 1e-12, false);
            let length = (to - from).abs();
            let end = match course {
                Course::Zero(x) => {
                    let value = wave.at(from + (to - from).signum() * x).0;
                    prop_assert!(value.abs() < 1e-13, "{value:e} at {x}");
                    x
                }
                Course::Stays { .. } => length,
                Course::Falls => panic!("it begins above"),
            };
            for k in 0..1000 {
                let x = end * f64::from(k) / 1000.0;
                let value = wave.at(from + (to - from).signum() * x).0;
                prop_assert!(value > 0.0, "{value:e} at {x} of {end}");
            }
        }
    }

    #[test]
    fn what_begins_at_zero_counts_once_it_was_above() {
        let sine = Wave::new(0.0, 0.0, 1.0);
        let Course::Zero(x) = sine.first_zero((0.0, 5.0), 1e-12, false) else {
            panic!("a half turn");
        };
        assert!((x - core::f64::consts::PI).abs() < 1e-15);
        assert_eq!(sine.first_zero((0.0, -5.0), 1e-12, false), Course::Falls);
        let none = Wave::default().first_zero((0.0, 5.0), 1e-12, false);
        assert_eq!(none, Course::Stays { began: true });
    }
}
