//! Two convex hulls in relative motion: gaps along an axis, their rates and their bounds.

use carom_math::{Rot, Vec2, cross_scalar};

use crate::{Hull, Motion};

/// A direction that may separate two hulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    /// Normal of an edge; it turns with its owner (0 is A, 1 is B).
    Edge { owner: usize, edge: usize },
    /// A direction fixed in the world, from A to B.
    World { normal: Vec2 },
}

/// A vertex (or a pair of them along a world axis) seen along an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    /// Vertex of A and of B that face each other; the owner of an edge axis counts as its edge.
    pub(super) vertices: [usize; 2],
    pub(super) gap: f64,
    pub(super) rate: f64,
}

/// Relative state at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// Centre of B minus centre of A, and its rate.
    pub(super) d: Vec2,
    pub(super) v: Vec2,
    pub(super) rotation: [Rot; 2],
    pub(super) spin: [f64; 2],
}

/// Two hulls whose motions start together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach<'a> {
    pub(super) hulls: [Hull<'a>; 2],
    motions: [Motion; 2],
    d: Vec2,
    v: Vec2,
    acceleration: Vec2,
    /// Largest distance of a point of the hull from the centre of its motion.
    pub(super) reach: [f64; 2],
}

impl<'a> Approach<'a> {
    pub(super) fn new(a: Hull<'a>, motion_a: &Motion, b: Hull<'a>, motion_b: &Motion) -> Self {
        let start = motion_a.start.max(motion_b.start);
        let motions = [motion_a.rebased(start), motion_b.rebased(start)];
        let reach = |hull: &Hull<'_>| {
            let square = hull.vertices.iter().map(|v| v.length_squared());
            square.fold(0.0, f64::max).sqrt() + hull.radius
        };
        Self {
            hulls: [a, b],
            d: motions[1].centre - motions[0].centre,
            v: motions[1].velocity - motions[0].velocity,
            acceleration: motions[1].acceleration - motions[0].acceleration,
            reach: [reach(&a), reach(&b)],
            motions,
        }
    }

    /// Bounding circles of the hulls that cannot meet, however they turn.
    pub(super) fn stays_apart(&self, horizon: f64) -> bool {
        if self.wall().is_some() {
            return false;
        }
        let circle = |k: usize| {
            let hull = &self.hulls[k];
            let bounds = hull.aabb(carom_math::Pose::IDENTITY);
            let centre = bounds.centre();
            let radius = bounds.extents().length() * 0.5;
            let turn = self.fastest_spin(k, horizon) * horizon * centre.length();
            (self.motions[k].rotation * centre, radius + turn)
        };
        let ((centre_a, radius_a), (centre_b, radius_b)) = (circle(0), circle(1));
        let apart = (self.d + centre_b - centre_a).length();
        apart > (radius_a + radius_b + self.fastest(horizon) * horizon) * (1.0 + 1e-9)
    }

    /// Rounding of a gap at `tau`: what lies below is touching. Distance, sizes and travel, turning
    /// included, each carry roundings of their own size.
    pub(super) fn tolerance(&self, tau: f64) -> f64 {
        let travel = (self.speed() + self.pull() * tau) * tau;
        6.0 * f64::EPSILON * (self.d.length() + self.reach[0] + self.reach[1] + travel)
    }

    /// The smaller hull's reach: lengths that mean something are fractions of it. A half-plane has
    /// none.
    pub(super) fn size(&self) -> f64 {
        match self.wall() {
            Some(wall) => self.reach[1 - wall],
            None => self.reach[0].min(self.reach[1]),
        }
    }

    /// Which of the two is a half-plane.
    fn wall(&self) -> Option<usize> {
        self.hulls.iter().position(Hull::is_half_plane)
    }

    /// Fastest that any two points approach at the start, in m/s.
    pub(super) fn speed(&self) -> f64 {
        self.v.length()
            + self.motions[0].spin.abs() * self.reach[0]
            + self.motions[1].spin.abs() * self.reach[1]
    }

    /// Fastest that the approach of any two points changes, in m/s².
    fn pull(&self) -> f64 {
        let turning = |k: usize| self.motions[k].angular_acceleration.abs() * self.reach[k];
        self.acceleration.length() + turning(0) + turning(1)
    }

    /// World position at `tau` of the frame of hull `k`.
    pub(super) fn centre(&self, k: usize, tau: f64) -> Vec2 {
        self.motions[k].centre + self.motions[k].travel(tau)
    }

    pub(super) fn at(&self, tau: f64) -> Instant {
        let [a, b] = &self.motions;
        Instant {
            d: self.d + (self.v + self.acceleration * (0.5 * tau)) * tau,
            v: self.v + self.acceleration * tau,
            rotation: [
                a.rotation.turned(a.turn(tau)),
                b.rotation.turned(b.turn(tau)),
            ],
            spin: [
                a.spin + a.angular_acceleration * tau,
                b.spin + b.angular_acceleration * tau,
            ],
        }
    }

    /// Gap and rate of every vertex that faces the axis.
    pub(super) fn each_gap(&self, axis: Axis, at: &Instant, mut visit: impl FnMut(Gap)) {
        let radius = self.hulls[0].radius + self.hulls[1].radius;
        match axis {
            Axis::Edge { owner, edge } => {
                let other = 1 - owner;
                let (mine, theirs) = (&self.hulls[owner], &self.hulls[other]);
                let sign = if owner == 0 { 1.0 } else { -1.0 };
                let (d, v) = (at.d * sign, at.v * sign);
                let n = at.rotation[owner] * mine.normals[edge];
                let offset = mine.normals[edge].dot(mine.vertices[edge]) + radius;
                // z: the vertex from the owner's centre. n turns with the owner, so
                // d(n·z)/dt = n·(ż − ω_owner × z).
                for (i, q) in theirs.vertices.iter().enumerate() {
                    let y = at.rotation[other] * *q;
                    let z = d + y;
                    let slip =
                        v + cross_scalar(at.spin[other], y) - cross_scalar(at.spin[owner], z);
                    let mut vertices = [edge; 2];
                    vertices[other] = i;
                    visit(Gap {
                        vertices,
                        gap: n.dot(z) - offset,
                        rate: n.dot(slip),
                    });
                }
            }
            Axis::World { normal } => {
                for (i, p) in self.hulls[0].vertices.iter().enumerate() {
                    let x = at.rotation[0] * *p;
                    for (j, q) in self.hulls[1].vertices.iter().enumerate() {
                        let y = at.rotation[1] * *q;
                        let slip = at.v + cross_scalar(at.spin[1], y) - cross_scalar(at.spin[0], x);
                        visit(Gap {
                            vertices: [i, j],
                            gap: normal.dot(at.d + y - x) - radius,
                            rate: normal.dot(slip),
                        });
                    }
                }
            }
        }
    }

    /// The smallest gap along the axis; the first of equals.
    pub(super) fn smallest_gap(&self, axis: Axis, at: &Instant) -> Gap {
        let mut least = Gap {
            vertices: [0, 0],
            gap: f64::INFINITY,
            rate: 0.0,
        };
        self.each_gap(axis, at, |gap| {
            if gap.gap < least.gap {
                least = gap;
            }
        });
        least
    }

    /// Visits every axis that can separate the hulls at `at`.
    pub(super) fn each_axis(&self, at: &Instant, mut visit: impl FnMut(Axis)) {
        if let Some(owner) = self.wall() {
            visit(Axis::Edge { owner, edge: 0 });
            return;
        }
        let round = self.hulls.iter().position(Hull::is_disc);
        let Some(disc) = round else {
            for owner in 0..2 {
                for edge in 0..self.hulls[owner].normals.len() {
                    visit(Axis::Edge { owner, edge });
                }
            }
            return;
        };
        visit(self.axis_of_disc(disc, at));
    }

    /// Disc against anything: the edge it lies over, or the direction to the nearest corner.
    fn axis_of_disc(&self, disc: usize, at: &Instant) -> Axis {
        let owner = 1 - disc;
        let hull = &self.hulls[owner];
        let sign = if owner == 0 { 1.0 } else { -1.0 };
        // The disc's centre in the owner's frame.
        let centre = at.rotation[owner]
            .inverse_mul(at.d * sign + at.rotation[disc] * self.hulls[disc].vertices[0]);
        let mut best = (f64::NEG_INFINITY, 0);
        for (edge, n) in hull.normals.iter().enumerate() {
            let height = n.dot(centre - hull.vertices[edge]);
            if height > best.0 {
                best = (height, edge);
            }
        }
        let corner = if hull.normals.is_empty() {
            hull.vertices[0]
        } else {
            let (from, to) = hull.edge(best.1);
            let along = to - from;
            let t = (centre - from).dot(along);
            if t < 0.0 {
                from
            } else if t > along.length_squared() {
                to
            } else {
                return Axis::Edge {
                    owner,
                    edge: best.1,
                };
            }
        };
        if best.0 <= 0.0 && hull.normals.len() > 2 {
            return Axis::Edge {
                owner,
                edge: best.1,
            };
        }
        let toward = at.rotation[owner] * (centre - corner) * sign;
        // Two centres at one place have no direction: x, as good as any and always the same.
        Axis::World {
            normal: toward.try_normalize().unwrap_or(Vec2::X),
        }
    }

    /// Direction of the axis in the world, from A to B.
    pub(super) fn normal(&self, axis: Axis, at: &Instant) -> Vec2 {
        match axis {
            Axis::Edge { owner, edge } => {
                let n = at.rotation[owner] * self.hulls[owner].normals[edge];
                if owner == 0 { n } else { -n }
            }
            Axis::World { normal } => normal,
        }
    }

    /// Bound M on −g'' of every vertex along the axis between `tau` and `end`.
    ///
    /// ```text
    /// |g''| ≤ a + 2 ω_E s + (ω_E² + α_E) R + ((ω_V − ω_E)² + |α_V − α_E|) ρ
    /// ```
    /// R the distance of the centres, s its rate, ρ the reach of the vertices. An axis that does
    /// not turn leaves −n·a, sign and all: then a fall without spin is one exact step.
    pub(super) fn bend(&self, axis: Axis, at: &Instant, tau: f64, end: f64) -> f64 {
        let spin = |k: usize| self.motions[k].spin_over(tau, end);
        let alpha = |k: usize| self.motions[k].angular_acceleration;
        let turning = |k: usize| spin(k) * spin(k) + alpha(k).abs();
        let relative = |e: usize, v: usize| {
            let w = self.motions[e].spin_difference(&self.motions[v], tau, end);
            w * w + (alpha(v) - alpha(e)).abs()
        };
        match axis {
            Axis::Edge { owner, .. } if turning(owner) == 0.0 => {
                let n = self.normal(axis, at);
                turning(1 - owner) * self.reach[1 - owner] - n.dot(self.acceleration)
            }
            Axis::Edge { owner, .. } => {
                let lasts = end - tau;
                let pull = self.acceleration.length();
                let s = at.v.length() + pull * lasts;
                let far = at.d.length() + s * lasts;
                pull + 2.0 * spin(owner) * s
                    + turning(owner) * far
                    + relative(owner, 1 - owner) * self.reach[1 - owner]
            }
            Axis::World { normal } => {
                turning(0) * self.reach[0] + turning(1) * self.reach[1]
                    - normal.dot(self.acceleration)
            }
        }
    }

    /// How long bounds taken now stay tight: two sizes of travel.
    pub(super) fn segment(&self, at: &Instant) -> f64 {
        let fast = at.v.length();
        let pull = self.acceleration.length();
        let size = 2.0 * (self.reach[0] + self.reach[1]);
        // fast t + pull t²/2 = size, in the form that does not cancel.
        let root = (fast * fast + 2.0 * pull * size).sqrt();
        if fast + root > 0.0 {
            2.0 * size / (fast + root)
        } else {
            f64::INFINITY
        }
    }

    fn fastest_spin(&self, k: usize, horizon: f64) -> f64 {
        self.motions[k].spin_over(0.0, horizon)
    }

    fn fastest(&self, horizon: f64) -> f64 {
        self.v.length() + self.acceleration.length() * horizon
    }
}

impl Motion {
    /// Largest |spin| between two times after the start.
    fn spin_over(&self, from: f64, to: f64) -> f64 {
        let at = |tau: f64| (self.spin + self.angular_acceleration * tau).abs();
        at(from).max(at(to))
    }

    /// Largest |difference of spins| between two times after the start.
    fn spin_difference(&self, other: &Self, from: f64, to: f64) -> f64 {
        let alpha = self.angular_acceleration - other.angular_acceleration;
        let at = |tau: f64| (self.spin - other.spin + alpha * tau).abs();
        at(from).max(at(to))
    }
}
