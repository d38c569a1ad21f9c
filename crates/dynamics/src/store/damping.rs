//! Energy that damping takes from a flight.

use carom_math::SimTime;

use super::state::BodyState;

/// What damping has taken along the present piece of a flight up to `time`, in J: ∫ (c m v² + c′ I ω²) dt.
pub(crate) fn damping_loss(state: &BodyState, time: SimTime) -> f64 {
    /// Gauss–Legendre points and weights of (−1, 1), mirrored: exact for polynomials of degree 7.
    const POINTS: [(f64, f64); 2] = [
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    ];
    if !state.is_damped() || state.flight.is_none() {
        return 0.0;
    }
    let (start, (linear, angular)) = (state.motion.start, state.damping());
    let half = 0.5 * (time - start);
    let power = |at: f64| {
        let at = start + half * (1.0 + at);
        let (v, w) = (state.velocity_at(at), state.spin_at(at));
        linear * state.mass.mass * v.length_squared() + angular * state.turning_inertia() * w * w
    };
    let sum: f64 = POINTS
        .iter()
        .map(|(at, weight)| weight * (power(*at) + power(-at)))
        .sum();
    half * sum
}
