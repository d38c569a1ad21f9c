//! The search: advance along an axis until it closes, look again, until all are closed.

use arrayvec::ArrayVec;
use carom_math::{Vec2, perp, within};

use super::approach::{Approach, Axis, Bend, Instant, Window};
use super::facing::{Facing, Gap};
use super::touching::{End, Stretch};
use super::{Impact, ImpactFeature, TimeOfImpact};

/// Axes looked at before the search gives up. Of the 64 open reference cases two need more than 80,
/// none needs 200.
const QUERIES: usize = 400;

/// Certified steps before the search gives up. A fast spin over a long slow approach needs many,
/// since its bound on g'' is loose; no open reference case needs 2,000.
const STEPS: usize = 20_000;

/// Vertices this close to the lowest, as a fraction of the smaller size, touch with it. Far above
/// the rounding of a gap, far below any feature.
pub(super) const NEAR: f64 = 1e-9;

/// How deep a pair that touches may sink before that is an impact, as a fraction of the smaller
/// size: rounding after an impact, never a visible overlap.
pub(super) const SLACK: f64 = 1e-12;

/// The first contact of two convex hulls within `horizon`; they may part along `last` now.
pub(super) fn first_contact(
    approach: &Approach<'_>,
    horizon: f64,
    last: Option<Axis>,
) -> TimeOfImpact {
    let Some(window) = approach.window(horizon) else {
        return TimeOfImpact::Clear;
    };
    let mut search = Search {
        approach,
        window,
        tau: window.from,
        at: approach.at(window.from),
        level: None,
        steps: 0,
    };
    let closing = -1e-13 * approach.speed;
    let mut sank = false;
    for query in 0..QUERIES {
        let parting = last.filter(|_| query == 0);
        let (mut axis, mut facing, mut least);
        search.level = None;
        if let Some(known) = parting.and_then(|axis| search.parts_along(axis, -closing)) {
            (axis, facing, least) = known;
            search.level = Some(least.gap - search.slack());
        } else {
            axis = approach.widest(&search.at);
            facing = approach.facing(axis, &search.at);
            least = facing.least(approach);
            if least.gap <= approach.tolerance(search.tau) {
                // Closed on every side. The pair opens if any of its closed axes opens.
                let (opening, rate) = search.opening(axis, &facing, &least);
                if rate < closing || (sank && rate < 0.0) {
                    return search.contact(opening, query == 0 && window.from <= 0.0);
                }
                if opening != axis {
                    axis = opening;
                    facing = approach.facing(axis, &search.at);
                    least = facing.least(approach);
                }
                search.level = Some(least.gap - search.slack());
            }
        }
        match search.advance(axis, facing, least) {
            Advance::Closed(least) => {
                sank = search.level.is_some();
                // A vertex well within an edge: their distance is that gap, and no axis is open.
                let floor = least.gap - 2.0 * NEAR * approach.size();
                if !sank
                    && least.rate < closing
                    && approach.is_alone(axis, &least, &search.at, floor)
                {
                    return search.contact(axis, false);
                }
            }
            Advance::Horizon => return TimeOfImpact::Clear,
            Advance::Spent => break,
        }
    }
    TimeOfImpact::Unresolved {
        safe_until: search.tau,
    }
}

/// The slowest rate of all gaps up to `most`.
fn slowest(approach: &Approach<'_>, facing: &Facing, most: f64) -> f64 {
    let mut rate = f64::INFINITY;
    facing.each_gap(approach, |vertex| {
        if vertex.gap <= most && vertex.rate < rate {
            rate = vertex.rate;
        }
    });
    rate
}

enum Advance {
    /// The gap along the axis has reached the level.
    Closed(Gap),
    /// It stays above up to the horizon.
    Horizon,
    /// The budget of steps is spent.
    Spent,
}

struct Search<'a> {
    approach: &'a Approach<'a>,
    window: Window,
    tau: f64,
    at: Instant,
    /// Gap at which the axis of a pair that touches already counts as closed; else the tolerance.
    level: Option<f64>,
    steps: usize,
}

impl Search<'_> {
    fn slack(&self) -> f64 {
        (SLACK * self.approach.size()).max(2.0 * self.approach.tolerance(self.tau))
    }

    fn move_to(&mut self, tau: f64) {
        self.tau = tau;
        self.at = self.approach.at(tau);
    }

    /// Whether a pair that touches opens along an axis by more than `rate`: then no other axis matters.
    fn parts_along(&self, axis: Axis, rate: f64) -> Option<(Axis, Facing, Gap)> {
        let approach = self.approach;
        let facing = approach.facing(axis, &self.at);
        let least = facing.least(approach);
        let touches = least.gap <= approach.tolerance(self.tau) && least.gap >= -self.slack();
        let near = NEAR * approach.size();
        (touches && slowest(approach, &facing, least.gap + near) > rate)
            .then_some((axis, facing, least))
    }

    /// Of the axes closed within [`NEAR`] of the widest, the one with the fastest opening (or
    /// slowest closing) gap, and that rate. Cuts through concave shapes are left aside if they can be.
    fn opening(&self, widest: Axis, facing: &Facing, least: &Gap) -> (Axis, f64) {
        let (approach, at, gap) = (self.approach, &self.at, least.gap);
        let near = NEAR * approach.size();
        // Twice as near, since heights are rounded otherwise than gaps.
        let floor = gap - 2.0 * near;
        if approach.has_one_axis() || approach.is_alone(widest, least, at, floor) {
            return (widest, slowest(approach, facing, gap + near));
        }
        let floor = floor + approach.hulls[0].radius + approach.hulls[1].radius;
        let mut best: Option<(bool, f64, Axis)> = None;
        approach.each_axis(at, |axis, height| {
            if height < floor && axis != widest {
                return;
            }
            let facing = approach.facing(axis, at);
            let least = facing.least(approach);
            if least.gap < gap - near {
                return;
            }
            let rate = slowest(approach, &facing, least.gap + near);
            let real = self.touches(axis, &least, at);
            if best.is_none_or(|(r, fastest, _)| (real, rate) > (r, fastest)) {
                best = Some((real, rate, axis));
            }
        });
        best.map_or((widest, 0.0), |(_, rate, axis)| (axis, rate))
    }

    /// Whether the true outlines can touch along the axis there: no cut is involved.
    fn touches(&self, axis: Axis, least: &Gap, at: &Instant) -> bool {
        let hulls = &self.approach.hulls;
        if hulls[0].boundary.is_none() && hulls[1].boundary.is_none() {
            return true;
        }
        let normal = self.approach.normal(axis, at);
        let allows = |k: usize, away: Vec2| {
            let local = at.rotation[k].inverse_mul(away);
            hulls[k].allows(least.vertices[k], local)
        };
        match axis {
            Axis::Edge { owner, edge } => {
                let away = if owner == 0 { -normal } else { normal };
                hulls[owner].is_boundary(edge) && allows(1 - owner, away)
            }
            Axis::World { .. } => allows(0, normal) && allows(1, -normal),
        }
    }

    /// Moves on along one axis, seen now, until its gap is at the level.
    fn advance(&mut self, axis: Axis, mut facing: Facing, mut least: Gap) -> Advance {
        let (approach, until) = (self.approach, self.window.until);
        while self.steps < STEPS {
            self.steps += 1;
            let tolerance = approach.tolerance(self.tau);
            // Once clear of the contact it left, the pair is like any other.
            if least.gap > 2.0 * tolerance {
                self.level = None;
            }
            let level = self.level.unwrap_or(tolerance);
            if least.gap <= level {
                return Advance::Closed(least);
            }
            let bend = approach.bend(&self.window, axis, &self.at, self.tau);
            let next = if let Some(crossing) = self.crossing(axis, &facing, &least, &bend) {
                crossing
            } else {
                let limit = self.opens_within(&least, &bend);
                let level = self.level.unwrap_or(tolerance);
                self.tau + facing.certified_step(approach, &least, level, bend.down, limit)
            };
            if next >= until {
                self.tau = until;
                return Advance::Horizon;
            }
            // Over a shorter step than these the gap changes by less than its rounding.
            let fastest = approach.speed + approach.pull * self.tau;
            let step = tolerance / (32.0 * fastest);
            let shortest = if approach.pull * step <= fastest {
                self.tau + step
            } else {
                self.tau
            };
            self.move_to(next.max(shortest).max(self.tau.next_up()));
            facing = approach.facing(axis, &self.at);
            least = facing.least(approach);
        }
        Advance::Spent
    }

    /// How far the next step may go: for a pair that overlaps no farther than it surely goes on to overlap, since
    /// what comes after that is another contact.
    fn opens_within(&mut self, least: &Gap, bend: &Bend) -> f64 {
        let limit = bend.end - self.tau;
        let Some(level) = self.level else {
            return limit;
        };
        let slack = self.slack();
        if least.gap >= -slack {
            // It touches, and may sink in no deeper than that again.
            self.level = Some(level.max(least.gap - slack));
            return limit;
        }
        // The first root of g + g' τ + M τ²/2: the lowest vertex is below 0 until then.
        let root = (least.rate * least.rate - 2.0 * bend.most * least.gap).sqrt();
        let opens = -2.0 * least.gap / (least.rate + root);
        if opens > 0.0 { limit.min(opens) } else { limit }
    }

    /// When the lowest vertex reaches the edge, if it is certain to, and before any other.
    ///
    /// With |g''| ≤ M a gap is down within the first root of `g + g' τ + M τ²/2`, and falls all the way, if
    /// `g'² > 2 M g`. Newton's method with the exact g'' as third term (Halley 1694) then finds where.
    fn crossing(&self, axis: Axis, facing: &Facing, least: &Gap, bend: &Bend) -> Option<f64> {
        let approach = self.approach;
        let certain = least.rate * least.rate > 2.5 * bend.most * least.gap;
        if !approach.turns_evenly() || self.level.is_some() || least.rate >= 0.0 || !certain {
            return None;
        }
        let root = (least.rate * least.rate - 2.0 * bend.most * least.gap).sqrt();
        let latest = self.tau + 2.0 * least.gap / (root - least.rate);
        if latest >= bend.end {
            return None;
        }
        let fine = 0.01 * approach.tolerance(latest);
        let fastest = approach.spin[0].abs() + approach.spin[1].abs();
        let (mut tau, mut then) = (self.tau, *facing);
        for _ in 0..8 {
            let (gap, curve) = then.again(approach, least);
            // The root of g + g' s + g'' s²/2 that is near −g/g'.
            let square = gap.rate * gap.rate - 2.0 * curve * gap.gap;
            if square < 0.0 || gap.rate >= 0.0 {
                return None;
            }
            let step = 2.0 * gap.gap / (square.sqrt() - gap.rate);
            tau = within(tau + step, self.tau, latest);
            // The third derivative is at most 3 ω M: this is what the step leaves of the gap.
            if 0.5 * fastest * bend.most * step.abs() * step * step <= fine {
                let open = facing.others_stay_open(approach, least, bend.down, tau - self.tau);
                return open.then_some(tau);
            }
            then = approach.facing(axis, &approach.at(tau));
        }
        None
    }

    /// The contact at the present instant, after a last Newton step.
    fn contact(&self, mut axis: Axis, start: bool) -> TimeOfImpact {
        let approach = self.approach;
        let near = NEAR * approach.size();
        let mut tau = self.tau;
        let mut at = self.at;
        let mut facing = approach.facing(axis, &at);
        let mut least = facing.least(approach);
        let off = least.gap.abs();
        let polished = off <= 0.1 * approach.tolerance(tau);
        if !start && !polished && least.rate < 0.0 && off <= 4.0 * self.slack() {
            let newton = tau - least.gap / least.rate;
            if newton > 0.0 && newton <= self.window.until {
                tau = newton;
                at = approach.at(tau);
                facing = approach.facing(axis, &at);
                least = facing.least(approach);
            }
        }
        if let Some(beside) = self.edge_beside(axis, &least, &at) {
            axis = beside;
            facing = approach.facing(axis, &at);
            least = facing.least(approach);
        }
        if !self.touches(axis, &least, &at) {
            // The vertex comes through a cut: it has touched another piece before.
            return TimeOfImpact::Clear;
        }
        let normal = approach.normal(axis, &at);
        let mut stretch: Option<Stretch> = None;
        let mut rate = f64::INFINITY;
        let tangent = perp(normal);
        let round = matches!(axis, Axis::World { .. });
        if round {
            // A disc touches one point: of the ends of an edge across the direction the one in front of its centre.
            least = self.before_disc(&facing, least, near, tangent, &at);
            rate = least.rate;
        }
        facing.each_gap(approach, |gap| {
            if round || gap.gap > least.gap + near {
                return;
            }
            rate = rate.min(gap.rate);
            let end = End {
                along: tangent.dot(self.place(axis, &gap, &at)),
                vertices: gap.vertices,
            };
            stretch = Some(stretch.map_or(Stretch::at(end), |known| known.and(end)));
        });
        let anchor = self.place(axis, &least, &at);
        let here = tangent.dot(anchor);
        let stretch = stretch.unwrap_or(Stretch::at(End {
            along: here,
            vertices: least.vertices,
        }));
        let ([low, high], [at_low, at_high]) = match axis {
            Axis::Edge { owner, edge } if !approach.hulls[owner].is_half_plane() => {
                let (from, to) = approach.hulls[owner].edge(edge);
                let seen = |p: Vec2| {
                    let local = at.rotation[owner] * p;
                    tangent.dot(if owner == 0 { local } else { at.d + local })
                };
                stretch.on_face(approach, (owner, edge), (seen(from), seen(to)), near)
            }
            _ => (stretch.ends.map(|end| end.along), stretch.features(axis)),
        };
        let centre = approach.centre(tau);
        let mut points = ArrayVec::new();
        let mut features = ArrayVec::new();
        if high - low > near {
            points.push(centre + anchor + tangent * (low - here));
            points.push(centre + anchor + tangent * (high - here));
            features.push(ImpactFeature::of(at_low));
            features.push(ImpactFeature::of(at_high));
        } else {
            // Clamped to the face: of two edges that share an end the far vertex may be the lowest.
            points.push(centre + anchor + tangent * (0.5 * (low + high) - here));
            features.push(ImpactFeature::of(at_low));
        }
        let impact = Impact {
            time: tau,
            normal,
            points,
            features,
            gap_rate: rate,
        };
        if start {
            TimeOfImpact::Touching(impact)
        } else {
            TimeOfImpact::Hit(impact)
        }
    }

    /// Of the vertices within `near` of the lowest the one nearest to the centre of the disc along the tangent.
    fn before_disc(
        &self,
        facing: &Facing,
        least: Gap,
        near: f64,
        tangent: Vec2,
        at: &Instant,
    ) -> Gap {
        let hulls = &self.approach.hulls;
        let aside = |gap: &Gap| {
            let [a, b] = [0, 1].map(|k| at.rotation[k] * hulls[k].vertices[gap.vertices[k]]);
            tangent.dot(at.d + b - a).abs()
        };
        let mut best = (aside(&least), least);
        facing.each_gap(self.approach, |gap| {
            let aside = aside(&gap);
            if gap.gap <= least.gap + near && aside < best.0 {
                best = (aside, gap);
            }
        });
        best.1
    }

    /// The neighbour of an edge that the vertex touches beyond its end: at a nearly straight corner both are
    /// closed within [`NEAR`].
    fn edge_beside(&self, axis: Axis, least: &Gap, at: &Instant) -> Option<Axis> {
        let approach = self.approach;
        let Axis::Edge { owner, edge } = axis else {
            return None;
        };
        let (own, other) = (&approach.hulls[owner], &approach.hulls[1 - owner]);
        if own.normals.len() < 3 {
            return None;
        }
        let near = NEAR * approach.size();
        let d = if owner == 0 { at.d } else { -at.d };
        let vertex = at.rotation[1 - owner] * other.vertices[least.vertices[1 - owner]];
        let vertex = at.rotation[owner].inverse_mul(d + vertex);
        let (from, to) = own.edge(edge);
        let along = perp(own.normals[edge]);
        let beside = if along.dot(vertex - from) < -near {
            own.previous(edge)
        } else if along.dot(vertex - to) > near {
            own.next(edge)
        } else {
            return None;
        };
        let axis = Axis::Edge {
            owner,
            edge: beside,
        };
        let next = approach.facing(axis, at).least(approach);
        let same = next.vertices[1 - owner] == least.vertices[1 - owner];
        (same && (next.gap - least.gap).abs() <= near && self.touches(axis, &next, at))
            .then_some(axis)
    }

    /// Where a vertex touches, from A's centre.
    fn place(&self, axis: Axis, gap: &Gap, at: &Instant) -> Vec2 {
        let hulls = &self.approach.hulls;
        let normal = self.approach.normal(axis, at);
        let of_a =
            || at.rotation[0] * hulls[0].vertices[gap.vertices[0]] + normal * hulls[0].radius;
        let of_b = || {
            at.d + at.rotation[1] * hulls[1].vertices[gap.vertices[1]] - normal * hulls[1].radius
        };
        match axis {
            Axis::Edge { owner: 0, .. } => of_b(),
            Axis::Edge { .. } => of_a(),
            // A corner is where it is; between two discs either surface will do.
            Axis::World { .. } if hulls[0].radius == 0.0 => of_a(),
            Axis::World { .. } => of_b(),
        }
    }
}
