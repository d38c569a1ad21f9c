//! Faces that are held, by sweeps: as near as these come, for a small part of the time of an answer to rounding.

use carom_math::{Vec2, cross, perp};

use super::body::ImpactBody;
use super::coulomb::dissipating;
use super::held::{Friction, HeldFace, HeldFaces};
use super::sweeps::{Sweeper, Swept};

/// Discs with a restitution of 0.7 that fall into a box overlap by up to 5.1, 1.3, 0.06, 0.04 mm with 16, 32, 64, 128 of them, in 1, 1.4,
/// 2.7, and 3.5 times the time (2026-11-27).
const SWEEPS: usize = 64;

/// Speed that a contact has still to take away, as a part of the fastest, at which nothing changes any more.
const CONVERGED: f64 = 1e-14;

/// As [`super::held_faces`], by few sweeps from the impulses before: points may close by a little more than is asked of them, and no
/// impulses gain energy. What sweeps came to is made smaller where it would:
///
/// ```text
/// s Σ jₙ (uₙ − opens) + jₜ (uₜ − slips) ≤ 0        u = u₀ + s K j,  s ≤ 1
/// ```
/// A limit of friction that is [`Friction::Given`] counts as 0.
#[must_use]
pub fn swept_faces(bodies: &[ImpactBody], faces: &[HeldFace]) -> HeldFaces {
    let mut sweeper = Sweeper::default();
    bodies.iter().for_each(|body| sweeper.add_body(body));
    for face in faces {
        let points = (0..face.points.len()).map(|k| contact(bodies, face, k));
        sweeper.contacts.extend(points);
    }
    sweeper.warm_start();
    sweep(&mut sweeper, bodies);
    let part = losing(&sweeper, bodies);
    let mut contacts = sweeper.contacts.iter();
    let impulses = faces.iter().map(|face| {
        let mut of_face = [0.0; 3];
        for (k, contact) in contacts.by_ref().take(face.points.len()).enumerate() {
            of_face[k] = part * contact.j_n;
            of_face[2] += part * contact.j_t;
        }
        of_face
    });
    let after = bodies
        .iter()
        .zip(&sweeper.bodies)
        .map(|(body, to)| ImpactBody {
            velocity: body.velocity + (to.velocity - body.velocity) * part,
            spin: body.spin + (to.spin - body.spin) * part,
            ..*body
        });
    HeldFaces {
        impulses: impulses.collect(),
        bodies: after.collect(),
        sure: true,
    }
}

fn sweep(sweeper: &mut Sweeper, bodies: &[ImpactBody]) {
    let speeds = bodies.iter().map(|body| body.velocity.length());
    let asked = sweeper.contacts.iter().map(|contact| contact.target.abs());
    let fastest = speeds.chain(asked).fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        if sweeper.sweep() <= CONVERGED * fastest {
            break;
        }
    }
}

/// A point of a face, with its share of the friction.
fn contact(bodies: &[ImpactBody], face: &HeldFace, k: usize) -> Swept {
    let (n, t) = (face.normal, perp(face.normal));
    let (a, b) = (&bodies[face.bodies.0], &bodies[face.bodies.1]);
    let point = &face.points[k];
    let (r_a, r_b) = (point.on.0 - a.centre, point.on.1 - b.centre);
    let arms = |along| (cross(r_a, along), cross(r_b, along));
    let mass = |(arm_a, arm_b): (f64, f64)| {
        let turns = arm_a * arm_a * a.inverse_inertia + arm_b * arm_b * b.inverse_inertia;
        let yields = a.inverse_mass + b.inverse_mass + turns;
        if yields > 0.0 { yields.recip() } else { 0.0 }
    };
    let pushes: f64 = face.before[..face.points.len()].iter().sum();
    let share = if pushes > 0.0 {
        face.before[k] / pushes
    } else {
        0.0
    };
    Swept {
        a: face.bodies.0,
        b: face.bodies.1,
        normal: n,
        arms_n: arms(n),
        arms_t: arms(t),
        m_n: mass(arms(n)),
        m_t: mass(arms(t)),
        friction: match face.friction {
            Friction::Coulomb(mu) => mu,
            Friction::Given(_) => 0.0,
        },
        target: point.opens,
        belt: face.slips,
        j_n: face.before[k],
        j_t: face.before[2] * share,
    }
}

/// The greatest part of impulses, at most 1, that gains nothing beyond what is asked for.
fn losing(sweeper: &Sweeper, bodies: &[ImpactBody]) -> f64 {
    let (mut before, mut after) = (0.0, 0.0);
    for contact in &sweeper.contacts {
        let work = |a: (Vec2, f64), b: (Vec2, f64)| {
            let opens = contact.opening(a, b) - contact.target;
            contact.j_n * opens + contact.j_t * contact.slip(a, b)
        };
        let began = |k: usize| (bodies[k].velocity, bodies[k].spin);
        before += work(began(contact.a), began(contact.b));
        after += work(sweeper.velocity(contact.a), sweeper.velocity(contact.b));
    }
    dissipating(before, after)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::tests::heaps::{energy, heap};
    use crate::{HeldPoint, SharedContact, held_faces};

    /// Faces of one point each, which open at `opens` m/s at least.
    fn faces(contacts: &[SharedContact], opens: f64) -> Vec<HeldFace> {
        let face = |shared: &SharedContact| HeldFace {
            bodies: (shared.a, shared.b),
            normal: shared.contact.normal,
            friction: Friction::Coulomb(shared.contact.friction),
            slips: 0.0,
            points: vec![HeldPoint {
                on: (shared.contact.point, shared.contact.point),
                opens,
            }],
            before: [0.0; 3],
        };
        contacts.iter().map(face).collect()
    }

    proptest! {
        #[test]
        fn no_impulses_gain_energy((bodies, contacts) in heap(3.0, 12, (Just(0.0), 0.0..2.0_f64)), opens in -1.0..0.0_f64) {
            let swept = swept_faces(&bodies, &faces(&contacts, opens));
            let (before, after) = (energy(&bodies), energy(&swept.bodies));
            prop_assert!(after <= before * (1.0 + 1e-12), "{after} J of {before} J");
            for ([normal, _, along], shared) in swept.impulses.iter().zip(&contacts) {
                prop_assert!(*normal >= 0.0);
                prop_assert!(along.abs() <= shared.contact.friction * normal * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn a_part_of_impulses_that_gain_is_taken() {
        // Two bodies that part are pushed by the impulse of a moment ago.
        let body = |x: f64, v: f64| ImpactBody {
            inverse_mass: 1.0,
            inverse_inertia: 0.0,
            centre: Vec2::new(x, 0.0),
            velocity: Vec2::new(v, 0.0),
            spin: 0.0,
        };
        let bodies = [body(0.0, -1.0), body(1.0, 1.0)];
        let point = HeldPoint {
            on: (Vec2::new(0.5, 0.0), Vec2::new(0.5, 0.0)),
            opens: 0.0,
        };
        let face = HeldFace {
            bodies: (0, 1),
            normal: Vec2::X,
            friction: Friction::Coulomb(0.0),
            slips: 0.0,
            points: vec![point],
            before: [3.0, 0.0, 0.0],
        };
        let swept = swept_faces(&bodies, &[face]);
        assert_eq!(swept.impulses, [[0.0; 3]]);
        assert_eq!(swept.bodies, bodies);
    }

    /// A column of discs that slides on a floor.
    #[test]
    fn a_column_is_held_as_by_pivots() {
        let mut bodies = vec![ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0)];
        let (mut faces, mut y) = (Vec::new(), 0.0);
        for k in 0..4 {
            bodies.push(ImpactBody {
                inverse_mass: 1.0,
                inverse_inertia: 8.0,
                centre: Vec2::new(0.0, y + 0.5),
                velocity: Vec2::new(1.0, -0.03),
                spin: 0.2,
            });
            let point = HeldPoint {
                on: (Vec2::new(0.0, y), Vec2::new(0.0, y)),
                opens: 0.0,
            };
            faces.push(HeldFace {
                bodies: (k, k + 1),
                normal: Vec2::Y,
                friction: Friction::Coulomb(0.3),
                slips: 0.0,
                points: vec![point],
                before: [0.0; 3],
            });
            y += 1.0;
        }
        let (mut swept, held) = (swept_faces(&bodies, &faces), held_faces(&bodies, &faces));
        for _ in 0..4 {
            // As from one sub-step to the next.
            for (face, impulses) in faces.iter_mut().zip(&swept.impulses) {
                face.before = *impulses;
            }
            swept = swept_faces(&bodies, &faces);
        }
        for (one, other) in swept.bodies.iter().zip(&held.bodies) {
            let off = (one.velocity - other.velocity).length() + (one.spin - other.spin).abs();
            assert!(off < 1e-12, "{off} m/s");
        }
    }
}
