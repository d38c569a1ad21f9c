//! A number between two bounds.

/// `x` where it lies within `low` and `high`, else the bound that it passed.
///
/// The bits of [`f64::clamp`], which panics where a bound is NaN or they are in the wrong order: then no bound holds that `x` does not
/// pass by a comparison, and NaN stays NaN.
///
/// # Examples
/// ```
/// use carom_math::within;
/// assert_eq!([-3.0, 0.5, 7.0].map(|x| within(x, -1.0, 1.0)), [-1.0, 0.5, 1.0]);
/// assert_eq!(within(7.0, f64::NAN, f64::NAN), 7.0);
/// assert!(within(f64::NAN, -1.0, 1.0).is_nan());
/// ```
#[inline]
#[must_use]
pub const fn within(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}
