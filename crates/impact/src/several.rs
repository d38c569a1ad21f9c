//! Several contacts that act at one instant.
//!
//! No law of a single impact says what happens then, and no answer is unique. Ours keeps momentum to
//! rounding, never gains energy, leaves no contact closing, gives symmetric answers to symmetric
//! questions, does not depend on the order of contacts, and is the single law for one contact.
//! Without friction all of it holds to rounding; for contacts with it see `rough`.

use super::body::{ImpactBody, ImpactContact, is_driven};
use super::law::{ImpactLaw, resolve};
use super::restitution::Impulses;
use super::rough::{is_large, is_rough, newton_rough, opened, opening, reflections, rounding};
use super::scaled::Scaled;

/// Operations of an impact at one contact.
const SINGLE: u64 = 256;

/// A contact of two bodies of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedContact {
    /// Index of A, which the normal points away from.
    pub a: usize,
    /// Index of B.
    pub b: usize,
    /// Where, and of what material.
    pub contact: ImpactContact,
}

/// What contacts at one instant did.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedOutcome {
    /// The bodies after it, in their order.
    pub bodies: Vec<ImpactBody>,
    /// Impulses on B along the normal, ≥ 0, and along the normal turned by +90 degrees, for each contact, in N·s.
    pub impulses: Vec<(f64, f64)>,
    /// Whether the law was not followed to its end: a thousand reflections (200 with friction) were not enough,
    /// and what still approached was stopped with a loss that e = 1 would not have had; or bodies are
    /// squeezed so that nothing meets all conditions, or by driven bodies so that only more than sixteen times the speed
    /// that squeezes them does, and some contact may still close.
    pub exhausted: bool,
    /// Floating-point operations that it took, to a factor of a few: what bounds the work of a call charges for it.
    pub operations: u64,
}

/// How contacts at one instant share an impact.
///
/// No answer is unique: an instant is a limit of many short impacts one after the other, and which
/// limit depends on what a rigid body leaves out. Each choice keeps momentum to rounding, keeps
/// friction in its cone, leaves no contact closing, and follows [`ImpactLaw`] where one
/// contact acts alone. With more than 64 rows (a contact has one, with friction two) all are
/// Newton's law by sweeps, in bounded time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Several {
    /// (1 − e) of a common stop and e of reflections: see [`blend`]. Symmetric, never gains energy,
    /// knows Newton's cradle at e = 1 and a dead stop at e = 0.
    #[default]
    Blend,
    /// Newton's law for all at once: see [`newton_lcp`]. Symmetric, passes no impact on, and may gain
    /// energy where contacts have friction or differ in e.
    NewtonLcp,
    /// Reflections that give back e each time, until nothing closes. Never gains energy and passes
    /// impacts on at every e; takes longest.
    Reflections,
}

/// What an impact at several contacts does under the world's choices.
///
/// One contact follows `law`, and so does one that approaches alone and closes no other.
/// Where a number is NaN or infinite the answer means nothing.
///
/// # Examples
/// A box lands flat on a rough floor, without restitution, while it slides: it neither turns nor
/// rises, and friction takes µ (m v) from its slide.
/// ```
/// use carom_impact::{ImpactBody, ImpactContact, ImpactLaw, Several, SharedContact, several};
/// use carom_math::{Vec2, vec2};
/// let floor = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
/// let landing = ImpactBody {
///     inverse_mass: 1.0, inverse_inertia: 6.0, centre: vec2(0.0, 0.5), velocity: vec2(3.0, -2.0), spin: 0.0,
/// };
/// let corner = |x: f64| SharedContact {
///     a: 0, b: 1,
///     contact: ImpactContact { point: vec2(x, 0.0), normal: Vec2::Y, restitution: 0.0, friction: 0.1 },
/// };
/// let contacts = [corner(-0.5), corner(0.5)];
/// let after = several(ImpactLaw::Stronge, Several::Blend, &[floor, landing], &contacts).bodies[1];
/// assert!((after.velocity - vec2(2.8, 0.0)).length() < 1e-14);     // m/s: it opens by 4 ε of its speed
/// assert!(after.spin.abs() < 1e-14);                               // rad/s
/// ```
///
/// # Panics
/// If a contact names a body that is not in the list.
#[must_use]
pub fn several(
    law: ImpactLaw,
    choice: Several,
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
) -> SharedOutcome {
    if let Some(single) = single(law, bodies, contacts) {
        return single;
    }
    // What squeezes bodies would go to and fro between them with every reflection, ever faster.
    let stop = is_driven(bodies).then(|| newton_rough(bodies, &with_restitution(contacts, 0.0)));
    if let Some(squeezed) = stop.as_ref().filter(|stop| stop.exhausted) {
        return squeezed.clone();
    }
    if is_large(contacts) && is_rough(contacts) {
        return newton_rough(bodies, contacts);
    }
    match choice {
        Several::Blend => blend_by(law, bodies, contacts, stop),
        Several::NewtonLcp => newton_lcp(bodies, contacts),
        Several::Reflections => opened(reflections(law, bodies, contacts, None, None), contacts),
    }
}

/// The only contact that approaches, if no other closes by it.
pub(super) fn single(
    law: ImpactLaw,
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
) -> Option<SharedOutcome> {
    let mut approaching = (0..contacts.len()).filter(|&k| opening(bodies, &contacts[k]) < 0.0);
    let (only, None) = (approaching.next()?, approaching.next()) else {
        return None;
    };
    let shared = &contacts[only];
    let outcome = resolve(law, &bodies[shared.a], &bodies[shared.b], &shared.contact);
    let mut after = bodies.to_vec();
    (after[shared.a], after[shared.b]) = (outcome.a, outcome.b);
    let others = contacts.iter().enumerate().filter(|(k, _)| *k != only);
    let mut closed = others.filter(|(_, other)| opening(&after, other) < 0.0);
    if closed.next().is_some() {
        return None;
    }
    let mut found = SharedOutcome {
        bodies: after,
        impulses: vec![(0.0, 0.0); contacts.len()],
        exhausted: false,
        operations: SINGLE,
    };
    found.impulses[only] = (outcome.normal_impulse, outcome.tangential_impulse);
    Some(found)
}

/// Newton's law at all contacts at once: `0 ≤ u⁺ + e u⁻ ⟂ j ≥ 0`.
///
/// u is the opening speed. Keeps energy where every e is 1 and none has friction, but passes nothing
/// on: the first of three touching discs bounces back from the other two together. Friction
/// is Coulomb's against the slip that is left.
///
/// # Panics
/// If a contact names a body that is not in the list.
#[must_use]
pub fn newton_lcp(bodies: &[ImpactBody], contacts: &[SharedContact]) -> SharedOutcome {
    opened(newton(bodies, contacts), contacts)
}

/// The same, before contacts with friction that rounding left closing are opened.
pub(super) fn newton(bodies: &[ImpactBody], contacts: &[SharedContact]) -> SharedOutcome {
    if is_rough(contacts) {
        return newton_rough(bodies, contacts);
    }
    let wanted = contacts
        .iter()
        .map(|shared| -shared.contact.restitution * opening(bodies, shared));
    let (wanted, zero): (Vec<f64>, f64) = (wanted.collect(), rounding(bodies, contacts));
    Scaled::of(bodies, contacts).reach(bodies, &wanted, zero)
}

/// Reflections of all approaching contacts together, again and again until none approaches.
///
/// The generalised reflections of Smith, Kaufman, Vouga, Tamstorf and Grinspun (2012), for e = 1
/// whatever the contacts say: energy is kept, and an impact runs through a row of touching discs.
/// With friction each reflection is a common stop by Coulomb's law and then Routh's path, which gives
/// back the work of compression and loses what friction takes.
///
/// # Panics
/// If a contact names a body that is not in the list.
#[must_use]
pub fn generalised_reflections(bodies: &[ImpactBody], contacts: &[SharedContact]) -> SharedOutcome {
    let found = reflections(ImpactLaw::Stronge, bodies, contacts, Some(1.0), None);
    opened(found, contacts)
}

pub(super) fn with_restitution(contacts: &[SharedContact], restitution: f64) -> Vec<SharedContact> {
    let set = |shared: &SharedContact| SharedContact {
        contact: ImpactContact {
            restitution,
            ..shared.contact
        },
        ..*shared
    };
    contacts.iter().map(set).collect()
}

/// (1 − e) · [`newton_lcp`] at e = 0 plus e · [`generalised_reflections`], velocity by velocity.
///
/// One weight e for all: the mean of the contacts' own, weighted with their impulses at e = 0. Both ends
/// leave no contact closing, so their mean does not, and its energy lies between theirs.
///
/// # Examples
/// Of three touching discs the first moves at 1 m/s: with e = ½ half of the answer is the common
/// velocity of ⅓ m/s, half is the cradle's.
/// ```
/// use carom_impact::{ImpactBody, ImpactContact, SharedContact, blend};
/// use carom_math::{Vec2, vec2};
/// let disc = |x: f64, v: f64| ImpactBody {
///     inverse_mass: 1.0, inverse_inertia: 8.0, centre: vec2(x, 0.0), velocity: vec2(v, 0.0), spin: 0.0,
/// };
/// let touch = |a: usize, x: f64| SharedContact {
///     a, b: a + 1,
///     contact: ImpactContact { point: vec2(x, 0.0), normal: Vec2::X, restitution: 0.5, friction: 0.0 },
/// };
/// let after = blend(&[disc(0.0, 1.0), disc(1.0, 0.0), disc(2.0, 0.0)], &[touch(0, 0.5), touch(1, 1.5)]);
/// for (body, exact) in after.bodies.iter().zip([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) {
///     assert!((body.velocity.x - exact).abs() < 1e-15);         // m/s
/// }
/// ```
///
/// # Panics
/// If a contact names a body that is not in the list.
#[must_use]
pub fn blend(bodies: &[ImpactBody], contacts: &[SharedContact]) -> SharedOutcome {
    blend_by(ImpactLaw::Stronge, bodies, contacts, None)
}

/// `stop`: what [`newton_rough`] says at e = 0, if that is known.
fn blend_by(
    law: ImpactLaw,
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
    stop: Option<SharedOutcome>,
) -> SharedOutcome {
    let still = with_restitution(contacts, 0.0);
    // Reflections begin with the same stop, before it is opened.
    let stop = stop
        .filter(|_| is_rough(contacts))
        .unwrap_or_else(|| newton(bodies, &still));
    let stuck = opened(stop.clone(), &still);
    let e = mean_restitution(contacts, &stuck.impulses);
    // What nothing stops gives nothing back; every reflection would ask for that stop again.
    if e <= 0.0 || stuck.exhausted {
        return stuck;
    }
    let thrown = reflections(law, bodies, contacts, Some(1.0), Some(stop));
    let mix = |at_0: f64, at_1: f64| (1.0 - e) * at_0 + e * at_1;
    let operations = stuck.operations + thrown.operations;
    let mixed = if e >= 1.0 {
        SharedOutcome {
            operations,
            ..thrown
        }
    } else {
        let both = stuck.bodies.iter().zip(&thrown.bodies);
        let impulses = stuck.impulses.iter().zip(&thrown.impulses);
        SharedOutcome {
            impulses: impulses
                .map(|(s, t)| (mix(s.0, t.0), mix(s.1, t.1)))
                .collect(),
            bodies: both
                .map(|(s, t)| ImpactBody {
                    velocity: s.velocity * (1.0 - e) + t.velocity * e,
                    spin: mix(s.spin, t.spin),
                    ..*s
                })
                .collect(),
            exhausted: stuck.exhausted || thrown.exhausted,
            operations,
        }
    };
    opened(mixed, contacts)
}

pub(super) fn mean_restitution(contacts: &[SharedContact], impulses: &Impulses) -> f64 {
    let all: f64 = impulses.iter().map(|(j, _)| j).sum();
    if all <= 0.0 {
        return 0.0;
    }
    let first = contacts
        .first()
        .map_or(0.0, |shared| shared.contact.restitution);
    // Equal ones need no mean, and no rounding.
    #[expect(clippy::float_cmp, reason = "equal settings are equal bits")]
    if contacts
        .iter()
        .all(|shared| shared.contact.restitution == first)
    {
        return first;
    }
    let weighted = contacts.iter().zip(impulses);
    let sum: f64 = weighted
        .map(|(shared, (j, _))| shared.contact.restitution * j)
        .sum();
    sum / all
}
