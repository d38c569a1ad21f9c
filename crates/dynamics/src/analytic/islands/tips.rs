//! Groups that turn about their contacts: which shapes touch, and which bodies the path moves.

use arrayvec::ArrayVec;
use carom_math::SimTime;

use super::joints::{Held, joint};
use crate::analytic::modes::NotMine;
use crate::analytic::tipping::{Contact, Joint, Tip, tip};
use crate::analytic::touching::Gathered;
use crate::law::path::Place;
use crate::model::graph::pair_of;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pairs;
use crate::store::state::BodyState;
use crate::{ColliderIx, Mode};

/// A corner this near to a point of contact is what touches there, as a part of the smaller reach.
const NEAR: f64 = 1e-6;

/// Bodies that move in a group that turns: more are the solver's.
const MOST: usize = 4;

/// The same where the engine takes what has no path: a path of several bodies takes 120 µs for a 30th of a second, the engine 7 µs
/// (1,000 seesaws: 15.8 and 4.5 ms a step, and 255 and 8 the worst one).
const MOST_BESIDE_ENGINE: usize = 1;

/// The path that its contacts leave a group.
pub(crate) fn path_of(
    bodies: &Bodies,
    pairs: &Pairs,
    gathered: &Gathered,
    (time, speed): (SimTime, f64),
) -> Result<Tip, NotMine> {
    let contacts = joints(bodies, pairs, gathered, time).ok_or(NotMine::Curved)?;
    let both = gathered.places.iter().zip(&gathered.bodies);
    let (mut places, mut reaches) = (Vec::new(), Vec::new());
    for (&index, body) in both {
        let state = bodies.get(index);
        places.push(Place {
            centre: body.centre,
            rotation: state.rotation_at(time),
            velocity: body.velocity,
            spin: body.spin,
        });
        reaches.push(if body.inverse_mass > 0.0 {
            state.reach
        } else {
            0.0
        });
    }
    tip(
        gathered.bodies.clone(),
        gathered.pulls.clone(),
        places,
        reaches,
        contacts,
        time,
        speed,
    )
}

/// Whether so many bodies turn that they have no path. Touches that are new are in `gathered` alone.
pub(crate) fn is_too_large(gathered: &Gathered, mode: Mode) -> bool {
    let moving = gathered.dynamic();
    let is_borne = moving.len() < gathered.places.len();
    moving.len() > MOST || moving.len() > MOST_BESIDE_ENGINE && mode == Mode::Hybrid && is_borne
}

/// What touches what in every contact of a group; `None` where two corners meet.
fn joints(
    bodies: &Bodies,
    pairs: &Pairs,
    gathered: &Gathered,
    time: SimTime,
) -> Option<Vec<Contact>> {
    let all = gathered.pairs.iter().zip(&gathered.touches);
    all.map(|(&(place, number), touch)| {
        let pair = pairs.get(place);
        let (a, b) = bodies.both(pair.bodies);
        let parts = pair.contacts.get(number)?.parts;
        let side = |k: usize, state: &BodyState, own: ColliderIx, other: ColliderIx, part: u32| {
            let meets = |at: &&ColliderIx| {
                **at == own || pair_of(bodies, pairs, state.id.index, (**at, other)).is_some()
            };
            let met = state.colliders.iter().filter(meets);
            Held {
                hull: bodies.hull(own, part),
                shape: &bodies.colliders[own].solid,
                shapes: met.map(|at| &*bodies.colliders[*at].solid).collect(),
                pose: state.centre_pose(time),
                moves: gathered.bodies[k],
            }
        };
        let (first, second) = pair.colliders;
        let ends = (
            side(touch.bodies.0, a, first, second, parts.0),
            side(touch.bodies.1, b, second, first, parts.1),
        );
        let near = NEAR * a.reach.min(b.reach);
        let joints: Option<ArrayVec<Joint, 2>> = touch
            .points
            .iter()
            .map(|point| {
                joint(
                    &ends.0,
                    &ends.1,
                    touch.normal,
                    *point,
                    touch.points.len(),
                    near,
                )
            })
            .collect();
        Some(Contact {
            bodies: touch.bodies,
            joints: joints?,
            friction: touch.friction,
        })
    })
    .collect()
}
