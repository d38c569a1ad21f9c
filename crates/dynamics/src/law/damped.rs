//! Linear damping in closed form: velocity falls off by an exponential.
//!
//! ```text
//! dv/dt = a − c v      v(t) = v₀ e^(−ct) + a t φ₁(ct)      x(t) = x₀ + v₀ t φ₁(ct) + a t² φ₂(ct)
//! φ₁(z) = (1 − e^(−z))/z      φ₂(z) = (z − 1 + e^(−z))/z²
//! ```
//!
//! At c = 0 that is the parabola. The same holds for the spin with its own damping.

use carom_math::trig;

/// e^(−z), φ₁(z) and φ₂(z) for z ≥ 0, right to rounding.
pub(crate) fn decays(z: f64) -> (f64, f64, f64) {
    if z < 0.5 {
        // φ₂ = Σ (−z)^n/(n + 2)!: 14 terms leave 1e-18, and 8 of them 1e-21 for z below 1/64.
        let terms = if z < 1.0 / 64.0 { 8 } else { 14 };
        let mut second = 0.0;
        for n in (0..terms).rev() {
            second = 1.0 - z * second * INVERSE[n + 3];
        }
        let second = 0.5 * second;
        let first = 1.0 - z * second;
        return (1.0 - z * first, first, second);
    }
    let decay = trig::exp(-z);
    let first = -trig::exp_m1(-z) / z;
    (decay, first, (1.0 - first) / z)
}

/// What becomes of one coordinate: its change and its velocity after `t` seconds, from a velocity of `v`, under an
/// acceleration of `a` and a damping of `c` ≥ 0 per second.
pub(crate) fn damped(v: f64, a: f64, c: f64, t: f64) -> (f64, f64) {
    let (decay, first, second) = decays(c * t);
    ((v * first + a * t * second) * t, v * decay + a * t * first)
}

/// 1/n.
const INVERSE: [f64; 34] = {
    let mut inverse = [0.0; 34];
    let mut n = 1;
    while n < inverse.len() {
        inverse[n] = 1.0 / n as f64;
        n += 1;
    }
    inverse
};

/// m₀ … m₉ of z ≥ 0, right to rounding: `m_n(z) = n ∫₀¹ θ^(n−1) e^(−(1−θ) z) dθ = n! φ_n(z)`, and m₀ = e^(−z).
///
/// They are what damping leaves of an acceleration t^(n−1), and all 1 where there is none: `m_n = 1 − z m_(n+1)/(n + 1)`.
pub(crate) fn left_by_damping(z: f64) -> [f64; 10] {
    /// From here on up the recurrence is stable, and below it down.
    const TURNS: f64 = 4.0;
    /// From m₃₃ = 1 down to m₉ the error falls by 4²⁴ 9!/33! = 1e-17; from m₁₅ by 4e-18 for z below 1/64, as in most pieces of a flight.
    const FIRST: [(f64, usize); 2] = [(1.0 / 64.0, 15), (TURNS, 33)];
    let mut left = [0.0; 10];
    left[0] = trig::exp(-z);
    if let Some((_, first)) = FIRST.iter().find(|(below, _)| z < *below) {
        let mut next = 1.0;
        for n in (10..*first).rev() {
            next = 1.0 - z * next * INVERSE[n + 1];
        }
        for n in (1..10).rev() {
            next = 1.0 - z * next * INVERSE[n + 1];
            left[n] = next;
        }
        return left;
    }
    left[1] = -trig::exp_m1(-z) / z;
    let mut n = 1.0;
    for k in 2..left.len() {
        n += 1.0;
        left[k] = n * (1.0 - left[k - 1]) / z;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn without_damping_it_is_the_parabola() {
        assert_eq!(damped(3.0, -10.0, 0.0, 0.5), (0.25, -2.0));
    }

    #[test]
    fn it_comes_to_the_terminal_velocity() {
        // 10 m/s² against 2 per second: 5 m/s.
        let (_, v) = damped(-7.0, -10.0, 2.0, 100.0);
        assert!((v + 5.0).abs() < 1e-15);
        // Without a force the body comes to rest after v/c.
        let (x, _) = damped(3.0, 0.0, 2.0, 100.0);
        assert!((x - 1.5).abs() < 1e-15);
    }

    #[test]
    fn both_forms_meet_where_they_change() {
        let below = 0.5 * (1.0 - f64::EPSILON);
        let (one, other) = (decays(below), decays(0.5));
        for (a, b) in [(one.0, other.0), (one.1, other.1), (one.2, other.2)] {
            assert!((a - b).abs() < 4.0 * f64::EPSILON, "{a} and {b}");
        }
    }

    #[test]
    fn what_damping_leaves_of_powers_is_their_integral() {
        assert_eq!(left_by_damping(0.0), [1.0; 10]);
        for z in [
            1e-9,
            0.015_624_9,
            0.015_625,
            0.3,
            1.0,
            3.999_999_9,
            4.0,
            4.000_000_1,
            9.0,
            50.0,
            1e4,
            1e300,
        ] {
            let left = left_by_damping(z);
            let (decay, first, second) = decays(z);
            assert!((left[0] - decay).abs() <= 1e-15 * decay);
            assert!((left[1] - first).abs() <= 1e-15 * first);
            assert!((left[2] - 2.0 * second).abs() <= 4e-15 * second, "{z}");
            // Simpson's rule, right to (z/20,000)⁴/180.
            let parts = 20_000;
            for (n, left) in (1_i32..).zip(&left[1..]) {
                if z > 60.0 {
                    continue;
                }
                let term = |k: i32| {
                    let theta = f64::from(k) / f64::from(parts);
                    f64::from(n)
                        * (1..n).map(|_| theta).product::<f64>()
                        * trig::exp((theta - 1.0) * z)
                };
                let inner = (1..parts).map(|k| f64::from(2 + 2 * (k % 2)) * term(k));
                let sum = (term(0) + term(parts) + inner.sum::<f64>()) / (3.0 * f64::from(parts));
                assert!(
                    (left - sum).abs() < 1e-12 * sum,
                    "m{n}({z}) = {left}, {sum}"
                );
            }
        }
    }

    proptest! {
        #[test]
        fn two_halves_make_a_whole(
            v in -10.0..10.0_f64, a in -10.0..10.0_f64, c in 0.0..20.0_f64, t in 0.0..3.0_f64,
        ) {
            let (x, w) = damped(v, a, c, t);
            let (first, middle) = damped(v, a, c, 0.5 * t);
            let (second, end) = damped(middle, a, c, 0.5 * t);
            prop_assert!((x - first - second).abs() < 1e-13);
            prop_assert!((w - end).abs() < 1e-13);
        }
    }
}
