//! Any other law of motion, `x'' = f(x) − c x'`: a flight by collocation, which the rims of fields end.

use carom_math::{Rot, SimTime, Vec2, vec2};

use super::collocated::{Collocated, NODES, shrunk};
use super::path::{Path, Place};

/// Part of a stretch that may lie beyond a rim.
const AT: f64 = 1e-12;

/// A circle across which a field has a kink: its centre and radius, in m.
pub(crate) type Rim = (Vec2, f64);

/// A stretch of a path.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// It leaves out more than was asked for, and is no shorter: the shortest of all.
    pub(crate) misses: bool,
    /// Of one body, which does not turn.
    pub(super) path: Collocated,
}

impl Stretch {
    /// The path under `f` and linear damping, in 1/s, from a place and a velocity on, for `longest` seconds or less: as far as it leaves out
    /// less than `error` metres a second, up to a rim at most, and no shorter than `shortest`: across an edge of a field.
    pub(crate) fn follow(
        f: &impl Fn(Vec2) -> Vec2,
        damping: f64,
        (place, velocity): (Vec2, Vec2),
        (shortest, longest): (f64, f64),
        error: f64,
        rims: &[Rim],
    ) -> Self {
        let mut law = |places: &[Place], to: &mut Vec<f64>| {
            let a = f(places[0].centre);
            to.clear();
            to.extend([a.x, a.y, 0.0]);
            true
        };
        let start = Place {
            centre: place,
            rotation: Rot::IDENTITY,
            velocity,
            spin: 0.0,
        };
        let mut first = Vec::new();
        law(&[start], &mut first);
        let mut path = Collocated::new(SimTime::ZERO, longest, &[start], &[1.0]);
        path.damping = damping;
        let shortest = shortest.min(longest);
        loop {
            let is_last = path.length <= shortest;
            let allowed = error * path.length;
            let left_out = path.collocate(&mut law, &first, allowed);
            // Beyond a rim is another law: the stretch ends there, and what it has beyond bends it less each time.
            let crossings = rims.iter().filter_map(|rim| crosses(&path, rim));
            let crossing = crossings.fold(path.length, f64::min);
            if !is_last && crossing < path.length * (1.0 - AT) && crossing > shortest {
                path.length = crossing;
                continue;
            }
            // What is no number is not within any error.
            let misses = !left_out.is_some_and(|left_out| left_out <= allowed);
            if !misses || is_last {
                return Self { misses, path };
            }
            path.length = shrunk(path.length, left_out, allowed).max(shortest);
        }
    }

    /// Place in m and velocity in m/s after `t` seconds, 0 ≤ t ≤ `length`.
    pub(crate) fn at(&self, t: f64) -> (Vec2, Vec2) {
        let (place, velocity, ..) = self.path.body_after(0, t);
        (place, velocity)
    }

    /// How fast `f` changes along the path, at most, in m/s³: the sum of `k |b_k|/h`. Without damping that is its third derivative.
    pub(crate) fn jerk(&self) -> f64 {
        let both = self.path.terms[0].iter().zip(&self.path.terms[1]);
        let each = (0..8_i32).zip(both);
        each.map(|(k, (x, y))| f64::from(k) * vec2(*x, *y).length())
            .sum::<f64>()
            / self.path.length
    }
}

/// When a path first crosses a rim between two nodes, in s.
fn crosses(path: &Collocated, &(centre, radius): &Rim) -> Option<f64> {
    let outside = |tau: f64| (path.body_after(0, tau * path.length).0 - centre).length() > radius;
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
    Some(high * path.length)
}

#[cfg(test)]
mod tests {
    use super::super::kepler::Conic;
    use super::*;
    use carom_math::trig;

    fn run(
        f: impl Fn(Vec2) -> Vec2,
        damping: f64,
        start: (Vec2, Vec2),
        seconds: f64,
        error: f64,
    ) -> (Vec2, Vec2) {
        let (mut x, mut v) = start;
        let mut left = seconds;
        while left > 0.0 {
            let stretch = Stretch::follow(&f, damping, (x, v), (1e-6, left.min(1.0)), error, &[]);
            (x, v) = stretch.at(stretch.path.length);
            left -= stretch.path.length;
        }
        (x, v)
    }

    #[test]
    fn a_spring_swings_as_its_cosine() {
        let (x, _) = run(
            |x| x * -4.0,
            0.0,
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
        let f = |x: Vec2| x * (-12.0 / (x.length() * x.length_squared()));
        let conic = Conic::through(Vec2::ZERO, 12.0, start.0, start.1).unwrap();
        let (x, _) = run(f, 0.0, start, 40.0, 1e-14);
        let off = (x - conic.at(40.0).0).length();
        assert!(off < 1e-10, "{off:e} m");
    }

    #[test]
    fn the_error_is_what_was_asked_for() {
        let start = (vec2(3.0, 0.0), vec2(0.3, 1.2));
        let f = |x: Vec2| x * (-12.0 / (x.length() * x.length_squared()));
        let conic = Conic::through(Vec2::ZERO, 12.0, start.0, start.1).unwrap();
        for error in [1e-4, 1e-6, 1e-8, 1e-10] {
            let stretch = Stretch::follow(&f, 0.0, start, (1e-6, 10.0), error, &[]);
            for part in [0.1, 0.37, 0.5, 0.81, 1.0] {
                let t = part * stretch.path.length;
                let off = (stretch.at(t).0 - conic.at(t).0).length();
                assert!(
                    off <= error * stretch.path.length,
                    "{off:e} m after {t} s at {error:e} m/s"
                );
            }
        }
    }

    #[test]
    fn damping_is_part_of_the_law() {
        let (x, v) = run(
            |_| vec2(0.0, -10.0),
            2.0,
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
