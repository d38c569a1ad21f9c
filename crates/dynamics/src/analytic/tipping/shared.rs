//! Corners of several bodies in one place, as at the tip between two segments: what turns about one turns about all.

use carom_math::Vec2;

use super::{Contact, Hold, Tangent};
use crate::law::path::Place;

/// Corners this near to each other are in one place, as a part of the smallest reach.
const SAME: f64 = 1e-9;

/// A corner of a body that stands, in touch with another body.
struct Corner {
    /// In m.
    at: Vec2,
    /// The other body, and what of it touches the corner.
    by: (usize, Vec2, f64),
}

/// Of corners in one place that one body turns about the first has the forces, since rows of the others depend on its own. What ends
/// one of them ends the mode. `size`: the smallest reach, in m.
pub(super) fn share_corners(contacts: &[Contact], places: &[Place], size: f64, holds: &mut [Hold]) {
    let corners: Vec<_> = contacts.iter().map(|of| corner(of, places)).collect();
    for k in 1..contacts.len() {
        let is_same = |other: &Option<Corner>| match (other, &corners[k]) {
            (Some(one), Some(two)) => one.by == two.by && (one.at - two.at).length() <= SAME * size,
            _ => false,
        };
        let Some(first) = corners[..k].iter().position(is_same) else {
            continue;
        };
        if holds[k].closed[0] && (!holds[first].closed[0] || holds[k].rub == Tangent::Holds) {
            holds[first] = holds[k];
        }
        if holds[first].closed[0] {
            holds[k] = Hold {
                closed: [false; 2],
                over: [true; 2],
                shares: Some(first),
                ..holds[first]
            };
        }
    }
}

/// The corner of a contact at one point, if it stands.
fn corner(contact: &Contact, places: &[Place]) -> Option<Corner> {
    let [joint] = &contact.joints[..] else {
        return None;
    };
    let (end, corner, by) = joint.corner()?;
    let (own, other) = end.first(contact.bodies.0, contact.bodies.1);
    let place = &places[own];
    let stands = place.velocity == Vec2::ZERO && place.spin == 0.0;
    stands.then(|| Corner {
        at: place.point(corner),
        by: (other, by.0, by.1),
    })
}
