//! Projected Gauss–Seidel: bounded in time whatever the contacts, and as exact as its sweeps.

use carom_math::{Vec2, cross, perp, within};

use super::body::{ImpactBody, ImpactContact, Response};
use super::rows::{Bound, Rows};

/// Sweeps before what is left stays.
const SWEEPS: usize = 300;

/// Change of a scaled speed in a sweep, as a part of the largest, at which it has converged.
const CONVERGED: f64 = 1e-12;

/// Compliance of a row where bodies are squeezed, as a part of what it yields to an impulse of its own: there contacts
/// go on closing with `u = −ε K_rr j_r`, so no impulse exceeds what four times the closing speed takes.
const YIELDS: f64 = 0.25;

/// Growth of all pushes in the second half of the sweeps, as a part of that in the first, from which on only the number of
/// sweeps limits them: 1 where they grow by as much in every sweep, 0.41 where an impulse diffuses along a chain, 0 at an answer.
const GROWS: f64 = 0.7;

/// Operations of a row's turn in a sweep.
pub(super) const TURN: usize = 32;

/// Scaled impulses that come as near to the conditions as the sweeps do, and the operations that it took.
///
/// Where bodies are squeezed between others that do not yield no impulses meet the conditions, and those of the sweeps
/// grow with their number: there every row yields. Without drivers there are some always (M. Anitescu, F. Potra 1997).
pub(super) fn swept(rows: &Rows) -> (Vec<f64>, u64) {
    let rigid = compliant(rows, 0.0);
    if !(rows.driven && rigid.grows) {
        return (rigid.impulses, rigid.operations);
    }
    let (impulses, operations) = yielding(rows);
    (impulses, rigid.operations + operations)
}

/// Scaled impulses for bodies that are squeezed: every row yields.
pub(super) fn yielding(rows: &Rows) -> (Vec<f64>, u64) {
    let found = compliant(rows, YIELDS);
    (found.impulses, found.operations)
}

/// What sweeps came to.
struct Found {
    impulses: Vec<f64>,
    /// Whether pushes go on growing.
    grows: bool,
    operations: u64,
}

/// Sweeps with `u_r = −compliance j_r` wherever a row holds, all scaled.
fn compliant(rows: &Rows, compliance: f64) -> Found {
    let mut impulses = vec![0.0; rows.len()];
    let mut bodies = rows.still.clone();
    let start = (0..rows.len()).map(|r| rows.speed(r, &bodies).abs());
    let size = start.fold(0.0, f64::max);
    let mut growth = Growth::default();
    let mut sweeps = 0;
    while sweeps < SWEEPS {
        sweeps += 1;
        let mut change = 0.0_f64;
        for r in 0..rows.len() {
            if rows.scales[r] == 0.0 {
                continue;
            }
            let wanted = (impulses[r] - rows.speed(r, &bodies)) / (1.0 + compliance);
            let limit = rows.limit(r, &impulses);
            let next = match rows.rows[r].bound {
                Bound::Push => wanted.max(0.0),
                Bound::Friction(..) | Bound::Limit(_) => within(wanted, -limit, limit),
            };
            let more = next - impulses[r];
            rows.rows[r].push(&mut bodies, more / rows.scales[r]);
            change = change.max(more.abs());
            impulses[r] = next;
        }
        growth.note(sweeps, SWEEPS, || pushes(rows, &impulses));
        if change <= CONVERGED * size {
            break;
        }
    }
    Found {
        impulses,
        grows: growth.is_steady(),
        operations: (sweeps * rows.len() * TURN) as u64,
    }
}

/// Sum of scaled pushes.
fn pushes(rows: &Rows, impulses: &[f64]) -> f64 {
    let all = rows.rows.iter().zip(impulses);
    all.filter(|(row, _)| row.bound == Bound::Push)
        .map(|(_, j)| j)
        .sum()
}

/// Sums of pushes after half of the sweeps and after all of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Growth {
    half: f64,
    whole: f64,
}

impl Growth {
    /// Notes the sum of pushes after `sweep` sweeps of at most `most`, where it is asked for.
    pub fn note(&mut self, sweep: usize, most: usize, pushes: impl FnOnce() -> f64) {
        if sweep == most / 2 {
            self.half = pushes();
        } else if sweep == most {
            self.whole = pushes();
        }
    }

    /// Whether pushes grew in the second half nearly as they did in the first: no impulses meet the conditions.
    #[must_use]
    pub fn is_steady(&self) -> bool {
        self.whole - self.half > GROWS * self.half
    }
}

/// Part of a speed that a contact's turn takes away. 60 steps of the scene `d_tumbler` take 20.1 s at 1, 17.2 s at
/// 1.3, 19.7 s at 1.6 (2026-11-21).
const OVER_RELAXATION: f64 = 1.3;

/// Coulomb's friction and contacts that are to open, or may close, at given speeds, by sweeps; their number may grow on the way.
#[derive(Clone, Debug, Default)]
pub struct Sweeper {
    /// In the order in which they came.
    pub(super) bodies: Vec<Moving>,
    /// In the order in which they came.
    pub(super) contacts: Vec<Swept>,
    /// How much a contact goes on closing under its impulse, as a part of what that impulse alone would change.
    pub(super) compliance: f64,
}

/// A body's velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    /// Of the centre of mass, in m/s.
    pub(super) velocity: Vec2,
    /// In rad/s.
    pub(super) spin: f64,
    /// In 1/kg; 0 of what does not yield.
    pub(super) inverse_mass: f64,
    /// In 1/(kg·m²).
    pub(super) inverse_inertia: f64,
}

/// A contact with the arms of its normal and its tangent about both centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swept {
    /// Number of the body that the normal points away from.
    pub(super) a: usize,
    /// Number of the body that it points to.
    pub(super) b: usize,
    /// Unit normal from A to B.
    pub(super) normal: Vec2,
    /// r × n of A and of B, in m.
    pub(super) arms_n: (f64, f64),
    /// r × t of A and of B, in m; t is the normal turned by +90 degrees.
    pub(super) arms_t: (f64, f64),
    /// Effective mass along the normal, in kg; 0 if nothing yields.
    pub(super) m_n: f64,
    /// Effective mass along the tangent, in kg.
    pub(super) m_t: f64,
    /// Coulomb's coefficient.
    pub(super) friction: f64,
    /// Opening speed to reach, in m/s.
    pub(super) target: f64,
    /// Slip at which both surfaces run along with each other, in m/s.
    pub(super) belt: f64,
    /// Impulse along the normal, in N·s.
    pub(super) j_n: f64,
    /// Impulse along the tangent, in N·s.
    pub(super) j_t: f64,
}

impl Swept {
    /// Opening speed of two bodies that move like this, in m/s.
    pub(super) fn opening(&self, a: (Vec2, f64), b: (Vec2, f64)) -> f64 {
        let (arm_a, arm_b) = self.arms_n;
        (b.0 - a.0).dot(self.normal) + b.1 * arm_b - a.1 * arm_a
    }

    /// Slip of the surfaces of two bodies that move like this, in m/s.
    pub(super) fn slip(&self, a: (Vec2, f64), b: (Vec2, f64)) -> f64 {
        let (arm_a, arm_b) = self.arms_t;
        let of_bodies = (b.0 - a.0).dot(perp(self.normal)) + b.1 * arm_b - a.1 * arm_a;
        of_bodies - self.belt
    }
}

impl Sweeper {
    /// For bodies that are squeezed between others that do not yield: contacts go on closing by a quarter of what their
    /// impulses alone would change, which bounds the impulses.
    #[must_use]
    pub fn yielding() -> Self {
        Self {
            compliance: YIELDS,
            ..Self::default()
        }
    }

    /// Sum of all pushes, each by the speed that it alone would change, in m/s.
    #[must_use]
    pub fn pushes(&self) -> f64 {
        let pushing = self.contacts.iter().filter(|contact| contact.m_n > 0.0);
        pushing.map(|contact| contact.j_n / contact.m_n).sum()
    }

    /// Bodies are named by the order in which they came.
    pub fn add_body(&mut self, body: &ImpactBody) {
        self.bodies.push(Moving {
            velocity: body.velocity,
            spin: body.spin,
            inverse_mass: body.inverse_mass,
            inverse_inertia: body.inverse_inertia,
        });
    }

    /// A contact of two bodies, given at the instant of the impact, that is to open with `target` m/s,
    /// and the impulses that have been given along its normal and its tangent.
    pub fn add_contact(
        &mut self,
        (a, b): (usize, usize),
        (body_a, body_b): (&ImpactBody, &ImpactBody),
        contact: &ImpactContact,
        target: f64,
        (j_n, j_t): (f64, f64),
    ) {
        let normal = contact.normal;
        let (r_a, r_b) = (contact.point - body_a.centre, contact.point - body_b.centre);
        let response = Response::of(body_a, body_b, contact);
        let inverse = |k: f64| if k > 0.0 { k.recip() } else { 0.0 };
        self.contacts.push(Swept {
            a,
            b,
            normal,
            arms_n: (cross(r_a, normal), cross(r_b, normal)),
            arms_t: (cross(r_a, perp(normal)), cross(r_b, perp(normal))),
            m_n: inverse(response.k_nn),
            m_t: inverse(response.k_tt),
            friction: contact.friction,
            target,
            belt: 0.0,
            j_n,
            j_t,
        });
    }

    /// How many bodies and contacts there are.
    pub fn len(&self) -> (usize, usize) {
        (self.bodies.len(), self.contacts.len())
    }

    /// Velocity of the k-th body, in m/s, and its spin in rad/s.
    pub fn velocity(&self, k: usize) -> (Vec2, f64) {
        self.bodies[k].moves()
    }

    /// Impulses of the k-th contact along its normal and its tangent, in N·s.
    pub fn impulses(&self, k: usize) -> (f64, f64) {
        (self.contacts[k].j_n, self.contacts[k].j_t)
    }

    /// Gives bodies the impulses that contacts begin with.
    pub(super) fn warm_start(&mut self) {
        for contact in &self.contacts {
            let (n, t) = (contact.normal, perp(contact.normal));
            let a = &mut self.bodies[contact.a];
            a.push(n, contact.arms_n.0, -contact.j_n);
            a.push(t, contact.arms_t.0, -contact.j_t);
            let b = &mut self.bodies[contact.b];
            b.push(n, contact.arms_n.1, contact.j_n);
            b.push(t, contact.arms_t.1, contact.j_t);
        }
    }

    /// Every contact's turn; the largest speed that one had still to take away, or to yield, in m/s.
    pub fn sweep(&mut self) -> f64 {
        let Self {
            bodies,
            contacts,
            compliance,
        } = self;
        let part = OVER_RELAXATION / (1.0 + *compliance);
        let yields = part * *compliance;
        let mut most = 0.0_f64;
        for contact in contacts {
            let (mut a, mut b) = (bodies[contact.a], bodies[contact.b]);
            let (n, t) = (contact.normal, perp(contact.normal));
            let (an, bn) = contact.arms_n;
            let u_n = contact.opening(a.moves(), b.moves());
            let j_n = (contact.j_n + part * (contact.target - u_n) * contact.m_n
                - yields * contact.j_n)
                .max(0.0);
            let more_n = j_n - contact.j_n;
            a.push(n, an, -more_n);
            b.push(n, bn, more_n);
            let (at, bt) = contact.arms_t;
            let u_t = contact.slip(a.moves(), b.moves());
            let limit = contact.friction * j_n;
            let wanted = contact.j_t - part * u_t * contact.m_t - yields * contact.j_t;
            let j_t = within(wanted, -limit, limit);
            let more_t = j_t - contact.j_t;
            a.push(t, at, -more_t);
            b.push(t, bt, more_t);
            (bodies[contact.a], bodies[contact.b]) = (a, b);
            (contact.j_n, contact.j_t) = (j_n, j_t);
            // What is left of a speed that an impulse was to take: 0 where the impulse is at its bound.
            if more_n != 0.0 {
                most = most.max((u_n - contact.target).abs());
            }
            if more_t != 0.0 {
                most = most.max(u_t.abs());
            }
        }
        most
    }
}

impl Moving {
    const fn moves(&self) -> (Vec2, f64) {
        (self.velocity, self.spin)
    }

    fn push(&mut self, direction: Vec2, arm: f64, impulse: f64) {
        self.velocity += direction * (impulse * self.inverse_mass);
        self.spin += arm * impulse * self.inverse_inertia;
    }
}
