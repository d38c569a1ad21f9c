//! A point of contact between two bodies that turn: its gap, its rows, and what they change by.
//!
//! ```text
//! g″   = n·(a_B − a_A) + (r_B × n) α_B − (r_A × n) α_A + γ_n
//! v_t′ = t·(a_B − a_A) + (r_B × t) α_B − (r_A × t) α_A + γ_t         n from A to B, t = n turned by +90°
//! ```
//!
//! The rows are those of a contact that does not turn; γ is what velocities alone do to them.

use arrayvec::ArrayVec;
use carom_math::{Vec2, cross, perp};

use crate::law::path::Place;

/// Which of the two bodies of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    A,
    B,
}

/// What touches what, in the frames of the two bodies about their centres of mass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Joint {
    /// A corner, or a disc about a point, on a straight edge.
    Line {
        /// The body with the edge.
        owner: End,
        /// Outward unit normal of the edge.
        normal: Vec2,
        /// Distance of the edge's line from the owner's centre of mass along the normal, in m.
        height: f64,
        /// Both ends of the edge along the normal turned by +90°, in m.
        ends: [f64; 2],
        /// The corner, or the disc's centre, of the other body.
        tip: Vec2,
        /// 0 for a corner, in m.
        radius: f64,
        /// The corners beside the tip, where they do not touch themselves.
        beside: ArrayVec<Vec2, 2>,
    },
    /// Two discs, or a disc and a corner.
    Points {
        a: Vec2,
        b: Vec2,
        /// 0 for a corner, in m.
        radii: (f64, f64),
        /// The body with the corner, and the normals of the edges that end there, clockwise one first.
        cone: Option<(End, [Vec2; 2])>,
    },
}

/// A contact at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// Unit normal from A to B.
    pub(crate) normal: Vec2,
    /// In m.
    pub(crate) point: Vec2,
    /// In m; negative: overlap.
    pub(crate) gap: f64,
    /// Speed of B against A along the tangent, in m/s.
    pub(crate) slip: f64,
    /// `γ_n`, in m/s².
    pub(crate) bend: f64,
    /// `γ_t`, in m/s².
    pub(crate) drift: f64,
}

impl End {
    /// Of what belongs to A and B: that of this body, and that of the other one.
    pub(crate) fn first<T>(self, a: T, b: T) -> (T, T) {
        match self {
            Self::A => (a, b),
            Self::B => (b, a),
        }
    }
}

impl Joint {
    /// Normal from A to B and point of contact, with all that moves them.
    pub(crate) fn seen(&self, a: &Place, b: &Place) -> Seen {
        // The end that has the edge, or A of two points; the normal away from it and how fast that turns; the point of contact and its
        // velocity.
        let (owner, n, turning, (point, rate), gap, bend) = match *self {
            Self::Line {
                owner,
                normal,
                height,
                tip,
                radius,
                ..
            } => {
                let (own, other) = owner.first(a, b);
                let n = own.rotation * normal;
                let t = perp(n);
                let q = other.point(tip);
                let (arm, way) = (q - other.centre, q - own.centre);
                let q_rate = other.velocity_of(q);
                // g = n·(q − c) − h − r, with n′ = ω t and t′ = −ω n.
                let bend = 2.0 * own.spin * t.dot(q_rate - own.velocity)
                    - own.spin * own.spin * n.dot(way)
                    - other.spin * other.spin * n.dot(arm);
                let at = (q - n * radius, q_rate - t * (radius * own.spin));
                let gap = n.dot(way) - height - radius;
                (owner, n, own.spin, at, gap, bend)
            }
            Self::Points {
                a: of_a,
                b: of_b,
                radii,
                ..
            } => {
                let (p, q) = (a.point(of_a), b.point(of_b));
                let d = q - p;
                let distance = d.length();
                let n = d / distance;
                let t = perp(n);
                let (p_rate, q_rate) = (a.velocity_of(p), b.velocity_of(q));
                let across = t.dot(q_rate - p_rate);
                // n′ = t (t·d′)/|d|
                let turning = across / distance;
                let bend = n
                    .dot((p - a.centre) * (a.spin * a.spin) - (q - b.centre) * (b.spin * b.spin))
                    + across * turning;
                let at = (p + n * radii.0, p_rate + t * (radii.0 * turning));
                let gap = distance - radii.0 - radii.1;
                (End::A, n, turning, at, gap, bend)
            }
        };
        let ((own, other), t) = (owner.first(a, b), perp(n));
        let slip = other.velocity_of(point) - own.velocity_of(point);
        let bends = |place: &Place| perp(rate - place.velocity) * place.spin;
        Seen {
            // Seen from A; both rates are the same from either side.
            normal: owner.first(n, -n).0,
            point,
            gap,
            slip: t.dot(slip),
            bend,
            drift: -turning * n.dot(slip) + t.dot(bends(other) - bends(own)),
        }
    }

    /// The body with the corner that is in touch, where in its frame, and what of the other body touches it: the normal and height of an
    /// edge, or the middle and radius of a disc.
    pub(super) fn corner(&self) -> Option<(End, Vec2, (Vec2, f64))> {
        match *self {
            Self::Line {
                owner,
                normal,
                height,
                tip,
                radius: 0.0,
                ..
            } => Some((owner.first(End::A, End::B).1, tip, (normal, height))),
            Self::Points {
                a,
                b,
                radii,
                cone: Some((owner, _)),
            } => {
                let ((corner, _), by) = owner.first((a, radii.0), (b, radii.1));
                Some((owner, corner, by))
            }
            _ => None,
        }
    }

    /// What ends the joint when it falls to 0, in m: the way left on an edge, or for a disc on a corner on its arc, and the gap of a
    /// corner beside the tip, with where it would land.
    pub(crate) fn margins(&self, a: &Place, b: &Place) -> ArrayVec<(f64, Option<Vec2>), 4> {
        let mut margins = ArrayVec::new();
        match self {
            Self::Line {
                owner,
                normal,
                height,
                ends,
                tip,
                beside,
                ..
            } => {
                let (own, other) = owner.first(a, b);
                let n = own.rotation * *normal;
                let along = perp(n).dot(other.point(*tip) - own.centre);
                for left in [along - ends[0], ends[1] - along] {
                    if left.is_finite() {
                        margins.push((left, None));
                    }
                }
                for corner in beside {
                    let at = other.point(*corner);
                    let gap = n.dot(at - own.centre) - height;
                    margins.push((gap, Some(at)));
                }
            }
            Self::Points { cone: None, .. } => {}
            Self::Points {
                a: of_a,
                b: of_b,
                radii,
                cone: Some((owner, normals)),
            } => {
                let n = (b.point(*of_b) - a.point(*of_a)).normalize();
                let (own, outward) = owner.first((a, n), (b, -n)).0;
                let arc = radii.0 + radii.1;
                let (low, high) = (own.rotation * normals[0], own.rotation * normals[1]);
                margins.push((cross(low, outward) * arc, None));
                margins.push((cross(outward, high) * arc, None));
            }
        }
        margins
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::{Rot, vec2};
    use proptest::prelude::*;

    fn moved(place: &Place, (a, alpha): (Vec2, f64), t: f64) -> Place {
        Place {
            centre: place.centre + place.velocity * t + a * (0.5 * t * t),
            rotation: place.rotation.turned(place.spin * t + 0.5 * alpha * t * t),
            velocity: place.velocity + a * t,
            spin: place.spin + alpha * t,
        }
    }

    fn place() -> impl Strategy<Value = Place> {
        let number = || -2.0..2.0_f64;
        (number(), number(), number(), number(), number(), number()).prop_map(
            |(x, y, angle, vx, vy, spin)| Place {
                centre: vec2(x, y),
                rotation: Rot::from_angle(angle),
                velocity: vec2(vx, vy),
                spin,
            },
        )
    }

    fn joint() -> impl Strategy<Value = Joint> {
        let number = || -1.0..1.0_f64;
        let owner = || prop_oneof![Just(End::A), Just(End::B)];
        let line = (
            owner(),
            number(),
            number(),
            number(),
            number(),
            0.0..0.5_f64,
        )
            .prop_map(|(owner, angle, height, x, y, radius)| Joint::Line {
                owner,
                normal: Rot::from_angle(3.0 * angle) * Vec2::X,
                height,
                ends: [-1.0, 1.0],
                tip: vec2(x, y),
                radius,
                beside: ArrayVec::new(),
            });
        let points = (
            number(),
            number(),
            number(),
            number(),
            0.1..0.5_f64,
            0.0..0.5_f64,
        )
            .prop_map(|(x, y, z, w, r, s)| Joint::Points {
                a: vec2(x, y),
                b: vec2(z, w),
                radii: (r, s),
                cone: None,
            });
        prop_oneof![line, points]
    }

    proptest! {
        /// Rows and what they change by, against differences of gap and slip themselves.
        #[test]
        fn rates_are_those_of_the_gap_and_the_slip(
            joint in joint(), a in place(), b in place(), pull in prop::array::uniform6(-3.0..3.0_f64),
        ) {
            let accelerations = (
                (vec2(pull[0], pull[1]), pull[2]),
                (vec2(pull[3], pull[4]), pull[5]),
            );
            if let Joint::Points { a: p, b: q, .. } = &joint {
                prop_assume!((b.point(*q) - a.point(*p)).length() > 0.3);
            }
            let at = |t: f64| joint.seen(&moved(&a, accelerations.0, t), &moved(&b, accelerations.1, t));
            let now = at(0.0);
            let rate = |along: Vec2| {
                let of = |place: &Place, (a, alpha): (Vec2, f64)| a + perp(now.point - place.centre) * alpha;
                (of(&b, accelerations.1) - of(&a, accelerations.0)).dot(along)
            };
            let h = 1e-4;
            let gap = (at(h).gap - 2.0 * now.gap + at(-h).gap) / (h * h);
            prop_assert!((rate(now.normal) + now.bend - gap).abs() < 1e-4 * (1.0 + gap.abs()));
            let slip = (at(h).slip - at(-h).slip) / (2.0 * h);
            let found = rate(perp(now.normal)) + now.drift;
            prop_assert!((found - slip).abs() < 1e-4 * (1.0 + slip.abs()), "{found} not {slip}");
        }
    }
}
