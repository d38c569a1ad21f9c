//! What happens to bodies between the sweeps.

use super::line::{Line, Quad};
use crate::bodies::Bodies;

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

/// The same for bodies of which some are damped: `start = f v + φ h g`.
pub(crate) fn warm_start_damped(bodies: &mut Bodies, h: f64) {
    for (line, start, pull, [left, added]) in with_drag(bodies) {
        for k in 0..3 {
            let v = line.0[k];
            let p = v - start.0[k];
            start.0[k] = left.0[k] * v + added.0[k] * (h * pull.0[k]);
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
    for ((line, start), pull) in lines.iter_mut().zip(start).zip(pull) {
        correct_one(line, start, [0, 1, 2].map(|k| h * pull.0[k]), h);
    }
}

/// The same for bodies of which some are damped.
pub(crate) fn correct_damped(bodies: &mut Bodies, h: f64) {
    for (line, start, pull, drag) in with_drag(bodies) {
        // What pull and damping did: `start − v` with the v before.
        let before = velocity_before(start, pull, drag, h);
        let own = [0, 1, 2].map(|k| start.0[k] - before[k]);
        correct_one(line, start, own, h);
    }
}

/// The velocity at the beginning of a sub-step, which `start` comes from by pull and damping.
pub(crate) fn velocity_before(
    start: &Quad,
    pull: &Quad,
    [left, added]: &[Quad; 2],
    h: f64,
) -> [f64; 3] {
    [0, 1, 2].map(|k| (start.0[k] - added.0[k] * (h * pull.0[k])) / left.0[k])
}

/// Line, start, pull and drag of each body.
fn with_drag(
    bodies: &mut Bodies,
) -> impl Iterator<Item = (&mut Line, &mut Quad, &Quad, &[Quad; 2])> {
    let Bodies {
        lines,
        start,
        pull,
        drag,
        ..
    } = bodies;
    let with = lines.iter_mut().zip(start).zip(pull).zip(drag);
    with.map(|(((line, start), pull), drag)| (line, start, &*pull, &*drag))
}

/// `own` is the change of velocity without contacts.
fn correct_one(line: &mut Line, start: &Quad, own: [f64; 3], h: f64) {
    let change = [0, 1, 2].map(|k| line.0[k] - start.0[k] + own[k]);
    let square = change[0] * change[0] + change[1] * change[1];
    if square <= 16.0 * (own[0] * own[0] + own[1] * own[1]) {
        for (d, change) in line.0[4..7].iter_mut().zip(change) {
            *d -= 0.5 * h * change;
        }
    }
}
