//! The search: advance along an axis until it closes, look again, until all are closed.

use arrayvec::ArrayVec;
use carom_math::Vec2;

use super::approach::{Approach, Axis, Gap, Instant};
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
const NEAR: f64 = 1e-9;

/// How deep a pair that touches may sink before that is an impact, as a fraction of the smaller
/// size: rounding after an impact, never a visible overlap.
const SLACK: f64 = 1e-12;

/// The first contact of two convex hulls within `horizon`.
pub(super) fn first_contact(approach: &Approach<'_>, horizon: f64) -> TimeOfImpact {
    let mut search = Search {
        approach,
        horizon,
        tau: 0.0,
        level: None,
        steps: 0,
    };
    let mut sank = false;
    for query in 0..QUERIES {
        let at = approach.at(search.tau);
        let mut axis = search.widest(&at);
        let gap = approach.smallest_gap(axis, &at).gap;
        search.level = None;
        if gap <= approach.tolerance(search.tau) {
            // Closed on every side. The pair opens if any of its closed axes opens.
            let (opening, rate) = search.opening(&at, gap);
            if rate < -1e-13 * approach.speed() || (sank && rate < 0.0) {
                return search.contact(opening, &at, query == 0);
            }
            axis = opening;
            search.level = Some(approach.smallest_gap(axis, &at).gap - search.slack());
        }
        match search.advance(axis) {
            Advance::Closed => sank = search.level.is_some(),
            Advance::Horizon => return TimeOfImpact::Clear,
            Advance::Spent => break,
        }
    }
    TimeOfImpact::Unresolved {
        safe_until: search.tau,
    }
}

enum Advance {
    /// The gap along the axis has reached the level.
    Closed,
    /// It stays above up to the horizon.
    Horizon,
    /// The budget of steps is spent.
    Spent,
}

struct Search<'a> {
    approach: &'a Approach<'a>,
    horizon: f64,
    tau: f64,
    /// Gap at which the axis of a pair that touches already counts as closed; else the tolerance.
    level: Option<f64>,
    steps: usize,
}

impl Search<'_> {
    fn slack(&self) -> f64 {
        (SLACK * self.approach.size()).max(2.0 * self.approach.tolerance(self.tau))
    }

    /// The axis with the largest gap; the first of equals.
    fn widest(&self, at: &Instant) -> Axis {
        let mut best = None;
        self.approach.each_axis(at, |axis| {
            let gap = self.approach.smallest_gap(axis, at).gap;
            if best.is_none_or(|(_, widest)| gap > widest) {
                best = Some((axis, gap));
            }
        });
        best.map_or(Axis::World { normal: Vec2::X }, |(axis, _)| axis)
    }

    /// Of the axes closed within [`NEAR`] of the widest, the one whose gap opens fastest (or
    /// closes slowest), and that rate. Cuts through concave shapes are left aside if they can be.
    fn opening(&self, at: &Instant, widest: f64) -> (Axis, f64) {
        let near = NEAR * self.approach.size();
        let mut best: Option<(bool, f64, Axis)> = None;
        self.approach.each_axis(at, |axis| {
            let least = self.approach.smallest_gap(axis, at);
            if least.gap < widest - near {
                return;
            }
            let mut rate = f64::INFINITY;
            self.approach.each_gap(axis, at, |gap| {
                if gap.gap <= least.gap + near && gap.rate < rate {
                    rate = gap.rate;
                }
            });
            let real = self.touches(axis, &least, at);
            if best.is_none_or(|(r, fastest, _)| (real, rate) > (r, fastest)) {
                best = Some((real, rate, axis));
            }
        });
        best.map_or((self.widest(at), 0.0), |(_, rate, axis)| (axis, rate))
    }

    /// Whether the true outlines can touch along the axis there: no cut is involved.
    fn touches(&self, axis: Axis, least: &Gap, at: &Instant) -> bool {
        let normal = self.approach.normal(axis, at);
        let allows = |k: usize, away: Vec2| {
            let local = at.rotation[k].inverse_mul(away);
            self.approach.hulls[k].allows(least.vertices[k], local)
        };
        match axis {
            Axis::Edge { owner, edge } => {
                let away = if owner == 0 { -normal } else { normal };
                self.approach.hulls[owner].is_boundary(edge) && allows(1 - owner, away)
            }
            Axis::World { .. } => allows(0, normal) && allows(1, -normal),
        }
    }

    /// Moves on along one axis until its gap is at the level.
    fn advance(&mut self, axis: Axis) -> Advance {
        let approach = self.approach;
        while self.steps < STEPS {
            self.steps += 1;
            let at = approach.at(self.tau);
            let end = (self.tau + approach.segment(&at)).min(self.horizon);
            let bend = approach.bend(axis, &at, self.tau, end);
            let tolerance = approach.tolerance(self.tau);
            let level = self.level.unwrap_or(tolerance);
            let mut least = f64::INFINITY;
            let mut step = end - self.tau;
            approach.each_gap(axis, &at, |gap| {
                least = least.min(gap.gap);
                step = certified(gap.gap - level, gap.rate, bend, step);
            });
            if least <= level {
                return Advance::Closed;
            }
            // Once clear of the contact it left, the pair is like any other.
            if least > 2.0 * tolerance {
                self.level = None;
            }
            if self.tau + step >= self.horizon {
                self.tau = self.horizon;
                return Advance::Horizon;
            }
            // Below one ulp of time the gap changes by less than its rounding: go on by that.
            self.tau = (self.tau + step).max(self.tau.next_up());
        }
        Advance::Spent
    }

    /// The contact at the present instant, after a last Newton step.
    fn contact(&self, axis: Axis, at: &Instant, start: bool) -> TimeOfImpact {
        let approach = self.approach;
        let near = NEAR * approach.size();
        let mut tau = self.tau;
        let mut at = *at;
        let least = approach.smallest_gap(axis, &at);
        if !start && least.rate < 0.0 && least.gap.abs() <= 4.0 * self.slack() {
            let newton = tau - least.gap / least.rate;
            if newton > 0.0 && newton <= self.horizon {
                tau = newton;
                at = approach.at(tau);
            }
        }
        let least = approach.smallest_gap(axis, &at);
        if !self.touches(axis, &least, &at) {
            // The vertex comes through a cut: it has touched another piece before.
            return TimeOfImpact::Clear;
        }
        let normal = approach.normal(axis, &at);
        let mut stretch: Option<Stretch> = None;
        let mut rate = f64::INFINITY;
        let tangent = carom_math::perp(normal);
        approach.each_gap(axis, &at, |gap| {
            if gap.gap > least.gap + near {
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
        let centre = approach.centre(0, tau);
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

/// The smaller of `limit` and the first root of `g + g' τ − bend τ²/2`: no contact before it.
fn certified(g: f64, rate: f64, bend: f64, limit: f64) -> f64 {
    // A concave parabola that is positive at both ends is positive between them.
    if bend >= 0.0 && g + (rate - 0.5 * bend * limit) * limit > 0.0 {
        return limit;
    }
    let square = rate * rate + 2.0 * bend * g;
    if square < 0.0 {
        return limit;
    }
    let root = square.sqrt();
    // Both forms are the same root; each is taken where it does not cancel.
    let step = if rate < 0.0 {
        2.0 * g / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        return limit;
    };
    step.clamp(0.0, limit)
}
