//! Ghost contacts: with the sides of flush fixed pieces, which a body that lies on their faces cannot touch.
//!
//! A body penetrates its floor by a rounding, or by the compliance of its contacts, and the side of the next tile is in its
//! way by as much: they overlap along the floor's normal, and meet across the seam. But the plane of the face that bears
//! the body has the body in front of it and the tile behind it: it separates them, so its normal is the only one that the
//! two can touch with. (Box2D's rule needs a chain, Jolt's the vertices that two triangles of one body share: neither
//! serves tiles.)
//!
//! A piece that stands out of the plane by more than [`TOUCH`] is no ghost: steps of a micrometre, inner corners and ramps
//! stay. So do the ends of a floor: a body that tips over them is behind the plane. But of what stands out only the sides
//! above the plane are there: at the tip of a ramp the one that goes up from it.

use carom_collision::{Hull, contacts};
use carom_math::{Pose, SimTime, Vec2, cross};

use super::narrow::{TOUCH, look, note_touch};
use crate::store::bodies::Bodies;
use crate::store::moved::moves;
use crate::store::pairs::{Pair, Pairs};
use crate::store::state::BodyState;
use crate::{BodyIx, ColliderIx, PairIx, Two};

/// Sine of the angle up to which two normals are one.
const ALONG: f64 = 1e-6;

/// What of a piece a body can touch that lies on a face of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exposed {
    /// What it touches.
    Whole,
    /// Of the tip of a ramp, the side that goes up: its outward unit normal.
    Side(Vec2),
    /// All of it lies behind the face.
    Nothing,
}

impl Exposed {
    const fn less(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, _) | (_, Self::Nothing) => Self::Nothing,
            (Self::Side(_), _) => self,
            (Self::Whole, _) => other,
        }
    }
}

/// Where a body meets a convex piece of what stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// The body, and the collider and the part that it meets the piece with.
    body: BodyIx,
    own: (ColliderIx, u32),
    /// Collider and part of the piece.
    piece: (ColliderIx, u32),
    /// Unit normal, out of the piece.
    out: Vec2,
}

impl Meeting {
    /// A contact or an impact of two bodies, of which one stands; `normal`: from the first to the second.
    pub(crate) fn of(
        bodies: &Bodies,
        ends: Two<BodyIx>,
        colliders: Two<ColliderIx>,
        parts: (u32, u32),
        normal: Vec2,
    ) -> Option<Self> {
        let (a, b) = bodies.both(ends);
        let (first, second) = ((colliders.0, parts.0), (colliders.1, parts.1));
        let (body, own, piece, out) = if stands(a) && b.is_dynamic() {
            (ends.1, second, first, normal)
        } else if stands(b) && a.is_dynamic() {
            (ends.0, first, second, -normal)
        } else {
            return None;
        };
        Some(Self {
            body,
            own,
            piece,
            out,
        })
    }

    /// What is exposed of the piece where the body lies on a face of another one, which parts the two along another normal, at `time`.
    pub(crate) fn exposed(&self, bodies: &Bodies, pairs: &Pairs, time: SimTime) -> Exposed {
        let body = bodies.get(self.body);
        let hull = |(collider, number): (ColliderIx, u32)| bodies.hull(collider, number);
        let pose_of = |collider: ColliderIx| {
            let owner = bodies.colliders[collider].body;
            bodies.get(owner).centre_pose(time)
        };
        let owner = bodies.get(bodies.colliders[self.piece.0].body);
        let touch = TOUCH * body.reach.min(owner.reach);
        let bears = |pair: &Pair| {
            stands(bodies.get(pair.other(self.body))) && !self.is_along_all(pair, bodies)
        };
        let mut found = Vec::new();
        let pairs = body.pairs.iter().map(|place| pairs.get(*place));
        let exposed = pairs.filter(|pair| bears(pair)).map(|pair| {
            let (mine, base) = pair.shapes_from(self.body);
            let (pose, base_pose) = (pose_of(mine), pose_of(base));
            let solid = |collider: ColliderIx| &*bodies.colliders[collider].solid;
            found.clear();
            let seen = pose.seen_from(base_pose);
            contacts(solid(base), solid(mine), seen, touch, &mut found);
            let exposed = found.iter().map(|contact| {
                let normal = base_pose.vector(contact.manifold.normal);
                let at = (base, contact.part_a);
                let Some(level) = level_of_face(&hull(at), base_pose, normal) else {
                    return Exposed::Whole;
                };
                let depth = contact.manifold.deepest().map_or(0.0, |gap| -gap).max(0.0);
                let (piece, piece_pose) = (hull(self.piece), pose_of(self.piece.0));
                if at == self.piece
                    || self.is_along(normal)
                    || -top(&hull(self.own), pose, -normal) < level - depth - touch
                {
                    Exposed::Whole
                } else if top(&piece, piece_pose, normal) <= level + touch {
                    Exposed::Nothing
                } else {
                    self.side_above(&piece, piece_pose, (normal, level + touch), touch)
                        .map_or(Exposed::Whole, Exposed::Side)
                }
            });
            exposed.fold(Exposed::Whole, Exposed::less)
        });
        exposed.fold(Exposed::Whole, Exposed::less)
    }

    /// Of a piece that touches the body below a plane alone, but stands out of it, the side that goes up from there: its unit normal.
    fn side_above(
        &self,
        piece: &Hull<'_>,
        pose: Pose,
        (normal, level): (Vec2, f64),
        touch: f64,
    ) -> Option<Vec2> {
        if piece.is_half_plane() || piece.radius > 0.0 {
            return None;
        }
        let height = |i: usize| pose.point(piece.vertices[i]).dot(normal);
        let out = pose.inverse_vector(self.out);
        let farthest = piece.support(out).1;
        let touches = |i: usize| farthest - piece.vertices[i].dot(out) <= touch;
        let count = piece.vertices.len();
        if (0..count).any(|i| touches(i) && height(i) > level) {
            return None;
        }
        let goes_up = |&edge: &usize| {
            let (from, to) = (edge, (edge + 1) % count);
            let ends = [(from, to), (to, from)];
            piece.is_boundary(edge)
                && ends
                    .into_iter()
                    .any(|(low, high)| touches(low) && height(high) > level)
        };
        let edge = (0..piece.normals.len()).find(goes_up)?;
        Some(pose.vector(piece.normals[edge]))
    }

    /// A normal out of the piece as one from the first body to the second, as `normal` is.
    pub(crate) fn facing(&self, out: Vec2, normal: Vec2) -> Vec2 {
        if normal.dot(self.out) > 0.0 {
            out
        } else {
            -out
        }
    }

    /// Whether all contacts that were last found for a pair have the meeting's own normal: no face of it is another one's.
    fn is_along_all(&self, pair: &Pair, bodies: &Bodies) -> bool {
        let sign = if stands(bodies.get(pair.bodies.0)) {
            1.0
        } else {
            -1.0
        };
        let mut contacts = pair.contacts.iter();
        !pair.contacts.is_empty() && contacts.all(|contact| self.is_along(contact.normal * sign))
    }

    fn is_along(&self, normal: Vec2) -> bool {
        normal.dot(self.out) > 0.0 && cross(normal, self.out).abs() <= ALONG
    }
}

/// [`look`], and what it found but for ghosts.
pub(crate) fn look_at<'a>(
    bodies: &Bodies,
    pairs: &'a mut Pairs,
    place: PairIx,
    time: SimTime,
) -> &'a mut Pair {
    look(bodies, pairs.get_mut(place), time);
    let pair = pairs.get(place);
    let change = |k: usize| {
        let contact = &pair.contacts[k];
        let (ends, shapes) = (pair.bodies, pair.colliders);
        let meeting = Meeting::of(bodies, ends, shapes, contact.parts, contact.normal)?;
        match meeting.exposed(bodies, pairs, time) {
            Exposed::Whole => None,
            Exposed::Nothing => Some((k, None)),
            Exposed::Side(out) => Some((k, Some(meeting.facing(out, contact.normal)))),
        }
    };
    let changed: Vec<_> = (0..pair.contacts.len()).filter_map(change).collect();
    let pair = pairs.get_mut(place);
    if changed.is_empty() {
        return pair;
    }
    for (k, normal) in changed.into_iter().rev() {
        match normal {
            Some(normal) => pair.contacts[k].normal = normal,
            None => drop(pair.contacts.remove(k)),
        }
    }
    note_touch(bodies, pair, time);
    pair
}

/// Whether a body does not move, nor will before the caller moves it.
fn stands(body: &BodyState) -> bool {
    body.inverse_mass == 0.0 && !moves(body)
}

/// How far out along `normal` the face of a hull lies that it belongs to, in m, if it is one's.
fn level_of_face(hull: &Hull<'_>, pose: Pose, normal: Vec2) -> Option<f64> {
    let local = pose.inverse_vector(normal);
    let along = |edge: &usize| {
        let own = hull.normals[*edge];
        own.dot(local) > 0.0 && cross(own, local).abs() <= ALONG
    };
    let edge = (0..hull.normals.len()).find(along)?;
    hull.is_boundary(edge)
        .then(|| pose.point(hull.vertices[edge]).dot(normal))
}

/// How far a hull reaches along a direction in the world, in m.
fn top(hull: &Hull<'_>, pose: Pose, direction: Vec2) -> f64 {
    if hull.is_half_plane() {
        return f64::INFINITY;
    }
    let local = pose.inverse_vector(direction);
    hull.support(local).1 + hull.radius + pose.position.dot(direction)
}
