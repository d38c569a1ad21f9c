//! An axis at an instant: the gap of every vertex that faces it is linear in the vertex.

#![allow(
    clippy::inline_always,
    reason = "roots are inlined into the wide search"
)]

use carom_math::{Vec2, cross, vec2};

use super::approach::{Approach, Axis, Instant};
use crate::lanes::{larger, lowest, lowest_other, smaller};

/// A vertex seen along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// Vertex of A and of B that face each other; the owner of an edge axis counts as its edge.
    pub(super) vertices: [usize; 2],
    pub(super) gap: f64,
    pub(super) rate: f64,
}

/// An axis at an instant, as the vertices q of the hull that faces it see it, in that hull's frame:
///
/// ```text
/// gap(q)  = base + m·q
/// rate(q) = base_rate − w m × q
/// ```
///
/// From g = n·(d + R q) − h with n and R that turn: m = R⁻¹ n, and w is the spin of R less that of n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    /// Which hull's vertices.
    side: usize,
    /// Edge of the owner; vertex of a disc.
    opposite: usize,
    m: Vec2,
    base: f64,
    base_rate: f64,
    w: f64,
    /// Second time derivative of `base` while spins stay as they are.
    base_bend: f64,
}

impl Facing {
    pub(super) fn new(approach: &Approach<'_>, axis: Axis, at: &Instant) -> Self {
        let hulls = &approach.hulls;
        let radius = hulls[0].radius + hulls[1].radius;
        let (side, opposite, m, base, base_rate, w, base_bend) = match axis {
            Axis::Edge { owner, edge } => {
                let side = 1 - owner;
                let sign = if owner == 0 { 1.0 } else { -1.0 };
                let local = hulls[owner].normals[edge];
                let n = at.rotation[owner] * local * sign;
                let offset = local.dot(hulls[owner].vertices[edge]);
                let (along, across) = (n.dot(at.d), cross(n, at.d));
                let base = along - (offset + radius);
                // n turns with its owner: d(n·d)/dt = n·v + ω n × d, and d(n × d)/dt = n × v − ω n·d.
                let spin = at.spin[owner];
                let rate = n.dot(at.v) + spin * across;
                let bend =
                    spin * (2.0 * cross(n, at.v) - spin * along) + n.dot(approach.acceleration);
                let m = at.rotation[side].inverse_mul(n * sign);
                (side, edge, m, base, rate, at.spin[side] - spin, bend)
            }
            // One of the two is a disc: its only vertex counts as fixed to the axis.
            Axis::World { normal: n } => {
                let side = usize::from(hulls[0].is_disc());
                let disc = 1 - side;
                let sign = if side == 1 { 1.0 } else { -1.0 };
                let centre = at.rotation[disc] * hulls[disc].vertices[0] * -sign;
                let base = n.dot(at.d + centre) - radius;
                let spin = at.spin[disc];
                let rate = n.dot(at.v) - spin * cross(n, centre);
                let bend = n.dot(approach.acceleration) - spin * spin * n.dot(centre);
                let m = at.rotation[side].inverse_mul(n * sign);
                (side, 0, m, base, rate, at.spin[side], bend)
            }
        };
        Self {
            side,
            opposite,
            m,
            base,
            base_rate,
            w,
            base_bend,
        }
    }

    fn rate(&self, q: Vec2) -> f64 {
        self.base_rate - self.w * cross(self.m, q)
    }

    fn vertices(&self, vertex: usize) -> [usize; 2] {
        let mut vertices = [self.opposite; 2];
        vertices[self.side] = vertex;
        vertices
    }

    /// The smallest gap; the first of equals.
    pub(super) fn least(&self, approach: &Approach<'_>) -> Gap {
        let (vertex, _) = lowest(&approach.hulls[self.side], self.m);
        self.gap(approach, vertex)
    }

    fn gap(&self, approach: &Approach<'_>, vertex: usize) -> Gap {
        let q = approach.hulls[self.side].vertices[vertex];
        Gap {
            vertices: self.vertices(vertex),
            gap: self.base + self.m.dot(q),
            rate: self.rate(q),
        }
    }

    /// A gap seen before, as it is now, with its second time derivative while spins stay as they are.
    pub(super) fn again(&self, approach: &Approach<'_>, before: &Gap) -> (Gap, f64) {
        let gap = self.gap(approach, before.vertices[self.side]);
        (
            gap,
            self.base_bend - self.w * self.w * (gap.gap - self.base),
        )
    }

    /// Whether no other vertex than that of `gap` can close within the next `step` seconds, when −g'' of each stays
    /// below `bend`.
    pub(super) fn others_stay_open(
        &self,
        approach: &Approach<'_>,
        gap: &Gap,
        bend: f64,
        step: f64,
    ) -> bool {
        // Concave parabolas that are positive at both ends are positive between them.
        let hull = &approach.hulls[self.side];
        let others = lowest_other(hull, self.turned(step), gap.vertices[self.side]);
        bend >= 0.0 && self.base + (self.base_rate - 0.5 * bend * step) * step + others > 0.0
    }

    /// `m` after `step` seconds, to first order.
    fn turned(&self, step: f64) -> Vec2 {
        self.m + vec2(self.m.y, -self.m.x) * (self.w * step)
    }

    /// Gap and rate of every vertex.
    pub(super) fn each_gap(&self, approach: &Approach<'_>, mut visit: impl FnMut(Gap)) {
        for (i, q) in approach.hulls[self.side].vertices.iter().enumerate() {
            visit(Gap {
                vertices: self.vertices(i),
                gap: self.base + self.m.dot(*q),
                rate: self.rate(*q),
            });
        }
    }

    /// The first time, at most `limit`, at which a gap can be down at `level`, when −g'' of each stays below `bend`.
    ///
    /// With one bound for all, `g + g' τ − bend τ²/2` is linear in the vertex but for its last term. So
    /// the root of the lowest vertex counts, unless another vertex is lower by then: its root comes first.
    pub(super) fn certified_step(
        &self,
        approach: &Approach<'_>,
        least: &Gap,
        level: f64,
        bend: f64,
        limit: f64,
    ) -> f64 {
        let hull = &approach.hulls[self.side];
        let from = |vertex: usize, limit: f64| {
            let q = hull.vertices[vertex];
            certified(self.base + self.m.dot(q) - level, self.rate(q), bend, limit)
        };
        if bend < 0.0 {
            // Parabolas that open upwards may dip and come back in between.
            return (0..hull.vertices.len()).fold(limit, |step, vertex| from(vertex, step));
        }
        let mut vertex = least.vertices[self.side];
        let mut step = from(vertex, limit);
        if self.w == 0.0 {
            return step;
        }
        loop {
            let (lower, _) = lowest(hull, self.turned(step));
            let shorter = from(lower, step);
            if lower == vertex || shorter >= step {
                return step;
            }
            (vertex, step) = (lower, shorter);
        }
    }
}

/// The smaller of `limit` and the first root of `g + g' τ − bend τ²/2`: no contact before it.
fn certified(g: f64, rate: f64, bend: f64, limit: f64) -> f64 {
    if bend >= 0.0 {
        concave(g, rate, bend, limit)
    } else if rate * rate + 2.0 * bend * g < 0.0 {
        limit
    } else {
        first_root(g, rate, bend, limit)
    }
}

/// The same where `g` and `bend` are not below 0.
#[inline(always)]
pub(super) fn concave(g: f64, rate: f64, bend: f64, limit: f64) -> f64 {
    // A concave parabola that is positive at both ends is positive between them.
    if g + (rate - 0.5 * bend * limit) * limit > 0.0 {
        limit
    } else {
        first_root(g, rate, bend, limit)
    }
}

/// The same where there is a root, or none comes down.
#[inline(always)]
fn first_root(g: f64, rate: f64, bend: f64, limit: f64) -> f64 {
    let root = (rate * rate + 2.0 * bend * g).sqrt();
    // Both forms are the same root; each is taken where it does not cancel.
    let step = if rate < 0.0 {
        2.0 * g / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        return limit;
    };
    smaller(larger(step, 0.0), limit)
}
