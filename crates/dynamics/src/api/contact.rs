//! Contacts of a pair as a caller reads them.

use crate::store::bodies::Bodies;
use crate::store::pairs::Pair;
use crate::{Contact, ContactPoint};

impl Contact {
    pub(crate) fn of<'a>(
        bodies: &'a Bodies,
        pair: &'a Pair,
    ) -> impl Iterator<Item = Self> + use<'a> {
        pair.contacts.iter().map(|contact| Self {
            a: bodies.get(pair.bodies.0).id,
            b: bodies.get(pair.bodies.1).id,
            normal: contact.normal,
            points: contact
                .points
                .iter()
                .map(|point| ContactPoint {
                    position: point.position,
                    separation: point.separation,
                    normal_impulse: point.impulse,
                })
                .collect(),
            tangent_impulse: contact.tangent_impulse,
        })
    }
}
