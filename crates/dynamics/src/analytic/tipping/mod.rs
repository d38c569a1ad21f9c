//! Contact islands with rows that turn with their bodies: a box tips about its corner, a disc rolls over a disc.
//!
//! While every contact keeps its mode the accelerations follow from where the bodies are ([`equations`]); they are
//! integrated with dense output ([`crate::law::path`]), and the mode ends at the first root of its margins ([`roots`]).
//!
//! Pure functions on plain data, without a world.

mod equations;
mod joint;
mod roots;
mod shared;
mod swing;
#[cfg(test)]
mod tests;
mod wave;

use std::sync::Arc;

use arrayvec::ArrayVec;
use carom_math::{SimTime, Vec2};

use crate::ContactMode;
use crate::analytic::modes::{BodyMove, NotMine, Tangent, Touch, TouchMove, begin};
use crate::impact::ImpactBody;
use crate::law::collocated::Collocated;
use crate::law::path::{Path, Place};
use crate::model::edges::Feature;
pub(crate) use equations::{Equations, Forces, Workspace};
pub(crate) use joint::{End, Joint};
pub(crate) use roots::Limit;
use roots::{faint, first, heat};
use shared::share_corners;
use swing::swing;

/// Longest stretch of a path, in s.
const LONGEST: f64 = 0.25;

/// Shortest one, in s: below it forces grow without bound.
const SHORTEST: f64 = 1e-7;

/// What a path may leave out, as a fraction of the smallest reach a second.
const ERROR: f64 = 1e-11;

/// A mode that ends sooner is none, in s.
const AT_ONCE: f64 = 1e-14;

/// Modes tried at one instant.
const TRIES: usize = 8;

/// A contact of two bodies: one point, or both ends of a stretch, with one friction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contact {
    /// Places of A and B in the list of bodies.
    pub(crate) bodies: (usize, usize),
    pub(crate) joints: ArrayVec<Joint, 2>,
    /// Coefficient of friction.
    pub(crate) friction: f64,
}

/// Mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold {
    /// Points that stay in touch.
    pub(crate) closed: [bool; 2],
    /// Points that have come over the end of an edge: there is no line under them any more.
    pub(crate) over: [bool; 2],
    pub(crate) rub: Tangent,
    /// The contact whose corner is in the same place, as at the tip between two segments: it has the forces of both.
    pub(crate) shares: Option<usize>,
}

/// How a group moves until its next change.
#[derive(Clone, Debug)]
pub(crate) struct Tip {
    pub(crate) path: Arc<dyn Path>,
    pub(crate) equations: Equations,
    /// Of the bodies, in m; 0 of those of infinite mass.
    reaches: Vec<f64>,
    /// In s from the start of the path.
    pub(crate) after: f64,
    /// What ends the mode; `None`: the path is known no further.
    pub(crate) ends: Option<Limit>,
}

impl Tip {
    /// Places of the bodies that it moves: of the members of a group, in their order.
    pub(crate) fn movers(&self) -> impl Iterator<Item = usize> {
        let bodies = &self.equations.bodies;
        (0..bodies.len()).filter(|place| bodies[*place].inverse_mass > 0.0)
    }

    /// Corners that a contact keeps on an edge, each with the body that has the edge.
    pub(crate) fn held_corners(&self, contact: usize) -> impl Iterator<Item = (End, Vec2)> + '_ {
        let hold = &self.equations.holds[contact];
        let joints = self.equations.contacts[contact].joints.iter().enumerate();
        joints.filter_map(|(k, joint)| match *joint {
            Joint::Line {
                owner, tip, radius, ..
            } if radius == 0.0 && hold.closed[k] && !hold.over[k] => Some((owner, tip)),
            _ => None,
        })
    }

    /// How fast the corner comes down that ends the mode, in m/s; `None` if none does.
    pub(crate) fn landing_speed(&self) -> Option<f64> {
        let Some(Limit::Corner {
            contact,
            normal,
            at,
        }) = self.ends
        else {
            return None;
        };
        let places = self.path.places_after(self.after);
        let (a, b) = self.equations.contacts[contact].bodies;
        let opening = places[b].velocity_of(at) - places[a].velocity_of(at);
        Some(-normal.dot(opening))
    }

    /// The next stretch of a path that is known no further, while all modes go on.
    pub(crate) fn next(&self, speed: f64) -> Option<Self> {
        if self.ends.is_some() {
            return None;
        }
        let places = self.path.places_after(self.after);
        let mut bodies = self.equations.bodies.clone();
        for (body, place) in bodies.iter_mut().zip(&places) {
            (body.centre, body.velocity, body.spin) = (place.centre, place.velocity, place.spin);
        }
        let (reaches, contacts) = (self.reaches.clone(), self.equations.contacts.clone());
        let start = self.path.start() + self.after;
        let pulls = self.equations.pulls.clone();
        let next = tip(bodies, pulls, places, reaches, contacts, start, speed).ok()?;
        (next.equations.holds == self.equations.holds).then_some(next)
    }

    /// Heat by friction in the first `elapsed` seconds, in J.
    pub(crate) fn heat(&self, elapsed: f64) -> f64 {
        heat(&self.equations, &*self.path, elapsed)
    }

    /// Motions of all bodies and modes of all contacts `t` seconds after the start; `None` where there are no forces.
    pub(crate) fn moves_after(&self, t: f64) -> Option<(Vec<BodyMove>, Vec<TouchMove>)> {
        let places = self.path.places_after(t);
        let mut workspace = Workspace::default();
        let forces = self.equations.forces(&places, &mut workspace)?;
        let touches = self.touches_at(&places, forces);
        let both = places.iter().zip(&forces.accelerations);
        let moves = both.map(|(place, &(acceleration, angular_acceleration))| BodyMove {
            velocity: place.velocity,
            spin: place.spin,
            acceleration,
            angular_acceleration,
        });
        Some((moves.collect(), touches))
    }

    fn touches_at(&self, places: &[Place], forces: &Forces) -> Vec<TouchMove> {
        let seen = self.equations.seen(places);
        let all = self.equations.holds.iter().enumerate();
        all.map(|(i, hold)| TouchMove {
            mode: self.mode(i),
            normal: forces.normal[i],
            tangential: forces.tangential[i],
            slip: match hold.rub {
                Tangent::Slides(_) => seen[i][0].map_or(0.0, |seen| seen.slip),
                Tangent::Smooth | Tangent::Holds => 0.0,
            },
        })
        .collect()
    }

    fn mode(&self, i: usize) -> ContactMode {
        let hold = &self.equations.holds[i];
        let hold = hold.shares.map_or(hold, |k| &self.equations.holds[k]);
        let contact = &self.equations.contacts[i];
        let round = |joint: &Joint| match joint {
            Joint::Line { radius, .. } => *radius > 0.0,
            Joint::Points { .. } => true,
        };
        if !hold.closed.contains(&true) {
            ContactMode::Open
        } else if hold.rub != Tangent::Holds {
            ContactMode::Slide
        } else if contact.joints.iter().any(round) {
            ContactMode::Roll
        } else {
            ContactMode::Stick
        }
    }
}

/// The path of a group from `start` on.
///
/// `pulls`: accelerations of the bodies by all that is no contact, in m/s² and rad/s².
/// The given velocities may be roundings of speeds up to `speed`, in m/s; `reaches` are those of the bodies, in m, and
/// 0 of those of infinite mass.
pub(crate) fn tip(
    mut bodies: Vec<ImpactBody>,
    pulls: Vec<(Vec2, f64)>,
    mut places: Vec<Place>,
    reaches: Vec<f64>,
    contacts: Vec<Contact>,
    start: SimTime,
    speed: f64,
) -> Result<Tip, NotMine> {
    let (mut holds, moves) = modes(&bodies, &pulls, &places, &contacts, speed)?;
    let mut fastest = speed;
    for ((place, body), moved) in places.iter_mut().zip(&mut bodies).zip(moves) {
        (place.velocity, place.spin) = (moved.velocity, moved.spin);
        (body.velocity, body.spin) = (moved.velocity, moved.spin);
        fastest = fastest.max(moved.velocity.length());
    }
    let moving = bodies.iter().zip(&reaches);
    let moving = moving.filter(|(body, _)| body.inverse_mass > 0.0);
    let size = moving
        .map(|(_, reach)| *reach)
        .fold(f64::INFINITY, f64::min);
    share_corners(&contacts, &places, size, &mut holds);
    let mut equations = Equations {
        bodies,
        pulls,
        contacts,
        holds,
    };
    for _ in 0..TRIES {
        let found = swing(&equations, &places, &reaches, start, size)
            .or_else(|| follow(&equations, &places, &reaches, start, (size, fastest)));
        let Some((path, end)) = found else {
            // A touch that fades while it slides has no path of its own: it opens.
            let limit = faint(&equations, &places).ok_or(NotMine::Unsolved)?;
            amend(&mut equations, limit)?;
            continue;
        };
        let (after, ends) = match end {
            roots::End::Open => (path.length(), None),
            roots::End::After(after, limit)
                if after > AT_ONCE || matches!(limit, Limit::Corner { .. }) =>
            {
                (after, Some(limit))
            }
            roots::End::Never(limit) | roots::End::After(_, limit) => {
                // The edge of a mode: what rounding decided was decided wrongly.
                amend(&mut equations, limit)?;
                continue;
            }
            roots::End::Lost => return Err(NotMine::Unsolved),
        };
        return Ok(Tip {
            path,
            equations,
            reaches,
            after,
            ends,
        });
    }
    Err(NotMine::Unsolved)
}

/// Path and end of any island by collocation; `None` where there are no forces. `sizes`: a length in m and a speed in m/s that
/// roundings are measured by.
fn follow(
    equations: &Equations,
    places: &[Place],
    reaches: &[f64],
    start: SimTime,
    sizes: (f64, f64),
) -> Option<(Arc<dyn Path>, roots::End)> {
    let mut workspace = Workspace::default();
    let accelerations = |places: &[Place], to: &mut Vec<f64>| {
        let Some(forces) = equations.forces(places, &mut workspace) else {
            return false;
        };
        let all = forces.accelerations.iter();
        to.clear();
        to.extend(all.flat_map(|(a, alpha)| [a.x, a.y, *alpha]));
        true
    };
    let lengths = (LONGEST, SHORTEST);
    let error = ERROR * sizes.0;
    let path = Collocated::follow(accelerations, start, places, reaches, lengths, error)?;
    let end = first(equations, &path, sizes);
    Some((Arc::new(path), end))
}

/// A contact is in the next mode already if its margin is 0 and falls.
fn amend(equations: &mut Equations, limit: Limit) -> Result<(), NotMine> {
    let holds = &mut equations.holds;
    match limit {
        Limit::Press { contact, point } => holds[contact].closed[point] = false,
        Limit::Grip { contact, sign } => holds[contact].rub = Tangent::Slides(sign),
        Limit::Slip { contact } => holds[contact].rub = Tangent::Holds,
        // A corner that slides over the end of an edge moves on along that edge's line, and what follows it rises: it
        // leaves. A disc rolls round the corner.
        Limit::Way { contact, point } => match equations.contacts[contact].joints[point] {
            Joint::Line { radius: 0.0, .. } => {
                holds[contact].closed[point] = false;
                holds[contact].over[point] = true;
            }
            _ => return Err(NotMine::Curved),
        },
        Limit::Corner { .. } => return Err(NotMine::Unsolved),
    }
    Ok(())
}

/// Modes by the complementarity problem of this instant, and the velocities without the roundings against them.
fn modes(
    bodies: &[ImpactBody],
    pulls: &[(Vec2, f64)],
    places: &[Place],
    contacts: &[Contact],
    speed: f64,
) -> Result<(Vec<Hold>, Vec<BodyMove>), NotMine> {
    let mut touches = Vec::with_capacity(contacts.len());
    let mut bends = Vec::with_capacity(contacts.len());
    for contact in contacts {
        let (a, b) = (&places[contact.bodies.0], &places[contact.bodies.1]);
        let seen: ArrayVec<_, 2> = contact
            .joints
            .iter()
            .map(|joint| joint.seen(a, b))
            .collect();
        let bend = |k: usize| seen.get(k).map_or(0.0, |seen| seen.bend);
        bends.push(([bend(0), bend(1)], seen[0].drift));
        touches.push(Touch {
            bodies: contact.bodies,
            normal: seen[0].normal,
            points: seen.iter().map(|seen| seen.point).collect(),
            features: (Feature::Corner, Feature::Corner),
            friction: contact.friction,
        });
    }
    let begun = begin(bodies, pulls, &touches, &bends, speed)?;
    let hold = |(i, touch): (usize, &Touch)| Hold {
        closed: begun.reactions[i].closed,
        over: [false; 2],
        rub: if touch.friction == 0.0 {
            Tangent::Smooth
        } else if begun.reactions[i].sticks {
            Tangent::Holds
        } else if begun.slips[i] != 0.0 {
            Tangent::Slides(begun.slips[i].signum())
        } else {
            Tangent::Slides(-begun.reactions[i].tangential.signum())
        },
        shares: None,
    };
    let holds = touches.iter().enumerate().map(hold).collect();
    Ok((holds, begun.moves))
}
