//! Groups in which a body is much heavier than what gives way to it: solved for at once, not by sweeps.
//!
//! A light body between a heavy one and the floor stops the heavy one by its own weight in a sweep: with r times the mass
//! it takes r sweeps, and long before the light one is in it and has been pushed through the floor. So these groups get
//! what sweeps without end would lead to: velocities that close no contact, and a displacement that pushes overlaps out.

use carom_math::Vec2;

use super::{Law, Row, SolverBody};
use crate::impact::{ImpactBody, ImpactContact, SharedContact, held};

/// Where a row pushes: its points, and the centres of mass of both bodies, in m.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) points: arrayvec::ArrayVec<Vec2, 2>,
    pub(crate) centres: (Vec2, Vec2),
}

/// Velocities and displacements of the bodies of a heavy group, and the impulses of its rows; whether there are such:
/// bodies may be squeezed so that no velocities close no contact.
pub(crate) fn solve_heavy(
    law: &Law,
    bodies: &mut [SolverBody],
    rows: &mut [Row],
    places: &[Place],
) -> bool {
    let mut members: Vec<u32> = Vec::new();
    let mut before: Vec<ImpactBody> = Vec::new();
    let mut contacts = Vec::new();
    let (mut kept, mut pushed) = (Vec::new(), Vec::new());
    // Which row, and which of its points.
    let mut of = Vec::new();
    for (k, (row, place)) in rows.iter().zip(places).enumerate() {
        let mut end = |index: u32, centre: Vec2| {
            if let Some(known) = members.iter().position(|member| *member == index) {
                return known;
            }
            let body = &bodies[index as usize];
            members.push(index);
            before.push(ImpactBody {
                inverse_mass: body.inverse_mass,
                inverse_inertia: body.inverse_inertia,
                centre,
                velocity: body.v,
                spin: body.w,
            });
            members.len() - 1
        };
        let (a, b) = (
            end(row.bodies.0, place.centres.0),
            end(row.bodies.1, place.centres.1),
        );
        for (i, point) in place.points.iter().enumerate() {
            if row.gap[i] >= Row::OPEN {
                continue;
            }
            let contact = ImpactContact {
                point: *point,
                normal: row.n,
                restitution: 0.0,
                friction: row.mu,
            };
            contacts.push(SharedContact { a, b, contact });
            kept.push((-row.gap[i].max(0.0) * law.inverse_h(), row.belt));
            pushed.push((-law.bias(row.gap[i], row.ground), 0.0));
            of.push((k, i));
        }
    }
    let relaxed = held(&before, &contacts, &kept);
    if !relaxed.sure {
        return false;
    }
    for row in rows.iter_mut() {
        (row.j, row.jt) = ([0.0; 2], 0.0);
    }
    for (&(k, i), (normal, along)) in of.iter().zip(relaxed.impulses) {
        rows[k].j[i] = normal;
        rows[k].jt += along;
    }
    for shared in &mut contacts {
        shared.contact.friction = 0.0;
    }
    let out = held(&relaxed.bodies, &contacts, &pushed);
    // What is wedged in goes a long way for a little room, or there is none: no point is pushed faster than any overlap.
    let extra = |shared: &SharedContact, body: usize| {
        let point = shared.contact.point;
        (out.bodies[body].velocity_of(point) - relaxed.bodies[body].velocity_of(point)).length()
    };
    let extras = contacts
        .iter()
        .map(|shared| extra(shared, shared.a).max(extra(shared, shared.b)));
    let most = extras.fold(0.0, f64::max);
    let share = if most > law.push_out() {
        law.push_out() / most
    } else {
        1.0
    };
    for (&(k, _), (normal, _)) in of.iter().zip(out.impulses) {
        if normal > 0.0 || rows[k].acts() {
            let (i, j) = rows[k].bodies;
            (bodies[i as usize].acted, bodies[j as usize].acted) = (true, true);
        }
    }
    let after = relaxed.bodies.iter().zip(&out.bodies);
    for (&index, (relaxed, out)) in members.iter().zip(after) {
        let body = &mut bodies[index as usize];
        (body.v, body.w) = (relaxed.velocity, relaxed.spin);
        let v = relaxed.velocity + (out.velocity - relaxed.velocity) * share;
        let w = relaxed.spin + (out.spin - relaxed.spin) * share;
        (body.d, body.turn) = (v * law.h(), w * law.h());
    }
    true
}
