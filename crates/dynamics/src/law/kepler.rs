//! Motion about a Newtonian centre, in closed form for every conic.
//!
//! With µ = GM, `α = 2/r₀ − v₀²/µ` (1/α is the semi-major axis) and `σ₀ = r₀·v₀/√µ`, the universal anomaly χ of the
//! instant t solves Kepler's equation, which is the same for ellipse, parabola and hyperbola:
//!
//! ```text
//! √µ t = r₀ U₁ + σ₀ U₂ + U₃            r = r₀ U₀ + σ₀ U₁ + U₂ = d(√µ t)/dχ
//! x = f x₀ + g v₀                      f = 1 − U₂/r₀,  g = (r₀ U₁ + σ₀ U₂)/√µ
//! v = ḟ x₀ + ġ v₀                      ḟ = −√µ U₁/(r r₀),  ġ = 1 − U₂/r
//! U₀ = cos √α χ,  U₁ = sin(√α χ)/√α,  U₂ = (1 − U₀)/α,  U₃ = (χ − U₁)/α
//! ```
//!
//! Source: R. H. Battin, *An Introduction to the Mathematics and Methods of Astrodynamics*, 1999, sections 4.5 and 4.6.

use carom_math::{Vec2, cross, perp, trig};

use super::osculating::Jerk;

/// Guesses before the equation counts as solved as well as numbers allow.
const GUESSES: u32 = 100;

/// A step of the universal anomaly by no more than this part of it is the last one.
const LAST: f64 = 2.0 * f64::EPSILON;

/// A conic about a centre, told by a place and a velocity on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conic {
    centre: Vec2,
    /// µ in m³/s², > 0.
    strength: f64,
    /// Place relative to the centre, in m, and velocity, in m/s, at t = 0.
    start: (Vec2, Vec2),
    /// 1 over the semi-major axis, in 1/m: positive for an ellipse, negative for a hyperbola.
    alpha: f64,
    /// Where a hyperbola is nearest.
    turn: Option<Turn>,
}

/// The point of a hyperbola nearest to its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    /// When it is reached, in s.
    time: f64,
    /// Place relative to the centre, in m, and velocity, in m/s.
    state: (Vec2, Vec2),
}

impl Conic {
    /// The conic through a place with a velocity; `None` at the centre itself and where nothing attracts.
    pub(crate) fn through(
        centre: Vec2,
        strength: f64,
        place: Vec2,
        velocity: Vec2,
    ) -> Option<Self> {
        let from = place - centre;
        let distance = from.length();
        if !(strength > 0.0 && distance > 0.0) {
            return None;
        }
        let alpha = 2.0 / distance - velocity.length_squared() / strength;
        let mut conic = Self {
            centre,
            strength,
            start: (from, velocity),
            alpha,
            turn: None,
        };
        conic.turn = conic.turn();
        alpha.is_finite().then_some(conic)
    }

    /// Where a hyperbola turns: at `x = q e/|e|`, with `√µ t = q U₁ + U₃` from there to the start, where
    /// `σ₀ = |e| U₁`.
    fn turn(&self) -> Option<Turn> {
        let (x, v) = self.start;
        let nearest = self.nearest();
        if !(self.alpha < 0.0 && nearest > 0.0) {
            return None;
        }
        let mu = self.strength;
        let eccentricity = x * (v.length_squared() / mu - 1.0 / x.length()) - v * (x.dot(v) / mu);
        let e = eccentricity.length();
        let towards = eccentricity / e;
        let root = (-self.alpha).sqrt();
        let chi = trig::asinh(root * x.dot(v) / (mu.sqrt() * e)) / root;
        let [_, u1, _, u3] = self.universal(chi);
        let time = -(nearest * u1 + u3) / mu.sqrt();
        let speed = cross(x, v) / nearest;
        let state = (towards * nearest, perp(towards) * speed);
        (time.is_finite() && speed.is_finite()).then_some(Turn { time, state })
    }

    /// Least distance from the centre on the whole conic, in m.
    pub(crate) fn nearest(&self) -> f64 {
        let (x, v) = self.start;
        let momentum = cross(x, v);
        // p = h²/µ, e² = 1 − α p, and p/(1 + e) has no cancellation.
        let p = momentum * momentum / self.strength;
        let e2 = 1.0 - self.alpha * p;
        p / (1.0 + if e2 > 0.0 { e2.sqrt() } else { 0.0 })
    }

    /// Seconds from `t` on for which it surely stays outside a core: nothing falls faster than at the rim.
    pub(crate) fn time_outside(&self, t: f64, core: f64) -> f64 {
        let (x, v) = self.at(t);
        let r = (x - self.centre).length();
        let rim = v.length_squared() + 2.0 * self.strength * (1.0 / core - 1.0 / r);
        let outside = (r - core) / rim.max(0.0).sqrt();
        if outside > 0.0 { outside } else { 0.0 }
    }

    /// Acceleration at a place with a velocity, in m/s², and how it changes.
    pub(crate) fn bends(&self, place: Vec2, velocity: Vec2) -> (Vec2, Jerk) {
        let from = place - self.centre;
        let (distance, strength) = (from.length(), self.strength);
        let jerk = Jerk::Newton {
            strength,
            distance,
            speed: velocity.length(),
        };
        (from * (-strength / (distance * distance * distance)), jerk)
    }

    /// Place in m and velocity in m/s after `t` seconds.
    pub(crate) fn at(&self, t: f64) -> (Vec2, Vec2) {
        let t = self.within_a_turn(t);
        // Beyond its turn a hyperbola is told from there: cosh √−α χ of a way down and up again is far larger
        // than the r that it leaves.
        match self.turn {
            Some(turn)
                if (0.0 < turn.time && turn.time < t) || (t < turn.time && turn.time < 0.0) =>
            {
                self.after(turn.state, t - turn.time)
            }
            _ => self.after(self.start, t),
        }
    }

    /// Place and velocity `t` seconds after a place and velocity on it.
    fn after(&self, (x, v): (Vec2, Vec2), t: f64) -> (Vec2, Vec2) {
        let root = self.strength.sqrt();
        let (r0, sigma) = (x.length(), x.dot(v) / root);
        let (chi, _) = self.anomaly(root * t, r0, sigma);
        let [u0, u1, u2, _] = self.universal(chi);
        let r = r0 * u0 + sigma * u1 + u2;
        let (f, g) = (1.0 - u2 / r0, (r0 * u1 + sigma * u2) / root);
        let (df, dg) = (-root * u1 / (r * r0), 1.0 - u2 / r);
        (self.centre + x * f + v * g, x * df + v * dg)
    }

    /// Time of one turn, in s; infinite if it never comes back.
    fn period(&self) -> f64 {
        if self.alpha <= 0.0 {
            return f64::INFINITY;
        }
        // 2π √(a³/µ)
        2.0 * core::f64::consts::PI / (self.alpha * (self.alpha * self.strength).sqrt())
    }

    /// The same place on an ellipse, at most half a turn away.
    fn within_a_turn(&self, t: f64) -> f64 {
        let period = self.period();
        if period.is_finite() {
            t - period * (t / period).round()
        } else {
            t
        }
    }

    /// χ with `r₀ U₁ + σ₀ U₂ + U₃ = way`: the left side grows with slope r > 0, so a bracket closes. And how many guesses it took.
    fn anomaly(&self, way: f64, r0: f64, sigma: f64) -> (f64, u32) {
        if way == 0.0 {
            return (0.0, 0);
        }
        let (mut low, mut high) = if way > 0.0 {
            (0.0, f64::INFINITY)
        } else {
            (f64::NEG_INFINITY, 0.0)
        };
        // For a near-radial start r₀ says little: way³ = 6 t is the guess of a parabola through the centre.
        let mut chi = way / r0;
        if self.alpha > 0.0 {
            // Half a turn is χ = π/√α.
            let most = core::f64::consts::PI / self.alpha.sqrt();
            chi = chi.clamp(-most, most);
        } else {
            let far = trig::pow(6.0 * way.abs(), 1.0 / 3.0) + sigma.abs();
            chi = chi.clamp(-far, far);
        }
        let mut last = f64::INFINITY;
        for guess in 1..=GUESSES {
            let [u0, u1, u2, u3] = self.universal(chi);
            let off = r0 * u1 + sigma * u2 + u3 - way;
            // What numbers cannot hold is too far.
            let beyond = if off.is_finite() {
                off > 0.0
            } else {
                chi > 0.0
            };
            if beyond {
                high = chi;
            } else {
                low = chi;
            }
            let r = r0 * u0 + sigma * u1 + u2;
            let next = chi - off / r;
            // It may be an end of the bracket: on a circle the first guess is χ.
            if r > 0.0 && (next - chi).abs() <= LAST * chi.abs() {
                return (next, guess);
            }
            let bracketed = low.is_finite() && high.is_finite();
            // Newton's step if it stays inside and at least halves the one before: near the centre the
            // slope r is next to nothing, and it leaps.
            let inside = next > low && next < high && r > 0.0;
            let longest = if bracketed { 0.5 * last } else { chi.abs() };
            let next = if inside && (next - chi).abs() <= longest {
                next
            } else if bracketed {
                0.5 * (low + high)
            } else {
                2.0 * chi
            };
            let step = (next - chi).abs();
            last = if bracketed { step } else { f64::INFINITY };
            chi = next;
            if step <= LAST * chi.abs() {
                return (chi, guess);
            }
        }
        (chi, GUESSES)
    }

    /// U₀ … U₃ at χ.
    fn universal(&self, chi: f64) -> [f64; 4] {
        let z = self.alpha * chi * chi;
        if z.abs() < 1.0 {
            // U_k = χ^k Σ (−z)^n / (2 n + k)!: 11 terms leave 1e-21.
            let (mut third, mut second) = (0.0, 0.0);
            for n in (0..11_i32).rev() {
                let n = f64::from(n);
                third = 1.0 - z * third / ((2.0 * n + 4.0) * (2.0 * n + 5.0));
                second = 1.0 - z * second / ((2.0 * n + 3.0) * (2.0 * n + 4.0));
            }
            let u2 = 0.5 * chi * chi * second;
            let u3 = chi * chi * chi * third / 6.0;
            return [1.0 - self.alpha * u2, chi - self.alpha * u3, u2, u3];
        }
        let root = self.alpha.abs().sqrt();
        let (u1, u2) = if self.alpha > 0.0 {
            let (sin, _) = trig::sin_cos(root * chi);
            let (half, _) = trig::sin_cos(0.5 * root * chi);
            (sin / root, 2.0 * half * half / self.alpha)
        } else {
            let (sinh, _) = trig::sinh_cosh(root * chi);
            let (half, _) = trig::sinh_cosh(0.5 * root * chi);
            (sinh / root, -2.0 * half * half / self.alpha)
        };
        [1.0 - self.alpha * u2, u1, u2, (chi - u1) / self.alpha]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    fn closes_after(turns: f64, place: Vec2, velocity: Vec2, strength: f64) -> f64 {
        let conic = Conic::through(Vec2::ZERO, strength, place, velocity).unwrap();
        // By the period of its own axis, to the rounding of the quotient.
        let (x, v) = conic.at(turns * conic.period());
        (x - place).length() / place.length() + (v - velocity).length() / velocity.length()
    }

    #[test]
    fn circles_and_ellipses_close_after_a_hundred_turns() {
        assert!(closes_after(100.0, vec2(3.0, 0.0), vec2(0.0, 2.0), 12.0) < 1e-12);
        for speed in [2.1, 2.5, 1.5, 0.7] {
            let off = closes_after(100.0, vec2(3.0, 0.0), vec2(0.3, speed), 12.0);
            assert!(off < 1e-11, "{off:e} at {speed} m/s");
        }
    }

    /// A guess may be χ itself, as the first one on a circle: the bracket was halved down to it then, 55 times.
    #[test]
    fn a_few_guesses_find_a_place_on_an_ellipse() {
        for eccentricity in [0.0, 1e-9, 0.1, 0.5, 0.9, 0.99] {
            let speed = (5.0_f64 * (1.0 + eccentricity)).sqrt();
            let conic = Conic::through(Vec2::ZERO, 5.0, Vec2::X, vec2(0.0, speed)).unwrap();
            for k in 0..200 {
                let t = conic.period() * f64::from(k) / 400.0;
                let (_, guesses) = conic.anomaly(5.0_f64.sqrt() * t, 1.0, 0.0);
                assert!(guesses <= 12, "{guesses}, e = {eccentricity}, {t} s");
            }
        }
    }

    #[test]
    fn a_quarter_of_a_circle_is_a_quarter() {
        let conic = Conic::through(vec2(1.0, 1.0), 8.0, vec2(3.0, 1.0), vec2(0.0, 2.0)).unwrap();
        let (x, v) = conic.at(0.25 * conic.period());
        assert!((x - vec2(1.0, 3.0)).length() < 1e-15, "{x}");
        assert!((v - vec2(-2.0, 0.0)).length() < 1e-15, "{v}");
    }

    #[test]
    fn a_parabola_follows_barkers_equation() {
        // From the vertex at distance q: t = √(2 q³/µ) (D + D³/3), x = q (1 − D²), y = 2 q D.
        let (q, mu) = (1.5_f64, 3.0_f64);
        let conic = Conic::through(
            Vec2::ZERO,
            mu,
            vec2(q, 0.0),
            vec2(0.0, (2.0 * mu / q).sqrt()),
        )
        .unwrap();
        for d in [0.01, 0.5, 2.0, 10.0] {
            let t = (2.0 * q * q * q / mu).sqrt() * (d + d * d * d / 3.0);
            let (x, _) = conic.at(t);
            let exact = vec2(q * (1.0 - d * d), 2.0 * q * d);
            assert!(
                (x - exact).length() < 1e-14 * exact.length(),
                "{x} not {exact}"
            );
        }
    }

    #[test]
    fn a_start_near_the_centre_leaves_it() {
        let start = (vec2(-8.72, 0.254), vec2(-1.7, -0.019));
        let conic = Conic::through(Vec2::ZERO, 11.12, start.0, start.1).unwrap();
        let (x, v) = conic.at(-10.3);
        let back = Conic::through(Vec2::ZERO, 11.12, x, v).unwrap();
        for k in 0..100 {
            let t = 0.103 * f64::from(k);
            let off = (back.at(t).0 - conic.at(t - 10.3).0).length();
            assert!(off < 1e-9, "{off:e} m after {t} s from {x}, {}", back.alpha);
        }
    }

    #[test]
    fn a_radial_throw_comes_back() {
        // Straight up from distance 1 with µ = 1 and v²/2 = 1/2: turns at 2, where it rests.
        let conic = Conic::through(Vec2::ZERO, 1.0, vec2(1.0, 0.0), vec2(1.0, 0.0)).unwrap();
        // From r = 1 to r = 2 a with a = 1: E from π/2 to π, t = E − sin E.
        let t = core::f64::consts::PI - (0.5 * core::f64::consts::PI - 1.0);
        let (x, v) = conic.at(t);
        assert!((x - vec2(2.0, 0.0)).length() < 1e-14, "{x}");
        assert!(v.length() < 1e-14, "{v}");
    }

    /// Told from its start, the way out was wrong by 2,000 roundings: r is a difference of far larger terms there.
    #[test]
    fn a_comet_that_comes_from_afar_keeps_its_momentum() {
        let (place, velocity) = (vec2(-8.0, -3.0), vec2(1.45, 0.5));
        let conic = Conic::through(Vec2::ZERO, 0.3, place, velocity).unwrap();
        assert!(conic.nearest() < 0.2);
        for t in [4.0, 6.0, 13.0, 40.0] {
            let (x, v) = conic.at(t);
            // What the rounding of x and v alone can do.
            let rounding = f64::EPSILON * x.length() * v.length();
            let off = cross(x, v) - cross(place, velocity);
            assert!(off.abs() < 8.0 * rounding, "{off:e}, {rounding:e} at {t} s");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn energy_and_areal_speed_stay(
            r in 0.1..10.0_f64, angle in -3.2..3.2_f64, speed in 0.0..4.0_f64, towards in -3.2..3.2_f64,
            strength in 0.1..20.0_f64, t in -20.0..20.0_f64,
        ) {
            let place = carom_math::Rot::from_angle(angle).x_axis() * r;
            let velocity = carom_math::Rot::from_angle(towards).x_axis() * speed;
            let conic = Conic::through(Vec2::ZERO, strength, place, velocity).unwrap();
            // No orbit passes through the centre itself.
            prop_assume!(conic.nearest() > 1e-3);
            let (x, v) = conic.at(t);
            let scale = strength / conic.nearest();
            let energy = |x: Vec2, v: Vec2| 0.5 * v.length_squared() - strength / x.length();
            prop_assert!((energy(x, v) - energy(place, velocity)).abs() < 1e-11 * scale);
            prop_assert!((cross(x, v) - cross(place, velocity)).abs() < 1e-12 * x.length().max(r) * scale.sqrt());
            // There and back again.
            let back = Conic::through(Vec2::ZERO, strength, x, v).unwrap();
            let (y, _) = back.at(-t);
            prop_assert!((y - place).length() < 1e-7 * (r + x.length()), "{y} not {place}");
        }

        #[test]
        fn two_halves_make_a_whole(
            speed in 0.5..4.0_f64, tilt in -1.0..1.0_f64, t in 0.0..5.0_f64,
        ) {
            let conic = Conic::through(Vec2::ZERO, 4.0, vec2(2.0, 0.0), vec2(tilt, speed)).unwrap();
            let (x, v) = conic.at(t);
            let (half, w) = conic.at(0.5 * t);
            let second = Conic::through(Vec2::ZERO, 4.0, half, w).unwrap();
            let (y, u) = second.at(0.5 * t);
            prop_assert!((x - y).length() < 1e-11 && (v - u).length() < 1e-11);
        }
    }
}
