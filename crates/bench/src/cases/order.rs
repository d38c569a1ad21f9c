//! Observed order of convergence.

use carom_math::trig;

/// Below this an error is rounding: it no longer falls with the step.
const ROUNDING: f64 = 1e-12;

/// The order of convergence of a sweep over rates: the p of error = C hz^−p.
///
/// Least squares of log error over log rate. Counted are the errors above 10^−12; and if the curve turns up again, as
/// single precision and chaos make it do, those before the least error and above four times it. `None` if fewer than
/// three points are left, or one that counts is not finite. Rates in any order, in Hz.
#[must_use]
pub fn order(points: &[(f64, f64)]) -> Option<f64> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let falling = falling(&sorted);
    if falling.len() < 3 || falling.iter().any(|(_, error)| !error.is_finite()) {
        return None;
    }
    let logs = falling.iter().map(|&(hz, e)| (trig::ln(hz), trig::ln(e)));
    Some(-slope(&logs.collect::<Vec<_>>()))
}

/// The points that rounding did not touch.
fn falling(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let rounded = points.iter().position(|&(_, error)| error <= ROUNDING);
    let points = &points[..rounded.unwrap_or(points.len())];
    let errors = points.iter().map(|(_, error)| *error).enumerate();
    let Some((at, least)) = errors.min_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return Vec::new();
    };
    if at + 1 == points.len() {
        return points.to_vec();
    }
    let before = points[..at].iter().copied();
    before.filter(|(_, error)| *error > 4.0 * least).collect()
}

/// Σ (x − x̄)(y − ȳ) / Σ (x − x̄)².
#[expect(clippy::cast_precision_loss, reason = "a handful of points")]
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / n;
    let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / n;
    let (mut above, mut below) = (0.0, 0.0);
    for &(x, y) in points {
        above += (x - mean_x) * (y - mean_y);
        below += (x - mean_x) * (x - mean_x);
    }
    above / below
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        [30.0, 60.0, 120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0]
            .map(|hz| (hz, error(hz)))
            .to_vec()
    }

    fn close(found: Option<f64>, exact: f64) -> bool {
        found.is_some_and(|found| (found - exact).abs() < 1e-9)
    }

    #[test]
    fn powers_are_found() {
        assert!(close(order(&sweep(|hz| 5.0 / hz)), 1.0));
        assert!(close(order(&sweep(|hz| 0.1 / (hz * hz))), 2.0));
    }

    #[test]
    fn the_order_of_the_points_does_not_matter() {
        let mut points = sweep(|hz| 5.0 / hz);
        points.reverse();
        assert!(close(order(&points), 1.0));
    }

    #[test]
    fn rounding_that_grows_with_the_steps_is_left_out() {
        let single = |hz: f64| 1.0 / (hz * hz) + 1e-8 * hz;
        let found = order(&sweep(single)[..]).expect("several points fall");
        assert!((1.9..2.0).contains(&found), "{found}");
        assert!(close(
            order(&sweep(|hz| (1e-4 / (hz * hz * hz)).max(1e-13))),
            3.0
        ));
    }

    #[test]
    fn nothing_is_said_of_what_does_not_fall_or_of_two_points() {
        assert_eq!(order(&sweep(|_| 0.0)), None);
        assert_eq!(order(&sweep(|_| 0.3)), None);
        assert_eq!(order(&sweep(|hz| 1.0 / hz)[..2]), None);
        assert_eq!(order(&[]), None);
        assert_eq!(order(&sweep(|_| f64::NAN)), None);
    }
}
