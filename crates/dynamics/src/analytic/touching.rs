//! Contacts at an instant, as plain data for the closed forms of islands.

use std::borrow::Cow;

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use crate::analytic::modes::{GroupMove, NotMine, Touch, hold, solve_modes, stand};
use crate::impact::ImpactBody;
use crate::model::approach::{Approach, approach, opening};
use crate::model::edges::{Feature, at_the_end, corner_under_disc, feature};
use crate::model::ghost::look_at;
use crate::model::graph::neighbours;
use crate::model::narrow::{SUNK, TOUCH, rest_speed};
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::{BodyIx, PairIx};

/// An island of more rows (points, and a friction for each touch) than this has no closed form: it is the engine's.
const ROWS: usize = 64;

/// All that hangs together by touch around a body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gathered {
    /// Bodies of the world, in the order of `bodies`.
    pub(crate) places: Vec<BodyIx>,
    pub(crate) bodies: Vec<ImpactBody>,
    /// Their accelerations by all that is no contact, in m/s² and rad/s².
    pub(crate) pulls: Vec<(Vec2, f64)>,
    pub(crate) touches: Vec<Touch>,
    /// Pair and contact of each touch.
    pub(crate) pairs: Vec<(PairIx, usize)>,
    /// Speed below which what opens there comes back at once, because turning presses, for each touch, in m/s.
    presses: Vec<f64>,
    /// Fastest approach of a touch, in m/s; 0 if it is no more than rounding.
    pub(crate) closing: f64,
    /// Approach below which a touch rests, the largest of all pairs, in m/s.
    pub(crate) rest: f64,
}

impl Gathered {
    /// Places of those that move by forces.
    pub(crate) fn dynamic(&self) -> Vec<BodyIx> {
        let all = self.places.iter().zip(&self.bodies);
        all.filter(|(_, body)| body.inverse_mass > 0.0)
            .map(|(index, _)| *index)
            .collect()
    }

    pub(crate) fn solve_modes(&self, speed: f64) -> Result<GroupMove, NotMine> {
        solve_modes(&self.bodies, &self.pulls, &self.touches, speed)
    }

    /// Velocities after a landing; what opens then is let go.
    pub(crate) fn landed(&mut self, velocities: &[(Vec2, f64)]) {
        self.move_by(velocities);
        self.end_series();
        let (bodies, rest) = (&self.bodies, self.rest);
        for touch in &mut self.touches {
            let (ends, normal) = (ends_of(bodies, touch), touch.normal);
            let leaves =
                |point: &Vec2| matches!(approach(ends, *point, normal, rest), Approach::Leaves(_));
            let two = touch.points.len() == 2;
            touch.points.retain(|point| !leaves(point));
            if two && touch.points.len() == 1 {
                // It stands on a corner.
                touch.features = (Feature::Corner, Feature::Corner);
            }
        }
        let mut touches = self.touches.iter();
        self.pairs
            .retain(|_| touches.next().is_some_and(|touch| !touch.points.is_empty()));
        self.touches.retain(|touch| !touch.points.is_empty());
    }

    /// The same with one touch of a corner that parts of a shape share: rows twice over have no answer of their own where it turns.
    pub(crate) fn with_corners_once(&self) -> Cow<'_, Self> {
        let is_corner = |k: usize| self.touches[k].points.len() == 1;
        let is_same = |j: usize, k: usize| {
            let (one, other) = (&self.touches[j], &self.touches[k]);
            self.pairs[j].0 == self.pairs[k].0
                && (one.points[0], one.normal) == (other.points[0], other.normal)
        };
        let again = |k: &usize| is_corner(*k) && (0..*k).any(|j| is_corner(j) && is_same(j, *k));
        let again: Vec<usize> = (0..self.touches.len()).filter(again).collect();
        if again.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut once = self.clone();
        for &k in again.iter().rev() {
            once.touches.remove(k);
            once.pairs.remove(k);
        }
        Cow::Owned(once)
    }

    /// Kinetic energy that the bodies have in the world, in J.
    pub(crate) fn kinetic(&self, bodies: &Bodies, time: SimTime) -> f64 {
        let all = self.places.iter();
        all.map(|index| bodies.get(*index).kinetic_energy(time))
            .sum()
    }

    /// Every touch that there was before a landing stays closed: what that opened comes back at once.
    pub(crate) fn stand(&mut self, landed: &Self) {
        let held = stand(&landed.bodies, &self.touches, self.rest);
        self.move_by(&held);
    }

    /// Whether a landing opens none of its touches faster than rest.
    pub(crate) fn opens_slowly(&self, landed: &Self) -> bool {
        let opens = |touch: &Touch| {
            let ends = ends_of(&landed.bodies, touch);
            let rate = |point: &Vec2| opening(ends, *point, touch.normal).0;
            touch.points.iter().map(rate).fold(0.0, f64::max)
        };
        self.touches.iter().all(|touch| opens(touch) <= self.rest)
    }

    fn move_by(&mut self, velocities: &[(Vec2, f64)]) {
        for (body, &(velocity, spin)) in self.bodies.iter_mut().zip(velocities) {
            (body.velocity, body.spin) = (velocity, spin);
        }
    }

    /// What a landing opens so little that turning brings it back at once stays closed.
    fn end_series(&mut self) {
        let (bodies, rest) = (&self.bodies, self.rest);
        let opens = |touch: &Touch| {
            let ends = ends_of(bodies, touch);
            let rate = |point: &Vec2| match approach(ends, *point, touch.normal, rest) {
                Approach::Leaves(rate) => rate,
                _ => 0.0,
            };
            touch.points.iter().map(rate).fold(0.0, f64::max)
        };
        let rates: Vec<f64> = self.touches.iter().map(opens).collect();
        let low = |(rate, press): (&f64, &f64)| *rate <= *press;
        let mut all = rates.iter().zip(&self.presses);
        if !all.any(|both| *both.0 > 0.0 && low(both)) {
            return;
        }
        let both = self.touches.iter().zip(rates.iter().zip(&self.presses));
        let kept: Vec<&Touch> = both
            .filter(|(_, both)| low(*both))
            .map(|(touch, _)| touch)
            .collect();
        let held = hold(&self.bodies, &kept);
        self.move_by(&held);
    }

    fn place_of(&mut self, bodies: &Bodies, index: BodyIx, time: SimTime) -> usize {
        if let Some(place) = self.places.iter().position(|known| *known == index) {
            return place;
        }
        let body = bodies.get(index).in_impact(time);
        self.places.push(index);
        self.pulls.push(bodies.pull_on(index, body.centre));
        self.bodies.push(body);
        self.places.len() - 1
    }
}

fn ends_of(bodies: &[ImpactBody], touch: &Touch) -> (ImpactBody, ImpactBody) {
    let (a, b) = touch.bodies;
    (bodies[a], bodies[b])
}

/// All that hangs together by touch around a dynamic body.
///
/// # Errors
/// If these are too many for closed forms, or a body is asleep, penetrates another by more than
/// rounding, or a mode solve of it failed at this instant: the dynamic bodies that were seen.
pub(crate) fn gather(
    bodies: &Bodies,
    pairs: &mut Pairs,
    index: BodyIx,
    time: SimTime,
) -> Result<Gathered, Vec<BodyIx>> {
    let mut found = Gathered::default();
    found.place_of(bodies, index, time);
    let (mut next, mut rows) = (0, 0);
    let mut looked = Vec::new();
    while next < found.places.len() {
        let index = found.places[next];
        next += 1;
        let state = bodies.get(index);
        if !state.is_dynamic() {
            if state.motion.acceleration != Vec2::ZERO {
                return Err(found.dynamic());
            }
            continue;
        }
        if state.is_asleep() || state.is_damped() || state.in_engine() {
            return Err(found.dynamic());
        }
        let near = state.pairs.clone();
        // A mode solve of a body in contact with this one failed at this instant.
        let has_failed = |other| bodies.get(other).membership.has_failed(time);
        if neighbours(bodies, pairs, index).any(has_failed) {
            return Err(found.dynamic());
        }
        for place in near {
            if looked.contains(&place) {
                continue;
            }
            looked.push(place);
            let Some(more) = touches_of(bodies, pairs, &mut found, place, time) else {
                return Err(found.dynamic());
            };
            rows += more;
            if rows > ROWS {
                return Err(found.dynamic());
            }
        }
    }
    Ok(found)
}

/// Adds the touches of a pair; returns how many rows they have.
fn touches_of(
    bodies: &Bodies,
    pairs: &mut Pairs,
    found: &mut Gathered,
    place: PairIx,
    time: SimTime,
) -> Option<usize> {
    let told = pairs.get(place).touching;
    let pair = look_at(bodies, pairs, place, time);
    // Begins and ends of touch are told once all has its method.
    let touching = core::mem::replace(&mut pair.touching, told);
    let pair = pairs.get(place);
    let (a, b) = bodies.both(pair.bodies);
    let size = a.reach.min(b.reach);
    let gap = TOUCH * size;
    let mut points = pair.contacts.iter().flat_map(|contact| &contact.points);
    if points.any(|point| point.separation < -SUNK * size) {
        return None;
    }
    let rest = rest_speed(bodies, pair);
    let ends = (a.in_impact(time), b.in_impact(time));
    if !touching {
        return Some(0);
    }
    found.rest = found.rest.max(rest);
    let mut rows = 0;
    for (number, contact) in pair.contacts.iter().enumerate() {
        let hull_a = bodies.hull(pair.colliders.0, contact.parts.0);
        let hull_b = bodies.hull(pair.colliders.1, contact.parts.1);
        let poses = (a.centre_pose(time), b.centre_pose(time));
        let corner = corner_under_disc((&hull_a, &hull_b), poses, ends, contact.normal);
        let normal = corner.map_or(contact.normal, |(normal, _)| normal);
        let mut points: ArrayVec<Vec2, 2> = ArrayVec::new();
        for point in contact
            .points
            .iter()
            .filter(|point| point.separation <= gap)
        {
            let at = corner.map_or(point.position, |(_, at)| at);
            match approach(ends, at, normal, rest) {
                Approach::Leaves(_) => {}
                Approach::Stays => points.push(at),
                Approach::Closes(speed) => {
                    points.push(at);
                    found.closing = found.closing.max(speed);
                }
            }
        }
        let Some(&origin) = points.first() else {
            continue;
        };
        let mut features = (
            feature(&hull_a, poses.0, normal, normal, origin),
            feature(&hull_b, poses.1, -normal, normal, origin),
        );
        let edge = |feature| matches!(feature, Feature::Edge { .. });
        if points.len() == 2 && !(edge(features.0) && edge(features.1)) {
            // Not flush: it may rest, but not slide.
            features = (Feature::Corner, Feature::Corner);
        }
        let Some(features) = at_the_end(features, ends, normal) else {
            continue;
        };
        // A surface that runs is no body that moves.
        if pair.material.tangent_speed != 0.0 {
            return None;
        }
        rows += points.len() + usize::from(pair.material.friction > 0.0);
        let ends = (
            found.place_of(bodies, pair.bodies.0, time),
            found.place_of(bodies, pair.bodies.1, time),
        );
        let press_at = |point: &Vec2| pair.turning_rest_at(bodies, contact, *point, time);
        let presses = points.iter().map(press_at);
        found.presses.push(presses.fold(f64::INFINITY, f64::min));
        found.touches.push(Touch {
            bodies: ends,
            normal,
            points,
            features,
            friction: pair.material.friction,
        });
        found.pairs.push((place, number));
    }
    Some(rows)
}
