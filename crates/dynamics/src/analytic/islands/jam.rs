//! Painlevé's configurations: friction outweighs the normal force that makes it, and no acceleration obeys Coulomb.
//!
//! An impulse does. Along Routh's path it grows from an approach of nothing: the normal speed falls as long as the
//! contact slides, and rises once it does not (an impact without collision: Génot and Brogliato 1999).

use carom_math::{SimTime, perp};

use crate::analytic::touching::Gathered;
use crate::impact::resolve;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::{BodyIx, EventKind, ImpactLaw};

/// Approach that the impulse begins with, as a part of the slip.
const NUDGE: f64 = 1e-13;

/// A slip that loses less than this part by the impulse did not jam.
const JAMS: f64 = 1e-6;

/// Gives the bodies of a group of one point the impulse of a jam: these bodies, and how it is told; `None` if it does not jam.
pub(crate) fn jam(
    bodies: &mut Bodies,
    pairs: &Pairs,
    gathered: &Gathered,
    law: ImpactLaw,
    time: SimTime,
) -> Option<([BodyIx; 2], EventKind)> {
    let ([touch], [(place, _)]) = (&*gathered.touches, &*gathered.pairs) else {
        return None;
    };
    let [point] = *touch.points else {
        return None;
    };
    let ends = [touch.bodies.0, touch.bodies.1].map(|slot| gathered.places[slot]);
    let mut before = ends.map(|index| bodies.get(index).in_impact(time));
    let tangent = perp(touch.normal);
    let relative = before[1].velocity_of(point) - before[0].velocity_of(point);
    let (slip, opening) = (relative.dot(tangent), relative.dot(touch.normal));
    // From exactly the nudge on, whatever rounding left.
    let moves = usize::from(before[0].inverse_mass < before[1].inverse_mass);
    let excess = touch.normal * (opening + NUDGE * slip.abs());
    before[moves].velocity += if moves == 1 { -excess } else { excess };
    let contact = pairs.get(*place).material.contact(point, touch.normal);
    let outcome = resolve(law, &before[0], &before[1], &contact);
    let after = [outcome.a, outcome.b];
    let left = (after[1].velocity_of(point) - after[0].velocity_of(point)).dot(tangent);
    if (left - slip).abs() <= JAMS * slip.abs() {
        return None;
    }
    let energy = |bodies: &Bodies| -> f64 {
        let each = ends.iter();
        each.map(|index| bodies.get(*index).kinetic_energy(time))
            .sum()
    };
    let had = energy(bodies);
    for (index, body) in ends.into_iter().zip(after) {
        bodies.end_impact(index, time, &body);
    }
    let lost = had - energy(bodies);
    bodies.book.impacts.add(lost);
    let ids = ends.map(|index| bodies.get(index).id);
    let impulses = (outcome.normal_impulse, outcome.tangential_impulse);
    let told = EventKind::impact(ids, (point, touch.normal), impulses, 0.0);
    Some((ends, told))
}
