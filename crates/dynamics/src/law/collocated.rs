//! Paths of several bodies that contacts hold, `y″ = f(y, y′)`: the collocation of [`super::integrate`] for any number of coordinates.
//!
//! Three coordinates a body: both of its centre in m, and the angle since the start of the path in rad.

use carom_math::{Rot, SimTime, Vec2, vec2};

use super::integrate::{ALL, NODES, ROUNDS, through};
use super::path::{Path, Place};

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
    length: f64,
    rotations: Vec<Rot>,
    /// Bodies that do not move.
    stays: Vec<bool>,
    place: Vec<f64>,
    velocity: Vec<f64>,
    /// b₀ … b₇ of each coordinate.
    terms: Vec<[f64; 8]>,
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
        let flat = |of: fn(&Place) -> [f64; 3]| places.iter().flat_map(of).collect::<Vec<f64>>();
        let mut path = Self {
            start,
            length: longest,
            rotations: places.iter().map(|place| place.rotation).collect(),
            stays: reaches.iter().map(|reach| *reach == 0.0).collect(),
            place: flat(|place| [place.centre.x, place.centre.y, 0.0]),
            velocity: flat(|place| [place.velocity.x, place.velocity.y, place.spin]),
            terms: Vec::new(),
            integrals: Vec::new(),
        };
        // In 1/12 of a radian by what turns fastest the polynomials are as right as is asked for. 1/7: nearly always too long.
        let mut rate = 0.0_f64;
        for (place, turn) in places.iter().zip(first.iter().skip(2).step_by(3)) {
            rate = rate.max(place.spin.abs().max(turn.abs().sqrt()));
        }
        if rate * path.length > TURN {
            path.length = TURN / rate;
        }
        let scale = |k: usize| if k % 3 == 2 { reaches[k / 3] } else { 1.0 };
        let mut values: Vec<[f64; 8]> = first.iter().map(|x| [*x; 8]).collect();
        let mut places = Vec::with_capacity(places.len());
        while path.length >= shortest {
            let allowed = error * path.length;
            let left_out = path.collocate(&mut f, (&mut values, &mut places), &scale, allowed);
            if left_out.is_some_and(|left_out| left_out <= allowed) {
                return Some(path);
            }
            let ratio = left_out.map_or(0.0, |left_out| allowed / left_out);
            let shrink = if ratio > 0.0 && ratio.is_finite() {
                (0.9 * ratio.sqrt().sqrt().sqrt()).clamp(0.1, 0.8)
            } else {
                0.25
            };
            path.length *= shrink;
        }
        None
    }

    /// Rounds of fixed-point iteration from constant accelerations: what the path leaves out, in m; `None` where they do not
    /// converge. They end as soon as it is more than `allowed`: the first round with all nodes knows it to a factor of two.
    /// `values`: accelerations at the nodes, those at the first given.
    fn collocate(
        &mut self,
        f: &mut impl FnMut(&[Place], &mut Vec<f64>) -> bool,
        (values, places): (&mut [[f64; 8]], &mut Vec<Place>),
        scale: &impl Fn(usize) -> f64,
        allowed: f64,
    ) -> Option<f64> {
        let begins = |values: &[f64; 8]| [values[0], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        self.terms.clear();
        self.terms.extend(values.iter().map(begins));
        self.integrals.clear();
        self.integrals.extend(self.terms.iter().map(integrated));
        let sizes = values.iter().enumerate();
        let sizes = sizes.map(|(k, values)| (values[0] * scale(k)).abs());
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let mut found = Vec::with_capacity(values.len());
        for nodes in STAGES {
            self.round(f, (values, places, &mut found), scale, nodes)?;
        }
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            let change = self.round(f, (values, places, &mut found), scale, &ALL)?;
            let left_out = self.left_out(scale);
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
        scale: &impl Fn(usize) -> f64,
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
            if self.stays[k / 3] {
                continue;
            }
            let new = through(values, nodes);
            for (new, old) in new.iter().zip(&self.terms[k]) {
                change = change.max((new - old).abs() * scale(k));
            }
            self.terms[k] = new;
            self.integrals[k] = integrated(&new);
        }
        change.is_finite().then_some(change)
    }

    /// What the path lacks, at most, in m.
    fn left_out(&self, scale: &impl Fn(usize) -> f64) -> f64 {
        let last = self.terms.iter().enumerate();
        let most = last.map(|(k, terms)| (terms[7] * scale(k)).abs());
        most.fold(0.0, f64::max) * self.length * self.length / 72.0
    }

    fn coordinate(&self, k: usize, t: f64) -> (f64, f64) {
        let tau = t / self.length;
        let (mut v, mut x) = (0.0, 0.0);
        for [once, twice] in self.integrals[k].iter().rev() {
            v = v * tau + once;
            x = x * tau + twice;
        }
        (
            self.place[k] + (self.velocity[k] + x * t) * t,
            self.velocity[k] + v * t,
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
        if self.stays[body] {
            return (
                vec2(self.place[3 * body], self.place[3 * body + 1]),
                Vec2::ZERO,
                0.0,
                0.0,
            );
        }
        let [(x, u), (y, v), (angle, spin)] = [0, 1, 2].map(|k| self.coordinate(3 * body + k, t));
        (vec2(x, y), vec2(u, v), angle, spin)
    }

    fn acceleration_after(&self, body: usize, t: f64) -> (Vec2, f64) {
        let tau = t / self.length;
        let of = |k: usize| {
            let terms = self.terms[3 * body + k].iter().rev();
            terms.fold(0.0, |sum, term| sum * tau + term)
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
