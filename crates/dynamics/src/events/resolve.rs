//! An impact that is due: velocities before become velocities after.

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use crate::events::shock::Shock;
use crate::model::narrow::{NOISE, opening_speed, pace, rest_speed};
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, Pairs};
use crate::values::event::EventKind;
use crate::{BodyIx, Events, PairIx, PairMaterial, Settings, StepReport, Two};

/// What the impacts of one pair may spend in a sub-step before the engine takes its bodies: what rattles with e = 0 faster than a
/// thirtieth of a sub-step is closer to rest than to flight.
pub(crate) const BUDGET: f64 = 32.0;

/// What an impact spends: the loss of relative speed, since k impacts leave `e^k` of it.
///
/// At least 1/1024, so that a pair without any loss ends, too: after 32,768 impacts in a sub-step.
pub(crate) fn price(material: &PairMaterial) -> f64 {
    (1.0 - material.restitution).max(1.0 / 1024.0)
}

/// An impact of a pair.
#[derive(Clone, Debug)]
pub(crate) struct PairImpact {
    pub(crate) time: SimTime,
    /// Place of the pair.
    pub(crate) pair: PairIx,
    /// Unit normal from A to B.
    pub(crate) normal: Vec2,
    /// One point, or both ends of a common stretch, in m.
    pub(crate) points: ArrayVec<Vec2, 2>,
}

/// What an impact did.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Struck {
    /// The pair has used up its impacts.
    Exhausted,
    /// They met too gently to bounce: the contact lasts.
    Rests,
    /// These bodies have new motions.
    Impact {
        changed: Vec<BodyIx>,
        /// Floating-point operations that it took.
        operations: u64,
    },
}

/// Resolves an impact of a pair.
///
/// A single contact follows the impact law; one that runs into others is resolved with them.
pub(crate) fn strike(
    settings: &Settings,
    bodies: &mut Bodies,
    pairs: &mut Pairs,
    due: &PairImpact,
    events: &mut Events,
    report: &mut StepReport,
) -> Struck {
    let pair = pairs.get_mut(due.pair);
    let (ends, material) = (pair.bodies, pair.material);
    let (a, b) = bodies.both(ends);
    // A touch that begins here is an event.
    pair.touching = true;
    events.tell_touch(bodies, pair, due.time);
    pair.begin_budget(due.time, bodies.h);
    let rest = rest_speed(bodies, pair);
    let rounding = NOISE * pace(a, b, due.time);
    let mut shock = Shock::new(due.time);
    for &point in &due.points {
        let speed = -opening_speed(a, b, due.time, point, due.normal);
        // At exactly zero pull there is no rest: an approach is an approach, unless rounding made it.
        if speed > rest && speed > rounding {
            let at = (point, due.normal);
            shock.add(bodies, due.pair, ends, at, material, rest);
        }
    }
    if shock.strikes.is_empty() {
        pair.lasting = true;
        // A group with modes that are solved for anew each time comes to an end, too.
        return if outruns(pair, 1.0) {
            report.collapsed += 1;
            Struck::Exhausted
        } else {
            Struck::Rests
        };
    }
    match spend(bodies, pair, due, &shock, events, report) {
        Budget::Left => {}
        Budget::Outrun => shock.collapse(),
        Budget::Gone => return Struck::Exhausted,
    }
    shock.solve(settings, bodies, pairs);
    shock.hold(pairs);
    for strike in shock.squeezed() {
        report.collapsed += 1;
        pairs.get_mut(strike.pair).lasting = true;
    }
    Struck::Impact {
        changed: apply(bodies, due.time, &shock, events, report),
        operations: shock.operations,
    }
}

/// What is left of a pair's budget after an impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Budget {
    Left,
    /// The impacts come ever faster: this one is their limit.
    Outrun,
    /// Not even limits bring the pair to rest: the engine takes it.
    Gone,
}

/// Takes `losses` from a pair's budget; whether there is less. Once it is outrun it gets another one, of a loss for each limit
/// and rest.
fn outruns(pair: &mut Pair, losses: f64) -> bool {
    let (losses, limit) = if pair.spent > BUDGET {
        (1.0, 2.0 * BUDGET)
    } else {
        (losses, BUDGET)
    };
    pair.spent += losses;
    pair.spent > limit
}

/// Counts the impact among those of this sub-step.
fn spend(
    bodies: &Bodies,
    pair: &mut Pair,
    due: &PairImpact,
    shock: &Shock,
    events: &mut Events,
    report: &mut StepReport,
) -> Budget {
    let ends = [pair.bodies.0, pair.bodies.1].map(|index| bodies.get(index));
    // Struck on both sides at once it goes to and fro, and time does not pass: no bounces, whatever they give back.
    let again = pair.impacts > 0 && ends.iter().any(|body| body.motion.start == due.time);
    let losses = if again { 1.0 } else { price(&pair.material) };
    pair.impacts += 1;
    let collapsed = pair.spent > BUDGET;
    let outrun = outruns(pair, losses);
    report.collapsed += u64::from(outrun);
    match (collapsed, outrun) {
        (false, false) => Budget::Left,
        (true, true) => Budget::Gone,
        (true, false) => Budget::Outrun,
        (false, true) => {
            let speed = shock.strikes[0].speed;
            tell_collapse(bodies, pair.bodies, 0.5 * speed * speed, due.time, events);
            Budget::Outrun
        }
    }
}

/// Says that infinitely many impacts of two bodies have ended, with their energy per kg of reduced mass, in J/kg.
pub(crate) fn tell_collapse(
    bodies: &Bodies,
    (a, b): Two<BodyIx>,
    energy: f64,
    time: SimTime,
    events: &mut Events,
) {
    let (one, two) = (bodies.get(a), bodies.get(b));
    let inverse = one.inverse_mass + two.inverse_mass;
    let kind = EventKind::Collapse {
        a: one.id,
        b: two.id,
        // Between bodies that nothing moves there is no energy to lose.
        energy: if inverse > 0.0 { energy / inverse } else { 0.0 },
    };
    events.push(time, kind);
}

/// New motions for all that were shaken, events for all that pushed, losses to the ledger.
pub(crate) fn apply(
    bodies: &mut Bodies,
    time: SimTime,
    shock: &Shock,
    events: &mut Events,
    report: &mut StepReport,
) -> Vec<BodyIx> {
    for impact in shock.impacts() {
        report.impacts += 1;
        let (a, b) = shock.ends(&impact);
        let ids = [a, b].map(|index| bodies.get(index).id);
        let at = (impact.contact.point, impact.contact.normal);
        let impulses = (impact.normal_impulse, impact.tangential_impulse);
        events.push(time, EventKind::impact(ids, at, impulses, impact.speed));
    }
    let (loss, driven) = shock.works();
    bodies.book.impacts.add(loss);
    bodies.book.external.add(driven);
    let mut changed = Vec::new();
    for shaken in &shock.bodies {
        if bodies.end_impact(shaken.index, time, &shaken.after) {
            changed.push(shaken.index);
        }
    }
    changed
}
