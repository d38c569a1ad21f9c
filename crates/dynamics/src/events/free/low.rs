//! Micro-bounces: the contact acceleration brings two bodies back before a search could tell when.

use carom_math::{SimTime, Vec2};

use super::Foreseen;
use super::strike::{approach_speed, opening};
use crate::model::gap::{Touching, contact_after, gap_acceleration, slip_of};
use crate::store::bodies::Bodies;
use crate::store::mass::CENTRED;
use crate::store::state::BodyState;
use crate::{BodyIx, ColliderIx};

/// Height of a bounce below which it is timed by its speeds, as a fraction of the smaller reach, where
/// the normal turns: rounding of the gap is 1e-6 of it.
const LOW: f64 = 1e-9;

/// The same where the normal stands.
const FLAT: f64 = 1e-4;

/// Ends of a stretch that rise alike but for so much of it come back together: their gaps differ by four times as much of the height.
const ALIKE: f64 = 1e-3;

/// A bounce so low that the search for its end would see rounding: it lasts 2 u⁺/a. Its seconds, and its end.
///
/// The gap is `u t − a t²/2` but for what the normal turns by: nothing where neither turns or the
/// one that does is a disc about its centre of mass, and neither slips along what is round or pointed; else less than the spin times the
/// bounce, which is why that must be lower. Both ends of a stretch come back together where they rise alike.
pub(super) fn micro_bounce(
    bodies: &Bodies,
    impact: &Foreseen,
    time: SimTime,
) -> Option<(f64, Foreseen)> {
    let (a, b) = impact.bodies;
    let after = [a, b].map(|index| bodies.get(index).in_impact(time));
    let at = touching(bodies, impact, impact.points[0], time);
    let pressed = -gap_acceleration(&at.0, &at.1, impact.normal, impact.face());
    let rise = -approach_speed(impact, &after);
    let rises = |point: &Vec2| opening(&after, *point, impact.normal);
    if impact
        .points
        .iter()
        .any(|point| rises(point) > rise * (1.0 + ALIKE))
    {
        return None;
    }
    let (one, two) = (bodies.get(a), bodies.get(b));
    let steady = |state: &BodyState, at: ColliderIx| {
        let vertices = bodies.colliders[at].solid.vertices();
        let round = matches!(vertices, [centre] if centre.length() <= CENTRED * state.reach);
        state.motion.spin == 0.0 || round
    };
    let slips = impact.face().is_none() && slip_of(&at.0, &at.1, impact.normal) != 0.0;
    let turns = slips || !(steady(one, impact.colliders.0) && steady(two, impact.colliders.1));
    let bends = bodies.bends(a) || bodies.bends(b);
    let low = if turns || bends { LOW } else { FLAT };
    if rise <= 0.0 || pressed <= 0.0 || rise * rise > 2.0 * pressed * low * one.reach.min(two.reach)
    {
        return None;
    }
    let wait = 2.0 * rise / pressed;
    let mut next = impact.clone();
    for point in &mut next.points {
        let (a, b) = touching(bodies, impact, *point, time);
        (*point, next.normal) = contact_after(&a, &b, (*point, impact.normal), impact.face(), wait);
    }
    Some((wait, next))
}

/// How fast two bodies are pressed together where they touch, in m/s²; negative: pulled apart.
pub(super) fn press(bodies: &Bodies, impact: &Foreseen, time: SimTime) -> f64 {
    let (a, b) = touching(bodies, impact, impact.points[0], time);
    -gap_acceleration(&a, &b, impact.normal, impact.face())
}

/// What of both bodies touches at a point of an impact.
fn touching(
    bodies: &Bodies,
    impact: &Foreseen,
    point: Vec2,
    time: SimTime,
) -> (Touching, Touching) {
    let feature = |index: BodyIx, at: ColliderIx, number: u32| {
        let mut motion = bodies.get(index).motion;
        if bodies.bends(index) {
            motion = bodies.get(index).at(time).0;
            let freely = bodies.freely(index, time);
            (motion.acceleration, motion.angular_acceleration) = freely;
        }
        Touching::of(&motion, &bodies.hull(at, number), point, time)
    };
    let parts = impact.feature.parts;
    (
        feature(impact.bodies.0, impact.colliders.0, parts.0),
        feature(impact.bodies.1, impact.colliders.1, parts.1),
    )
}
