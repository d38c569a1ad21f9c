//! A body that turns about a fixed point under a uniform pull: a pendulum, in closed form.
//!
//! φ is the angle from the pull to the arm, which goes from the pivot to the centre of mass:
//!
//! ```text
//! φ″ = −k sin φ        e = φ′²/4 + k sin²(φ/2) stays        k = |g| ρ/(ρ² + I/m)
//!
//! e < k, it swings:    sin(φ/2) = √(e/k) sn(u | e/k)    φ′ = 2 √e cn(u | e/k)    u = √k t + u₀
//! e ≥ k, it goes over: φ/2 = am(u | k/e)                φ′ = 2 √e dn(u | k/e)    u = √e t + u₀
//! ```
//!
//! Source: E. T. Whittaker, *Analytical Dynamics*, 1937, §44.

use core::f64::consts::{PI, TAU};

use carom_math::{Elliptic, trig};

/// Amplitudes apart by less are one: what a pendulum reaches at its start is not what it reaches a period later.
const ONE: f64 = 1e-7;

/// The law of the angle of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pendulum {
    /// k, e and k − e, in 1/s²: near the top the last has digits that the others lost.
    pull: f64,
    energy: f64,
    short: f64,
    /// φ at the start, in rad.
    angle: f64,
    /// Which way it turns first, as a sign.
    way: f64,
    elliptic: Elliptic,
    /// Amplitude and argument at the start.
    amplitude: f64,
    argument: f64,
}

impl Pendulum {
    /// From an angle in rad, at most π in size, and its rate in rad/s on; `None` where nothing moves it.
    pub(crate) fn new(pull: f64, angle: f64, spin: f64) -> Option<Self> {
        let (sin, cos) = trig::sin_cos(0.5 * angle);
        let kinetic = 0.25 * spin * spin;
        let energy = pull * sin * sin + kinetic;
        if !(energy > 0.0 && energy.is_finite()) {
            return None;
        }
        let short = pull * cos * cos - kinetic;
        let (elliptic, amplitude) = if short > 0.0 {
            let amplitude = trig::atan2(pull.sqrt() * sin, 0.5 * spin);
            (Elliptic::new(short / pull), amplitude)
        } else {
            (
                Elliptic::new(-short / energy),
                0.5 * angle.copysign(angle * spin),
            )
        };
        let falls = -sin;
        let way = if spin == 0.0 { falls } else { spin };
        Some(Self {
            pull,
            energy,
            short,
            angle,
            way: 1.0_f64.copysign(way),
            elliptic,
            amplitude,
            argument: elliptic.integral(amplitude),
        })
    }

    fn swings(&self) -> bool {
        self.short > 0.0
    }

    /// du/dt, in 1/s.
    fn rate(&self) -> f64 {
        self.energy.max(self.pull).sqrt()
    }

    /// Angle turned by since the start in rad, and the rate in rad/s, after `t` seconds, at most a period.
    pub(crate) fn after(&self, t: f64) -> (f64, f64) {
        let [sn, cn, dn] = self.elliptic.functions(self.argument + self.rate() * t);
        let fastest = 2.0 * self.energy.sqrt();
        if self.swings() {
            let sine = (self.energy / self.pull).sqrt() * sn;
            (2.0 * trig::atan2(sine, dn) - self.angle, fastest * cn)
        } else {
            // Within a turn: the amplitude grows by π in one.
            let passed = self.next(trig::atan2(sn, cn)) - self.amplitude;
            (2.0 * self.way * passed, self.way * fastest * dn)
        }
    }

    /// The same amplitude, or one turn later if it was passed before the start.
    fn next(&self, amplitude: f64) -> f64 {
        if amplitude < self.amplitude - ONE {
            amplitude + TAU
        } else {
            amplitude
        }
    }

    /// φ at the start in rad, and k in 1/s².
    pub(crate) const fn start(&self) -> (f64, f64) {
        (self.angle, self.pull)
    }

    /// φ″ after it turned by `angle`, in rad/s².
    pub(crate) fn acceleration(&self, angle: f64) -> f64 {
        -self.pull * trig::sin_cos(self.angle + angle).0
    }

    /// Constant part of φ′² = c + 2 k cos φ, in rad²/s².
    pub(crate) fn constant(&self) -> f64 {
        2.0 * (self.energy - self.short)
    }

    /// Ranges of the angle turned by that it passes one after another, from and to, in rad: there and back if it swings, once
    /// round if it goes over. All else repeats them.
    pub(crate) fn legs(&self) -> [(f64, f64); 2] {
        if self.swings() {
            let widest = 2.0 * trig::atan2(self.energy.sqrt(), self.short.sqrt());
            let turn = |side: f64| side * widest - self.angle;
            let (first, second) = (turn(self.way), turn(-self.way));
            [(0.0, first), (first, second)]
        } else {
            let whole = self.way * TAU;
            [(0.0, whole), (whole, whole)]
        }
    }

    /// Seconds until it has turned by `angle` on a leg.
    pub(crate) fn time_at(&self, angle: f64, leg: usize) -> f64 {
        let amplitude = if self.swings() {
            let (sin, cos) = trig::sin_cos(0.5 * (self.angle + angle));
            // φ′²/4, without the difference of what is nearly equal at the top.
            let rest = (self.pull * cos * cos - self.short).max(0.0).sqrt();
            let way = if leg == 0 { self.way } else { -self.way };
            self.next(trig::atan2(self.pull.sqrt() * sin, way * rest))
        } else {
            self.amplitude + 0.5 * self.way * angle
        };
        let passed = self.elliptic.integral(amplitude) - self.argument;
        (passed / self.rate()).max(0.0)
    }

    /// Seconds until all repeats.
    pub(crate) fn period(&self) -> f64 {
        let turn = if self.swings() { TAU } else { PI };
        let whole = self.elliptic.integral(self.amplitude + turn) - self.argument;
        whole / self.rate()
    }

    /// Bounds on |φ′|, |φ″| and |φ‴| between the start and when it has turned by `angle` on a leg.
    pub(crate) fn bounds(&self, angle: f64, leg: usize) -> [f64; 3] {
        let ends = [0.0, angle].map(|turned| self.angle + turned);
        let rates =
            ends.map(|phi| (self.constant() + 2.0 * self.pull * trig::sin_cos(phi).1).max(0.0));
        // Fastest at the bottom, if that is between.
        let legs = self.legs();
        let far = if leg == 0 { angle } else { legs[0].1 };
        let [low, high] = if far < 0.0 { [far, 0.0] } else { [0.0, far] };
        let (low, high) = (self.angle + low.min(angle), self.angle + high.max(angle));
        let passes_bottom = (low / TAU).ceil() <= (high / TAU).floor();
        let spin = if passes_bottom {
            2.0 * self.energy.sqrt()
        } else {
            rates[0].max(rates[1]).sqrt()
        };
        [spin, self.pull, self.pull * spin]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// φ″ = −k sin φ by the classic method of order 4.
    pub(crate) fn integrate(pull: f64, mut angle: f64, mut spin: f64, t: f64) -> (f64, f64) {
        let steps = 4000_u32;
        let h = t / f64::from(steps);
        let f = |angle: f64| -pull * trig::sin_cos(angle).0;
        for _ in 0..steps {
            let (a1, w1) = (spin, f(angle));
            let (a2, w2) = (spin + 0.5 * h * w1, f(angle + 0.5 * h * a1));
            let (a3, w3) = (spin + 0.5 * h * w2, f(angle + 0.5 * h * a2));
            let (a4, w4) = (spin + h * w3, f(angle + h * a3));
            angle += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
            spin += h / 6.0 * (w1 + 2.0 * (w2 + w3) + w4);
        }
        (angle, spin)
    }

    proptest! {
        #[test]
        fn it_is_where_an_integrator_has_it(
            pull in 0.1..20.0_f64, angle in -PI..PI, spin in -8.0..8.0_f64, t in 0.0..1.0_f64,
        ) {
            let pendulum = Pendulum::new(pull, angle, spin).expect("it moves");
            let (turned, rate) = pendulum.after(t);
            let (there, fast) = integrate(pull, angle, spin, t);
            prop_assert!((angle + turned - there).abs() < 1e-10, "{} not {there}", angle + turned);
            prop_assert!((rate - fast).abs() < 1e-9, "{rate} not {fast}");
        }

        #[test]
        fn times_are_those_of_its_angles(
            pull in 0.1..20.0_f64, angle in -PI..PI, spin in -8.0..8.0_f64, part in 0.0..1.0_f64, leg in 0..2_usize,
        ) {
            let pendulum = Pendulum::new(pull, angle, spin).expect("it moves");
            let (from, to) = pendulum.legs()[leg];
            let there = from + part * (to - from);
            let time = pendulum.time_at(there, leg);
            let (turned, _) = pendulum.after(time);
            prop_assert!((turned - there).abs() < 1e-12, "{turned} not {there}");
            let [spin, ..] = pendulum.bounds(there, leg);
            for k in 0..20 {
                let (_, rate) = pendulum.after(time * f64::from(k) / 20.0);
                // Near a turning point the squares are small differences.
                prop_assert!(rate * rate <= spin * spin + 1e-13 * (pull + spin * spin), "{rate} above {spin}");
            }
        }

        #[test]
        fn all_repeats_after_a_period(pull in 0.1..20.0_f64, angle in -PI..PI, spin in -8.0..8.0_f64) {
            let pendulum = Pendulum::new(pull, angle, spin).expect("it moves");
            let ((turned, rate), back) = (pendulum.after(pendulum.period()), pendulum.legs()[1]);
            let whole = if back.0 == back.1 { back.1 } else { 0.0 };
            prop_assert!((turned - whole).abs() < 1e-11, "{turned} not {whole}");
            prop_assert!((rate - spin).abs() < 1e-11 * (1.0 + spin.abs()), "{rate} not {spin}");
        }
    }
}
