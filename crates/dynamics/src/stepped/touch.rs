//! What touches, as callers see it: begins, ends, and contacts read from the rows.
//!
//! Two stepped bodies touch while a row of theirs pushes.

use carom_math::{SimTime, perp};

use super::Stepped;
use crate::bodies::Bodies;
use crate::pairs::Pair;
use crate::{Contact, ContactPoint, World};

impl World {
    /// Begins and ends of touch since this was last called.
    pub(super) fn tell_touches(&mut self, time: SimTime) {
        let mut changed = core::mem::take(&mut self.pool.changed);
        self.pool.seats.rig.lanes.turned(&mut changed);
        // Rows lie where chance put them; events come in order of pairs.
        let pairs = changed.iter().map(|id| self.pool.pair_of[id.0 as usize]);
        let mut places: Vec<u32> = pairs.collect();
        places.sort_unstable_by_key(|place| self.pairs.shapes(*place));
        places.dedup();
        for place in places {
            self.judge(place, time);
        }
        changed.clear();
        self.pool.changed = changed;
    }

    /// Whether a pair touches now, and the event if that is new.
    pub(super) fn judge(&mut self, place: u32, time: SimTime) {
        let lanes = &self.pool.seats.rig.lanes;
        let pair = self.pairs.get_mut(place);
        let rows = pair.contacts.iter().filter_map(|contact| contact.row);
        let touching = rows.into_iter().any(|id| lanes.acted(id));
        pair.touching = touching;
        self.events.tell_touch(&self.bodies, pair, time);
    }
}

impl Stepped {
    /// Contacts of a pair: from its rows where it has some.
    pub(crate) fn contacts_of(&self, bodies: &Bodies, pair: &Pair) -> Vec<Contact> {
        let mut contacts: Vec<Contact> = Contact::of(bodies, pair).collect();
        for (contact, source) in contacts.iter_mut().zip(&pair.contacts) {
            let Some(id) = source.row else {
                continue;
            };
            let row = self.seats.rig.row(id);
            let [a, b] = [row.bodies.0, row.bodies.1].map(|slot| self.seats.centre(slot));
            contact.normal = row.n;
            contact.tangent_impulse = row.jt;
            let count = source.points.len();
            contact.points.clear();
            contact.points.extend((0..count).map(|i| {
                let on_a = a + row.n * row.at - perp(row.n) * row.a[i];
                let on_b = b + row.n * row.bt - perp(row.n) * row.b[i];
                ContactPoint {
                    position: 0.5 * (on_a + on_b),
                    separation: row.gap[i],
                    normal_impulse: row.j[i],
                }
            }));
        }
        contacts
    }
}
