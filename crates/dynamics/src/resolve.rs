//! An impact that is due: velocities before become velocities after.

use carom_math::Vec2;

use crate::agenda::Entry;
use crate::bodies::Bodies;
use crate::event::EventKind;
use crate::impact::{ImpactContact, ImpactLaw, Outcome, resolve};
use crate::narrow::{opening_speed, rest_speed};
use crate::pairs::Pairs;
use crate::predict::BUDGET;
use crate::{Events, StepReport};

/// What an entry that came up did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Struck {
    /// One of the bodies had changed its motion since: nothing.
    Stale,
    /// They met too gently to bounce: from the next sub-step on the solver holds them.
    Rests,
    /// The pair has used up its impacts of this sub-step.
    GaveUp,
    /// Both bodies have new motions.
    Impact,
}

/// Resolves one entry of the agenda.
pub(crate) fn strike(
    law: ImpactLaw,
    bodies: &mut Bodies,
    pairs: &mut Pairs,
    entry: &Entry,
    h: f64,
    events: &mut Events,
    report: &mut StepReport,
) -> Struck {
    let pair = pairs.get(entry.pair);
    let (i, j) = pair.bodies;
    let (a, b) = (bodies.get(i), bodies.get(j));
    if (a.version, b.version) != entry.versions {
        return Struck::Stale;
    }
    let time = entry.time;
    let (ids, rest) = ((a.id, b.id), rest_speed(bodies, pair, h));
    let (point, speed) = closing_point(bodies, (i, j), entry, rest);
    // At exactly zero pull there is no rest: an approach is an approach.
    if speed <= rest || speed <= 0.0 {
        let pair = pairs.get_mut(entry.pair);
        if !pair.touching {
            pair.touching = true;
            events.push(time, EventKind::Begin { a: ids.0, b: ids.1 });
        }
        return Struck::Rests;
    }
    let contact = ImpactContact {
        point,
        normal: entry.normal,
        restitution: pair.material.restitution,
        friction: pair.material.friction,
    };
    let before = (a.in_impact(time), b.in_impact(time));
    let outcome = resolve(law, &before.0, &before.1, &contact);
    let pair = pairs.get_mut(entry.pair);
    if !pair.touching {
        pair.touching = true;
        events.push(time, EventKind::Begin { a: ids.0, b: ids.1 });
    }
    pair.impacts += 1;
    if pair.impacts > BUDGET {
        pair.given_up = true;
        report.collapsed += 1;
        let energy = 0.5 * speed * outcome.normal_impulse / (1.0 + contact.restitution);
        events.push(
            time,
            EventKind::Collapse {
                a: ids.0,
                b: ids.1,
                energy,
            },
        );
        return Struck::GaveUp;
    }
    report.impacts += 1;
    events.push(
        time,
        EventKind::Impact {
            a: ids.0,
            b: ids.1,
            point,
            normal: entry.normal,
            normal_impulse: outcome.normal_impulse,
            tangential_impulse: outcome.tangential_impulse,
            speed,
        },
    );
    book(bodies, (i, j), &outcome, &contact);
    for (index, after) in [(i, outcome.a), (j, outcome.b)] {
        if bodies.get(index).is_dynamic() {
            bodies.change(index, time, |motion| {
                motion.velocity = after.velocity;
                motion.spin = after.spin;
            });
        }
    }
    Struck::Impact
}

/// The point that is struck, and its speed of approach: the middle of a common stretch if both of
/// its ends close, else the end that does.
fn closing_point(bodies: &Bodies, (i, j): (u32, u32), entry: &Entry, rest: f64) -> (Vec2, f64) {
    let (a, b) = (bodies.get(i), bodies.get(j));
    let speed = |p: Vec2| -opening_speed(a, b, entry.time, p, entry.normal);
    let first = entry.points[0];
    let Some(&second) = entry.points.get(1) else {
        return (first, speed(first));
    };
    let point = match (speed(first) > rest, speed(second) > rest) {
        (true, false) => first,
        (false, true) => second,
        _ => (first + second) * 0.5,
    };
    (point, speed(point))
}

/// Losses to the ledger; what a driven body put in counts as brought in from outside.
fn book(bodies: &mut Bodies, (i, j): (u32, u32), outcome: &Outcome, contact: &ImpactContact) {
    bodies.book.impacts.add(outcome.loss);
    let impulse = contact.normal * outcome.normal_impulse
        + carom_math::perp(contact.normal) * outcome.tangential_impulse;
    if !bodies.get(i).is_dynamic() {
        let drive = impulse.dot(outcome.a.velocity_of(contact.point));
        bodies.book.external.add(drive);
    }
    if !bodies.get(j).is_dynamic() {
        let drive = -impulse.dot(outcome.b.velocity_of(contact.point));
        bodies.book.external.add(drive);
    }
}
