//! Random shapes and pairs of them, a million each, against brute force over corners and edges.
//!
//! Slivers down to 1e-8 of their length, pairs that just touch, edges parallel to 1e-12 rad, sizes
//! from 1e-6 to 1e6 m. A case is its number: the same pairs on every machine and with any number of
//! threads.

#[path = "../../../../crates/bench/src/bin/pairs/exact.rs"]
mod exact;
#[path = "../../../../tests/it/twins/naive.rs"]
mod naive;
mod random;
mod single;

use carom_collision::{
    Convex, Motion, TimeOfImpact, contacts, distance, hulls, overlap_area, separating_axis,
    shape_distance, shape_push, time_of_impact,
};
use carom_geometry::Shape;
use carom_math::{Pose, SimTime, Vec2, vec2};

use super::Finding;
use crate::exit::Failure;
use crate::interrupt;
use crate::parallel::{cores, in_order};
use naive::Solid;
use random::{ConvexPair, Random};
pub(super) use single::{generators, masses, pieces};

/// Pairs of each case.
const COUNT: u64 = 1_000_000;

/// Pairs that one job of a thread looks at.
const BATCH: u64 = 5_000;

/// What a batch of pairs gave.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    looked_at: u64,
    failed: u64,
    undecided: u64,
    /// Largest error, as a fraction of what rounding is allowed to do.
    worst: f64,
    /// The first pair that failed.
    first: Option<u64>,
}

impl Tally {
    fn check(&mut self, number: u64, right: bool) {
        if !right {
            self.failed += 1;
            self.first = self.first.or(Some(number));
        }
    }

    /// An error and the unit it is measured in.
    fn error(&mut self, number: u64, error: f64, unit: f64, limit: f64) {
        let share = error / unit;
        self.worst = self.worst.max(share);
        self.check(number, share <= limit);
    }

    fn join(&mut self, other: Self) {
        self.looked_at += other.looked_at;
        self.failed += other.failed;
        self.undecided += other.undecided;
        self.worst = self.worst.max(other.worst);
        self.first = self.first.or(other.first);
    }
}

/// Runs a case over all pairs on every core; Ctrl-C ends it with what was looked at.
fn over_all(what: &'static str, look: impl Fn(u64, &mut Tally) + Sync) -> Result<Finding, Failure> {
    let mut next = 0;
    let mut all = Tally::default();
    in_order(
        cores(),
        || {
            let start = next;
            next += BATCH;
            Ok((start < COUNT && !interrupt::asked()).then_some(start))
        },
        |start| {
            let mut tally = Tally::default();
            for number in start..start + BATCH {
                look(number, &mut tally);
                tally.looked_at += 1;
            }
            Ok(tally)
        },
        |tally| {
            all.join(tally);
            Ok(())
        },
    )?;
    let first = all
        .first
        .map_or(String::new(), |n| format!(", first is {n}"));
    let undecided = match all.undecided {
        0 => String::new(),
        n => format!(", {n} undecided"),
    };
    Ok(Finding {
        passed: all.failed == 0 && all.undecided == 0 && all.looked_at > 0,
        measured: format!(
            "{} looked at, {} wrong{first}{undecided}, worst {:.1} roundings",
            all.looked_at,
            all.failed,
            all.worst / f64::EPSILON
        ),
        wanted: what,
    })
}

fn ring(shape: &Shape, pose: Pose) -> Vec<Vec2> {
    shape.vertices().iter().map(|v| pose.point(*v)).collect()
}

fn solid(shape: &Shape, pose: Pose) -> Solid {
    match shape {
        Shape::Circle(disc) => Solid::Disc(pose.point(disc.centre()), disc.radius()),
        other => Solid::Ring(ring(other, pose)),
    }
}

/// Depth, distance, witnesses, normals, swap and exact shifts of convex pairs.
pub(super) fn convex_pairs() -> Result<Finding, Failure> {
    over_all(
        "each within 8 roundings of its lengths; shifts bit for bit",
        |number, tally| {
            let pair = ConvexPair::new(number);
            let (a, b) = (pair.a.hull(), pair.b.hull());
            let corners = (pair.a.vertices().to_vec(), pair.b.vertices());
            let placed: Vec<Vec2> = corners.1.iter().map(|v| pair.pose.point(*v)).collect();
            let unit = pair.size + pair.pose.position.length();
            let limit = 8.0 * f64::EPSILON;

            let axis = separating_axis(&a, &b, pair.pose);
            let back = pair.pose.inverse();
            let seen: Vec<Vec2> = corners.0.iter().map(|v| back.point(*v)).collect();
            let overlap = naive::least_overlap((&corners.0, &placed), (corners.1, &seen));
            tally.error(number, (axis.separation + overlap).abs(), unit, limit);

            let way = distance(&a, &b, pair.pose);
            let apart = naive::distance(&Solid::Ring(corners.0.clone()), &Solid::Ring(placed));
            tally.error(number, (way.distance - apart).abs(), unit, limit);
            // 0 exactly when they overlap, where rounding does not decide.
            if overlap.abs() > limit * unit {
                tally.check(number, (way.distance == 0.0) == (overlap > 0.0));
            }
            let gap = (way.point_b - way.point_a).length();
            tally.error(number, (gap - way.distance).abs(), unit, limit);
            tally.error(number, (way.normal.length() - 1.0).abs(), 1.0, limit);

            let back = distance(&b, &a, pair.pose.inverse());
            tally.error(number, (back.distance - way.distance).abs(), unit, limit);

            // Both moved by 2^30 m, where that rounds nothing.
            let shift = vec2(1_073_741_824.0, -1_073_741_824.0);
            let far = Pose::new(pair.pose.position + shift, pair.pose.rotation);
            if far.position - shift == pair.pose.position {
                let seen = far.seen_from(Pose::at(shift));
                tally.check(number, distance(&a, &b, seen) == way);
            }
        },
    )
}

/// Whole shapes, concave ones too: distance, contacts, shared area and the way out.
pub(super) fn concave_pairs() -> Result<Finding, Failure> {
    over_all(
        "distance within 256 roundings; a contact wherever they overlap",
        |number, tally| {
            let mut random = Random::new(number);
            let (a, b) = (random.shape(), random.shape());
            let pose = random.pose(1.5);
            let unit = 4.0;
            let limit = 256.0 * f64::EPSILON;
            let way = shape_distance(&a, &b, pose);
            let apart = naive::distance(&solid(&a, Pose::IDENTITY), &solid(&b, pose));
            tally.error(number, (way.distance - apart).abs(), unit, limit);

            let mut found = Vec::new();
            contacts(&a, &b, pose, 0.0, &mut found);
            let deepest = found.iter().filter_map(|c| c.manifold.deepest());
            let deepest = deepest.fold(f64::INFINITY, f64::min);
            let area = overlap_area(&a, &b, pose);
            // An overlap of a tenth of a square micrometre is felt; what is apart is not.
            tally.check(number, area < 1e-13 || deepest < 0.0);
            tally.check(
                number,
                apart <= limit * unit || (found.is_empty() && area <= 0.0),
            );
            tally.error(
                number,
                (overlap_area(&b, &a, pose.inverse()) - area).abs(),
                unit,
                limit,
            );
            // The whole is what its pieces are together.
            let parts: f64 = hulls(&a)
                .flat_map(|x| hulls(&b).map(move |y| distance(&x, &y, pose).distance))
                .fold(f64::INFINITY, f64::min);
            tally.check(number, parts.to_bits() == way.distance.to_bits());
            if number.is_multiple_of(16)
                && let Some(push) = shape_push(&a, &b, pose)
            {
                let out = Pose::new(pose.position + push, pose.rotation);
                tally.check(number, overlap_area(&a, &b, out) < 1e-11);
            }
        },
    )
}

/// Times of impact against dense sampling, and their certificate: the distance at the instant.
pub(super) fn times_of_impact() -> Result<Finding, Failure> {
    const SAMPLES: u32 = 48;
    over_all(
        "no overlap before, contact at the instant, to 64 roundings",
        |number, tally| {
            let mut random = Random::new(number);
            let (a, b) = (random.shape(), random.shape());
            let (motion_a, motion_b) = (random.motion(-2.0), random.motion(2.0));
            let horizon = 1.5;
            // Sizes, turned, plus distance and travel.
            let reach = |shape: &Shape, motion: &Motion| {
                shape.reach_about(Vec2::ZERO) * (1.0 + motion.turn(horizon).abs())
                    + motion.travel(horizon).length()
                    + motion.centre.length()
            };
            let unit = reach(&a, &motion_a) + reach(&b, &motion_b);
            let limit = 64.0 * f64::EPSILON;
            let at = |t: f64| {
                let time = SimTime::from_secs(t);
                (
                    solid(&a, motion_a.pose_at(time)),
                    solid(&b, motion_b.pose_at(time)),
                )
            };
            let answer = time_of_impact(&a, &motion_a, &b, &motion_b, horizon);
            let until = match &answer {
                TimeOfImpact::Hit(hit) => {
                    let (x, y) = at(hit.time);
                    tally.error(number, naive::distance(&x, &y), unit, limit);
                    hit.time
                }
                TimeOfImpact::Clear => horizon,
                TimeOfImpact::Touching(_) => {
                    let (x, y) = at(0.0);
                    tally.check(number, naive::distance(&x, &y) <= limit * unit);
                    return;
                }
                TimeOfImpact::Unresolved { .. } => {
                    tally.undecided += 1;
                    return;
                }
            };
            // A pair that starts in an overlap that opens is free until it has opened.
            let (x, y) = at(0.0);
            if naive::distance(&x, &y) <= 0.0 {
                return;
            }
            for i in 0..SAMPLES {
                let t = until * f64::from(i) / f64::from(SAMPLES);
                let (x, y) = at(t);
                let missed = naive::distance(&x, &y) <= 0.0 && t < until - limit * unit;
                tally.check(number, !missed || !deep(&x, &y, limit * unit));
                if missed {
                    break;
                }
            }
        },
    )
}

/// Whether an overlap is more than rounding: it is there when either is a little smaller, too.
fn deep(a: &Solid, b: &Solid, rounding: f64) -> bool {
    match (a, b) {
        (Solid::Disc(p, r), other) => naive::distance(&Solid::Disc(*p, r - rounding), other) <= 0.0,
        (other, Solid::Disc(p, r)) => naive::distance(other, &Solid::Disc(*p, r - rounding)) <= 0.0,
        (Solid::Ring(p), Solid::Ring(q)) => {
            // A corner inside by more than rounding, or rims that cross that far apart.
            let in_by = |ring: &[Vec2], points: &[Vec2]| {
                let inside = points.iter().filter(|v| naive::inside(ring, **v));
                inside
                    .map(|v| naive::from_rim(ring, *v))
                    .fold(0.0, f64::max)
            };
            in_by(p, q).max(in_by(q, p)) > rounding
        }
    }
}
