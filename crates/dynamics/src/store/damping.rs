//! Energy that damping takes from a flight.

use carom_math::SimTime;

use super::state::BodyState;

/// What damping has taken along the present piece of a flight up to `time`, in J: ∫ (c m v² + c′ I ω²) dt.
pub(crate) fn damping_loss(state: &BodyState, time: SimTime) -> f64 {
    if !state.is_damped() || state.flight.is_none() {
        return 0.0;
    }
    let (start, (linear, angular)) = (state.motion.start, state.damping());
    let along = |at: f64| state.velocity_at(start + at).length_squared();
    let turning = |at: f64| {
        let w = state.spin_at(start + at);
        w * w
    };
    let length = time - start;
    state.mass.mass * taken(along, linear, length)
        + state.turning_inertia() * taken(turning, angular, length)
}

/// c ∫ v² dt over `length` seconds, of a velocity that falls off by e^(−ct) to one that changes slowly.
fn taken(square: impl Fn(f64) -> f64, damping: f64, length: f64) -> f64 {
    /// Gauss–Legendre points and weights of (−1, 1), mirrored: exact for polynomials of degree 7.
    const POINTS: [(f64, f64); 2] = [
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    ];
    /// A part of c t over which these have the integral of e^(−2ct) to 3e-12 of it.
    const PART: f64 = 0.25;
    /// Parts until it is over: e^(−36) is left of the square.
    const PARTS: u32 = 72;
    if damping == 0.0 {
        return 0.0;
    }
    let (mut from, mut sum) = (0.0, 0.0);
    for part in 1..=PARTS {
        let to = f64::from(part) * PART / damping;
        let to = if part < PARTS && to < length {
            to
        } else {
            length
        };
        let half = 0.5 * (to - from);
        for (at, weight) in POINTS {
            let (before, after) = (from + half * (1.0 - at), from + half * (1.0 + at));
            sum += half * weight * (square(before) + square(after));
        }
        if to >= length {
            break;
        }
        from = to;
    }
    damping * sum
}
