//! Several contacts that act at one instant: a common stop with friction, and reflections.
//!
//! The two ends of the [blend](super::blend): at e = 0 Signorini's condition and Coulomb's law for all
//! impulses at once, at e = 1 reflections with a restitution along Routh's path, which is straight without friction. Both keep
//! momentum to rounding, keep friction in its cone, never gain energy and leave no contact closing, so every mean of them does.

use carom_math::Vec2;

use super::body::{ImpactBody, Response};
use super::coulomb::{Stop, stop};
use super::law::ImpactLaw;
use super::restitution::{Impulses, Return, gathered, give_back, power, push};
use super::routh::EndRule;
use super::rows::{Bound, Row, Rows, contact_rows};
use super::several::{
    SharedContact, SharedOutcome, mean_restitution, newton, single, with_restitution,
};
use super::sweeps::swept;

/// Rows that are solved for exactly; above, sweeps end in bounded time.
const ROWS: usize = 64;

/// Reflections with friction before the rest is stopped.
const REFLECTIONS: u32 = 200;

/// The same without: a wedge of angle θ takes π/θ of them, a row of a hundred discs a hundred.
const SMOOTH_REFLECTIONS: u32 = 1000;

/// Whether friction has a part in it.
pub(super) fn is_rough(contacts: &[SharedContact]) -> bool {
    contacts.iter().any(|shared| shared.contact.friction > 0.0)
}

/// Whether there are too many rows for an exact answer.
pub(super) fn is_large(contacts: &[SharedContact]) -> bool {
    let frictions = contacts
        .iter()
        .filter(|shared| shared.contact.friction > 0.0);
    contacts.len() + frictions.count() > ROWS
}

/// Newton's law with Coulomb's friction against what slip is left: `0 ≤ u_n⁺ + e u_n⁻ ⟂ j_n ≥ 0`.
///
/// Each contact has its own e. At e = 0 for all it never gains energy. All contacts are asked to open as slowly as numbers can tell
/// ([`Rows::opens`]): rounding of their own solution would leave two in three closing, and those to be stopped once more.
pub(super) fn newton_rough(bodies: &[ImpactBody], contacts: &[SharedContact]) -> SharedOutcome {
    let large = is_large(contacts);
    let all = contact_rows(bodies, contacts);
    let mut rows = if large {
        Rows::loose(bodies, all)
    } else {
        Rows::new(bodies, all)
    };
    let opens = rows.opens(bodies);
    let mut wanted = Vec::with_capacity(rows.len());
    let mut restitutions = contacts.iter().map(|shared| shared.contact.restitution);
    for row in &rows.rows {
        let approach = -row.speed(bodies);
        wanted.push(match row.bound {
            Bound::Push => restitutions.next().unwrap_or(0.0) * approach.max(0.0) + opens,
            Bound::Friction(..) | Bound::Limit(_) => 0.0,
        });
    }
    rows.ask(&wanted);
    let stop = if large {
        let (scaled, operations) = swept(&rows);
        Stop {
            impulses: rows.unscaled(&scaled).collect(),
            sure: false,
            operations,
        }
    } else {
        stop(&rows)
    };
    let impulses = by_contact(&rows, &stop.impulses);
    let mut after = bodies.to_vec();
    for (shared, impulse) in contacts.iter().zip(&impulses) {
        push(&mut after, shared, *impulse);
    }
    SharedOutcome {
        bodies: after,
        impulses,
        exhausted: !stop.sure,
        operations: stop.operations,
    }
}

/// Reflections of all approaching contacts together, again and again until none approaches.
///
/// Each gives back by one restitution for all: `common`, or else the mean of those that approach. `stop`: what
/// [`newton_rough`] says at e = 0, if that is known; it is not counted again.
pub(super) fn reflections(
    law: ImpactLaw,
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
    common: Option<f64>,
    mut stop: Option<SharedOutcome>,
) -> SharedOutcome {
    let zero = rounding(bodies, contacts);
    let most = if is_rough(contacts) {
        REFLECTIONS
    } else {
        SMOOTH_REFLECTIONS
    };
    let mut total: Impulses = vec![(0.0, 0.0); contacts.len()];
    let mut now = bodies.to_vec();
    let (mut exhausted, mut unsure, mut operations) = (true, false, 0);
    for _ in 0..most {
        let places: Vec<usize> = (0..contacts.len())
            .filter(|&k| opening(&now, &contacts[k]) < -zero)
            .collect();
        if places.is_empty() {
            exhausted = false;
            break;
        }
        let some: Vec<SharedContact> = places.iter().map(|&k| contacts[k]).collect();
        let known = stop.take().filter(|_| places.len() == contacts.len());
        let next = reflected(law, &now, &some, common, zero, known);
        for (&k, pushed) in places.iter().zip(&next.impulses) {
            total[k].0 += pushed.0;
            total[k].1 += pushed.1;
        }
        now = next.bodies;
        unsure |= next.exhausted;
        operations += next.operations;
        if next.impulses.iter().all(|pushed| *pushed == (0.0, 0.0)) {
            // All further reflections would be this one. Beside a fast slip an approach below the rounding of the stop is no
            // approach: `opened` ends it. Any other is one that nothing stops.
            let yields = |shared: &SharedContact| {
                let (a, b) = (&bodies[shared.a], &bodies[shared.b]);
                Response::of(a, b, &shared.contact).k_nn > 0.0
            };
            exhausted = next.exhausted || !some.iter().all(yields);
            break;
        }
    }
    if exhausted {
        let stopped = newton(&now, &with_restitution(contacts, 0.0));
        for (sum, more) in total.iter_mut().zip(stopped.impulses) {
            sum.0 += more.0;
            sum.1 += more.1;
        }
        now = stopped.bodies;
        operations += stopped.operations;
    }
    SharedOutcome {
        bodies: now,
        impulses: total,
        exhausted: exhausted || unsure,
        operations,
    }
}

/// One reflection: compression of all contacts to a stop, then restitution along Routh's path; a contact alone follows its law. It is
/// exhausted where the stop that it began with does not meet its conditions.
fn reflected(
    law: ImpactLaw,
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
    common: Option<f64>,
    zero: f64,
    known: Option<SharedOutcome>,
) -> SharedOutcome {
    // Newton's law may gain energy.
    let (law, rule) = match law {
        ImpactLaw::Poisson => (law, EndRule::Impulse),
        ImpactLaw::Stronge | ImpactLaw::Newton => (ImpactLaw::Stronge, EndRule::Work),
    };
    if let [only] = contacts {
        let restitution = common.unwrap_or(only.contact.restitution);
        if let Some(found) = single(law, bodies, &with_restitution(contacts, restitution)) {
            return found;
        }
    }
    let (stopped, counted) = match known {
        Some(stopped) => (stopped, 0),
        None => {
            let stopped = newton(bodies, &with_restitution(contacts, 0.0));
            let operations = stopped.operations;
            (stopped, operations)
        }
    };
    let impulses = &stopped.impulses;
    let restitution = common.unwrap_or_else(|| mean_restitution(contacts, impulses));
    if !is_rough(contacts) {
        // The way back is straight, and by e as long.
        let back = 1.0 + restitution;
        let onward = |(body, stop): (&ImpactBody, &ImpactBody)| ImpactBody {
            velocity: back * stop.velocity - restitution * body.velocity,
            spin: back * stop.spin - restitution * body.spin,
            ..*body
        };
        return SharedOutcome {
            bodies: bodies.iter().zip(&stopped.bodies).map(onward).collect(),
            impulses: impulses.iter().map(|(n, _)| (back * n, 0.0)).collect(),
            operations: counted,
            ..stopped
        };
    }
    // Work of the normal impulses on the way to the stop, and all energy that went: friction that
    // turned a slip round has given some back.
    let given = gathered(bodies, contacts, impulses);
    let loss = -0.5 * (power(bodies, &given) + power(&stopped.bodies, &given));
    let noise = noise(bodies, contacts, impulses, zero);
    let mut work = loss;
    for (k, shared) in contacts.iter().enumerate() {
        let slip = |bodies: &[ImpactBody]| {
            let u_t = velocity(bodies, shared).1;
            if u_t.abs() > noise[k] { u_t } else { 0.0 }
        };
        work += 0.5 * impulses[k].1 * (slip(bodies) + slip(&stopped.bodies));
    }
    let how = Return {
        rule,
        restitution,
        work: work.min(loss).max(0.0),
        zero: &noise,
    };
    let (after, mut pushes, operations) = give_back(&stopped.bodies, contacts, impulses, &how);
    for (pushed, (n, t)) in pushes.iter_mut().zip(impulses) {
        pushed.0 += n;
        pushed.1 += t;
    }
    SharedOutcome {
        bodies: after,
        impulses: pushes,
        exhausted: stopped.exhausted,
        operations: counted + operations,
    }
}

/// Normal and tangential impulse of each contact.
fn by_contact(rows: &Rows, impulses: &[f64]) -> Impulses {
    let mut all = Impulses::new();
    for (row, impulse) in rows.rows.iter().zip(impulses) {
        match (row.bound, all.last_mut()) {
            (Bound::Push, _) => all.push((impulse.max(0.0), 0.0)),
            (_, Some(last)) => last.1 = *impulse,
            (_, None) => {}
        }
    }
    all
}

/// Takes away what rounding has left of an approach, so that what is resolved is not struck at once.
///
/// Such contacts are stopped once more, and open as slowly as numbers can tell. Where no impulses stop all of them, because
/// a body is squeezed between others that do not yield, what closes is no rounding: stopped without friction it would be shot
/// out of a wedge of 1e-5 rad at 1e5 times the speed that closes it.
pub(super) fn opened(mut found: SharedOutcome, contacts: &[SharedContact]) -> SharedOutcome {
    if is_large(contacts) || !is_rough(contacts) || found.exhausted {
        return found;
    }
    let mut closing = vec![false; contacts.len()];
    for _ in 0..4 {
        let mut any = false;
        for (closes, shared) in closing.iter_mut().zip(contacts) {
            let now = opening(&found.bodies, shared) < 0.0;
            (*closes, any) = (*closes || now, any || now);
        }
        if !any {
            break;
        }
        let places: Vec<usize> = (0..contacts.len()).filter(|&k| closing[k]).collect();
        let row = |&k: &usize| {
            let normal = contacts[k].contact.normal;
            Row::new(&found.bodies, &contacts[k], normal, Bound::Push)
        };
        let mut rows = Rows::new(&found.bodies, places.iter().map(row).collect());
        rows.ask(&vec![rows.opens(&found.bodies); places.len()]);
        let stopped = stop(&rows);
        found.operations += stopped.operations;
        for (k, impulse) in places.into_iter().zip(stopped.impulses) {
            push(&mut found.bodies, &contacts[k], (impulse, 0.0));
            found.impulses[k].0 += impulse;
        }
    }
    found
}

pub(super) fn opening(bodies: &[ImpactBody], shared: &SharedContact) -> f64 {
    velocity(bodies, shared).0
}

/// Normal and tangential velocity of B's point minus A's, in m/s.
pub(super) fn velocity(bodies: &[ImpactBody], shared: &SharedContact) -> (f64, f64) {
    let (point, normal) = (shared.contact.point, shared.contact.normal);
    let u = bodies[shared.b].velocity_of(point) - bodies[shared.a].velocity_of(point);
    (u.dot(normal), u.dot(carom_math::perp(normal)))
}

/// What counts as rounding of a speed: friction makes one of slip as well as of approach.
pub(super) fn rounding(bodies: &[ImpactBody], contacts: &[SharedContact]) -> f64 {
    let (part, slips) = if is_rough(contacts) {
        (64.0, 1.0)
    } else {
        (16.0, 0.0)
    };
    let fastest = contacts.iter().fold(0.0, |most: f64, shared| {
        let u = velocity(bodies, shared);
        most.max(u.0.abs()).max(slips * u.1.abs())
    });
    part * f64::EPSILON * fastest
}

/// The same for each contact where impulses have made velocities: no less than what the rounding of the
/// impulses on its bodies is worth there.
fn noise(
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
    impulses: &Impulses,
    zero: f64,
) -> Vec<f64> {
    let mut taken = vec![0.0; bodies.len()];
    for (shared, (n, t)) in contacts.iter().zip(impulses) {
        taken[shared.a] += n + t.abs();
        taken[shared.b] += n + t.abs();
    }
    let worth = |body: usize, point: Vec2| taken[body] * bodies[body].yields_at(point);
    let each = contacts.iter().map(|shared| {
        let point = shared.contact.point;
        let most = worth(shared.a, point).max(worth(shared.b, point));
        zero.max(4.0 * f64::EPSILON * most)
    });
    each.collect()
}
