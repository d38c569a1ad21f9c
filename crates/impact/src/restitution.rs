//! Restitution after a common compression: Routh's path for several contacts.
//!
//! What was pressed in together springs back together: the normal impulses grow in the proportions that
//! they had in compression, `j_n = τ p`, and friction follows them by Coulomb's law at every instant.
//! Between changes of slip velocities are linear in τ, so the path has a few straight pieces, as that
//! of a single contact.

use carom_math::{Vec2, cross, perp};

use super::body::ImpactBody;
use super::coulomb::{Stop, stop};
use super::rough::velocity;
use super::routh::EndRule;
use super::rows::{Bound, Row, Rows};
use super::several::SharedContact;

/// Restitution never lasts longer than this many times as long as compression: a jam would go on for ever.
const LONGEST: f64 = 2.0;

/// Impulses of each contact along its normal and along the normal turned by +90 degrees, in N·s.
pub(super) type Impulses = Vec<(f64, f64)>;

/// How much comes back, and by which measure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Return<'a> {
    pub(super) rule: EndRule,
    /// Coefficient of restitution of all contacts.
    pub(super) restitution: f64,
    /// Work of compression, in J. No more than e² of it comes back by any measure.
    pub(super) work: f64,
    /// Slip of each contact below which it is none, in m/s.
    pub(super) zero: &'a [f64],
}

/// What restitution adds, the bodies after it, and the operations that it took.
pub(super) fn give_back(
    stopped: &[ImpactBody],
    contacts: &[SharedContact],
    presses: &Impulses,
    how: &Return<'_>,
) -> (Vec<ImpactBody>, Impulses, u64) {
    let e = how.restitution;
    let mut path = Path {
        contacts,
        presses,
        zero: how.zero,
        bodies: stopped.to_vec(),
        operations: 0,
    };
    let mut work = e * e * how.work;
    let mut length = match how.rule {
        EndRule::Impulse => e,
        EndRule::Work => LONGEST * e,
    };
    let mut total = vec![(0.0, 0.0); contacts.len()];
    // Each piece ends a slip or begins one; the bound is for rounding alone.
    for _ in 0..(8 + 4 * contacts.len()) {
        let piece = path.piece();
        let (start, slope) = path.power(&piece);
        // ∫ (start + slope τ) dτ = work, in the form that does not cancel.
        let root = start * start + 2.0 * slope * work;
        let to_work = if root >= 0.0 && start + root.sqrt() > 0.0 {
            2.0 * work / (start + root.sqrt())
        } else {
            f64::INFINITY
        };
        let to_end = to_work.min(length);
        let step = to_end.min(path.to_change_of_slip(&piece));
        if !(step.is_finite() && step >= 0.0) {
            break;
        }
        path.advance(&piece, step, &mut total);
        work -= step * (start + 0.5 * slope * step);
        length -= step;
        if step >= to_end || work <= 0.0 {
            break;
        }
    }
    (path.bodies, total, path.operations)
}

/// One straight piece, per unit of τ.
struct Piece {
    /// Normal impulse and friction of every contact.
    impulses: Impulses,
    /// Whether friction is at its limit, and does work.
    slips: Vec<bool>,
    /// Velocities that the bodies gain.
    rates: Vec<ImpactBody>,
}

struct Path<'a> {
    contacts: &'a [SharedContact],
    presses: &'a Impulses,
    zero: &'a [f64],
    bodies: Vec<ImpactBody>,
    operations: u64,
}

/// Operations of a contact in a piece.
const PIECE: usize = 128;

impl Path<'_> {
    /// Direction in which contact k slips; 0 if it sticks.
    fn slip(&self, k: usize) -> f64 {
        let u_t = tangential(&self.bodies, &self.contacts[k]);
        if u_t.abs() > self.zero[k] {
            u_t.signum()
        } else {
            0.0
        }
    }

    /// What slips is held back by its limit; what sticks is held, if the limit allows it.
    fn piece(&mut self) -> Piece {
        self.operations += (self.contacts.len() * PIECE) as u64;
        let mut rates: Vec<ImpactBody> = self.bodies.iter().map(ImpactBody::at_rest).collect();
        let mut impulses: Impulses = self.presses.iter().map(|press| (press.0, 0.0)).collect();
        let mut slips = vec![true; self.contacts.len()];
        let (mut rows, mut places) = (Vec::new(), Vec::new());
        for (k, (shared, (press, _))) in self.contacts.iter().zip(self.presses).enumerate() {
            let limit = shared.contact.friction * press;
            let slip = self.slip(k);
            if slip == 0.0 && limit > 0.0 {
                let tangent = perp(shared.contact.normal);
                rows.push(Row::new(&rates, shared, tangent, Bound::Limit(limit)));
                places.push(k);
            }
            impulses[k].1 = -slip * limit;
            push(&mut rates, shared, impulses[k]);
        }
        if !rows.is_empty() {
            let held = Rows::new(&rates, rows);
            let Stop {
                impulses: holds,
                operations,
                ..
            } = stop(&held);
            self.operations += operations;
            for (k, hold) in places.into_iter().zip(holds) {
                let shared = &self.contacts[k];
                slips[k] = hold.abs() >= shared.contact.friction * self.presses[k].0;
                impulses[k].1 = hold;
                push(&mut rates, shared, (0.0, hold));
            }
        }
        Piece {
            impulses,
            slips,
            rates,
        }
    }

    /// Power of the normal impulses per unit of τ, and how it grows: all power but that of friction.
    fn power(&self, piece: &Piece) -> (f64, f64) {
        let given = gathered(&self.bodies, self.contacts, &piece.impulses);
        let of = |bodies: &[ImpactBody]| {
            let rubbing = piece.slips.iter().zip(&piece.impulses).zip(self.contacts);
            let lost = rubbing.filter(|((slips, _), _)| **slips);
            let lost = lost.map(|((_, impulse), shared)| impulse.1 * tangential(bodies, shared));
            power(bodies, &given) - lost.sum::<f64>()
        };
        (of(&self.bodies), of(&piece.rates))
    }

    fn to_change_of_slip(&self, piece: &Piece) -> f64 {
        let mut first = f64::INFINITY;
        for (k, shared) in self.contacts.iter().enumerate() {
            let slip = self.slip(k);
            let rate = tangential(&piece.rates, shared);
            if self.presses[k].0 > 0.0 && slip * rate < 0.0 {
                first = first.min(-tangential(&self.bodies, shared) / rate);
            }
        }
        first
    }

    fn advance(&mut self, piece: &Piece, step: f64, total: &mut Impulses) {
        for (k, shared) in self.contacts.iter().enumerate() {
            let (press, friction) = piece.impulses[k];
            let added = (press * step, friction * step);
            push(&mut self.bodies, shared, added);
            total[k].0 += added.0;
            total[k].1 += added.1;
        }
    }
}

/// Tangential velocity of B's point minus A's, in m/s.
fn tangential(bodies: &[ImpactBody], shared: &SharedContact) -> f64 {
    velocity(bodies, shared).1
}

/// Impulse in N·s and angular impulse about its centre in N·m·s that contacts give to each body.
pub(super) fn gathered(
    bodies: &[ImpactBody],
    contacts: &[SharedContact],
    impulses: &Impulses,
) -> Vec<(Vec2, f64)> {
    let mut given = vec![(Vec2::ZERO, 0.0); bodies.len()];
    for (shared, (n, t)) in contacts.iter().zip(impulses) {
        let contact = &shared.contact;
        let impulse = contact.normal * *n + perp(contact.normal) * *t;
        for (body, impulse) in [(shared.a, -impulse), (shared.b, impulse)] {
            given[body].0 += impulse;
            given[body].1 += cross(contact.point - bodies[body].centre, impulse);
        }
    }
    given
}

/// Impulses times velocities, in J: body by body, not contact by contact.
///
/// What a light body between heavy ones is given nearly cancels, while the rounding of its velocity is
/// that of each part: times one contact's impulse it is as much as heavy bodies lose.
pub(super) fn power(bodies: &[ImpactBody], given: &[(Vec2, f64)]) -> f64 {
    let each = bodies.iter().zip(given);
    each.map(|(body, (impulse, turn))| impulse.dot(body.velocity) + turn * body.spin)
        .sum()
}

/// ±J of a contact, given along its normal and its tangent.
pub(super) fn push(bodies: &mut [ImpactBody], shared: &SharedContact, (n, t): (f64, f64)) {
    if n == 0.0 && t == 0.0 {
        return;
    }
    let contact = &shared.contact;
    let impulse = contact.normal * n + perp(contact.normal) * t;
    bodies[shared.a] = bodies[shared.a].pushed(-impulse, contact.point);
    bodies[shared.b] = bodies[shared.b].pushed(impulse, contact.point);
}
