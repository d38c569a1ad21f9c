//! Which bodies touch, and which hang together.

use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::{BodyIx, ColliderIx, PairIx, Two};

/// Bodies that touch a body.
pub(crate) fn neighbours<'a>(
    bodies: &'a Bodies,
    pairs: &'a Pairs,
    index: BodyIx,
) -> impl Iterator<Item = BodyIx> + use<'a> {
    bodies.get(index).pairs.iter().filter_map(move |&place| {
        let pair = pairs.get(place);
        pair.touching.then(|| pair.other(index))
    })
}

/// The pair of two shapes, of which the first body has one, whichever comes first in it.
pub(crate) fn pair_of(
    bodies: &Bodies,
    pairs: &Pairs,
    index: BodyIx,
    (first, second): Two<ColliderIx>,
) -> Option<PairIx> {
    let mut places = bodies.get(index).pairs.iter().copied();
    places.find(|place| {
        let known = pairs.get(*place).colliders;
        known == (first, second) || known == (second, first)
    })
}
