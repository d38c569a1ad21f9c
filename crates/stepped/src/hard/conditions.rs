//! Whether impulses are an answer: those of the last sub-step are at rest, and in even motion.

use carom_impact::ImpactBody;
use carom_math::{Vec2, perp};

use super::solve::{Island, lane_of};
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
            fastest = fastest.max((opens - island.closes(law, gap)).abs());
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
            let left = opens[point] - island.closes(law, contact.gaps[point]);
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

/// A rigid motion.
struct Carrier {
    centre: Vec2,
    velocity: Vec2,
    spin: f64,
}

impl Carrier {
    const STILL: Self = Self {
        centre: Vec2::ZERO,
        velocity: Vec2::ZERO,
        spin: 0.0,
    };

    fn at(&self, point: Vec2) -> Vec2 {
        self.velocity + perp(point - self.centre) * self.spin
    }
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
    let carrier = carrier(island, bodies).filter(|_| belt <= 0.0);
    let still = Carrier::STILL;
    let from = carrier.as_ref().unwrap_or(&still);
    let (mut before, mut after, mut carried) = (0.0, 0.0, 0.0);
    let (mut fastest, mut fastest_after) = (0.0_f64, 0.0_f64);
    let mut drives = 0.0_f64;
    for (&line, body) in island.lines.iter().zip(&island.bodies) {
        if body.inverse_mass > 0.0 {
            let (mass, now) = (body.inverse_mass.recip(), &bodies.lines[line as usize]);
            let along = from.at(centre(bodies, line));
            let was = square(body, body.velocity - along, body.spin - from.spin);
            let is = square(body, now.v() - along, now.w() - from.spin);
            (before, after) = (before + mass * was, after + mass * is);
            carried += mass * square(body, along, from.spin);
            (fastest, fastest_after) = (fastest.max(was), fastest_after.max(is));
        } else if body.velocity != Vec2::ZERO || body.spin.abs() > 0.0 {
            drives = drives.max(carries(island, bodies, (line, body)));
        }
    }
    if carrier.is_some() {
        after <= (1.0 + ANSWERED) * before + ROUNDINGS * ROUNDINGS * carried
    } else {
        let most = fastest.max(drives).sqrt() + belt + island.pulled;
        fastest_after.sqrt() <= (1.0 + ANSWERED) * most
    }
}

/// The motion of all bodies of an island that cannot be moved, if they have one in common.
fn carrier(island: &Island, bodies: &Bodies) -> Option<Carrier> {
    let lines = island.lines.iter().zip(&island.bodies);
    let unmoved = lines.filter(|(_, body)| body.inverse_mass <= 0.0);
    let mut motions = unmoved.map(|(&line, body)| Carrier {
        centre: centre(bodies, line),
        velocity: body.velocity,
        spin: body.spin,
    });
    let first = motions.next().unwrap_or(Carrier::STILL);
    let is_same = |other: Carrier| {
        (other.spin - first.spin).abs() <= 0.0 && other.velocity == first.at(other.centre)
    };
    motions.all(is_same).then_some(first)
}

/// Where the centre of mass of a body is.
fn centre(bodies: &Bodies, line: u32) -> Vec2 {
    bodies.base[line as usize].position + bodies.lines[line as usize].d()
}

/// Twice the kinetic energy of a body, as a part of its mass, in m²/s².
fn square(body: &ImpactBody, velocity: Vec2, spin: f64) -> f64 {
    let turns = if body.inverse_inertia > 0.0 {
        body.inverse_mass / body.inverse_inertia * spin * spin
    } else {
        0.0
    };
    velocity.length_squared() + turns
}

/// The largest [`square`] of a body of the island that moves along with a kinematic one.
fn carries(island: &Island, bodies: &Bodies, (line, driver): (u32, &ImpactBody)) -> f64 {
    let driver = Carrier {
        centre: centre(bodies, line),
        velocity: driver.velocity,
        spin: driver.spin,
    };
    let of = |(&other, body): (&u32, &ImpactBody)| {
        if body.inverse_mass > 0.0 {
            square(body, driver.at(centre(bodies, other)), driver.spin)
        } else {
            0.0
        }
    };
    island
        .lines
        .iter()
        .zip(&island.bodies)
        .map(of)
        .fold(0.0, f64::max)
}
