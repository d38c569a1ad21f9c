//! How hard two bodies press where they touch: by what moves them, and by turning alone.

use carom_collision::{Hull, Motion, Side};
use carom_math::{SimTime, Vec2, perp};

use super::edges::{Feature, feature};
use super::gap::{Touching, gap_acceleration};
use super::narrow::opening_speed;
use crate::store::bodies::Bodies;
use crate::store::pairs::{Pair, PairContact};
use crate::store::state::BodyState;

/// What two bodies turn or slide by, in rad or sizes, while a bounce lasts that counts as over: half of it there and half
/// of it back. It is then no higher than 2^-17 of its distance from what it turns about.
const STEADY: f64 = 1.0 / 256.0;

impl Pair {
    /// Speed of an approach that turning brings back at a point of a contact, were it given back, before its bodies have turned or
    /// slid by more than [`STEADY`], and in less than four sub-steps, in m/s; 0 where turning does not press.
    pub(crate) fn turning_rest_at(
        &self,
        bodies: &Bodies,
        contact: &PairContact,
        point: Vec2,
        time: SimTime,
    ) -> f64 {
        let (a, b) = bodies.both(self.bodies);
        let fastest = a.spin_at(time).abs().max(b.spin_at(time).abs());
        if fastest == 0.0 {
            return 0.0;
        }
        // Nothing but their velocities: what pulls them is for others to say.
        let unforced = |state: &BodyState| Motion {
            acceleration: Vec2::ZERO,
            angular_acceleration: 0.0,
            ..state.at(time).0
        };
        let hulls = [
            bodies.hull(self.colliders.0, contact.parts.0),
            bodies.hull(self.colliders.1, contact.parts.1),
        ];
        let motions = [unforced(a), unforced(b)];
        let press = press_of(motions, hulls, point, contact.normal, time);
        if press <= 0.0 {
            return 0.0;
        }
        let slip = opening_speed(a, b, time, point, perp(contact.normal));
        let size = a.reach.min(b.reach);
        let wait = STEADY / (fastest + slip.abs() / size);
        let speed = press * wait.min(2.0 * bodies.h);
        // Until the solver holds the pair, it goes on closing.
        speed.min(STEADY * size / bodies.h)
    }
}

/// How hard two convex parts press at a point with this normal from A to B, in m/s².
fn press_of(
    motions: [Motion; 2],
    hulls: [Hull<'_>; 2],
    point: Vec2,
    normal: Vec2,
    time: SimTime,
) -> f64 {
    // Whether an edge of one of the two lies along the contact.
    let is_edge = |k: usize, outward: Vec2| {
        let pose = motions[k].pose_at(time);
        let found = feature(&hulls[k], pose, outward, normal, point);
        matches!(found, Feature::Edge { .. })
    };
    let face = if is_edge(0, normal) {
        Some(Side::A)
    } else if is_edge(1, -normal) {
        Some(Side::B)
    } else {
        None
    };
    let of = |k: usize| Touching::of(&motions[k], &hulls[k], point, time);
    -gap_acceleration(&of(0), &of(1), normal, face)
}
