//! A look at every near pair: where its parts touch, and which contacts the solver takes.

use carom_collision::{PartManifold, contacts};
use carom_math::{Pose, SimTime, Vec2};

use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, PairContact, PairPoint};
use crate::store::state::BodyState;
use crate::{BodyIx, Two};

/// Contacts are looked for this far beyond a sub-step's travel, as a fraction of the smaller reach.
const MARGIN: f64 = 1.0 / 1024.0;

/// Gap below which two shapes touch, as a fraction of the smaller reach: far above rounding after
/// an impact (1e-12), far below what the eye or the solver's softness can see.
pub(crate) const TOUCH: f64 = 1e-9;

/// Overlap beyond which a pair is pushed apart first, as a part of the smaller reach: flight and closed forms keep what
/// overlap there is.
pub(crate) const SUNK: f64 = 1e-6;

/// Overlap beyond which a pair is buried, as a fraction of the smaller reach: 44 mm for boxes of 1 m.
/// Impacts leave none, and the lowest contact of a stack of ten such boxes 0.8 mm.
pub(crate) const BURIED: f64 = 1.0 / 16.0;

/// Looks at a pair at `time` and replaces its contacts.
pub(crate) fn look(bodies: &Bodies, pair: &mut Pair, time: SimTime) {
    let (a, b) = bodies.both(pair.bodies);
    let (from, to) = (a.in_impact(time), b.in_impact(time));
    let closing = (to.velocity - from.velocity).length() + rim_speed(a, time) + rim_speed(b, time);
    let margin = MARGIN * a.reach.min(b.reach) + bodies.h * closing;
    let near = a.reach + b.reach + margin;
    if (to.centre - from.centre).length_squared() > near * near {
        pair.contacts = Vec::new();
        pair.touching = false;
        pair.buried = false;
        return;
    }
    // Rotations cost more than all that is asked before.
    let (pose_a, pose_b) = (a.centre_pose(time), b.centre_pose(time));
    let mut found = Vec::new();
    let [solid_a, solid_b] = bodies.solids(pair.colliders);
    let seen = pose_b.seen_from(pose_a);
    contacts(solid_a, solid_b, seen, margin, &mut found);
    pair.contacts = found.iter().map(|new| in_world(new, pose_a)).collect();
    note_touch(bodies, pair, time);
}

/// What the contacts of a pair say of it: whether it touches, and how deep it overlaps.
pub(crate) fn note_touch(bodies: &Bodies, pair: &mut Pair, time: SimTime) {
    let (a, b) = bodies.both(pair.bodies);
    let size = a.reach.min(b.reach);
    let points = pair.contacts.iter().flat_map(|contact| &contact.points);
    let deepest = points.map(|p| p.separation).fold(0.0, f64::min);
    pair.buried = deepest < -BURIED * size;
    pair.touching = pair
        .contacts
        .iter()
        .any(|contact| contact.points.iter().any(|p| p.separation <= TOUCH * size));
    if pair.touching {
        pair.turning_rest = turning_rest(bodies, pair, time);
    }
}

/// The largest [`Pair::turning_rest_at`] of all touches of a pair, in m/s.
fn turning_rest(bodies: &Bodies, pair: &Pair, time: SimTime) -> f64 {
    let (a, b) = bodies.both(pair.bodies);
    if pair.material.restitution >= 1.0 || a.motion.spin == 0.0 && b.motion.spin == 0.0 {
        return 0.0;
    }
    let touch = TOUCH * a.reach.min(b.reach);
    let mut fastest = 0.0;
    for contact in &pair.contacts {
        for point in contact.points.iter().filter(|p| p.separation <= touch) {
            let speed = pair.turning_rest_at(bodies, contact, point.position, time);
            fastest = if speed > fastest { speed } else { fastest };
        }
    }
    fastest
}

/// A new contact in the world.
fn in_world(new: &PartManifold, pose_a: Pose) -> PairContact {
    let points = new.manifold.points.iter().map(|point| PairPoint {
        position: pose_a.point(point.point),
        separation: point.separation,
        impulse: 0.0,
    });
    PairContact {
        parts: (new.part_a, new.part_b),
        normal: pose_a.vector(new.manifold.normal),
        points: points.collect(),
        tangent_impulse: 0.0,
    }
}

/// Fastest that a point of the body moves about its centre, in m/s.
fn rim_speed(body: &BodyState, time: SimTime) -> f64 {
    let spin = body.motion.spin_at(time).abs();
    // A half-plane has no end, and does not turn.
    if spin > 0.0 { spin * body.reach } else { 0.0 }
}

/// Speed of an approach that rounding alone can make, as a part of [`pace`].
pub(crate) const NOISE: f64 = 8.0 * f64::EPSILON;

/// The speeds that an approach of two bodies is the difference of, in m/s: of their fastest points.
pub(crate) fn pace(a: &BodyState, b: &BodyState, time: SimTime) -> f64 {
    let of = |body: &BodyState| body.velocity_at(time).length() + rim_speed(body, time);
    of(a) + of(b)
}

/// Normal velocity of a contact point: positive opens.
pub(crate) fn opening_speed(
    a: &BodyState,
    b: &BodyState,
    time: SimTime,
    point: Vec2,
    normal: Vec2,
) -> f64 {
    let of = |body: &BodyState| body.in_impact(time).velocity_of(point);
    (of(b) - of(a)).dot(normal)
}

/// Approach below which a contact rests instead of bouncing, in m/s.
///
/// Two sub-steps' worth of what presses the pair together: a bounce that is over within a few
/// sub-steps cannot be told from rest by a scheme that looks once a sub-step. Two free bodies under one
/// gravity press with nothing, so they always bounce but where turning presses them.
pub(crate) fn rest_speed(bodies: &Bodies, pair: &Pair) -> f64 {
    rest_speed_between(bodies, pair.bodies) + pair.turning_rest
}

/// [`rest_speed`] of two bodies that turn about nothing.
pub(crate) fn rest_speed_between(bodies: &Bodies, (a, b): Two<BodyIx>) -> f64 {
    let (a, b) = (bodies.get(a), bodies.get(b));
    let pull = |body: &BodyState| {
        if body.is_dynamic() {
            body.gravity_scale() * bodies.pull.at(body.motion.centre)
                + body.force() * body.inverse_mass
        } else {
            Vec2::ZERO
        }
    };
    let (pull_a, pull_b) = (pull(a), pull(b));
    let press = if a.member || b.member {
        pull_a.length().max(pull_b.length())
    } else {
        (pull_b - pull_a).length()
    };
    2.0 * bodies.h * press
}
