//! What happens to bodies between the sweeps.

use super::line::{Line, Quad};

/// `p = v − start; start = v + h g; v = start + p`: p is the warm start, what contacts did in the last sub-step.
pub(crate) fn warm_start(lines: &mut [Line], start: &mut [Quad], pull: &[Quad], h: f64) {
    for ((line, start), pull) in lines.iter_mut().zip(start).zip(pull) {
        for k in 0..3 {
            let v = line.0[k];
            let p = v - start.0[k];
            start.0[k] = v + h * pull.0[k];
            line.0[k] = start.0[k] + p;
        }
    }
}

/// `d += h v`
pub(crate) fn displace(lines: &mut [Line], h: f64) {
    for line in lines {
        for k in 0..3 {
            line.0[4 + k] += h * line.0[k];
        }
    }
}

/// Makes displacements of second order where velocities change smoothly: `d −= ½ h Δv`.
///
/// `h v` with the velocity at the end overshoots the trapezoid by h/2 Δv: g h²/2 in free flight,
/// and likewise where friction brakes. Where a contact stopped the body at its surface there is
/// nothing to take back; a stop is what changes the velocity by more than four times the pull.
pub(crate) fn correct(lines: &mut [Line], start: &[Quad], pull: &[Quad], h: f64) {
    let most = 16.0 * h * h;
    for ((line, start), pull) in lines.iter_mut().zip(start).zip(pull) {
        let change = [0, 1, 2].map(|k| line.0[k] - start.0[k] + h * pull.0[k]);
        let square = change[0] * change[0] + change[1] * change[1];
        if square <= most * pull.v().length_squared() {
            for (d, change) in line.0[4..7].iter_mut().zip(change) {
                *d -= 0.5 * h * change;
            }
        }
    }
}
