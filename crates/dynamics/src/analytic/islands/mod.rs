//! Contact groups in closed form, as a world keeps them: which bodies belong together, what moves them, what changes next.
//!
//! A group's modes are solved for where its contacts begin to last, where one of its members changes its motion, and
//! at the instant of its own next change ([`crate::islands`]). Between these it is left alone: its motions are right for
//! as long as its mode lasts. What does not qualify is the engine's.

pub(crate) mod jam;
mod joints;
pub(crate) mod mode_budget;
mod moving;
pub(crate) mod store;
pub(crate) mod tips;

use carom_math::{SimTime, Vec2, cross_scalar, perp};

use crate::BodyIx;
use crate::analytic::modes::{BodyMove, TouchMove, carrier};
use crate::analytic::touching::Gathered;
use crate::store::bodies::Bodies;
use store::Kept;

/// Gives the dynamic bodies of a group the motions of its mode; if it `accelerates` them, along parabolas: a path bends on. They are returned with
/// the versions of their motions, and the fastest speed of all, or `speed`. What their energy lacks is booked as lost in impacts.
pub(crate) fn give_motions(
    bodies: &mut Bodies,
    gathered: &Gathered,
    moves: &[BodyMove],
    (time, speed): (SimTime, f64),
    accelerates: bool,
) -> (Vec<(BodyIx, u32)>, f64) {
    let lost = gathered.kinetic(bodies, time) - kinetic(gathered, moves);
    let driven = driven(bodies, gathered, moves, time);
    bodies.book.impacts.add(lost + driven);
    bodies.book.external.add(driven);
    let (mut members, mut fastest) = (Vec::new(), speed);
    for (&index, moved) in gathered.places.iter().zip(moves) {
        if bodies.get(index).inverse_mass == 0.0 {
            continue;
        }
        bodies.change(index, time, |motion| {
            motion.velocity = moved.velocity;
            motion.spin = moved.spin;
            if accelerates {
                motion.acceleration = moved.acceleration;
                motion.angular_acceleration = moved.angular_acceleration;
            }
        });
        let state = bodies.get_mut(index);
        state.member = true;
        let reach = state.reach;
        members.push((index, bodies.version(index)));
        for fast in [moved.velocity.length(), moved.spin.abs() * reach] {
            fastest = if fast > fastest { fast } else { fastest };
        }
    }
    (members, fastest)
}

/// The work of what carries a group in a landing, in J: all its impulses come from bodies of one velocity.
fn driven(bodies: &Bodies, gathered: &Gathered, moves: &[BodyMove], time: SimTime) -> f64 {
    let carrier = carrier(&gathered.bodies);
    let both = gathered.places.iter().zip(moves);
    let work = |(index, moved): (&BodyIx, &BodyMove)| {
        let state = bodies.get(*index);
        let came = state.at(time).0.velocity;
        let free = state.inverse_mass > 0.0;
        free.then(|| (moved.velocity - came).dot(carrier) / state.inverse_mass)
    };
    both.filter_map(work).sum()
}

/// The touches of a group with what they do while its mode lasts.
pub(crate) fn kept(gathered: &Gathered, moves: &[BodyMove], touches: &[TouchMove]) -> Vec<Kept> {
    let sources = gathered.pairs.iter().zip(&gathered.touches).zip(touches);
    sources
        .map(|((&(pair, contact), touch), moved)| {
            let t = perp(touch.normal);
            let (a, b) = touch.bodies;
            let rate = |place: usize| {
                let body = &moves[place];
                let arm = touch.points[0] - gathered.bodies[place].centre;
                (body.acceleration + cross_scalar(body.angular_acceleration, arm)).dot(t)
            };
            let force = touch.normal * (moved.normal[0] + moved.normal[1]) + t * moved.tangential;
            let drive = |place: usize, force: Vec2| {
                let body = &gathered.bodies[place];
                if body.inverse_mass > 0.0 {
                    0.0
                } else {
                    force.dot(body.velocity_of(touch.points[0]))
                }
            };
            Kept {
                pair,
                contact,
                moved: *moved,
                slip_rate: rate(b) - rate(a),
                driven: drive(a, force) + drive(b, -force),
            }
        })
        .collect()
}

/// Kinetic energy of all dynamic bodies of a group, in J.
fn kinetic(gathered: &Gathered, moves: &[BodyMove]) -> f64 {
    let both = gathered.bodies.iter().zip(moves);
    let moving = both.map(|(body, moved)| body.moving(moved.velocity, moved.spin));
    moving.map(|body| body.kinetic_energy()).sum()
}
