//! Contacts that are held: what opens at a given speed at least, against Coulomb's friction, by a common stop.

use super::body::ImpactBody;
use super::coulomb::{Stop, stop};
use super::rows::{Bound, Rows, contact_rows};
use super::several::SharedContact;

/// What holds contacts.
#[derive(Clone, Debug)]
pub struct Held {
    /// The bodies after it, in their order.
    pub bodies: Vec<ImpactBody>,
    /// Impulses on B along the normal and along the normal turned by +90 degrees, for each contact, in N·s.
    pub impulses: Vec<(f64, f64)>,
    /// Whether all of it holds: bodies may be squeezed so that nothing meets all conditions.
    pub sure: bool,
}

/// The least impulses after which every contact opens by what is `asked` of it at least, and slips by what is asked of it
/// if friction can do it; both in m/s.
pub fn held(bodies: &[ImpactBody], contacts: &[SharedContact], asked: &[(f64, f64)]) -> Held {
    let mut rows = Rows::new(bodies, contact_rows(bodies, contacts));
    let mut of = asked.iter();
    let mut slip = 0.0;
    let mut wanted = Vec::with_capacity(rows.len());
    for row in &rows.rows {
        wanted.push(match row.bound {
            Bound::Push => {
                let (opening, along) = of.next().copied().unwrap_or_default();
                slip = along;
                opening
            }
            Bound::Friction(..) | Bound::Limit(_) => slip,
        });
    }
    rows.ask(&wanted);
    let Stop {
        impulses: found,
        sure,
        ..
    } = stop(&rows);
    let mut after = bodies.to_vec();
    let mut impulses: Vec<(f64, f64)> = Vec::with_capacity(contacts.len());
    for (row, impulse) in rows.rows.iter().zip(found) {
        row.push(&mut after, impulse);
        match (row.bound, impulses.last_mut()) {
            (Bound::Friction(..), Some(last)) => last.1 = impulse,
            _ => impulses.push((impulse, 0.0)),
        }
    }
    Held {
        bodies: after,
        impulses,
        sure,
    }
}
