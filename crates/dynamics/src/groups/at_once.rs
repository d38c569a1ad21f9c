//! Groups of other bodies than discs, and of discs that overlap: velocities that close no contact by more than its gap, and a
//! displacement that pushes overlaps out.

use carom_math::Vec2;

use super::{Row, SolverBody};
use crate::impact::{ImpactBody, ImpactContact, SharedContact, held};

/// Where a row pushes: its points, and the centres of mass of both bodies, in m.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) points: arrayvec::ArrayVec<Vec2, 2>,
    pub(super) centres: (Vec2, Vec2),
}

/// Velocities and displacements of the bodies of a group after `h` seconds, and the impulses of its rows. No overlap is pushed out
/// faster than at `push_out` m/s. Bodies that are squeezed so that no velocities close no contact get what sweeps come to.
pub(super) fn solve_at_once(
    (h, push_out): (f64, f64),
    bodies: &mut [SolverBody],
    rows: &mut [Row],
    places: &[Place],
) {
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
            kept.push((-row.gap[i].max(0.0) / h, row.belt));
            pushed.push(((-row.gap[i] / h).min(push_out), 0.0));
            of.push((k, i));
        }
    }
    let relaxed = held(&before, &contacts, &kept);
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
    let share = (push_out / most).min(1.0);
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
        (body.d, body.turn) = (v * h, w * h);
    }
}
