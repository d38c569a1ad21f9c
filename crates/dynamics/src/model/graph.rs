//! Which bodies touch, and which hang together.

use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;

/// An island of more rows (points, and a friction for each touch) than this has no closed form: it is the engine's.
pub(crate) const ROWS: usize = 64;

/// Bodies that touch a body.
pub(crate) fn neighbours<'a>(
    bodies: &'a Bodies,
    pairs: &'a Pairs,
    index: u32,
) -> impl Iterator<Item = u32> + use<'a> {
    bodies.get(index).pairs.iter().filter_map(move |&place| {
        let pair = pairs.get(place);
        pair.touching.then(|| pair.other(index))
    })
}

/// Whether two shapes touch in an island in analytic motion: their contact changes with the island's mode alone.
pub(crate) fn touch_in_moving_island(
    bodies: &Bodies,
    pairs: &Pairs,
    (a, b): (u32, u32),
    shapes: (u32, u32),
) -> bool {
    let moves_analytically = |index: &u32| bodies.get(*index).moves_analytically();
    let Some(index) = [a, b].into_iter().find(moves_analytically) else {
        return false;
    };
    // Other pairs it has with bodies that are stepped alone.
    let (first, second) = shapes;
    let mut places = bodies.get(index).pairs.iter();
    places.any(|place| {
        let colliders = pairs.get(*place).colliders;
        colliders == (first, second) || colliders == (second, first)
    })
}
