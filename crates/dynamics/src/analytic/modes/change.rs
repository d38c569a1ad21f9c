//! The next change of a mode, from roots of quadratics.

use super::alone;
use super::balance::{Balance, Tangent, balance};
use super::faces::Faces;
use super::{BodyMove, Feature, Touch, slip_rate};
use crate::impact::ImpactBody;
use carom_math::{Vec2, perp};

/// How far ahead a load that shifts is looked at where nothing else ends the mode, in s.
const LOOK: f64 = 64.0;

/// Instants within a mode at which a load that shifts is looked at.
const LOOKS: u32 = 8;

/// Accelerations that differ by more than this part belong to another motion.
pub(super) const SAME: f64 = 1e-12;

/// Halvings of a stretch after which an instant is as near as it comes.
const HALVINGS: u32 = 60;

/// How B slides along A: `speed τ + ½ rate τ²` along the tangent, and the stretches that each touches with.
pub(super) struct Slide {
    pub(super) speed: f64,
    pub(super) rate: f64,
    a: [f64; 2],
    b: [f64; 2],
}

impl Slide {
    pub(super) fn of(touch: &Touch, moves: &[BodyMove]) -> Self {
        let (a, b) = (&moves[touch.bodies.0], &moves[touch.bodies.1]);
        let t = perp(touch.normal);
        Self {
            speed: (b.velocity - a.velocity).dot(t),
            rate: (b.acceleration - a.acceleration).dot(t),
            a: stretch(touch.features.0),
            b: stretch(touch.features.1),
        }
    }

    fn moves(&self) -> bool {
        self.speed != 0.0 || self.rate != 0.0
    }

    fn at(&self, after: f64) -> f64 {
        (self.speed + 0.5 * self.rate * after) * after
    }

    /// When the stretches part: `a_high − b_low − d` or `b_high − a_low + d` comes to 0.
    pub(super) fn ends(&self) -> Option<f64> {
        let up = falls_to_zero(self.a[1] - self.b[0], -self.speed, -self.rate);
        let down = falls_to_zero(self.b[1] - self.a[0], self.speed, self.rate);
        match (up, down) {
            (Some(x), Some(y)) => Some(if y < x { y } else { x }),
            (x, y) => x.or(y),
        }
    }

    /// The common stretch, from the first point of the touch as A carries it.
    fn common(&self, after: f64) -> [f64; 2] {
        let d = self.at(after);
        let larger = |x: f64, y: f64| if y > x { y } else { x };
        let smaller = |x: f64, y: f64| if y < x { y } else { x };
        [
            larger(self.a[0], self.b[0] + d),
            smaller(self.a[1], self.b[1] + d),
        ]
    }
}

pub(super) fn stretch(feature: Feature) -> [f64; 2] {
    match feature {
        Feature::Edge { low, high } => [low, high],
        Feature::Corner | Feature::Round => [0.0; 2],
    }
}

/// The first τ > 0 at which `gap + speed τ + ½ rate τ²` falls to 0.
///
/// From a positive gap the first root is the falling one; in the form without cancellation
/// τ = 2 gap / (−speed + √(speed² − 2 rate gap)).
pub(super) fn falls_to_zero(gap: f64, speed: f64, rate: f64) -> Option<f64> {
    if gap.is_infinite() || (speed >= 0.0 && rate >= 0.0) {
        return None;
    }
    let gap = if gap > 0.0 { gap } else { 0.0 };
    let within = speed * speed - 2.0 * rate * gap;
    if within < 0.0 {
        return None;
    }
    let root = within.sqrt();
    if speed <= 0.0 {
        let below = -speed + root;
        return (below > 0.0).then(|| 2.0 * gap / below);
    }
    // It grows first, and falls through a negative rate.
    Some((speed + root) / -rate)
}

/// A mode of a group: the load that shifts on what bears it.
pub(super) struct Load<'a> {
    pub(super) bodies: &'a [ImpactBody],
    /// Their accelerations by all that is no contact.
    pub(super) pulls: &'a [(Vec2, f64)],
    pub(super) touches: &'a [Touch],
    pub(super) moves: &'a [BodyMove],
    pub(super) found: &'a Balance,
    pub(super) slips: &'a [f64],
    pub(super) tangents: &'a [Tangent],
}

impl Load<'_> {
    /// The first instant at which something changes: a slip comes to 0, what slides or rolls comes to the end of an edge, or the load
    /// has moved so far that the forces need another motion. Where nothing is known to end the mode what was looked at ends.
    pub(super) fn next(&self) -> Option<f64> {
        let (mut first, mut shifts) = (None, false);
        for (i, touch) in self.touches.iter().enumerate() {
            if !self.found.reactions[i].closed.contains(&true) {
                continue;
            }
            let (slip, rate) = (self.slips[i], slip_rate(self.bodies, touch, self.moves));
            let stops = touch.friction > 0.0 && slip * rate < 0.0;
            let slide = Slide::of(touch, self.moves);
            for after in stops.then(|| -slip / rate).into_iter().chain(slide.ends()) {
                if first.is_none_or(|known| after < known) {
                    first = Some(after);
                }
            }
            let bears = |place: usize, feature: Feature| {
                feature != Feature::Round && self.bodies[place].inverse_inertia > 0.0
            };
            let (ends, features) = (touch.bodies, touch.features);
            shifts |= slide.moves() && (bears(ends.0, features.0) || bears(ends.1, features.1));
        }
        if !shifts {
            return first;
        }
        let end = first.unwrap_or(LOOK);
        Some(self.tips(end).unwrap_or(end))
    }

    /// The first instant before `end` from which on the forces need another motion.
    fn tips(&self, end: f64) -> Option<f64> {
        if let Some(ways) = alone::ways(self) {
            return alone::tips(self, ways, end);
        }
        self.first_other_motion((1..=LOOKS).map(|k| end * f64::from(k) / f64::from(LOOKS)))
    }

    /// The first instant from which on the forces need another motion, seen at these `looks`.
    pub(super) fn first_other_motion(&self, looks: impl IntoIterator<Item = f64>) -> Option<f64> {
        let mut good = 0.0;
        for look in looks {
            if !self.goes_on(look) {
                return Some(self.other_between(good, look));
            }
            good = look;
        }
        None
    }

    /// The same between an instant at which it goes on, and one at which it does not.
    fn other_between(&self, mut good: f64, mut bad: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            if self.goes_on(middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        bad
    }

    /// Whether the accelerations are the same where the load is then.
    fn goes_on(&self, after: f64) -> bool {
        let faces = self.faces_at(after);
        let then = balance(&faces, self.tangents);
        then.is_ok_and(|then| self.differs(&faces, &then.state) <= SAME)
    }

    /// By what part the accelerations are others.
    fn differs(&self, faces: &Faces, state: &[f64]) -> f64 {
        let all = faces.free.iter().chain(state);
        let size = all.fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let both = state.iter().zip(&self.found.state);
        both.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) / size
    }

    pub(super) fn faces_at(&self, after: f64) -> Faces {
        let (bodies, touches) = self.at(after);
        Faces::new(&bodies, self.pulls, &touches)
    }

    /// Bodies and touches where the present motions lead.
    fn at(&self, after: f64) -> (Vec<ImpactBody>, Vec<Touch>) {
        let travel = |body: &BodyMove| (body.velocity + body.acceleration * (0.5 * after)) * after;
        let bodies = self
            .bodies
            .iter()
            .zip(self.moves)
            .map(|(body, moved)| ImpactBody {
                centre: body.centre + travel(moved),
                ..*body
            });
        let touches = self.touches.iter().map(|touch| {
            let slide = Slide::of(touch, self.moves);
            let origin = touch.points[0] + travel(&self.moves[touch.bodies.0]);
            let mut touch = touch.clone();
            for (point, along) in touch.points.iter_mut().zip(slide.common(after)) {
                *point = origin + perp(touch.normal) * along;
            }
            touch
        });
        (bodies.collect(), touches.collect())
    }
}
