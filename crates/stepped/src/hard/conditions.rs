//! Whether impulses are an answer: those of the last sub-step are at rest, and in even motion.

use carom_impact::ImpactBody;
use carom_math::Vec2;

use super::solve::Island;
use crate::LineIx;
use crate::bodies::Bodies;
use crate::rows::{Graph, Law, quotient};

/// Speed that counts as 0, as a part of the fastest along a row before contacts act: ten times what a solve leaves at most, so that
/// at rest there is one solve.
const ANSWERED: f64 = 1e-9;

/// The same where sweeps go on from these impulses, and come ten times as near: with [`ANSWERED`] heaps of discs gained up to 1.4e-11 of
/// their energy in a tick, with this 5e-16.
const SWEPT: f64 = 1e-13;

/// Roundings of the velocities of both bodies of a row.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// A friction impulse this near to its limit, as a part of it, is there.
const LIMIT: f64 = 1e-9;

/// Speed that counts as 0 where all is at rest, in m/s.
pub(super) fn rest(island: &Island, law: &Law, graph: &Graph) -> f64 {
    let mut fastest = 0.0_f64;
    for contact in &island.contacts {
        let (block, _, lane) = graph.lane(contact.id);
        let free = contact.ends.map(|end| &island.bodies[end]);
        let [a, b] = free.map(|body| (body.velocity, body.spin));
        let opens = block.along(lane, a, b);
        for (opens, gap) in opens.iter().zip(contact.gaps).take(contact.points) {
            fastest = fastest.max((opens - island.closes(law, gap)).abs());
        }
    }
    let part = if island.is_swept { SWEPT } else { ANSWERED };
    part * fastest
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
        let (block, _, lane) = graph.lane(contact.id);
        let opens = block.opening(lane, &bodies.lines);
        let [j1, j2, jt] = block.impulses(lane);
        let impulse = j1.abs() + j2.abs() + jt.abs();
        let sizes = contact.ends.map(|end| {
            let line = &bodies.lines[island.lines[end]];
            line.v().length() + impulse * line.inverse_mass()
        });
        let zero = rest + ROUNDINGS * (sizes[0] + sizes[1]);
        let holds = |point: usize| {
            let left = opens[point] - island.closes(law, contact.gaps[point]);
            left.abs() <= zero || left > 0.0 && [j1, j2][point] <= 0.0
        };
        let limit = block.mu[lane] * (j1 + j2);
        let slip = block.slip(lane, &bodies.lines) - contact.belt;
        let rubs = jt.abs() <= limit * (1.0 + LIMIT);
        let sticks = slip.abs() <= zero;
        let slides = jt * slip <= 0.0 && jt.abs() >= limit * (1.0 - LIMIT);
        (0..contact.points).all(holds) && rubs && (sticks || slides)
    })
}

/// Whether what was before, and what drives the island, can give such velocities. Bodies that are squeezed so that nothing holds them
/// seem held by impulses so large that their rounding is more than the speeds that were asked for, or leave a wedge of 1e-12 rad at
/// 1e12 times the speed that closes it.
///
/// ```text
/// what cannot be moved goes as one, u: j·(J (v' − u)) ≤ 0, so with w = v − u and w' = w + M⁻¹ Jᵀ j        w'ᵀ M w' ≤ wᵀ M w
/// in several ways, or as belts:        a stop mixes velocities, so max s' ≤ max s + h max |pull|        s² = v² + k² ω²
/// ```
/// The second counts what bodies would have that move along with drivers, too: at rest on one, h |pull| is all that they have besides.
/// It is exact along a line, and of one body on one driver; levers and wedges that drivers move go faster, and take soft rows. The speed
/// of belts is added: what moves may carry one.
pub(super) fn justified(island: &Island, bodies: &Bodies) -> bool {
    let belts = island.contacts.iter().map(|contact| contact.belt.abs());
    let belt = belts.fold(0.0, f64::max);
    match carrier(island, bodies) {
        Some(carrier) if belt <= 0.0 => gains_nothing(island, bodies, &carrier),
        _ => none_is_faster(island, bodies, belt),
    }
}

/// Whether the kinetic energy is no more than before, seen from a body.
fn gains_nothing(island: &Island, bodies: &Bodies, from: &ImpactBody) -> bool {
    let (mut before, mut after, mut carried) = (0.0, 0.0, 0.0);
    for (line, body) in island.moved() {
        let (mass, now) = (body.inverse_mass.recip(), &bodies.lines[line]);
        let along = from.velocity_of(bodies.centre_at(line));
        let was = square(body, body.velocity - along, body.spin - from.spin);
        let is = square(body, now.v() - along, now.w() - from.spin);
        (before, after) = (before + mass * was, after + mass * is);
        carried += mass * square(body, along, from.spin);
    }
    after <= (1.0 + ANSWERED) * before + ROUNDINGS * ROUNDINGS * carried
}

/// Whether no body is faster than the fastest one was, or would be along with what moves it.
fn none_is_faster(island: &Island, bodies: &Bodies, belt: f64) -> bool {
    let (mut fastest, mut fastest_after) = (0.0_f64, 0.0_f64);
    for (line, body) in island.moved() {
        let now = &bodies.lines[line];
        fastest = fastest.max(square(body, body.velocity, body.spin));
        fastest_after = fastest_after.max(square(body, now.v(), now.w()));
    }
    for driver in unmoved(island, bodies) {
        let along = |(line, body): (LineIx, &ImpactBody)| {
            let velocity = driver.velocity_of(bodies.centre_at(line));
            square(body, velocity, driver.spin)
        };
        fastest = island.moved().map(along).fold(fastest, f64::max);
    }
    let most = fastest.sqrt() + belt + island.pulled;
    fastest_after.sqrt() <= (1.0 + ANSWERED) * most
}

/// The bodies of an island that cannot be moved, where they are.
fn unmoved<'i>(island: &'i Island, bodies: &'i Bodies) -> impl Iterator<Item = ImpactBody> + 'i {
    let lines = island.lines.iter().zip(&island.bodies);
    let unmoved = lines.filter(|(_, body)| body.inverse_mass <= 0.0);
    unmoved.map(|(&line, body)| {
        ImpactBody::immovable(bodies.centre_at(line), body.velocity, body.spin)
    })
}

/// A body that moves as all do that cannot be moved, if these have one motion in common.
fn carrier(island: &Island, bodies: &Bodies) -> Option<ImpactBody> {
    let mut unmoved = unmoved(island, bodies);
    let still = ImpactBody::immovable(Vec2::ZERO, Vec2::ZERO, 0.0);
    let first = unmoved.next().unwrap_or(still);
    let is_same = |other: ImpactBody| {
        (other.spin - first.spin).abs() <= 0.0 && other.velocity == first.velocity_of(other.centre)
    };
    unmoved.all(is_same).then_some(first)
}

/// Twice the kinetic energy of a body, as a part of its mass, in m²/s².
pub(super) fn square(body: &ImpactBody, velocity: Vec2, spin: f64) -> f64 {
    let turning = quotient(body.inverse_mass, body.inverse_inertia);
    velocity.length_squared() + turning * spin * spin
}
