//! The energy of bounces: bodies that bounce together leave with no more than they came with.
//!
//! Restitution sets speeds along normals, and friction acts at the same points: both together may give more than the blow took
//! (Kane's example: a rod that strikes the ground aslant). Then the impulses of all points that hang together by bodies are
//! made smaller by one factor.

use carom_math::Vec2;

use super::bounce::Bounce;
use super::line::{Line, Quad, quotient};
use super::restitution::Arrival;
use crate::LineIx;
use crate::bodies::Bodies;
use crate::groups::Groups;

/// What came out of rounding is no gain, as a part of the energy.
const ROUNDING: f64 = 1e-13;

/// A body before it bounced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Before {
    line: LineIx,
    /// Kinetic energy before the sub-step, in J.
    kinetic: f64,
    d: Quad,
}

/// Notes the bodies of all arrivals, once the warm start acts and before anything is solved for.
pub(crate) fn note(bodies: &Bodies, lines: &[[LineIx; 2]], h: f64, before: &mut Vec<Before>) {
    before.clear();
    let mut all: Vec<LineIx> = lines.iter().flatten().copied().collect();
    all.sort_unstable();
    all.dedup();
    for line in all {
        let body = &bodies.lines[line];
        before.push(Before {
            line,
            kinetic: kinetic(body, bodies.velocity_before(line, h)),
            d: body.displacement(),
        });
    }
}

/// Where those two bodies of each arrival are in `before` that contacts move.
pub(super) fn places(bodies: &Bodies, arrived: &[Arrival], before: &[Before]) -> Vec<Places> {
    let place = |line: LineIx| {
        let is_moved = bodies.lines[line].inverse_mass() > 0.0;
        is_moved.then(|| place(before, line)).flatten()
    };
    let places = arrived.iter().map(|arrival| arrival.lines.map(place));
    places.collect()
}

pub(super) type Places = [Option<usize>; 2];

/// Makes bounces smaller that leave their bodies with more energy than these had.
pub(super) fn keep(
    bodies: &mut Bodies,
    arrived: &mut [Arrival],
    bounces: &[Bounce],
    (before, places): (&[Before], &[Places]),
) {
    // Points are one group that share a body which can be moved.
    let mut groups = Groups::new(arrived.len());
    let mut first = vec![usize::MAX; before.len()];
    for (k, places) in places.iter().enumerate() {
        for &at in places.iter().flatten() {
            if first[at] == usize::MAX {
                first[at] = k;
            }
            groups.join(first[at], k);
        }
    }
    let mut pushed = Vec::with_capacity(2 * arrived.len());
    for (k, (arrival, bounce)) in arrived.iter().zip(bounces).enumerate() {
        let group = groups.find(k);
        let pushes = bounce.pushes(arrival.impulses);
        for (line, push) in arrival.lines.into_iter().zip(pushes) {
            let birth = bodies.birth_of_line(line);
            pushed.push(Pushed {
                group,
                birth,
                line,
                push,
            });
        }
    }
    // A body's pushes are added up in the order of the arrivals.
    pushed.sort_by_key(|pushed| (pushed.group, pushed.birth, pushed.line));
    pushed.dedup_by(|next, pushed| {
        let same = (next.group, next.line) == (pushed.group, pushed.line);
        if same {
            pushed.push.add(&next.push);
        }
        same
    });
    let mut back = vec![0.0; arrived.len()];
    for group in pushed.chunk_by(|a, b| a.group == b.group) {
        let r = excess(bodies, group, before);
        if r > 0.0 {
            back[group[0].group] = r;
            for pushed in group {
                let back = Quad(pushed.push.0.map(|x| -r * x));
                bodies.push(pushed.line, &back);
            }
        }
    }
    for (k, arrival) in arrived.iter_mut().enumerate() {
        let kept = 1.0 - back[groups.find(k)];
        arrival.impulses = arrival.impulses.map(|impulse| impulse * kept);
    }
}

/// What the bounces of a group add to the velocity of a body.
#[derive(Clone, Copy, Debug)]
struct Pushed {
    group: usize,
    birth: u64,
    line: LineIx,
    push: Quad,
}

fn place(before: &[Before], line: LineIx) -> Option<usize> {
    before
        .binary_search_by_key(&line, |before| before.line)
        .ok()
}

/// What part of its bounces a group must give back: sums over its bodies in the order of their births, since lines depend on
/// other islands.
fn excess(bodies: &Bodies, group: &[Pushed], before: &[Before]) -> f64 {
    let (mut had, mut has, mut mixed, mut square) = (0.0, 0.0, 0.0, 0.0);
    for &Pushed { line, push, .. } in group {
        let body = &bodies.lines[line];
        if body.inverse_mass() <= 0.0 {
            // Whatever drives a body may give energy.
            if body.v() != Vec2::ZERO || body.w().abs() > 0.0 {
                return 0.0;
            }
            continue;
        }
        let Some(known) = place(before, line) else {
            return 0.0;
        };
        let came = &before[known];
        let mass = body.inverse_mass().recip();
        let turning = |x: f64| quotient(x, body.inverse_inertia());
        // What the pull did on the way of this sub-step.
        let fell = mass * bodies.pull[line].v().dot(body.d() - came.d.v());
        had += came.kinetic + fell;
        has += kinetic(body, (body.v(), body.w()));
        mixed += mass * push.v().dot(body.v()) + turning(push.w() * body.w());
        square += 0.5 * (mass * push.v().length_squared() + turning(push.w() * push.w()));
    }
    let more = has - had;
    if more <= ROUNDING * (has + had.abs()) || square <= 0.0 {
        return 0.0;
    }
    // E − r B + r² A is what they had.
    let root = mixed * mixed - 4.0 * square * more;
    let r = if root > 0.0 {
        (mixed - root.sqrt()) / (2.0 * square)
    } else {
        mixed / (2.0 * square)
    };
    r.clamp(0.0, 1.0)
}

fn kinetic(body: &Line, (v, w): (Vec2, f64)) -> f64 {
    let straight = quotient(v.length_squared(), body.inverse_mass());
    0.5 * (straight + quotient(w * w, body.inverse_inertia()))
}
