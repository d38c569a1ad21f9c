//! Two convex hulls in relative motion: where they are, along which axes, within which bounds.

use carom_math::{Pose, Rot, Vec2};

use super::facing::{Facing, Gap};
use crate::lanes::{each_height, farthest, highest_over, widest_edge};
use crate::{AxisFeature, Hull, Motion, Side};

/// A direction that may separate two hulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    /// Normal of an edge; it turns with its owner (0 is A, 1 is B).
    Edge { owner: usize, edge: usize },
    /// A direction fixed in the world, from A to B; one of the hulls is a disc.
    World { normal: Vec2 },
}

impl Axis {
    /// The axis along which something touches, where that is an edge's.
    pub(super) fn of(feature: AxisFeature) -> Option<Self> {
        match feature {
            AxisFeature::Edge { owner, edge, .. } => Some(Self::Edge {
                owner: usize::from(owner == Side::B),
                edge,
            }),
            AxisFeature::Vertices { .. } => None,
        }
    }
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

/// The time in which two hulls can touch, in s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) from: f64,
    pub(super) until: f64,
    /// If nothing accelerates: bounds on |g''| from `from` to `until`, along axes of A, of B, of the world.
    bends: Option<[f64; 3]>,
}

/// Bounds on the second time derivative of every gap along an axis, from now until `end`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    pub(super) end: f64,
    /// Bound on −g'': below 0 if the gaps open ever faster.
    pub(super) down: f64,
    /// Bound on |g''|.
    pub(super) most: f64,
}

/// Two hulls with motions that start together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach<'a> {
    pub(super) hulls: [Hull<'a>; 2],
    /// A's motion, for places in the world.
    motion: Motion,
    d: Vec2,
    v: Vec2,
    pub(super) acceleration: Vec2,
    rotation: [Rot; 2],
    pub(super) spin: [f64; 2],
    angular_acceleration: [f64; 2],
    /// Largest distance of a vertex from the centre of its motion.
    arm: [f64; 2],
    /// The same of a point of the hull, its radius included.
    pub(super) reach: [f64; 2],
    /// Fastest that any two points approach at the start, in m/s.
    pub(super) speed: f64,
    /// Fastest that the approach of any two points changes, in m/s².
    pub(super) pull: f64,
    /// Distance of the centres, its rate and its change of rate at the start.
    distance: f64,
    speed_of_centres: f64,
    pull_of_centres: f64,
    /// Which of the two is a half-plane.
    wall: Option<usize>,
    /// Which of the two is a disc, the first of two.
    disc: Option<usize>,
}

impl<'a> Approach<'a> {
    pub(super) fn new(a: Hull<'a>, motion_a: &Motion, b: Hull<'a>, motion_b: &Motion) -> Self {
        let start = motion_a.start.max(motion_b.start);
        let motions = [motion_a.rebased(start), motion_b.rebased(start)];
        let hulls = [a, b];
        let arm = hulls.each_ref().map(farthest);
        let reach = [arm[0] + a.radius, arm[1] + b.radius];
        let d = motions[1].centre - motions[0].centre;
        let v = motions[1].velocity - motions[0].velocity;
        let acceleration = motions[1].acceleration - motions[0].acceleration;
        let spin = motions.each_ref().map(|motion| motion.spin);
        let alpha = motions.each_ref().map(|motion| motion.angular_acceleration);
        let (speed_of_centres, pull_of_centres) = (v.length(), acceleration.length());
        let turning = |rate: [f64; 2]| rate[0].abs() * reach[0] + rate[1].abs() * reach[1];
        Self {
            hulls,
            motion: motions[0],
            d,
            v,
            acceleration,
            rotation: motions.each_ref().map(|motion| motion.rotation),
            spin,
            angular_acceleration: alpha,
            arm,
            reach,
            speed: speed_of_centres + turning(spin),
            pull: pull_of_centres + turning(alpha),
            distance: d.length(),
            speed_of_centres,
            pull_of_centres,
            wall: hulls.iter().position(Hull::is_half_plane),
            disc: hulls.iter().position(Hull::is_disc),
        }
    }

    /// When, within the horizon, the hulls can touch; `None` if never.
    pub(super) fn window(&self, horizon: f64) -> Option<Window> {
        let (from, until) = self.times(horizon)?;
        let steady = self.pull == 0.0;
        let bends = steady.then(|| {
            // A straight way is farthest at one of its ends.
            let ends = [from, until].map(|tau| (self.d + self.v * tau).length_squared());
            let far = ends[0].max(ends[1]).sqrt();
            let [a, b] = self.spin;
            let relative = (b - a) * (b - a);
            let of = |k: usize, spin: f64| {
                let turning = spin.abs() * (2.0 * self.speed_of_centres + spin.abs() * far);
                let turning = if spin == 0.0 { 0.0 } else { turning };
                turning + relative * self.arm[1 - k]
            };
            [
                of(0, a),
                of(1, b),
                a * a * self.arm[0] + b * b * self.arm[1],
            ]
        });
        Some(Window { from, until, bends })
    }

    /// From when until when the hulls can touch, in s.
    fn times(&self, horizon: f64) -> Option<(f64, f64)> {
        if self.wall.is_some() {
            return Some((0.0, horizon));
        }
        // Far above the rounding of what follows, as a fraction of the lengths in it.
        let reach = (self.reach[0] + self.reach[1]) * (1.0 + 1e-9) + 1e-14 * self.distance;
        let window = if self.pull_of_centres > 0.0 {
            let travel = (self.speed_of_centres + 0.5 * self.pull_of_centres * horizon) * horizon;
            (self.distance <= reach + travel).then_some((0.0, horizon))
        } else {
            circles_meet(self.d, self.v, reach, horizon)
        };
        let small = self.hulls.iter().all(|hull| hull.boundary.is_none());
        window.filter(|_| small || !self.pieces_stay_apart(horizon))
    }

    /// Circles about the boxes of the hulls that cannot meet, however these turn: closer than circles about the
    /// centres of motion where a hull is a piece far from there.
    fn pieces_stay_apart(&self, horizon: f64) -> bool {
        let circle = |k: usize| {
            let bounds = self.hulls[k].aabb(Pose::IDENTITY);
            let centre = bounds.centre();
            let turn = self.spin_over(k, 0.0, horizon) * horizon * centre.length();
            (
                self.rotation[k] * centre,
                bounds.extents().length() * 0.5 + turn,
            )
        };
        let ((centre_a, radius_a), (centre_b, radius_b)) = (circle(0), circle(1));
        let apart = (self.d + centre_b - centre_a).length();
        let fastest = self.speed_of_centres + self.pull_of_centres * horizon;
        apart > (radius_a + radius_b + fastest * horizon) * (1.0 + 1e-9)
    }

    /// Rounding of a gap at `tau`: what lies below is touching. Distance, sizes and travel, turning
    /// included, each carry roundings of their own size.
    pub(super) fn tolerance(&self, tau: f64) -> f64 {
        let travel = (self.speed + self.pull * tau) * tau;
        6.0 * f64::EPSILON * (self.distance + self.reach[0] + self.reach[1] + travel)
    }

    /// The smaller hull's reach: lengths that mean something are fractions of it. A half-plane has
    /// none.
    pub(super) fn size(&self) -> f64 {
        match self.wall {
            Some(wall) => self.reach[1 - wall],
            None => self.reach[0].min(self.reach[1]),
        }
    }

    /// World position at `tau` of the frame of A.
    pub(super) fn centre(&self, tau: f64) -> Vec2 {
        self.motion.centre + self.motion.travel(tau)
    }

    pub(super) fn at(&self, tau: f64) -> Instant {
        let (spin, alpha) = (self.spin, self.angular_acceleration);
        let turn = |k: usize| (spin[k] + 0.5 * alpha[k] * tau) * tau;
        Instant {
            d: self.d + (self.v + self.acceleration * (0.5 * tau)) * tau,
            v: self.v + self.acceleration * tau,
            rotation: Rot::turned_pair(self.rotation, [turn(0), turn(1)]),
            spin: [spin[0] + alpha[0] * tau, spin[1] + alpha[1] * tau],
        }
    }

    /// The axis along which the hulls are farthest apart at `at`; the first of equals.
    pub(super) fn widest(&self, at: &Instant) -> Axis {
        if let Some(owner) = self.wall {
            return Axis::Edge { owner, edge: 0 };
        }
        if let Some(disc) = self.disc {
            return self.axis_of_disc(disc, at);
        }
        let [a, b] = [0, 1].map(|owner| {
            let (turn, offset) = self.seen_from(owner, at);
            widest_edge(&self.hulls[owner], &self.hulls[1 - owner], turn, offset)
        });
        let (owner, edge) = if b.1 > a.1 { (1, b.0) } else { (0, a.0) };
        Axis::Edge { owner, edge }
    }

    /// Pose of the other hull in the frame of one.
    fn seen_from(&self, owner: usize, at: &Instant) -> (Rot, Vec2) {
        let [from, to] = [owner, 1 - owner].map(|k| at.rotation[k]);
        let d = if owner == 0 { at.d } else { -at.d };
        (from.inverse() * to, from.inverse_mul(d))
    }

    /// Visits every axis that can separate the hulls at `at`, with the gap along it, radii left out. To rounding: what
    /// is decided by a gap is decided by [`Facing`].
    pub(super) fn each_axis(&self, at: &Instant, mut visit: impl FnMut(Axis, f64)) {
        if let Some(owner) = self.wall {
            visit(Axis::Edge { owner, edge: 0 }, 0.0);
            return;
        }
        if let Some(disc) = self.disc {
            visit(self.axis_of_disc(disc, at), 0.0);
            return;
        }
        for owner in 0..2 {
            let [own, facing] = [owner, 1 - owner].map(|k| &self.hulls[k]);
            let (turn, offset) = self.seen_from(owner, at);
            each_height(own, facing, turn, offset, |edge, height| {
                // Edges that pad the last block repeat the last one.
                let edge = edge.min(own.normals.len() - 1);
                visit(Axis::Edge { owner, edge }, height);
            });
        }
    }

    /// Whether there is but one axis to look at: of a disc, or of a half-plane.
    pub(super) const fn has_one_axis(&self) -> bool {
        self.wall.is_some() || self.disc.is_some()
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

    /// Whether the axis of an edge is the only one along which the hulls are that little apart: along every other the
    /// gap is below `floor`. An answer of no may be wrong. Where nothing turns an edge flush with this one counts as
    /// the same: their gaps have one rate.
    pub(super) fn is_alone(&self, axis: Axis, least: &Gap, at: &Instant, floor: f64) -> bool {
        let Axis::Edge { owner, edge } = axis else {
            return false;
        };
        let side = 1 - owner;
        let (own, other) = (&self.hulls[owner], &self.hulls[side]);
        if own.blocks.is_empty() || other.blocks.is_empty() {
            return false;
        }
        let d = if owner == 0 { at.d } else { -at.d };
        // The vertex seen from the edge's hull, and the edge seen from the vertex's.
        let vertex = at.rotation[side] * other.vertices[least.vertices[side]] + d;
        let vertex = at.rotation[owner].inverse_mul(vertex);
        if highest_over(own, [vertex; 2], Some(edge)) >= floor {
            return false;
        }
        let ends = || {
            let (from, to) = own.edge(edge);
            [from, to].map(|p| at.rotation[side].inverse_mul(at.rotation[owner] * p - d))
        };
        let turns = self.turns(0) || self.turns(1);
        !turns || highest_over(other, ends(), None) < floor
    }

    /// The axis at an instant.
    pub(super) fn facing(&self, axis: Axis, at: &Instant) -> Facing {
        Facing::new(self, axis, at)
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

    /// Bounds on g'' of every vertex along the axis, from `tau` until a time in the window.
    ///
    /// ```text
    /// |g''| ≤ a + 2 ω_E s + (ω_E² + α_E) R + ((ω_V − ω_E)² + |α_V − α_E|) ρ
    /// ```
    /// R the distance of the centres, s its rate, ρ the reach of the vertices. An axis that does
    /// not turn leaves −n·a, sign and all: then a fall without spin is one exact step.
    pub(super) fn bend(&self, window: &Window, axis: Axis, at: &Instant, tau: f64) -> Bend {
        if let Some(bends) = window.bends {
            let bend = match axis {
                Axis::Edge { owner, .. } => bends[owner],
                Axis::World { .. } => bends[2],
            };
            return Bend {
                end: window.until,
                down: bend,
                most: bend,
            };
        }
        let lasts = match axis {
            Axis::Edge { owner, .. } if self.turns(owner) => self.segment(at),
            Axis::Edge { owner, .. } => self.spin_lasts(1 - owner, at),
            Axis::World { .. } => self.spin_lasts(0, at).min(self.spin_lasts(1, at)),
        };
        let end = (tau + lasts).min(window.until);
        let alpha = self.angular_acceleration;
        let spin = |k: usize| self.spin_over(k, tau, end);
        let turning = |k: usize| spin(k) * spin(k) + alpha[k].abs();
        let (turns, falls) = match axis {
            Axis::Edge { owner, .. } if !self.turns(owner) => {
                let other = 1 - owner;
                let falls = self.normal(axis, at).dot(self.acceleration);
                (turning(other) * self.arm[other], falls)
            }
            Axis::Edge { owner, .. } => {
                let lasts = end - tau;
                let pull = self.pull_of_centres;
                let s = at.v.length() + pull * lasts;
                let far = at.d.length() + s * lasts;
                let other = 1 - owner;
                let alpha = alpha[other] - alpha[owner];
                let apart = self.spin[other] - self.spin[owner];
                let w = |tau: f64| (apart + alpha * tau).abs();
                let w = w(tau).max(w(end));
                let relative = w * w + alpha.abs();
                let turns = pull + 2.0 * spin(owner) * s + turning(owner) * far;
                (turns + relative * self.arm[other], 0.0)
            }
            Axis::World { normal } => {
                let turns = turning(0) * self.arm[0] + turning(1) * self.arm[1];
                (turns, normal.dot(self.acceleration))
            }
        };
        Bend {
            end,
            down: turns - falls,
            most: turns + falls.abs(),
        }
    }

    /// Whether neither hull's spin changes.
    pub(super) fn turns_evenly(&self) -> bool {
        self.angular_acceleration.iter().all(|alpha| *alpha == 0.0)
    }

    /// Whether a hull turns, now or later.
    fn turns(&self, k: usize) -> bool {
        self.spin[k] != 0.0 || self.angular_acceleration[k] != 0.0
    }

    /// How long the bound on the way that the vertices of a hull bend in a frame at rest stays tight, (ω² + |α|) ρ: until it
    /// is four times as much, or twice where nothing turns yet.
    fn spin_lasts(&self, k: usize, at: &Instant) -> f64 {
        let alpha = self.angular_acceleration[k].abs();
        if alpha == 0.0 || self.arm[k] == 0.0 {
            f64::INFINITY
        } else {
            (at.spin[k].abs() / alpha).max(alpha.sqrt().recip())
        }
    }

    /// How long bounds taken now along an axis that turns stay tight: two sizes of travel.
    fn segment(&self, at: &Instant) -> f64 {
        let size = 2.0 * (self.reach[0] + self.reach[1]);
        // fast t + pull t²/2 = size, in the form that does not cancel.
        let fast = at.v.length();
        let root = (fast * fast + 2.0 * self.pull_of_centres * size).sqrt();
        if fast + root > 0.0 {
            2.0 * size / (fast + root)
        } else {
            f64::INFINITY
        }
    }

    /// Largest |spin| of a hull between two times.
    fn spin_over(&self, k: usize, from: f64, to: f64) -> f64 {
        let at = |tau: f64| (self.spin[k] + self.angular_acceleration[k] * tau).abs();
        at(from).max(at(to))
    }
}

/// When two points on straight ways are within `reach` of each other, from 0 to `horizon`.
pub(super) fn circles_meet(d: Vec2, v: Vec2, reach: f64, horizon: f64) -> Option<(f64, f64)> {
    // |d + v t|² = reach²
    let outside = d.length_squared() - reach * reach;
    let (square, along) = (v.length_squared(), d.dot(v));
    if outside > 0.0 && along >= 0.0 {
        return None;
    }
    if square == 0.0 {
        return (outside <= 0.0).then_some((0.0, horizon));
    }
    let aside = carom_math::cross(d, v);
    let root = square * reach * reach - aside * aside;
    if root < 0.0 {
        return None;
    }
    let root = root.sqrt();
    let from = if outside > 0.0 {
        outside / (root - along)
    } else {
        0.0
    };
    (from <= horizon).then_some((from, ((root - along) / square).min(horizon)))
}
