//! Two polygons that keep their velocities and spins, or a polygon and a disc: the search of [`super::search`] without its
//! rare ways.
//!
//! It knows one vertex that comes down on the inside of an edge, a disc that meets an edge or a corner, and pairs that part
//! where they have just struck. Everything else (corners that meet, flat landings, overlaps) it leaves to the general search.
//! Dispatched once a search; everything is inlined there, so that four corners are one instruction.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::{Rot, SimTime, Vec2, cross, perp};
use fearless_simd::{Level, Simd, dispatch};

use super::approach::{Axis, circles_meet};
use super::corners::Corners;
use super::search::{NEAR, SLACK};
use super::turns::{LARGEST, sines_and_cosines, turned};
use crate::{AxisFeature, Hull, Motion, Side};

/// Steps and axes together before the general search takes over: it has a larger budget.
const STEPS: usize = 64;

/// Both from the instant on at which they are near enough to touch.
struct Even<'a, S: Simd> {
    simd: S,
    hulls: [Corners<'a>; 2],
    /// Seconds until then, and how long they stay near enough.
    from: f64,
    lasts: f64,
    /// Centre of A now, how fast it moves and how fast that changes.
    centre: Vec2,
    velocity: Vec2,
    acceleration: Vec2,
    /// Centre of the other minus the centre of each, and its rate.
    d: [Vec2; 2],
    v: [Vec2; 2],
    spin: [f64; 2],
    /// Bounds on |g''| along the axes of each, and along those of the world.
    bends: [f64; 3],
    /// The disc, if one is.
    disc: Option<usize>,
    /// Rounding of a gap at the start, and how it grows, in m/s.
    rounding: (f64, f64),
    /// The smaller reach.
    size: f64,
    /// Slowest approach that is one.
    closing: f64,
}

/// Where both are, `tau` seconds into the window.
#[derive(Clone, Copy)]
struct Place {
    tau: f64,
    d: [Vec2; 2],
    rotation: [Rot; 2],
}

/// What an axis is the normal of.
#[derive(Clone, Copy)]
enum Normal {
    /// Of an edge, with which it turns.
    Edge(usize),
    /// Of nothing: away from the polygon to the disc, fixed in the world.
    World(Vec2),
}

/// An axis, and the vertex that is lowest along it: see [`super::facing::Facing`].
#[derive(Clone, Copy)]
struct Sight {
    /// Whose edge it is; of a fixed axis the polygon.
    owner: usize,
    normal: Normal,
    /// How fast it turns, and the polygon with the vertex against it.
    spin: f64,
    w: f64,
    bend: f64,
    /// Whose vertex, which, and where in its frame.
    side: usize,
    vertex: usize,
    q: Vec2,
    /// The axis in the world, away from the owner; and as the vertex sees what it faces.
    n: Vec2,
    m: Vec2,
    /// n·d and n × d, with d from the owner on.
    along: f64,
    across: f64,
    /// What is to be left of n·d when they touch, but for the vertex.
    height: f64,
    gap: f64,
    rate: f64,
    base_rate: f64,
}

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
    /// One point: see [`super::Impact`].
    Hit {
        time: f64,
        normal: Vec2,
        point: Vec2,
        feature: AxisFeature,
        gap_rate: f64,
    },
}

/// The first contact within `horizon` seconds of `start`, which no motion begins after; `None` if that is not for this
/// search to say.
pub(super) fn first_contact(
    level: Level,
    hulls: (&Hull<'_>, &Hull<'_>),
    (a, b): (&Motion, &Motion),
    (start, horizon): (SimTime, f64),
    last: Option<Axis>,
) -> Option<Found> {
    let corners = [Corners::of(hulls.0)?, Corners::of(hulls.1)?];
    let turning = |k: usize, motion: &Motion| !corners[k].is_disc() && motion.spin != 0.0;
    let turns = turning(0, a) || turning(1, b);
    let steady = a.acceleration == b.acceleration
        && a.angular_acceleration == 0.0
        && b.angular_acceleration == 0.0;
    if !(turns && steady) {
        return None;
    }
    dispatch!(level, simd => contact_of(simd, corners, (a, b), (start, horizon), last))
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

    /// The edge whose line is farthest from the other polygon, and its owner.
    #[inline(always)]
    fn widest(&self, place: &Place) -> (usize, Normal) {
        let (a, b) = (&self.hulls[0], &self.hulls[1]);
        let [from, to] = place.rotation;
        let turn = from.inverse() * to;
        let offset = from.inverse_mul(place.d[0]);
        let of_a = a.widest(self.simd, b, turn, offset);
        let offset = to.inverse_mul(place.d[1]);
        let of_b = b.widest(self.simd, a, turn.inverse(), offset);
        if of_b.1 > of_a.1 {
            (1, Normal::Edge(of_b.0))
        } else {
            (0, Normal::Edge(of_a.0))
        }
    }

    /// From the polygon to the disc: the normal of the edge that this lies over, or away from the nearest corner.
    #[inline(always)]
    fn toward(&self, disc: usize, place: &Place) -> Normal {
        let hull = &self.hulls[1 - disc];
        let rotation = place.rotation[1 - disc];
        let centre = rotation.inverse_mul(place.d[1 - disc]);
        let edge = hull.highest(self.simd, centre);
        let (from, to) = (hull.corner(edge), hull.corner(hull.next(edge)));
        let along = perp(hull.normal(edge));
        let corner = if along.dot(centre - from) < 0.0 {
            from
        } else if along.dot(centre - to) > 0.0 {
            to
        } else {
            return Normal::Edge(edge);
        };
        let away = rotation * (centre - corner);
        Normal::World(away / away.length())
    }

    #[inline(always)]
    fn sight(&self, owner: usize, normal: Normal, place: &Place) -> Sight {
        let own = &self.hulls[owner];
        let (n, faced, height, spin, side) = match normal {
            Normal::Edge(edge) => {
                let local = own.normal(edge);
                let n = place.rotation[owner] * local;
                let height = local.dot(own.corner(edge));
                (n, n, height, self.spin[owner], 1 - owner)
            }
            Normal::World(n) => (n, -n, 0.0, 0.0, owner),
        };
        let other = &self.hulls[side];
        let height = height + (self.hulls[0].radius + self.hulls[1].radius);
        let m = place.rotation[side].inverse_mul(faced);
        let vertex = other.lowest(self.simd, m);
        let q = other.corner(vertex);
        let (along, across) = (n.dot(place.d[owner]), cross(n, place.d[owner]));
        let base_rate = n.dot(self.v[owner]) + spin * across;
        let w = self.spin[side] - spin;
        Sight {
            owner,
            normal,
            spin,
            w,
            bend: self.bends[if side == owner { 2 } else { owner }],
            side,
            vertex,
            q,
            n,
            m,
            along,
            across,
            height,
            gap: (along - height) + m.dot(q),
            rate: base_rate - w * cross(m, q),
            base_rate,
        }
    }

    /// When the lowest vertex reaches the edge, if it is certain to within `left` seconds, and before any other: seconds
    /// from now on.
    ///
    /// From what is seen now the gap is
    /// ```text
    /// g(s) = (n·d + n·v s) cos ω_E s + (n×d + n×v s) sin ω_E s − h + m·q cos w s − m×q sin w s,    w = ω_V − ω_E
    /// ```
    /// and Newton's method with g'' as third term (Halley 1694) finds where it is 0.
    #[inline(always)]
    fn crossing(&self, sight: &Sight, tau: f64, left: f64) -> Option<f64> {
        let bend = sight.bend;
        let square = sight.rate * sight.rate;
        if sight.rate >= 0.0 || square <= 2.5 * bend * sight.gap {
            return None;
        }
        let latest = 2.0 * sight.gap / ((square - 2.0 * bend * sight.gap).sqrt() - sight.rate);
        if latest >= left {
            return None;
        }
        let fine = 0.01 * (self.rounding.0 + self.rounding.1 * (tau + latest));
        let (spin, w) = (sight.spin, sight.w);
        let third = 0.5 * (self.spin[0].abs() + self.spin[1].abs()) * bend;
        let v = self.v[sight.owner];
        let (nv, cv) = (sight.n.dot(v), cross(sight.n, v));
        let (mq, cq) = (sight.m.dot(sight.q), cross(sight.m, sight.q));
        let mut s = 0.0;
        let (mut gap, mut rate) = (sight.gap, sight.rate);
        let (mut along, mut rising, mut low) = (sight.along, cv, mq);
        for _ in 0..8 {
            let curve = spin * (2.0 * rising - spin * along) - w * w * low;
            let square = rate * rate - 2.0 * curve * gap;
            if square < 0.0 || rate >= 0.0 {
                return None;
            }
            let step = 2.0 * gap / (square.sqrt() - rate);
            s = smaller(larger(s + step, 0.0), latest);
            // The third derivative is at most 3 ω M: this is what the step leaves of the gap.
            if third * step.abs() * step * step <= fine {
                return self.others_stay_open(sight, bend, s).then_some(s);
            }
            let [s0, s1, c0, c1] = sines_and_cosines(self.simd, [spin * s, w * s]);
            let (da, dc) = (sight.along + nv * s, sight.across + cv * s);
            along = c0 * da + s0 * dc;
            rising = c0 * cv - s0 * nv;
            low = c1 * mq - s1 * cq;
            gap = (along - sight.height) + low;
            rate = (c0 * nv + s0 * cv) + spin * (c0 * dc - s0 * da) - w * (c1 * cq + s1 * mq);
        }
        None
    }

    /// Whether no other vertex can close within the next `step` seconds.
    #[inline(always)]
    fn others_stay_open(&self, sight: &Sight, bend: f64, step: f64) -> bool {
        // Concave parabolas that are positive at both ends are positive between them.
        let m = self.ahead(sight, step);
        let others = self.hulls[sight.side].lowest_but(self.simd, m, sight.q);
        let base = sight.along - sight.height;
        base + (sight.base_rate - 0.5 * bend * step) * step + others > 0.0
    }

    /// `m` after `step` seconds, to first order.
    #[inline(always)]
    fn ahead(&self, sight: &Sight, step: f64) -> Vec2 {
        sight.m - perp(sight.m) * (sight.w * step)
    }

    /// The first time, at most `limit`, at which a gap can be down at `level`: see
    /// [`super::facing::Facing::certified_step`].
    #[inline(always)]
    fn certified_step(&self, sight: &Sight, level: f64, limit: f64) -> f64 {
        let hull = &self.hulls[sight.side];
        let base = sight.along - sight.height - level;
        let (mut step, mut vertex) = (limit, sight.vertex);
        let (mut gap, mut rate) = (sight.gap - level, sight.rate);
        loop {
            let shorter = root(gap, rate, sight.bend, step);
            if vertex != sight.vertex && shorter >= step {
                return step;
            }
            step = shorter;
            let lower = hull.lowest(self.simd, self.ahead(sight, step));
            if lower == vertex {
                return step;
            }
            vertex = lower;
            let q = hull.corner(vertex);
            gap = base + sight.m.dot(q);
            rate = sight.base_rate - sight.w * cross(sight.m, q);
        }
    }

    /// Whether another vertex touches with the lowest.
    #[inline(always)]
    fn is_flat(&self, sight: &Sight) -> bool {
        let others = self.hulls[sight.side].lowest_but(self.simd, sight.m, sight.q);
        (sight.along - sight.height) + others <= sight.gap + NEAR * self.size
    }

    /// Whether no other axis is that little closed: see [`super::approach::Approach::is_alone`].
    #[inline(always)]
    fn is_alone(&self, sight: &Sight, place: &Place) -> bool {
        let Normal::Edge(edge) = sight.normal else {
            return false;
        };
        let floor = sight.gap - 2.0 * NEAR * self.size;
        let (own, other) = (&self.hulls[sight.owner], &self.hulls[1 - sight.owner]);
        let here = place.rotation[sight.owner];
        let there = place.rotation[1 - sight.owner];
        let d = place.d[sight.owner];
        let vertex = here.inverse_mul(there * sight.q + d);
        let (from, to) = (own.corner(edge), own.corner(own.next(edge)));
        if other.is_disc() {
            let along = perp(own.normal(edge));
            return along.dot(vertex - from) > 0.0 && along.dot(to - vertex) > 0.0;
        }
        let seen = [
            there.inverse_mul(here * from - d),
            there.inverse_mul(here * to - d),
        ];
        own.highest_but(self.simd, vertex, from) < floor
            && other.highest_of(self.simd, seen[0], seen[1]) < floor
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
        // A last Newton step, by less than what moves anything.
        let tau = self.from + (place.tau - sight.gap / sight.rate);
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

#[inline(always)]
fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

#[inline(always)]
fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The smaller of `limit` and the first root of `g + g' τ − bend τ²/2` with bend ≥ 0.
#[inline(always)]
fn root(g: f64, rate: f64, bend: f64, limit: f64) -> f64 {
    if g + (rate - 0.5 * bend * limit) * limit > 0.0 {
        return limit;
    }
    let root = (rate * rate + 2.0 * bend * g).sqrt();
    let step = if rate < 0.0 {
        2.0 * g / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        return limit;
    };
    smaller(larger(step, 0.0), limit)
}
