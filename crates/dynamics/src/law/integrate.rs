//! Any other law of motion, `x'' = f(x, v)`: Gauss–Radau collocation of order 15 with dense output.
//!
//! Over a stretch of h seconds the acceleration is a polynomial in τ = t/h that agrees with f at the eight
//! Gauss–Radau points; velocity and place are its integrals:
//!
//! ```text
//! a(τ) = Σ b_k τ^k      v(τ) = v₀ + h Σ b_k τ^(k+1)/(k+1)      x(τ) = x₀ + h τ v₀ + h² Σ b_k τ^(k+2)/((k+1)(k+2))
//! ```
//!
//! Source: E. Everhart 1985; H. Rein and D. S. Spiegel, *IAS15*, 2015. The last coefficient is what the next lower
//! order would lack: h² b₇/72 bounds, generously, what a stretch leaves out, at its end and everywhere in it.

use core::ops::{Add, Div, Mul, Sub};

use carom_math::Vec2;

/// Gauss–Radau points of (0, 1], with 0 the first: roots of `P₇(s) + P₈(s)` for s = 2 τ − 1.
pub(super) const NODES: [f64; 8] = [
    0.0,
    0.056_262_560_536_922_15,
    0.180_240_691_736_892_36,
    0.352_624_717_113_169_6,
    0.547_153_626_330_555_4,
    0.734_210_177_215_410_5,
    0.885_320_946_839_095_8,
    0.977_520_613_561_287_5,
];

/// Rounds of correction at most; a stretch that needs more is too long.
pub(super) const ROUNDS: u32 = 12;

/// Change of the polynomial, as a part of the acceleration, at which it stands.
const STANDS: f64 = 2.0 * f64::EPSILON;

/// Part of a stretch that may lie beyond a rim.
const AT: f64 = 1e-12;

/// A circle across which a field has a kink: its centre and radius, in m.
pub(crate) type Rim = (Vec2, f64);

/// A stretch of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    /// Length in s.
    pub(crate) length: f64,
    /// It leaves out more than was asked for, and is no shorter: the shortest of all.
    pub(crate) misses: bool,
    place: Vec2,
    velocity: Vec2,
    /// b₀ … b₇, in m/s².
    terms: [Vec2; 8],
}

impl Stretch {
    /// The path under `f` from a place and a velocity on, for `longest` seconds or less: as far as it leaves out
    /// less than `error` metres a second, up to a rim at most, and no shorter than `shortest`: across an edge of a field.
    pub(crate) fn follow(
        f: &impl Fn(Vec2, Vec2) -> Vec2,
        place: Vec2,
        velocity: Vec2,
        (shortest, longest): (f64, f64),
        error: f64,
        rims: &[Rim],
    ) -> Self {
        let first = f(place, velocity);
        let mut length = longest;
        // A halved stretch leaves out 2⁹ times less where the field is smooth.
        while length > shortest {
            let (stretch, stands) = Self::collocate(f, place, velocity, first, length);
            // Beyond a rim is another law: the stretch ends there, and what it has beyond bends it less each time.
            let crossings = rims.iter().filter_map(|rim| stretch.crosses(rim));
            let crossing = crossings.fold(length, f64::min);
            if crossing < length * (1.0 - AT) && crossing > shortest {
                length = crossing;
                continue;
            }
            let left_out = stretch.left_out();
            if stands && left_out <= error * length {
                return stretch;
            }
            // The term of order 9 in h tells how far is near enough.
            let ratio = error * length / left_out;
            let shrink = if stands && ratio > 0.0 && ratio.is_finite() {
                (0.9 * ratio.sqrt().sqrt().sqrt()).clamp(0.1, 0.8)
            } else {
                0.25
            };
            length *= shrink;
        }
        let length = if longest < shortest {
            longest
        } else {
            shortest
        };
        let (mut stretch, stands) = Self::collocate(f, place, velocity, first, length);
        // What is no number is not within any error.
        stretch.misses = !(stands && stretch.left_out() <= error * length);
        stretch
    }

    fn collocate(
        f: &impl Fn(Vec2, Vec2) -> Vec2,
        place: Vec2,
        velocity: Vec2,
        first: Vec2,
        length: f64,
    ) -> (Self, bool) {
        let mut stretch = Self {
            length,
            misses: false,
            place,
            velocity,
            terms: [Vec2::ZERO; 8],
        };
        stretch.terms[0] = first;
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let mut values = [first; 8];
            for (value, node) in values.iter_mut().zip(NODES).skip(1) {
                let (x, v) = stretch.at(node * length);
                *value = f(x, v);
            }
            let terms = through(&values, &ALL);
            let mut change = 0.0_f64;
            for (new, old) in terms.iter().zip(&stretch.terms) {
                change = change.max((*new - *old).length());
            }
            stretch.terms = terms;
            if !change.is_finite() {
                return (stretch, false);
            }
            // To rounding, or as near as the polynomial's own coefficients allow.
            if change <= STANDS * first.length()
                || change >= 0.5 * before && change <= 1e-11 * first.length()
            {
                return (stretch, true);
            }
            before = change;
        }
        (stretch, false)
    }

    /// Place in m and velocity in m/s after `t` seconds, 0 ≤ t ≤ `length`.
    pub(crate) fn at(&self, t: f64) -> (Vec2, Vec2) {
        let tau = t / self.length;
        let (mut v, mut x) = (Vec2::ZERO, Vec2::ZERO);
        for (k, term) in self.terms.iter().enumerate().rev() {
            #[expect(clippy::cast_precision_loss, reason = "at most 8")]
            let k = k as f64;
            v = v * tau + *term / (k + 1.0);
            x = x * tau + *term / ((k + 1.0) * (k + 2.0));
        }
        (
            self.place + (self.velocity + x * t) * t,
            self.velocity + v * t,
        )
    }

    /// When the path first crosses a rim between two nodes, in s.
    fn crosses(&self, &(centre, radius): &Rim) -> Option<f64> {
        let outside = |tau: f64| (self.at(tau * self.length).0 - centre).length() > radius;
        let started = outside(NODES[1]);
        let after = NODES[2..].iter().chain(&[1.0]).copied();
        let (mut low, mut high) = NODES[1..]
            .iter()
            .copied()
            .zip(after)
            .find(|(_, tau)| outside(*tau) != started)?;
        while high - low > 1e-15 {
            let middle = 0.5 * (low + high);
            if outside(middle) == started {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high * self.length)
    }

    /// Acceleration after `t` seconds, in m/s².
    pub(crate) fn acceleration(&self, t: f64) -> Vec2 {
        let tau = t / self.length;
        let terms = self.terms.iter().rev();
        terms.fold(Vec2::ZERO, |sum, term| sum * tau + *term)
    }

    /// Largest third derivative of the path, at most, in m/s³: the sum of `k |b_k|/h`.
    pub(crate) fn jerk(&self) -> f64 {
        let terms = (0..8_i32).zip(&self.terms);
        terms
            .map(|(k, term)| f64::from(k) * term.length())
            .sum::<f64>()
            / self.length
    }

    /// What the path lacks, at most, in m.
    pub(crate) fn left_out(&self) -> f64 {
        self.terms[7].length() * self.length * self.length / 72.0
    }
}

/// All nodes.
pub(super) const ALL: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Coefficients of the polynomial through the values at these nodes: Newton's divided differences, multiplied out.
pub(super) fn through<T>(values: &[T; 8], nodes: &[usize]) -> [T; 8]
where
    T: Copy
        + Default
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<f64, Output = T>
        + Div<f64, Output = T>,
{
    let mut differences = [T::default(); 8];
    for (difference, &node) in differences.iter_mut().zip(nodes) {
        *difference = values[node];
    }
    for order in 1..nodes.len() {
        for k in (order..nodes.len()).rev() {
            let span = NODES[nodes[k]] - NODES[nodes[k - order]];
            differences[k] = (differences[k] - differences[k - 1]) / span;
        }
    }
    let mut terms = [T::default(); 8];
    for (difference, &node) in differences.iter().zip(nodes).rev() {
        // p ← p (τ − node) + difference
        for k in (0..8).rev() {
            let below = if k > 0 { terms[k - 1] } else { T::default() };
            terms[k] = below - terms[k] * NODES[node];
        }
        terms[0] = terms[0] + *difference;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::super::kepler::Conic;
    use super::*;
    use carom_math::{trig, vec2};

    #[test]
    fn the_nodes_are_those_of_gauss_and_radau() {
        for node in NODES {
            let s = 2.0 * node - 1.0;
            let (mut low, mut high) = (1.0, s);
            for n in 1..8_i32 {
                let n = f64::from(n);
                (low, high) = (high, ((2.0 * n + 1.0) * s * high - n * low) / (n + 1.0));
            }
            assert!((low + high).abs() < 2e-14, "{node}: {:e}", low + high);
        }
    }

    fn run(
        f: impl Fn(Vec2, Vec2) -> Vec2,
        start: (Vec2, Vec2),
        seconds: f64,
        error: f64,
    ) -> (Vec2, Vec2) {
        let (mut x, mut v) = start;
        let mut left = seconds;
        while left > 0.0 {
            let stretch = Stretch::follow(&f, x, v, (1e-6, left.min(1.0)), error, &[]);
            (x, v) = stretch.at(stretch.length);
            left -= stretch.length;
        }
        (x, v)
    }

    #[test]
    fn a_spring_swings_as_its_cosine() {
        let (x, _) = run(
            |x, _| x * -4.0,
            (vec2(1.0, 0.0), vec2(0.0, 2.0)),
            50.0,
            1e-14,
        );
        let (sin, cos) = trig::sin_cos(100.0);
        assert!((x - vec2(cos, sin)).length() < 1e-12, "{x}");
    }

    #[test]
    fn an_ellipse_is_keplers() {
        let start = (vec2(3.0, 0.0), vec2(0.3, 1.2));
        let f = |x: Vec2, _| x * (-12.0 / (x.length() * x.length_squared()));
        let conic = Conic::through(Vec2::ZERO, 12.0, start.0, start.1).unwrap();
        let (x, _) = run(f, start, 40.0, 1e-14);
        let off = (x - conic.at(40.0).0).length();
        assert!(off < 1e-10, "{off:e} m");
    }

    #[test]
    fn the_error_is_what_was_asked_for() {
        let start = (vec2(3.0, 0.0), vec2(0.3, 1.2));
        let f = |x: Vec2, _| x * (-12.0 / (x.length() * x.length_squared()));
        let conic = Conic::through(Vec2::ZERO, 12.0, start.0, start.1).unwrap();
        for error in [1e-4, 1e-6, 1e-8, 1e-10] {
            let stretch = Stretch::follow(&f, start.0, start.1, (1e-6, 10.0), error, &[]);
            for part in [0.1, 0.37, 0.5, 0.81, 1.0] {
                let t = part * stretch.length;
                let off = (stretch.at(t).0 - conic.at(t).0).length();
                assert!(
                    off <= error * stretch.length,
                    "{off:e} m after {t} s at {error:e} m/s"
                );
            }
        }
    }

    #[test]
    fn damping_is_part_of_the_law() {
        let (x, v) = run(
            |_, v| vec2(0.0, -10.0) - v * 2.0,
            (Vec2::ZERO, vec2(3.0, 4.0)),
            2.0,
            1e-14,
        );
        let (along, up) = (
            super::super::damped::damped(3.0, 0.0, 2.0, 2.0),
            super::super::damped::damped(4.0, -10.0, 2.0, 2.0),
        );
        assert!((x - vec2(along.0, up.0)).length() < 1e-13);
        assert!((v - vec2(along.1, up.1)).length() < 1e-13);
    }
}
