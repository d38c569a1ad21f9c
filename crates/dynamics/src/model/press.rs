//! How hard two bodies press where they touch: by what moves them, and by turning alone.

use carom_collision::{Motion, Side, part};
use carom_geometry::Shape;
use carom_math::{SimTime, Vec2, perp};

use super::edges::{Feature, feature};
use super::gap::{Touching, gap_acceleration};
use super::narrow::opening_speed;
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, PairContact};
use crate::store::state::{BodyState, Collider};

/// What two bodies turn or slide by, in rad or sizes, while a bounce lasts that counts as over: half of it there and half
/// of it back. It is then no higher than 2^-17 of its distance from what it turns about.
const STEADY: f64 = 1.0 / 256.0;

/// Where two convex parts of two bodies touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot<'a> {
    pub(crate) bodies: (&'a BodyState, &'a BodyState),
    pub(crate) solids: [&'a Shape; 2],
    pub(crate) parts: (u32, u32),
    pub(crate) point: Vec2,
    /// From A to B.
    pub(crate) normal: Vec2,
}

/// Where a pair touches.
impl Pair {
    /// A point of one of its contacts.
    pub(crate) fn spot<'a>(
        &self,
        bodies: &'a Bodies,
        colliders: &'a [Collider],
        contact: &PairContact,
        point: Vec2,
    ) -> Spot<'a> {
        self.spot_of(bodies, colliders, contact.parts, point, contact.normal)
    }

    /// A place where convex parts of the pair touch, with the normal there from A to B.
    pub(crate) fn spot_of<'a>(
        &self,
        bodies: &'a Bodies,
        colliders: &'a [Collider],
        parts: (u32, u32),
        point: Vec2,
        normal: Vec2,
    ) -> Spot<'a> {
        let solid = |at: u32| &*colliders[at as usize].solid;
        Spot {
            bodies: (bodies.get(self.bodies.0), bodies.get(self.bodies.1)),
            solids: [solid(self.colliders.0), solid(self.colliders.1)],
            parts,
            point,
            normal,
        }
    }
}

impl Spot<'_> {
    /// Speed of an approach that turning brings back, were it given back, before its bodies have turned or slid by more
    /// than [`STEADY`], and in less than four sub-steps of `h` seconds, in m/s; 0 where turning does not press.
    pub(crate) fn turning_rest(&self, time: SimTime, h: f64) -> f64 {
        let (a, b) = self.bodies;
        let fastest = a.spin_at(time).abs().max(b.spin_at(time).abs());
        if fastest == 0.0 {
            return 0.0;
        }
        // Nothing but their velocities: what pulls them is for others to say.
        let unforced = |state: &BodyState| Motion {
            acceleration: Vec2::ZERO,
            angular_acceleration: 0.0,
            ..state.at(time)
        };
        let press = self.press_of([unforced(a), unforced(b)], time);
        if press <= 0.0 {
            return 0.0;
        }
        let slip = opening_speed(a, b, time, self.point, perp(self.normal));
        let size = a.reach.min(b.reach);
        let wait = STEADY / (fastest + slip.abs() / size);
        let speed = press * wait.min(2.0 * h);
        // Until the solver holds the pair, it goes on closing.
        speed.min(STEADY * size / h)
    }

    fn press_of(&self, motions: [Motion; 2], time: SimTime) -> f64 {
        let hull = |k: usize, at: u32| part(self.solids[k], at as usize);
        let hulls = [hull(0, self.parts.0), hull(1, self.parts.1)];
        // Whether an edge of one of the two lies along the contact.
        let is_edge = |k: usize, outward: Vec2| {
            let pose = motions[k].pose_at(time);
            let found = feature(&hulls[k], pose, outward, self.normal, self.point);
            matches!(found, Feature::Edge { .. })
        };
        let face = if is_edge(0, self.normal) {
            Some(Side::A)
        } else if is_edge(1, -self.normal) {
            Some(Side::B)
        } else {
            None
        };
        let of = |k: usize| Touching::of(&motions[k], &hulls[k], self.point, time);
        -gap_acceleration(&of(0), &of(1), self.normal, face)
    }
}
