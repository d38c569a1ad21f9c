//! A root between two bounds.

/// Evaluations after which a root is as near as it comes.
const ROUNDS: u32 = 100;

/// Where a continuous function falls through 0: between `above`, a place and the positive value there, and `below`, a later
/// place and the value there that is not positive; the place nearest behind the root, to the last bits.
///
/// False position with the Illinois rule (M. Dowell, P. Jarratt 1971). `None` where the function has no value.
///
/// # Examples
/// ```
/// use carom_math::falling_root;
///
/// let root = falling_root((1.0, 1.0), (2.0, -2.0), |x| Some(2.0 - x * x)).unwrap();
/// assert!((root - 2.0_f64.sqrt()).abs() < 1e-15);
/// ```
pub fn falling_root(
    (mut low, mut above): (f64, f64),
    (mut high, mut below): (f64, f64),
    mut f: impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    let mut side = 0;
    for _ in 0..ROUNDS {
        if high - low <= 4.0 * f64::EPSILON * high {
            break;
        }
        let guess = low + (high - low) * (above / (above - below));
        let middle = if guess > low && guess < high {
            guess
        } else {
            0.5 * (low + high)
        };
        if !(middle > low && middle < high) {
            break;
        }
        let value = f(middle)?;
        if value > 0.0 {
            (low, above) = (middle, value);
            if side == 1 {
                below *= 0.5;
            }
            side = 1;
        } else {
            (high, below) = (middle, value);
            if side == 2 {
                above *= 0.5;
            }
            side = 2;
        }
    }
    Some(high)
}
