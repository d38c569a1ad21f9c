//! Pairs that last, of bodies that wait within a sub-step for the method that holds them, and pairs that overlap.
//!
//! What waits goes on as it did: it may turn or be struck into what it touches. So such a pair is followed until the sub-step ends, and
//! struck where it sinks in.
//!
//! So is one that is let go while it still overlaps: the search for its next impact begins within both shapes. Where the
//! nearest way out of a piece is a cut, what comes in there has touched another piece before, by that search; but it began
//! behind both, and a corner in the seam of two pieces would leave through the wall.

use arrayvec::ArrayVec;
use carom_collision::Impact;
use carom_math::{SimTime, Vec2};

use crate::model::narrow::{Narrow, opening_speed, strikes_with};
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, PairContact};
use crate::store::state::{BodyState, Collider};

/// How far a held pair may sink in within a sub-step, as a part of the smaller reach: the linear plan is off by as much
/// where a body turns by 1/11 rad, which is 32 rad/s at 1/360 s.
const DEPTH: f64 = 1.0 / 256.0;

/// The same beyond that, and for what is as deep already: with a sixteenth for the quarter 3 s beside a ring at
/// 12 rad/s take six times as long.
const MORE: f64 = DEPTH / 4.0;

/// Looks at a pair in a sub-step.
const LOOKS: u32 = 64;

/// Halves of a step before what is deeper by more than [`MORE`] is struck where it is: 2000 m/s at 1/360 s are 87 mm a look.
const HALVES: u32 = 12;

/// The first instant within `horizon` seconds from `time` at which a pair is deeper in than [`DEPTH`], and than now, by [`MORE`],
/// and sinks in faster than `rest`, in m/s. Its contacts are those of `time`.
pub(crate) fn sinks_in(
    bodies: &Bodies,
    colliders: &[Collider],
    narrow: &mut Narrow,
    pair: &Pair,
    (time, horizon, rest): (SimTime, f64, f64),
) -> Option<Impact> {
    let (a, b) = (bodies.get(pair.bodies.0), bodies.get(pair.bodies.1));
    let size = a.reach.min(b.reach);
    let deep = pair.contacts.iter().map(depth).fold(DEPTH * size, f64::max);
    let allowed = deep + MORE * size;
    let mut wait = 0.0;
    let mut seen = None;
    for _ in 0..LOOKS {
        let contacts: &[PairContact] = seen.as_deref().unwrap_or(&pair.contacts);
        let left = horizon - wait;
        let room = |contact: &PairContact| {
            let speed = fastest([a, b], colliders, contact.normal, time + wait, left);
            (allowed - depth(contact)) / speed
        };
        // A speed of 0 has all the room there is, and so has a pair without contacts.
        let room = contacts.iter().map(room).fold(f64::INFINITY, f64::min);
        let least = horizon / f64::from(LOOKS);
        let before = wait;
        wait += if room > least { room } else { least };
        if wait >= horizon {
            return None;
        }
        let mut look = |wait: f64| {
            let found = narrow.contacts(bodies, colliders, pair, time + wait, horizon - wait);
            let sunk = |contact: &PairContact| {
                let closes =
                    |point| opening_speed(a, b, time + wait, point, contact.normal) < -rest;
                depth(contact) >= allowed && contact.points.iter().any(|p| closes(p.position))
            };
            let sunk = found.iter().position(sunk);
            (found, sunk)
        };
        let (mut found, mut sunk) = look(wait);
        // The least step of what is fast may be a long way.
        let (mut low, too_deep) = (before, allowed + MORE * size);
        for _ in 0..HALVES {
            if sunk.is_none_or(|k| depth(&found[k]) <= too_deep) {
                break;
            }
            let middle = 0.5 * (low + wait);
            match look(middle) {
                (earlier, Some(k)) => (wait, found, sunk) = (middle, earlier, Some(k)),
                _ => low = middle,
            }
        }
        if let Some(k) = sunk {
            let contact = &found[k];
            return Some(strikes(contact, wait, |p| {
                opening_speed(a, b, time + wait, p, contact.normal)
            }));
        }
        seen = Some(found);
    }
    None
}

/// How deep a contact is, in m; below 0 it is a gap.
fn depth(contact: &PairContact) -> f64 {
    let points = contact.points.iter().map(|point| -point.separation);
    points.fold(f64::NEG_INFINITY, f64::max)
}

/// Fastest that two shapes may come closer along a normal within `left` seconds from `time`, in m/s.
fn fastest(
    bodies: [&BodyState; 2],
    colliders: &[Collider],
    normal: Vec2,
    time: SimTime,
    left: f64,
) -> f64 {
    let [a, b] = bodies.map(|state| state.at(time));
    let along = (a.velocity - b.velocity).dot(normal).max(0.0);
    let pull = (a.acceleration - b.acceleration).length();
    let rim = |k: usize| {
        let motion = [&a, &b][k];
        let spin = motion.spin.abs() + motion.angular_acceleration.abs() * left;
        // A half-plane has no end, and does not turn.
        if spin > 0.0 && !bodies[k].turns_in_place(colliders) {
            spin * bodies[k].reach
        } else {
            0.0
        }
    };
    along + pull * left + rim(0) + rim(1)
}

/// The impact of a contact, at all of its points that overlap.
fn strikes(contact: &PairContact, time: f64, rate: impl Fn(Vec2) -> f64) -> Impact {
    let inside = contact.points.iter().filter(|p| p.separation <= 0.0);
    let mut impact = Impact {
        time,
        normal: contact.normal,
        points: ArrayVec::new(),
        features: ArrayVec::new(),
        gap_rate: 0.0,
    };
    for point in inside {
        impact.points.push(point.position);
        impact.features.push(strikes_with(contact.parts, point));
        impact.gap_rate = impact.gap_rate.min(rate(point.position));
    }
    impact
}
