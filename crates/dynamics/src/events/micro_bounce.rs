//! Micro-bounces: contacts that open so slowly that they close again before a search could see them open.
//!
//! A blow on one contact may push its bodies apart at another one, by friction, at a speed u at which what presses them
//! brings them back at once: after `2 u/a`, from a height of `u²/(2 a)`. Where that is less than what counts as touch a
//! search for its end sees rounding, and a contact taken for open would penetrate.

use arrayvec::ArrayVec;
use carom_collision::{AxisFeature, Impact, ImpactFeature};
use carom_math::SimTime;

use crate::model::approach::{Approach, approach_at};
use crate::model::narrow::TOUCH;
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, PairContact};
use crate::store::state::Collider;

/// When a contact closes that opens now, if that is by `horizon` seconds from `time` and it does not come out of touch.
pub(crate) fn micro_bounce(
    bodies: &Bodies,
    colliders: &[Collider],
    pair: &Pair,
    contact: &PairContact,
    (time, horizon, rest): (SimTime, f64, f64),
) -> Option<Impact> {
    let (a, b) = (bodies.get(pair.bodies.0), bodies.get(pair.bodies.1));
    let touch = TOUCH * a.reach.min(b.reach);
    let mut first: Option<Impact> = None;
    for point in &contact.points {
        if point.separation > touch {
            continue;
        }
        let at = (point.position, contact.normal);
        let Approach::Leaves(speed) = approach_at((a, b), at, time, rest) else {
            continue;
        };
        let press = pair
            .spot(bodies, colliders, contact, point.position)
            .press(time);
        // u t − a t²/2 from a gap g above 0: back after (u + √(u² + 2 a g))/a, from a height of u²/(2 a) + g.
        let gap = point.separation.max(0.0);
        if press <= 0.0 || 0.5 * speed * speed / press + gap > touch {
            continue;
        }
        let back = (speed * speed + 2.0 * press * gap).sqrt();
        let wait = (speed + back) / press;
        if wait > horizon || first.as_ref().is_some_and(|first| first.time <= wait) {
            continue;
        }
        let drift = 0.5 * (a.velocity_at(time) + b.velocity_at(time)) * wait;
        let (of_a, of_b) = point.feature.vertices();
        first = Some(Impact {
            time: wait,
            normal: contact.normal,
            points: ArrayVec::from_iter([point.position + drift]),
            features: ArrayVec::from_iter([ImpactFeature {
                parts: contact.parts,
                feature: AxisFeature::Vertices { a: of_a, b: of_b },
            }]),
            gap_rate: -back,
        });
    }
    first
}
