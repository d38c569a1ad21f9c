//! Paths of bodies by any law, `x″ = f(x, x′)`: Gauss–Radau collocation of order 15 with dense output.
//!
//! Three coordinates a body: both of its centre in m, and the angle since the start of the path in rad.
//! Over a stretch of h seconds the acceleration of each is a polynomial in τ = t/h that agrees with f at the eight
//! Gauss–Radau points; velocity and place are its integrals:
//!
//! ```text
//! a(τ) = Σ b_k τ^k      v(τ) = v₀ + h Σ b_k τ^(k+1)/(k+1)      x(τ) = x₀ + h τ v₀ + h² Σ b_k τ^(k+2)/((k+1)(k+2))
//! ```
//!
//! Where damping c takes velocity, x″ = f − c x′, it is taken as it is, and f alone is the polynomial: it is smooth however
//! strong c is. With z = c h τ and mₙ of [`left_by_damping`]
//!
//! ```text
//! v(τ) = v₀ m₀(z) + h Σ b_k τ^(k+1) m_(k+1)(z)/(k+1)      x(τ) = x₀ + h τ v₀ m₁(z) + h² Σ b_k τ^(k+2) m_(k+2)(z)/((k+1)(k+2))
//! ```
//!
//! Source: E. Everhart 1985; H. Rein and D. S. Spiegel, *IAS15*, 2015. The last coefficient is what the next lower
//! order would lack: h² b₇/72 bounds, generously, what a stretch leaves out, at its end and everywhere in it.

use carom_math::{Rot, SimTime, Vec2, vec2};

use super::damped::left_by_damping;
use super::path::{Path, Place};

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
const ROUNDS: u32 = 12;

/// First guess of how far a body turns in a stretch, in rad.
const TURN: f64 = 1.0 / 12.0;

/// Nodes of the first rounds: a round brings the path nearer by a factor of a hundred and gains one degree, so that more nodes
/// would tell no more.
const STAGES: [&[usize]; 3] = [&[0, 5], &[0, 3, 6], &[0, 2, 4, 6, 7]];

/// Accelerations are known where what the next round would change is below this part of them: roundings of the terms are 1e-12.
const STANDS: f64 = 1e-13;

/// Where bodies are for a while, as polynomials of degree 9.
#[derive(Clone, Debug)]
pub(crate) struct Collocated {
    start: SimTime,
    /// In s.
    pub(super) length: f64,
    rotations: Vec<Rot>,
    /// What a coordinate counts for, in m: that of an angle the way at the body's reach, and 0 if the body does not move.
    scales: Vec<f64>,
    place: Vec<f64>,
    velocity: Vec<f64>,
    /// Linear damping of all coordinates beside the law, in 1/s.
    pub(super) damping: f64,
    /// b₀ … b₇ of each coordinate.
    pub(super) terms: Vec<[f64; 8]>,
    /// The same integrated once and twice: bₙ/(n + 1), and bₙ/((n + 1)(n + 2)). A path is evaluated far more often than made.
    integrals: Vec<[[f64; 2]; 8]>,
}

impl Collocated {
    /// From these places on under `f`, for `longest` seconds or less: as far as it leaves out less than `error`
    /// metres a second, an angle counting as the way at its `reach`; `None` if it is not known for `shortest` seconds.
    ///
    /// `f` writes three accelerations a body, and says whether there are any; a body with reach 0 stays where it is.
    pub(crate) fn follow(
        mut f: impl FnMut(&[Place], &mut Vec<f64>) -> bool,
        start: SimTime,
        places: &[Place],
        reaches: &[f64],
        (longest, shortest): (f64, f64),
        error: f64,
    ) -> Option<Self> {
        let mut first = Vec::with_capacity(3 * places.len());
        if !f(places, &mut first) {
            return None;
        }
        // In 1/12 of a radian by what turns fastest the polynomials are as right as is asked for. 1/7: nearly always too long.
        let mut rate = 0.0_f64;
        for (place, turn) in places.iter().zip(first.iter().skip(2).step_by(3)) {
            rate = rate.max(place.spin.abs().max(turn.abs().sqrt()));
        }
        let length = if rate * longest > TURN {
            TURN / rate
        } else {
            longest
        };
        let mut path = Self::new(start, length, places, reaches);
        while path.length >= shortest {
            let allowed = error * path.length;
            let left_out = path.collocate(&mut f, &first, allowed);
            if left_out.is_some_and(|left_out| left_out <= allowed) {
                return Some(path);
            }
            path.length = shrunk(path.length, left_out, allowed);
        }
        None
    }

    /// From these places on; nothing is known of it yet.
    pub(super) fn new(start: SimTime, length: f64, places: &[Place], reaches: &[f64]) -> Self {
        let flat = |of: fn(&Place) -> [f64; 3]| places.iter().flat_map(of).collect();
        let scale = |reach: &f64| {
            if *reach == 0.0 {
                [0.0; 3]
            } else {
                [1.0, 1.0, *reach]
            }
        };
        Self {
            start,
            length,
            rotations: places.iter().map(|place| place.rotation).collect(),
            scales: reaches.iter().flat_map(scale).collect(),
            place: flat(|place| [place.centre.x, place.centre.y, 0.0]),
            velocity: flat(|place| [place.velocity.x, place.velocity.y, place.spin]),
            damping: 0.0,
            terms: Vec::new(),
            integrals: Vec::new(),
        }
    }

    /// Rounds of fixed-point iteration from constant accelerations: what the path leaves out, in m; `None` where they do not
    /// converge. They end as soon as it is more than `allowed`: the first round with all nodes knows it to a factor of two.
    /// `first`: accelerations at the start.
    pub(super) fn collocate(
        &mut self,
        f: &mut impl FnMut(&[Place], &mut Vec<f64>) -> bool,
        first: &[f64],
        allowed: f64,
    ) -> Option<f64> {
        let mut values: Vec<[f64; 8]> = first.iter().map(|x| [*x; 8]).collect();
        self.terms.clear();
        self.terms.extend(
            first
                .iter()
                .map(|x| [*x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        );
        self.integrals.clear();
        self.integrals.extend(self.terms.iter().map(integrated));
        let sizes = first.iter().zip(&self.scales);
        let sizes = sizes.map(|(x, scale)| (x * scale).abs());
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let (mut places, mut found) = (Vec::new(), Vec::with_capacity(first.len()));
        for nodes in STAGES {
            self.round(f, (&mut values, &mut places, &mut found), nodes)?;
        }
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let change = self.round(f, (&mut values, &mut places, &mut found), &ALL)?;
            let left_out = self.left_out();
            // The next round changes less by the same factor, until rounding is all that changes.
            let factor = change / before;
            let converges = factor > 0.0 && factor < 0.1 && change * factor <= STANDS * size;
            let stands = change == 0.0 || change <= 1e-11 * size && factor >= 0.5;
            if converges || stands || left_out > allowed {
                return Some(left_out);
            }
            // A stretch that is too long gets no nearer.
            if change > before {
                return None;
            }
            before = change;
        }
        None
    }

    /// A round with these nodes: by how much the terms change at most; `None` where there are no accelerations.
    fn round(
        &mut self,
        f: &mut impl FnMut(&[Place], &mut Vec<f64>) -> bool,
        (values, places, found): (&mut [[f64; 8]], &mut Vec<Place>, &mut Vec<f64>),
        nodes: &[usize],
    ) -> Option<f64> {
        for &k in &nodes[1..] {
            self.write_places(NODES[k] * self.length, places);
            if !f(places, found) {
                return None;
            }
            for (values, found) in values.iter_mut().zip(&*found) {
                values[k] = *found;
            }
        }
        let mut change = 0.0_f64;
        for (k, values) in values.iter().enumerate() {
            let scale = self.scales[k];
            if scale == 0.0 {
                continue;
            }
            let new = through(values, nodes);
            for (new, old) in new.iter().zip(&self.terms[k]) {
                change = change.max((new - old).abs() * scale);
            }
            self.terms[k] = new;
            self.integrals[k] = integrated(&new);
        }
        change.is_finite().then_some(change)
    }

    /// What the path lacks, at most, in m.
    fn left_out(&self) -> f64 {
        let last = self.terms.iter().zip(&self.scales);
        let most = last.map(|(terms, scale)| (terms[7] * scale).abs());
        let most = most.fold(0.0, f64::max) * self.length * self.length / 72.0;
        most * self.left(self.length)[9]
    }

    /// What damping leaves `t` seconds on.
    fn left(&self, t: f64) -> [f64; 10] {
        if self.damping == 0.0 {
            [1.0; 10]
        } else {
            left_by_damping(self.damping * t)
        }
    }

    fn coordinate(&self, k: usize, t: f64, left: &[f64; 10]) -> (f64, f64) {
        let tau = t / self.length;
        let (mut v, mut x) = (0.0, 0.0);
        for (n, [once, twice]) in self.integrals[k].iter().enumerate().rev() {
            v = v * tau + once * left[n + 1];
            x = x * tau + twice * left[n + 2];
        }
        (
            self.place[k] + (self.velocity[k] * left[1] + x * t) * t,
            self.velocity[k] * left[0] + v * t,
        )
    }
}

impl Path for Collocated {
    fn start(&self) -> SimTime {
        self.start
    }

    fn length(&self) -> f64 {
        self.length
    }

    fn bodies(&self) -> usize {
        self.rotations.len()
    }

    fn rotation(&self, body: usize) -> Rot {
        self.rotations[body]
    }

    fn body_after(&self, body: usize, t: f64) -> (Vec2, Vec2, f64, f64) {
        if self.scales[3 * body] == 0.0 {
            return (
                vec2(self.place[3 * body], self.place[3 * body + 1]),
                Vec2::ZERO,
                0.0,
                0.0,
            );
        }
        let left = self.left(t);
        let coordinate = |k: usize| self.coordinate(3 * body + k, t, &left);
        let [(x, u), (y, v), (angle, spin)] = [0, 1, 2].map(coordinate);
        (vec2(x, y), vec2(u, v), angle, spin)
    }

    fn acceleration_after(&self, body: usize, t: f64) -> (Vec2, f64) {
        let (tau, left) = (t / self.length, self.left(t));
        let of = |k: usize| {
            let terms = self.terms[3 * body + k].iter().rev();
            let law = terms.fold(0.0, |sum, term| sum * tau + term);
            law - self.damping * self.coordinate(3 * body + k, t, &left).1
        };
        (vec2(of(0), of(1)), of(2))
    }

    fn jerk(&self, body: usize) -> (f64, f64) {
        let of = |k: usize| {
            let mut sum = 0.0;
            for (power, term) in (0_u32..).zip(self.terms[3 * body + k]) {
                sum += f64::from(power) * term.abs();
            }
            sum / self.length
        };
        (of(0) + of(1), of(2))
    }
}

/// Coefficients of the first and the second integral of a polynomial.
fn integrated(terms: &[f64; 8]) -> [[f64; 2]; 8] {
    let mut n = 0.0;
    terms.map(|term| {
        n += 1.0;
        [term / n, term / (n * (n + 1.0))]
    })
}

/// How long a path is to be next that left out more than is allowed, or was not found: the term of order 9 in its length tells.
pub(super) fn shrunk(length: f64, left_out: Option<f64>, allowed: f64) -> f64 {
    let ratio = left_out.map_or(0.0, |left_out| allowed / left_out);
    length
        * if ratio > 0.0 && ratio.is_finite() {
            (0.9 * ratio.sqrt().sqrt().sqrt()).clamp(0.1, 0.8)
        } else {
            0.25
        }
}

/// All nodes.
const ALL: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// Coefficients of the polynomial through the values at these nodes: Newton's divided differences, multiplied out.
fn through(values: &[f64; 8], nodes: &[usize]) -> [f64; 8] {
    let mut differences = [0.0; 8];
    for (difference, &node) in differences.iter_mut().zip(nodes) {
        *difference = values[node];
    }
    for order in 1..nodes.len() {
        for k in (order..nodes.len()).rev() {
            let span = NODES[nodes[k]] - NODES[nodes[k - order]];
            differences[k] = (differences[k] - differences[k - 1]) / span;
        }
    }
    let mut terms = [0.0; 8];
    for (difference, &node) in differences.iter().zip(nodes).rev() {
        // p ← p (τ − node) + difference
        for k in (0..8).rev() {
            let below = if k > 0 { terms[k - 1] } else { 0.0 };
            terms[k] = below - terms[k] * NODES[node];
        }
        terms[0] += *difference;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
