//! An axis of two polygons in even motion, or of a polygon and a disc: what is seen along it, and until when it surely stays
//! open. What [`super::facing`] is for all pairs.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use carom_math::{Rot, Vec2, cross, perp};
use fearless_simd::Simd;

use super::corners::Corners;
use super::facing::concave;
use super::search::NEAR;
use super::turns::sines_and_cosines;
use crate::lanes::larger;

/// Both from the instant on at which they are near enough to touch.
pub(super) struct Even<'a, S: Simd> {
    pub(super) simd: S,
    pub(super) hulls: [Corners<'a>; 2],
    /// Seconds until then, and how long they stay near enough.
    pub(super) from: f64,
    pub(super) lasts: f64,
    /// Centre of A now, how fast it moves and how fast that changes.
    pub(super) centre: Vec2,
    pub(super) velocity: Vec2,
    pub(super) acceleration: Vec2,
    /// Centre of the other minus the centre of each, and its rate.
    pub(super) d: [Vec2; 2],
    pub(super) v: [Vec2; 2],
    pub(super) spin: [f64; 2],
    /// Bounds on |g''| along the axes of each, and along those of the world.
    pub(super) bends: [f64; 3],
    /// The disc, if one is.
    pub(super) disc: Option<usize>,
    /// Rounding of a gap at the start, and how it grows, in m/s.
    pub(super) rounding: (f64, f64),
    /// The smaller reach.
    pub(super) size: f64,
    /// Slowest approach that is one.
    pub(super) closing: f64,
}

/// Where both are, `tau` seconds into the window.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) tau: f64,
    pub(super) d: [Vec2; 2],
    pub(super) rotation: [Rot; 2],
}

/// What an axis is the normal of.
#[derive(Clone, Copy)]
pub(super) enum Normal {
    /// Of an edge, with which it turns.
    Edge(usize),
    /// Of nothing: away from the polygon to the disc, fixed in the world.
    World(Vec2),
}

/// An axis, and the vertex that is lowest along it: see [`super::facing::Facing`].
#[derive(Clone, Copy)]
pub(super) struct Sight {
    /// The polygon with the edge, or with a fixed axis.
    pub(super) owner: usize,
    pub(super) normal: Normal,
    /// How fast it turns, and the polygon with the vertex against it.
    pub(super) spin: f64,
    pub(super) w: f64,
    pub(super) bend: f64,
    /// The vertex: its polygon, its index, and its place in the polygon's frame.
    pub(super) side: usize,
    pub(super) vertex: usize,
    pub(super) q: Vec2,
    /// The axis in the world, away from the owner; and as the vertex sees what it faces.
    pub(super) n: Vec2,
    pub(super) m: Vec2,
    /// n·d and n × d, with d from the owner on.
    pub(super) along: f64,
    pub(super) across: f64,
    /// What is to be left of n·d when they touch, but for the vertex.
    pub(super) height: f64,
    pub(super) gap: f64,
    pub(super) rate: f64,
    pub(super) base_rate: f64,
}

impl<S: Simd> Even<'_, S> {
    /// The edge with the line farthest from the other polygon, and its owner.
    #[inline(always)]
    pub(super) fn widest(&self, place: &Place) -> (usize, Normal) {
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
    pub(super) fn toward(&self, disc: usize, place: &Place) -> Normal {
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
    pub(super) fn sight(&self, owner: usize, normal: Normal, place: &Place) -> Sight {
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

    /// When the lowest vertex reaches the edge, if that is certain to be within `left` seconds and before any other:
    /// seconds from now on.
    ///
    /// From what is seen now the gap is
    /// ```text
    /// g(s) = (n·d + n·v s) cos ω_E s + (n×d + n×v s) sin ω_E s − h + m·q cos w s − m×q sin w s,    w = ω_V − ω_E
    /// ```
    /// and Newton's method with g'' as third term (Halley 1694) finds where it is 0. With −g'' ≤ M it is above 0 for
    /// (√(g'² + 2 M g) + g')/M after now and for 2 |g'|/M before that root: together that is all the time between, or
    /// the root need not be the first.
    #[inline(always)]
    pub(super) fn crossing(&self, sight: &Sight, tau: f64, left: f64) -> Option<f64> {
        let bend = sight.bend;
        if sight.rate >= 0.0 {
            return None;
        }
        let open = (sight.rate * sight.rate + 2.0 * bend * sight.gap).sqrt() + sight.rate;
        let (spin, w) = (sight.spin, sight.w);
        let third = 0.5 * (self.spin[0].abs() + self.spin[1].abs()) * bend;
        let v = self.v[sight.owner];
        let (nv, cv) = (sight.n.dot(v), cross(sight.n, v));
        let (mq, cq) = (sight.m.dot(sight.q), cross(sight.m, sight.q));
        let mut s = 0.0;
        let (mut gap, mut rate) = (sight.gap, sight.rate);
        let (mut along, mut rising, mut low) = (sight.along, cv, mq);
        let mut m = sight.m;
        for _ in 0..8 {
            let curve = spin * (2.0 * rising - spin * along) - w * w * low;
            let square = rate * rate - 2.0 * curve * gap;
            if square < 0.0 || rate >= 0.0 {
                return None;
            }
            let root = square.sqrt();
            let step = 2.0 * gap / (root - rate);
            s = larger(s + step, 0.0);
            if s >= left || open + 1.9 * root < bend * s {
                return None;
            }
            // The third derivative is at most 3 ω M: this is what the step leaves of the gap.
            let fine = 0.01 * (self.rounding.0 + self.rounding.1 * (tau + s));
            if third * step.abs() * step * step <= fine {
                let m = m - perp(m) * (w * step);
                return self.others_stay_open(sight, m, s).then_some(s);
            }
            let [s0, s1, c0, c1] = sines_and_cosines(self.simd, [spin * s, w * s]);
            let (da, dc) = (sight.along + nv * s, sight.across + cv * s);
            along = c0 * da + s0 * dc;
            rising = c0 * cv - s0 * nv;
            m = sight.m * c1 - perp(sight.m) * s1;
            low = c1 * mq - s1 * cq;
            gap = (along - sight.height) + low;
            rate = (c0 * nv + s0 * cv) + spin * (c0 * dc - s0 * da) - w * (c1 * cq + s1 * mq);
        }
        None
    }

    /// Whether no other vertex closes until the lowest does, `step` seconds from now, when the other side sees `m`.
    ///
    /// Gaps p now and r then with |g''| ≤ M are above `p (1 − x) + r x − K x (1 − x)` between, K = M s²/2, which has no
    /// root if K < (√p + √r)². All others are at least as wide now as the lowest.
    #[inline(always)]
    fn others_stay_open(&self, sight: &Sight, m: Vec2, step: f64) -> bool {
        let now = sight.gap;
        let then = self.hulls[sight.side].lowest_but(self.simd, m, sight.q) - m.dot(sight.q);
        let beyond = 0.5 * sight.bend * step * step - now - then;
        then > NEAR * self.size && (beyond < 0.0 || beyond * beyond < 4.0 * now * then)
    }

    /// `m` after `step` seconds, to first order.
    #[inline(always)]
    fn ahead(&self, sight: &Sight, step: f64) -> Vec2 {
        sight.m - perp(sight.m) * (sight.w * step)
    }

    /// The first time, at most `limit`, at which a gap can be down at `level`: see
    /// [`super::facing::Facing::certified_step`].
    #[inline(always)]
    pub(super) fn certified_step(&self, sight: &Sight, level: f64, limit: f64) -> f64 {
        let hull = &self.hulls[sight.side];
        let base = sight.along - sight.height - level;
        let (mut step, mut vertex) = (limit, sight.vertex);
        let (mut gap, mut rate) = (sight.gap - level, sight.rate);
        loop {
            let shorter = concave(gap, rate, sight.bend, step);
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
    pub(super) fn is_flat(&self, sight: &Sight) -> bool {
        let others = self.hulls[sight.side].lowest_but(self.simd, sight.m, sight.q);
        (sight.along - sight.height) + others <= sight.gap + NEAR * self.size
    }

    /// Whether no other axis is that little closed: see [`super::approach::Approach::is_alone`].
    #[inline(always)]
    pub(super) fn is_alone(&self, sight: &Sight, place: &Place) -> bool {
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
}
