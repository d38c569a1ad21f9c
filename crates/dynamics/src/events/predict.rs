//! What comes next for a pair: the instant at which it strikes, within the present sub-step.

use arrayvec::ArrayVec;
use carom_collision::{
    Hull, Impact, TimeOfImpact, earlier, part, part_count, time_of_impact_of_parts,
};
use carom_math::{SimTime, Vec2};

use crate::events::event_queue::{Entry, EventQueue};
use crate::events::micro_bounce::micro_bounce;
use crate::model::approach::{CLOSED, stays};
use crate::model::ghost::Meeting;
use crate::model::narrow::{NOISE, Narrow, TOUCH, opening_speed, pace, rest_speed};
use crate::motion::first_touch::first_touch_of_parts;
use crate::motion::flight::motion_along;
use crate::store::bodies::Bodies;
use crate::store::pairs::{PairContact, Pairs};
use crate::store::state::{BodyState, Collider};
use crate::{BodyKind, PairMaterial, StepReport};

/// What the impacts of one pair may spend in one sub-step before the solver takes the rest: bodies that
/// rattle with e = 0 faster than a thirtieth of a sub-step are closer to rest than to flight.
pub(crate) const BUDGET: f64 = 32.0;

/// Looks at an impact of bodies that fly by a law.
const ROUNDS: usize = 4;

/// A stretch of a law, in s, in which its parabola is right to the last digits.
const INSTANT: f64 = 1e-6;

/// What an impact spends: the loss of relative speed, since k impacts leave `e^k` of it.
///
/// At least 1/1024, so that a pair without any loss ends, too: after 32,768 impacts in a sub-step.
pub(crate) fn price(material: &PairMaterial) -> f64 {
    (1.0 - material.restitution).max(1.0 / 1024.0)
}

/// Predicts the next impact of a pair between `time` and `end` and enters it into the event queue.
#[expect(
    clippy::too_many_arguments,
    reason = "what a prediction reads, and the two stores it writes"
)]
pub(crate) fn predict(
    bodies: &Bodies,
    colliders: &[Collider],
    pairs: &mut Pairs,
    narrow: &mut Narrow,
    event_queue: &mut EventQueue,
    report: &mut StepReport,
    place: u32,
    time: SimTime,
    end: SimTime,
    h: f64,
) {
    let mut pair = pairs.get(place);
    let (a, b) = (bodies.get(pair.bodies.0), bodies.get(pair.bodies.1));
    let end = end.min(a.stands_until()).min(b.stands_until());
    // A body that no method moves yet gets one before time goes on.
    let end = if a.is_unsolved() || b.is_unsolved() {
        end.min(time + INSTANT)
    } else {
        end
    };
    let horizon = end - time;
    let by_law = |state: &BodyState| state.is_free() && state.flight.is_some();
    let by_law = by_law(a) || by_law(b);
    if pair.given_up || pair.buried || horizon <= 0.0 || !(a.is_stepped() || b.is_stepped()) {
        return;
    }
    if a.kind != BodyKind::Dynamic && b.kind != BodyKind::Dynamic {
        return;
    }
    let shapes = (
        &*colliders[pair.colliders.0 as usize].solid,
        &*colliders[pair.colliders.1 as usize].solid,
    );
    let (motion_a, motion_b) = (a.motion.rebased(time), b.motion.rebased(time));
    if pair.contacts.is_empty() && apart(&motion_a, a.reach, &motion_b, b.reach, horizon) {
        return;
    }
    report.pairs += 1;
    let mut first = TimeOfImpact::Clear;
    let group_rest = rest_speed(bodies, pair, h);
    let noise = NOISE * pace(a, b, time);
    let rest = pair.lasting.then(|| group_rest.max(noise));
    let touch = TOUCH * a.reach.min(b.reach);
    // A search that begins within both shapes may end at a cut between pieces.
    let sunken = pair.touching && pair.overlaps(touch);
    if rest.is_some() || sunken {
        narrow.look_at(bodies, colliders, pairs, place, time, h);
        pair = pairs.get(place);
    }
    let closed = a.membership.is_closed() || b.membership.is_closed();
    // Parts in a micro-bounce: their contact opens and closes again at once.
    let mut bouncing: ArrayVec<(u32, u32), 4> = ArrayVec::new();
    if pair.touching && (closed || pair.turning_rest > 0.0) {
        if rest.is_none() && !sunken {
            narrow.look_at(bodies, colliders, pairs, place, time, h);
            pair = pairs.get(place);
        }
        for contact in &pair.contacts {
            let now = (time, horizon, group_rest);
            if let Some(back) = micro_bounce(bodies, colliders, pair, contact, now)
                && bouncing.try_push(contact.parts).is_ok()
            {
                first = earlier(first, TimeOfImpact::Hit(back));
            }
        }
    }
    // What becomes of the contacts of a group in closed form is that group's next change. A touch that opens is none of them: it may
    // come back before the group changes.
    let holds = |contact: &PairContact| closed && stays((a, b), contact, time, group_rest);
    for i in 0..part_count(shapes.0) {
        for j in 0..part_count(shapes.1) {
            let is_here = |&(x, y): &(u32, u32)| x as usize == i && y as usize == j;
            let held = |contact: &PairContact| is_here(&contact.parts) && holds(contact);
            if pair.lasting && pair.contacts.iter().any(held) || bouncing.iter().any(is_here) {
                continue;
            }
            let parts = (part(shapes.0, i), part(shapes.1, j));
            let next = if by_law {
                first_touch_of_parts([a, b], [parts.0, parts.1], time, horizon)
            } else {
                let (one, two) = (&parts.0, &parts.1);
                let next = time_of_impact_of_parts(one, &motion_a, two, &motion_b, horizon);
                polished(next, (a, b), parts, time)
            };
            // A contact that lasts holds what closes slowly on other parts, too. One in closed form knows of no touch to
            // come; but of two pieces that share a corner it names one, and the other closes by rounding.
            let slow = |impact: &Impact| match rest {
                Some(_) if closed => {
                    let at = time + impact.time;
                    let least = CLOSED * (pace(a, b, at) + group_rest);
                    let closes =
                        |point: &Vec2| opening_speed(a, b, at, *point, impact.normal) < -least;
                    !impact.points.iter().any(closes)
                }
                Some(rest) => impact.gap_rate >= -rest,
                None => false,
            };
            let ghost = |impact: &Impact| {
                let at = time + impact.time;
                let [i, j] = [i, j].map(|k| u32::try_from(k).unwrap_or(u32::MAX));
                Meeting::of(bodies, pair.bodies, pair.colliders, (i, j), impact.normal)
                    .is_some_and(|meeting| meeting.is_ghost(bodies, colliders, pairs, at))
            };
            match &next {
                TimeOfImpact::Hit(found) | TimeOfImpact::Touching(found) if slow(found) => {}
                TimeOfImpact::Hit(found) | TimeOfImpact::Touching(found) if ghost(found) => {}
                _ => first = earlier(first, next),
            }
        }
    }
    let (wait, impact) = match first {
        TimeOfImpact::Clear => return,
        TimeOfImpact::Unresolved { .. } => {
            report.unresolved += 1;
            return;
        }
        TimeOfImpact::Hit(impact) => (impact.time, impact),
        // Touching and pressed, but slowly: the next sub-step's solver takes it.
        TimeOfImpact::Touching(contact) => (0.0, contact),
    };
    let at = time + wait;
    let turning_rest = if pair.material.restitution < 1.0 {
        let parts = impact.features[0].parts;
        let spot = pair.spot_of(bodies, colliders, parts, impact.points[0], impact.normal);
        spot.turning_rest(at, h)
    } else {
        0.0
    };
    let pair = pairs.get_mut(place);
    pair.turning_rest = turning_rest;
    let entry = Entry::of(bodies, (place, pair), at, impact.normal, impact.points);
    event_queue.push(entry);
}

/// An impact that was found for the parabolas of two bodies, found again for what they fly by near that instant.
///
/// A parabola through both ends of s seconds leaves out as much as its cube, so that every round looks at a shorter
/// stretch about the instant that the one before found.
fn polished(
    found: TimeOfImpact,
    (a, b): (&BodyState, &BodyState),
    parts: (Hull<'_>, Hull<'_>),
    time: SimTime,
) -> TimeOfImpact {
    let left_out = |span: f64| {
        let of = |state: &BodyState| {
            let part = (span / state.lag().length).min(1.0);
            state.motion.left_out * part * part * part
        };
        // A body without a law to refine by is as far off however short the stretch.
        of(a) + of(b)
    };
    let mut left = a.motion.left_out + b.motion.left_out;
    let mut best = found;
    for round in 0..ROUNDS {
        let TimeOfImpact::Hit(impact) = &best else {
            return best;
        };
        if left == 0.0 || impact.gap_rate >= 0.0 {
            return best;
        }
        let near = (4.0 * left / -impact.gap_rate).max(INSTANT);
        // A slow approach may be off by more than all of its way; even so twice its way is a shorter stretch.
        let capped = near > impact.time;
        let near = if capped {
            impact.time.max(INSTANT)
        } else {
            near
        };
        let from = if impact.time > near {
            impact.time - near
        } else {
            0.0
        };
        let span = impact.time - from + near;
        let motions = [a, b].map(|state| motion_along(state, time + from, span));
        match time_of_impact_of_parts(&parts.0, &motions[0], &parts.1, &motions[1], span) {
            TimeOfImpact::Hit(found) => {
                best = TimeOfImpact::Hit(Impact {
                    time: from + found.time,
                    ..found
                });
            }
            // A graze that was none, or one that began before: the first parabola's word stands.
            TimeOfImpact::Clear if round == 0 && !capped => return TimeOfImpact::Clear,
            _ => return best,
        }
        if near <= INSTANT {
            return best;
        }
        left = left_out(span);
    }
    best
}

/// Bounding circles that cannot meet within `horizon`.
fn apart(
    a: &carom_collision::Motion,
    reach_a: f64,
    b: &carom_collision::Motion,
    reach_b: f64,
    horizon: f64,
) -> bool {
    let speed = (b.velocity - a.velocity).length();
    let pull = (b.acceleration - a.acceleration).length();
    let travel = (speed + 0.5 * pull * horizon) * horizon + a.left_out + b.left_out;
    let reach = (reach_a + reach_b + travel) * (1.0 + 1e-9);
    (b.centre - a.centre).length_squared() > reach * reach
}
