//! Time of impact of shapes with many parts: circles around boxes of parts tell which pairs can meet
//! at all, and from when on.

use carom_geometry::{Aabb, Shape};
use carom_math::Vec2;

use super::{FLUSH, TimeOfImpact, earlier, time_of_impact_of_parts};
use crate::parts::{Node, Nodes};
use crate::{Motion, part};

/// The first contact over all parts that approach faster than `slow` there; the same bits as a look at every pair of parts.
pub(super) fn first_of_parts(
    a: &Shape,
    motion_a: &Motion,
    b: &Shape,
    motion_b: &Motion,
    (horizon, slow): (f64, f64),
) -> TimeOfImpact {
    let sweep = Sweep::new(motion_a, motion_b, horizon);
    let mut near = sweep.near_parts(&Nodes::of(a), &Nodes::of(b));
    near.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2))));

    let size = 2.0 * (a.reach_about(Vec2::ZERO) + b.reach_about(Vec2::ZERO));
    let mut found: Vec<(u32, u32, TimeOfImpact)> = Vec::new();
    let mut latest = f64::INFINITY;
    for (from, i, j) in near {
        if from > latest {
            break;
        }
        let (part_a, part_b) = (part(a, i as usize), part(b, j as usize));
        let next = time_of_impact_of_parts(&part_a, motion_a, &part_b, motion_b, horizon);
        let matters = match &next {
            TimeOfImpact::Clear => continue,
            TimeOfImpact::Touching(hit) | TimeOfImpact::Hit(hit) if -hit.gap_rate <= slow => {
                continue;
            }
            TimeOfImpact::Touching(_) => 0.0,
            // Flush contacts are one if less than FLUSH of their stretch lies between them.
            TimeOfImpact::Hit(hit) => hit.time + FLUSH * size / hit.gap_rate.abs(),
            TimeOfImpact::Unresolved { safe_until } => *safe_until,
        };
        latest = latest.min(matters);
        found.push((i, j, next.of_parts((i, j))));
    }
    in_order(found)
}

/// The first of several outcomes, joined with those that are flush with it.
fn in_order(mut found: Vec<(u32, u32, TimeOfImpact)>) -> TimeOfImpact {
    let when = |outcome: &TimeOfImpact| match outcome {
        TimeOfImpact::Touching(_) => -1.0,
        TimeOfImpact::Hit(hit) => hit.time,
        TimeOfImpact::Unresolved { safe_until } => *safe_until,
        TimeOfImpact::Clear => f64::INFINITY,
    };
    found.sort_by(|p, q| {
        when(&p.2)
            .total_cmp(&when(&q.2))
            .then((p.0, p.1).cmp(&(q.0, q.1)))
    });
    let outcomes = found.into_iter().map(|(_, _, outcome)| outcome);
    outcomes.fold(TimeOfImpact::Clear, earlier)
}

/// How boxes about the centres of two motions can approach within the horizon.
struct Sweep {
    motions: [Motion; 2],
    horizon: f64,
    /// Largest |spin| of each within the horizon, in rad/s.
    spin: [f64; 2],
    /// Fastest approach of the centres, in m/s.
    speed: f64,
    /// Path of B's centre from A's: a straight way and how far it leaves it.
    travel: Vec2,
    bulge: f64,
}

impl Sweep {
    fn new(a: &Motion, b: &Motion, horizon: f64) -> Self {
        let start = a.start.max(b.start);
        let rebased = [a.rebased(start), b.rebased(start)];
        let velocity = rebased[1].velocity - rebased[0].velocity;
        let acceleration = rebased[1].acceleration - rebased[0].acceleration;
        let fastest_spin = |motion: &Motion| {
            let end = motion.spin + motion.angular_acceleration * horizon;
            motion.spin.abs().max(end.abs())
        };
        Self {
            spin: [fastest_spin(&rebased[0]), fastest_spin(&rebased[1])],
            motions: rebased,
            horizon,
            speed: velocity.length() + acceleration.length() * horizon,
            travel: (velocity + acceleration * (0.5 * horizon)) * horizon,
            bulge: 0.125 * acceleration.length() * horizon * horizon,
        }
    }

    /// Earliest time, in s, at which what is in two boxes can touch; `None` if it cannot.
    fn earliest(&self, a: Aabb, b: Aabb) -> Option<f64> {
        /// Far above the rounding of this estimate, as a fraction of the lengths in it.
        const SLACK: f64 = 1e-9;
        if !(a.is_finite() && b.is_finite()) {
            return Some(0.0);
        }
        let [motion_a, motion_b] = &self.motions;
        let centres = [a.centre(), b.centre()];
        let away = (motion_b.centre - motion_a.centre)
            + (motion_b.rotation * centres[1] - motion_a.rotation * centres[0]);
        let radii = 0.5 * (a.extents().length() + b.extents().length());
        // A centre turns on its circle: not farther than along the arc, nor than across.
        let turning = [0, 1].map(|k| self.spin[k] * centres[k].length());
        let across = [0, 1].map(|k| (turning[k] * self.horizon).min(2.0 * centres[k].length()));
        let reach = radii + across[0] + across[1] + self.bulge;
        let room = SLACK * (away.length() + reach + self.travel.length());
        let along = self.travel.length_squared();
        let share = if along > 0.0 {
            (-away.dot(self.travel) / along).clamp(0.0, 1.0)
        } else {
            0.0
        };
        if (away + self.travel * share).length() > reach + room {
            return None;
        }
        let gap = away.length() - radii - room;
        let speed = self.speed + turning[0] + turning[1];
        let from = if gap > 0.0 { gap / speed } else { 0.0 };
        (from <= self.horizon * (1.0 + SLACK)).then_some(from)
    }

    /// Pairs of parts that can meet, each with the time from which on.
    fn near_parts(&self, a: &Nodes<'_>, b: &Nodes<'_>) -> Vec<(f64, u32, u32)> {
        let mut waiting: Vec<(Node, Node)> = Vec::new();
        let mut near = Vec::new();
        for i in a.roots() {
            waiting.extend(b.roots().map(|j| (i, j)));
        }
        while let Some((i, j)) = waiting.pop() {
            let Some(from) = self.earliest(i.bounds, j.bounds) else {
                continue;
            };
            match i.split_before(&j) {
                Some(true) => waiting.extend(a.children(&i).map(|i| (i, j))),
                Some(false) => waiting.extend(b.children(&j).map(|j| (i, j))),
                None => near.extend(i.part().zip(j.part()).map(|(i, j)| (from, i, j))),
            }
        }
        near
    }
}
