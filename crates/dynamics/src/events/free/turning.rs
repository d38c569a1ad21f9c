//! Bodies that turn often while they are searched for: a circle about each of them does not turn.
//!
//! Bounds on a gap's second derivative are loose over more than a turn, so that a search goes through a part of it at a
//! time. That is cheap as long as the parts are few. A body at 1e4 rad/s that flies for a day past a wall would be
//! searched for 1e8 times; the circle about it meets the wall, or does not, in one search.

use std::sync::Arc;

use carom_collision::{TimeOfImpact, shape_distance};
use carom_geometry::{Circle, Shape};
use carom_math::SimTime;

use crate::broad::window::ways_from;
use crate::motion::first_touch::first_touch;
use crate::store::bodies::Bodies;
use crate::{BodyIx, ColliderIx, Two};

/// Largest turn that one search for a time of impact goes through, in rad.
const TURN: f64 = 8.0;

/// A search in fewer pieces than this is no dearer than one more for the circles.
const PIECES: f64 = 8.0;

/// Circles about bodies are this much larger, so that rounding is outside of them.
const RIM: f64 = 1.0 + 1.0 / (1_u64 << 20) as f64;

/// What a search of `length` seconds for a pair begins with, in seconds from `time`: up to the first value nothing
/// touches; where that is 0, the search goes up to the second.
pub(super) fn first_piece(
    bodies: &Bodies,
    pair: Two<BodyIx>,
    time: SimTime,
    length: f64,
) -> (f64, f64) {
    let piece = length_by_turn(bodies, pair, time, length);
    if length / piece >= PIECES {
        let apart = apart_however_turned(bodies, pair, time, length);
        if apart > piece {
            return (apart, piece);
        }
    }
    (0.0, piece)
}

/// As much of `length` seconds as the bodies of a pair turn by at most [`TURN`] in.
fn length_by_turn(bodies: &Bodies, (a, b): Two<BodyIx>, time: SimTime, length: f64) -> f64 {
    let spin = |index: BodyIx| {
        let motion = &bodies.get(index).motion;
        motion.spin_at(time).abs() + motion.angular_acceleration.abs() * length
    };
    if length * (spin(a) + spin(b)) <= TURN {
        return length;
    }
    let seen = |index: BodyIx| {
        if bodies.get(index).turns_in_place(&bodies.colliders) {
            0.0
        } else {
            spin(index)
        }
    };
    length.min(TURN / (seen(a) + seen(b)))
}

/// How long two bodies surely do not touch, at most `length` seconds, whatever those of them turn by that turn by more
/// than [`TURN`] in it: the circles about these have not met the other one by then.
fn apart_however_turned(bodies: &Bodies, (a, b): Two<BodyIx>, time: SimTime, length: f64) -> f64 {
    let (one, two) = (bodies.get(a), bodies.get(b));
    let (of_one, of_two) = (
        shapes_however_turned(bodies, a, time, length),
        shapes_however_turned(bodies, b, time, length),
    );
    let seen = two.centre_pose(time).seen_from(one.centre_pose(time));
    let mut first = length;
    for first_shape in &of_one {
        for second_shape in &of_two {
            // Circles that overlap may part, and their bodies strike all the same.
            if shape_distance(first_shape, second_shape, seen).distance <= 0.0 {
                return 0.0;
            }
            let shapes: [&Shape; 2] = [first_shape, second_shape];
            let next = first_touch([one, two], shapes, (time, first), ways_from(time), None);
            first = match next {
                TimeOfImpact::Clear => first,
                TimeOfImpact::Hit(impact) => first.min(impact.time),
                TimeOfImpact::Touching(_) => return 0.0,
                TimeOfImpact::Unresolved { safe_until } => first.min(safe_until),
            };
        }
    }
    first
}

/// The shapes of a body about its centre; the one circle about them, where it turns by more than [`TURN`].
fn shapes_however_turned(
    bodies: &Bodies,
    index: BodyIx,
    time: SimTime,
    length: f64,
) -> Vec<Arc<Shape>> {
    let state = bodies.get(index);
    let motion = &state.motion;
    let spin = motion.spin_at(time).abs() + motion.angular_acceleration.abs() * length;
    let about = state.reach * RIM + motion.left_out;
    match Circle::new(about) {
        Ok(circle) if spin * length > TURN => vec![Arc::new(circle.into())],
        _ => {
            let solid = |at: &ColliderIx| Arc::clone(&bodies.colliders[*at].solid);
            state.colliders.iter().map(solid).collect()
        }
    }
}
