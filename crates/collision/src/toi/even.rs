//! Fast path of the time of impact for constant relative velocity and constant spins: vertex–edge and disc contacts only.
//!
//! It finds a vertex that meets the inside of an edge, a disc that meets an edge or a corner, and pairs that separate after
//! the impact just resolved. It returns `None` for anything else (vertex–vertex, flat landings, overlaps), which
//! [`super::search`] then answers. Disc–disc is solved in closed form.
//! Dispatched once a search; everything is inlined there, so that four corners are one instruction.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use arrayvec::ArrayVec;
use carom_geometry::Shape;
use carom_math::{Rot, SimTime, Vec2, perp};
use fearless_simd::{Level, Simd, dispatch};

use super::approach::{Axis, circles_meet};
use super::corners::Corners;
use super::search::{NEAR, SLACK};
use super::sight::{Even, Normal, Place, Sight};
use super::turns::{LARGEST, turned};
use super::{Impact, ImpactFeature, TimeOfImpact, discs};
use crate::lanes::{larger, smaller};
use crate::{AxisFeature, Hull, Motion, Side};

/// Steps and axes together before the general search takes over: it has a larger budget.
const STEPS: usize = 64;

/// What the search does next.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    /// Looks along the axis of the last impact, which opens.
    Parts,
    /// Looks for the widest axis.
    Looks,
    /// Goes on along an axis.
    Advances,
}

/// What the search has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    Clear,
    /// One point: see [`Impact`].
    Hit {
        time: f64,
        normal: Vec2,
        point: Vec2,
        feature: AxisFeature,
        gap_rate: f64,
    },
}

impl From<Found> for TimeOfImpact {
    fn from(found: Found) -> Self {
        match found {
            Found::Clear => Self::Clear,
            Found::Hit {
                time,
                normal,
                point,
                feature,
                gap_rate,
            } => Self::Hit(Impact {
                time,
                normal,
                points: ArrayVec::from_iter([point]),
                features: ArrayVec::from_iter([ImpactFeature::of(feature)]),
                gap_rate,
            }),
        }
    }
}

/// The first contact within `horizon` seconds of `start`, which no motion begins after; `None` if that is not for this
/// search to say.
pub(super) fn first_contact(
    level: Level,
    hulls: (&Hull<'_>, &Hull<'_>),
    motions: (&Motion, &Motion),
    span: (SimTime, f64),
    last: Option<Axis>,
) -> Option<Found> {
    let corners = [Corners::of(hulls.0)?, Corners::of(hulls.1)?];
    first_contact_of(level, corners, motions, span, last)
}

/// The same of shapes.
#[inline]
pub(super) fn first_contact_of_shapes(
    level: Level,
    shapes: (&Shape, &Shape),
    motions: (&Motion, &Motion),
    span: (SimTime, f64),
    last: Option<Axis>,
) -> Option<Found> {
    let corners = [Corners::of_shape(shapes.0)?, Corners::of_shape(shapes.1)?];
    first_contact_of(level, corners, motions, span, last)
}

#[inline]
fn first_contact_of(
    level: Level,
    corners: [Corners<'_>; 2],
    (a, b): (&Motion, &Motion),
    span: (SimTime, f64),
    last: Option<Axis>,
) -> Option<Found> {
    if corners[0].is_disc() && corners[1].is_disc() {
        let radii = [corners[0].radius, corners[1].radius];
        let alike = a.acceleration == b.acceleration;
        return alike
            .then(|| discs::first_contact(radii, (a, b), span))
            .flatten();
    }
    let turning = |k: usize, motion: &Motion| !corners[k].is_disc() && motion.spin != 0.0;
    let turns = turning(0, a) || turning(1, b);
    let steady = a.acceleration == b.acceleration
        && a.angular_acceleration == 0.0
        && b.angular_acceleration == 0.0;
    if !(turns && steady) {
        return None;
    }
    dispatch!(level, simd => contact_of(simd, corners, (a, b), span, last))
}

#[inline(always)]
fn contact_of<S: Simd>(
    simd: S,
    hulls: [Corners<'_>; 2],
    (a, b): (&Motion, &Motion),
    (start, horizon): (SimTime, f64),
    last: Option<Axis>,
) -> Option<Found> {
    let ages = [start - a.start, start - b.start];
    let arms = [hulls[0].arm(simd), hulls[1].arm(simd)];
    let (centre, velocity) = (
        a.centre + a.travel(ages[0]),
        a.velocity + a.acceleration * ages[0],
    );
    let d = b.centre + b.travel(ages[1]) - centre;
    let v = b.velocity + b.acceleration * ages[1] - velocity;
    let distance = d.length();
    let reaches = [arms[0] + hulls[0].radius, arms[1] + hulls[1].radius];
    let reach = (reaches[0] + reaches[1]) * (1.0 + 1e-9) + 1e-14 * distance;
    let Some((from, until)) = circles_meet(d, v, reach, horizon) else {
        return Some(Found::Clear);
    };
    let spin = [a.spin, b.spin];
    let turn = [spin[0].abs(), spin[1].abs()];
    let oldest = larger(ages[0], ages[1]);
    let keeps_digits = (turn[0] + turn[1]) * (oldest + until) <= LARGEST;
    if !keeps_digits {
        return None;
    }
    let speed = v.length();
    let fastest = speed + turn[0] * reaches[0] + turn[1] * reaches[1];
    // |g''| ≤ 2 ω_E s + ω_E² R + (ω_V − ω_E)² ρ, and a straight way is farthest at one of its ends.
    let near = d + v * from;
    let far = larger(near.length_squared(), (d + v * until).length_squared()).sqrt();
    let relative = (spin[1] - spin[0]) * (spin[1] - spin[0]);
    let bends = [
        turn[0] * (2.0 * speed + turn[0] * far) + relative * arms[1],
        turn[1] * (2.0 * speed + turn[1] * far) + relative * arms[0],
        turn[0] * turn[0] * arms[0] + turn[1] * turn[1] * arms[1],
    ];
    let lengths = distance + reaches[0] + reaches[1];
    let rounding = 6.0 * f64::EPSILON;
    let even = Even {
        simd,
        hulls,
        from,
        lasts: until - from,
        centre,
        velocity,
        acceleration: a.acceleration,
        d: [near, -near],
        v: [v, -v],
        spin,
        bends,
        disc: hulls.iter().position(Corners::is_disc),
        rounding: (rounding * (lengths + fastest * from), rounding * fastest),
        size: smaller(reaches[0], reaches[1]),
        closing: -1e-13 * fastest,
    };
    let turns = [spin[0] * (ages[0] + from), spin[1] * (ages[1] + from)];
    even.search([a.rotation, b.rotation], turns, last)
}

impl<S: Simd> Even<'_, S> {
    /// From rotations that are turned by `turns` at the begin of the window.
    #[inline(always)]
    fn search(&self, mut from: [Rot; 2], mut turns: [f64; 2], last: Option<Axis>) -> Option<Found> {
        let mut place = Place {
            tau: 0.0,
            d: self.d,
            rotation: from,
        };
        let mut moved = true;
        let (mut owner, mut normal, mut next) = match last {
            Some(Axis::Edge { owner, edge }) => (owner, Normal::Edge(edge), Next::Parts),
            _ => (0, Normal::Edge(0), Next::Looks),
        };
        for _ in 0..STEPS {
            if moved {
                place.rotation = turned(self.simd, from, turns);
                if place.tau == 0.0 {
                    let [a, b] = place.rotation;
                    from = [a.renormalized(), b.renormalized()];
                    place.rotation = from;
                }
                moved = false;
            }
            if next == Next::Looks {
                (owner, normal) = match self.disc {
                    Some(disc) => (1 - disc, self.toward(disc, &place)),
                    None => self.widest(&place),
                };
            }
            let sight = self.sight(owner, normal, &place);
            let tolerance = self.rounding.0 + self.rounding.1 * place.tau;
            let mut level = tolerance;
            if sight.gap <= tolerance {
                let closes = sight.rate < self.closing;
                // A disc and a polygon have but one axis: once that is closed they touch.
                let touches = next == Next::Looks && self.disc.is_some() && place.tau > 0.0;
                // A vertex well within an edge: their distance is that gap, and no axis is open.
                if closes && (touches || next == Next::Advances && self.is_alone(&sight, &place)) {
                    return self.contact(&sight, &place);
                }
                if next == Next::Advances {
                    next = Next::Looks;
                    continue;
                }
                let slack = larger(SLACK * self.size, 2.0 * tolerance);
                let parts = next == Next::Parts || self.disc.is_some() && place.tau == 0.0;
                if !parts
                    || sight.gap < -slack
                    || sight.rate <= -self.closing
                    || self.is_flat(&sight)
                {
                    return None;
                }
                // They touch where they have struck each other, and part: no other axis matters.
                next = Next::Parts;
                level = sight.gap - slack;
            } else if next == Next::Parts {
                next = Next::Looks;
                continue;
            }
            let left = self.lasts - place.tau;
            let crossing = if next == Next::Parts {
                None
            } else {
                self.crossing(&sight, place.tau, left)
            };
            let step = match crossing {
                Some(step) => step,
                None => self.certified_step(&sight, level, left),
            };
            let tau = place.tau + step;
            if tau >= self.lasts {
                return Some(Found::Clear);
            }
            place.tau = larger(tau, place.tau.next_up());
            let d = self.d[0] + self.v[0] * place.tau;
            place.d = [d, -d];
            turns = [self.spin[0] * place.tau, self.spin[1] * place.tau];
            moved = true;
            next = Next::Advances;
        }
        None
    }

    /// The vertex has come down on the edge, or the disc on the corner.
    #[inline(always)]
    fn contact(&self, sight: &Sight, place: &Place) -> Option<Found> {
        let (own, near) = (&self.hulls[sight.owner], NEAR * self.size);
        if self.is_flat(sight) {
            return None;
        }
        let rotation = [
            place.rotation[0].renormalized(),
            place.rotation[1].renormalized(),
        ];
        let vertex = rotation[sight.side] * sight.q;
        // From the owner's centre, and away from it.
        let (point, away, feature) = match sight.normal {
            Normal::Edge(edge) => {
                let here = rotation[sight.owner];
                let normal = own.normal(edge);
                let away = here * normal;
                let point = place.d[sight.owner] + vertex - away * self.hulls[sight.side].radius;
                // Within the edge, not at its end.
                let (from, to) = (own.corner(edge), own.corner(own.next(edge)));
                let (local, along) = (here.inverse_mul(point), perp(normal));
                if along.dot(local - from) <= near || along.dot(to - local) <= near {
                    return None;
                }
                let owner = if sight.owner == 0 { Side::A } else { Side::B };
                let vertex = sight.vertex;
                (
                    point,
                    away,
                    AxisFeature::Edge {
                        owner,
                        edge,
                        vertex,
                    },
                )
            }
            Normal::World(n) => {
                let (a, b) = if sight.owner == 0 {
                    (sight.vertex, 0)
                } else {
                    (0, sight.vertex)
                };
                (vertex, n, AxisFeature::Vertices { a, b })
            }
        };
        // A last Newton step, by less than what moves anything; but what touched to begin with, overlapped by rounding and
        // comes back as slowly was no less deep before the search begins.
        let newton = self.from + (place.tau - sight.gap / sight.rate);
        let tau = if newton > 0.0 {
            newton
        } else {
            self.from + place.tau
        };
        let centre = self.centre + (self.velocity + self.acceleration * (0.5 * tau)) * tau;
        let (point, normal) = if sight.owner == 0 {
            (centre + point, away)
        } else {
            (centre + (place.d[0] + point), -away)
        };
        Some(Found::Hit {
            time: tau,
            normal,
            point,
            feature,
            gap_rate: sight.rate,
        })
    }
}
