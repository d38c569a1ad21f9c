//! Contact islands with rows that do not change with time, in closed form.
//!
//! Flats that slide on flats and discs on straight edges keep their normals and, seen from what
//! turns, their arms. So every body of such a group has a constant acceleration until a slip stops,
//! an edge ends or a body begins to tip: [`solve_modes`] solves the complementarity problem of Signorini and
//! Coulomb for the accelerations once, and names the instant of the next change.
//!
//! Pure functions on plain data, without a world.

mod alone;
mod balance;
mod change;
mod faces;
#[cfg(test)]
mod naive;
mod rest;
#[cfg(test)]
mod tests;

use arrayvec::ArrayVec;
use carom_math::{Vec2, cross_scalar, perp};

use crate::ContactMode;
use crate::impact::ImpactBody;
use crate::model::approach::CLOSED;
use crate::model::edges::Feature;
pub(crate) use balance::Tangent;
use balance::{Balance, Reaction, balance};
use change::Load;
use faces::Faces;

/// Slip below this part of the speeds that it is the difference of is none.
const STILL: f64 = 1e-12;

/// Part of the kinetic energy that the roundings of a landing may add.
const ROUNDED: f64 = 1e-9;

/// A lasting contact of two bodies: one point, or both ends of a stretch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Places of A and B in the list of bodies.
    pub(crate) bodies: (usize, usize),
    /// Unit normal from A to B.
    pub(crate) normal: Vec2,
    /// In m.
    pub(crate) points: ArrayVec<Vec2, 2>,
    /// What A and B touch with.
    pub(crate) features: (Feature, Feature),
    /// Coefficient of friction.
    pub(crate) friction: f64,
}

/// What a body does until the next change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyMove {
    /// At the instant of the mode solve: what was given, without the roundings against the rows, in m/s.
    pub(crate) velocity: Vec2,
    /// In rad/s.
    pub(crate) spin: f64,
    /// In m/s².
    pub(crate) acceleration: Vec2,
    /// In rad/s².
    pub(crate) angular_acceleration: f64,
}

/// What a touch does until the next change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TouchMove {
    pub(crate) mode: ContactMode,
    /// Force on B along the normal at each point, in N; where the touch is redundant, one of many.
    pub(crate) normal: [f64; 2],
    /// Force on B along the normal turned by +90 degrees, in N.
    pub(crate) tangential: f64,
    /// Speed of B against A along the same, in m/s.
    pub(crate) slip: f64,
}

/// How a group moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GroupMove {
    pub(crate) bodies: Vec<BodyMove>,
    pub(crate) touches: Vec<TouchMove>,
    /// In s from the mode solve; `None`: never.
    pub(crate) change: Option<f64>,
}

/// Why a group is not for closed forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotMine {
    /// A touch opens or closes already.
    Approaches,
    /// A body that has corners or edges in touch turns, or would.
    Turns,
    /// Something round rolls about something round or a corner.
    Curved,
    /// Friction outweighs the normal force that makes it (Painlevé): accelerations have no answer or
    /// several. An impulse has one.
    Painleve,
    /// No accelerations were found.
    Unsolved,
    /// What a landing opens comes back at once: the series of landings ends.
    Returns,
}

/// Modes and motions of a group from now on. A body of infinite mass moves uniformly; `pulls`: accelerations of the bodies by all that is
/// no contact, in m/s² and rad/s².
///
/// The given velocities may be roundings of speeds up to `speed`, in m/s: a body that stopped just
/// now is not exactly still.
pub(crate) fn solve_modes(
    bodies: &[ImpactBody],
    pulls: &[(Vec2, f64)],
    touches: &[Touch],
    speed: f64,
) -> Result<GroupMove, NotMine> {
    let slips = faces::slips(bodies, touches, speed)?;
    let without;
    let bodies = if turns(bodies, touches, speed) {
        without = without_roundings(bodies, touches, speed).ok_or(NotMine::Turns)?;
        &without
    } else {
        bodies
    };
    let faces = Faces::new(bodies, pulls, touches);
    if let Some(moves) = rest::rest(bodies, touches, &faces, speed) {
        return Ok(moves);
    }
    let tangents = tangents(touches, &slips);
    let found = balance(&faces, &tangents)?;
    let moves = faces.moves(bodies, &found, &slips);
    rows_stay(touches, &moves, &found)?;
    let load = Load {
        bodies,
        pulls,
        touches,
        moves: &moves,
        found: &found,
        slips: &slips,
        tangents: &tangents,
    };
    Ok(GroupMove {
        touches: (0..touches.len()).map(|i| load.touch_move(i)).collect(),
        change: load.next(),
        bodies: moves,
    })
}

/// How an island with rows that turn begins to move.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Begun {
    /// Of each touch.
    pub(crate) reactions: Vec<Reaction>,
    /// Exactly 0 where they are no more than rounding, in m/s.
    pub(crate) slips: Vec<f64>,
    /// Of each body.
    pub(crate) moves: Vec<BodyMove>,
}

/// Modes at an instant of an island with rows that turn; `bends` is what velocities add to the rates of each touch's
/// points, and of its tangent, in m/s².
pub(crate) fn begin(
    bodies: &[ImpactBody],
    pulls: &[(Vec2, f64)],
    touches: &[Touch],
    bends: &[([f64; 2], f64)],
    speed: f64,
) -> Result<Begun, NotMine> {
    if bodies.iter().any(ImpactBody::drives) {
        return Err(NotMine::Turns);
    }
    let mut faces = Faces::new(bodies, pulls, touches);
    for (face, (points, tangent)) in faces.list.iter_mut().zip(bends) {
        for (row, bend) in face.normals.iter_mut().zip(points) {
            row.bend = bend / row.length;
        }
        if face.tangent.length > 0.0 {
            face.tangent.bend = tangent / face.tangent.length;
        }
    }
    let slips = faces::slips(bodies, touches, speed)?;
    let found = balance(&faces, &tangents(touches, &slips))?;
    let moves = faces.moves(bodies, &found, &slips);
    Ok(Begun {
        reactions: found.reactions,
        slips,
        moves,
    })
}

/// Velocities after touches that close have come to rest along their normals, and against slip as
/// far as friction can: the impact without restitution of the whole group.
///
/// The same problem as that of the accelerations, with impulses for forces; it has a solution where
/// accelerations have none (Painlevé). Of several answers that Coulomb friction leaves to a wedged body, one that adds energy is none.
pub(crate) fn land(bodies: &[ImpactBody], touches: &[Touch]) -> Result<Vec<(Vec2, f64)>, NotMine> {
    let carrier = carrier(bodies);
    let alike =
        |body: &ImpactBody| body.inverse_mass > 0.0 || body.velocity == carrier && body.spin == 0.0;
    if !bodies.iter().all(alike) {
        return Err(NotMine::Approaches);
    }
    let arriving = bodies
        .iter()
        .map(|body| (body.velocity - carrier, body.spin));
    let faces = Faces::new(bodies, &arriving.collect::<Vec<_>>(), touches);
    let none = vec![0.0; touches.len()];
    let found = balance(&faces, &tangents(touches, &none))?;
    let moves = faces.moves(bodies, &found, &none);
    let (mut before, mut after) = (0.0, 0.0);
    for (body, moved) in bodies.iter().zip(&moves) {
        before += body
            .moving(body.velocity - carrier, body.spin)
            .kinetic_energy();
        after += body
            .moving(moved.acceleration, moved.angular_acceleration)
            .kinetic_energy();
    }
    if after > before * (1.0 + ROUNDED) {
        return Err(NotMine::Unsolved);
    }
    Ok(moves
        .iter()
        .map(|body| (body.acceleration + carrier, body.angular_acceleration))
        .collect())
}

/// Velocities after infinitely many small impacts have come to their end at these touches: none of them opens or closes.
///
/// What a blow opens a little, where turning presses it together again, comes back, and what comes back opens another one:
/// a disc in an obtuse corner goes from wall to wall, each time `cos` of the angle between them slower. All of it takes no
/// more than [`crate::model::press`] lets it, and no more energy than these bounces had.
pub(crate) fn hold(bodies: &[ImpactBody], touches: &[&Touch]) -> Vec<(Vec2, f64)> {
    if bodies.iter().any(ImpactBody::drives) {
        return faces::velocities_of(bodies).collect();
    }
    faces::held(bodies, touches, |_| false)
}

/// The same where what sticks after a landing goes on to stick: `bodies` have the velocities after it; `speed`, in m/s, is the
/// largest that their roundings are measured by.
pub(crate) fn stand(bodies: &[ImpactBody], touches: &[Touch], speed: f64) -> Vec<(Vec2, f64)> {
    let all: Vec<&Touch> = touches.iter().collect();
    faces::held(bodies, &all, |touch| {
        touch.friction > 0.0 && faces::slip(bodies, touch, touch.points[0], speed) == 0.0
    })
}

/// What friction does at each touch: it opposes the slip there is, or holds if it can.
fn tangents(touches: &[Touch], slips: &[f64]) -> Vec<Tangent> {
    let of = |(touch, slip): (&Touch, &f64)| {
        if touch.friction == 0.0 {
            Tangent::Smooth
        } else if *slip == 0.0 {
            Tangent::Holds
        } else {
            Tangent::Slides(slip.signum())
        }
    };
    touches.iter().zip(slips).map(of).collect()
}

/// Whether a body turns that has a corner or an edge in touch, by more than rounding: rows, once they turn, have other accelerations.
fn turns(bodies: &[ImpactBody], touches: &[Touch], speed: f64) -> bool {
    touches.iter().any(|touch| {
        let (a, b) = touch.bodies;
        [(a, touch.features.0), (b, touch.features.1)]
            .into_iter()
            .any(|(place, feature)| {
                let body = &bodies[place];
                let turning = body.spin.abs() * (touch.points[0] - body.centre).length();
                feature != Feature::Round
                    && turning > STILL * (body.velocity.length() + turning + speed)
            })
    })
}

/// The bodies as their touches let them move, where none turns then; `None` where one does.
///
/// A touch counts as closed up to [`CLOSED`], and turning from [`STILL`] on: an edge flush on another one that turns by something in
/// between is at the end of a series of landings, and turns by their roundings. A path would take them out, too, and never end.
fn without_roundings(
    bodies: &[ImpactBody],
    touches: &[Touch],
    speed: f64,
) -> Option<Vec<ImpactBody>> {
    if bodies.iter().any(ImpactBody::drives) {
        return None;
    }
    let held = stand(bodies, touches, speed);
    let both = bodies.iter().zip(held);
    let without = both.map(|(body, (velocity, spin))| body.moving(velocity, spin));
    let without: Vec<ImpactBody> = without.collect();
    (!turns(&without, touches, speed)).then_some(without)
}

/// Velocity of what carries a group, in m/s: of the first body that impulses do not move.
pub(crate) fn carrier(bodies: &[ImpactBody]) -> Vec2 {
    let mut bearers = bodies.iter().filter(|body| body.inverse_mass == 0.0);
    bearers.next().map_or(Vec2::ZERO, |body| body.velocity)
}

/// Whether the rows of all closed touches keep their numbers, as far as accelerations feel them.
fn rows_stay(touches: &[Touch], moves: &[BodyMove], found: &Balance) -> Result<(), NotMine> {
    for (touch, reaction) in touches.iter().zip(&found.reactions) {
        if !reaction.closed.contains(&true) {
            continue;
        }
        let (a, b) = touch.bodies;
        for (place, feature) in [(a, touch.features.0), (b, touch.features.1)] {
            let turns = moves[place].spin != 0.0 || moves[place].angular_acceleration != 0.0;
            if feature != Feature::Round && turns {
                return Err(NotMine::Turns);
            }
        }
        let flat = |feature| matches!(feature, Feature::Edge { .. });
        let parts = moves[a].velocity != moves[b].velocity
            || moves[a].acceleration != moves[b].acceleration;
        if !flat(touch.features.0) && !flat(touch.features.1) && parts {
            return Err(NotMine::Curved);
        }
    }
    Ok(())
}

impl Load<'_> {
    /// What a touch does.
    fn touch_move(&self, i: usize) -> TouchMove {
        let (touch, reaction, slip) = (&self.touches[i], &self.found.reactions[i], self.slips[i]);
        let (a, b) = (&self.moves[touch.bodies.0], &self.moves[touch.bodies.1]);
        let still = |body: &BodyMove| *body == BodyMove::default();
        let round = |(place, feature): (usize, Feature)| {
            let body = &self.moves[place];
            feature == Feature::Round && (body.spin != 0.0 || body.angular_acceleration != 0.0)
        };
        let ends = [
            (touch.bodies.0, touch.features.0),
            (touch.bodies.1, touch.features.1),
        ];
        let mode = if !reaction.closed.contains(&true) {
            ContactMode::Open
        } else if slip != 0.0
            || slip_rate(self.bodies, touch, self.moves) != 0.0 && !reaction.sticks
        {
            ContactMode::Slide
        } else if ends.into_iter().any(round) {
            ContactMode::Roll
        } else if still(a) && still(b) {
            ContactMode::Rest
        } else {
            ContactMode::Stick
        };
        TouchMove {
            mode,
            normal: reaction.normal,
            tangential: reaction.tangential,
            slip,
        }
    }
}

/// How fast the slip of B against A grows, in m/s².
fn slip_rate(bodies: &[ImpactBody], touch: &Touch, moves: &[BodyMove]) -> f64 {
    let point = touch.points[0];
    let of = |place: usize| {
        let arm = point - bodies[place].centre;
        moves[place].acceleration + cross_scalar(moves[place].angular_acceleration, arm)
    };
    (of(touch.bodies.1) - of(touch.bodies.0)).dot(perp(touch.normal))
}
