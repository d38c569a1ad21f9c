//! Whether the impulses of the last sub-step are the answer of this one, too: at rest, and in even motion, they are.

use super::solve::{Island, closes, lane_of};
use crate::bodies::Bodies;
use crate::rows::{Graph, Law};

/// Speed that counts as 0, as a part of the fastest along a row before contacts act: ten times what a solve leaves at most, so that
/// at rest there is one solve.
const ANSWERED: f64 = 1e-9;

/// Roundings of the velocities of both bodies of a row.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// A friction impulse this near to its limit, as a part of it, is there.
const LIMIT: f64 = 1e-9;

/// Speed that counts as 0 where all is at rest, in m/s.
pub(super) fn rest(island: &Island, law: &Law, graph: &Graph) -> f64 {
    let mut fastest = 0.0_f64;
    for contact in &island.contacts {
        let (block, lane) = lane_of(graph, contact.id);
        let [a, b] = island.free(contact).map(|body| (body.velocity, body.spin));
        let opens = block.along(lane, a, b);
        for (opens, gap) in opens.iter().zip(contact.gaps).take(contact.points) {
            fastest = fastest.max((opens - closes(law, gap)).abs());
        }
    }
    ANSWERED * fastest
}

/// Whether the velocities that the warm start gave meet all conditions, to rounding.
pub(super) fn answers(
    island: &Island,
    law: &Law,
    bodies: &Bodies,
    graph: &Graph,
    rest: f64,
) -> bool {
    island.contacts.iter().all(|contact| {
        let (block, lane) = lane_of(graph, contact.id);
        let ends = island.ends(bodies, contact);
        let opens = block.opening(lane, ends[0], ends[1]);
        let [j1, j2, jt] = block.impulses(lane);
        let impulse = j1.abs() + j2.abs() + jt.abs();
        let sizes = ends.map(|end| end.v().length() + impulse * end.inverse_mass());
        let zero = rest + ROUNDINGS * (sizes[0] + sizes[1]);
        let holds = |point: usize| {
            let left = opens[point] - closes(law, contact.gaps[point]);
            left.abs() <= zero || left > 0.0 && [j1, j2][point] <= 0.0
        };
        let limit = block.mu[lane] * (j1 + j2);
        let slip = block.slip(lane, ends) - contact.belt;
        let rubs = jt.abs() <= limit * (1.0 + LIMIT);
        let sticks = slip.abs() <= zero;
        let slides = jt * slip <= 0.0 && jt.abs() >= limit * (1.0 - LIMIT);
        (0..contact.points).all(holds) && rubs && (sticks || slides)
    })
}
