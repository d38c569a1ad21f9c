//! Two shapes in motion: times of impact.

use carom_collision::{Motion, TimeOfImpact, time_of_impact};
use carom_math::{Rot, SimTime, Vec2, vec2};
use parry2d_f64::math::Vector;
use parry2d_f64::query::{self, NonlinearRigidMotion};

use crate::naive;
use crate::race::Table;
use crate::shapes::{Kind, Pair, Random, solid, their_pose, vector};

/// Pairs of each row.
const COUNT: u64 = 1000;

/// Seconds that are searched.
const HORIZON: f64 = 2.0;

/// Two shapes that fly towards each other at 3 m/s, from 4 m apart.
struct Flight {
    pair: Pair,
    motions: [Motion; 2],
    their_motions: [NonlinearRigidMotion; 2],
}

impl Flight {
    /// Centres pass each other at `aside` of both reaches; `spin` in rad/s.
    fn some(kind: Kind, aside: (f64, f64), spin: f64) -> Vec<Self> {
        let pairs = Pair::some(COUNT, (kind, kind), 1.0);
        let one = |(number, pair): (u64, Pair)| {
            let mut random = Random::new(number + 9000);
            let reach = pair.a.reach_about(Vec2::ZERO) + pair.b.reach_about(Vec2::ZERO);
            let y = reach * random.between(aside.0, aside.1);
            let mut motion = |x: f64, y: f64| Motion {
                velocity: vec2(-0.75 * x, 0.0),
                spin: random.between(-spin, spin),
                rotation: Rot::from_angle(random.between(-3.0, 3.0)),
                ..Motion::resting(vec2(x, y))
            };
            let motions = [motion(-2.0, 0.0), motion(2.0, y)];
            let theirs = |motion: &Motion| {
                let start = their_pose(motion.pose_at(SimTime::ZERO));
                let velocity = vector(motion.velocity);
                NonlinearRigidMotion::new(start, Vector::ZERO, velocity, motion.spin)
            };
            Self {
                their_motions: motions.each_ref().map(theirs),
                motions,
                pair,
            }
        };
        (0..).zip(pairs).map(one).collect()
    }

    /// Brute force: metres between the two at a time.
    fn gap(&self, seconds: f64) -> f64 {
        let at = |motion: &Motion| motion.pose_at(SimTime::from_secs(seconds));
        naive::distance(
            &solid(&self.pair.a, at(&self.motions[0])),
            &solid(&self.pair.b, at(&self.motions[1])),
        )
    }

    /// Whether a hit is none (they are more than 0.1 mm apart), or a sample before it overlaps.
    fn refutes(&self, hit: Option<f64>) -> bool {
        const SAMPLES: u32 = 200;
        if hit.is_some_and(|time| self.gap(time) > 1e-4) {
            return true;
        }
        let until = hit.unwrap_or(HORIZON) - 1e-4;
        let sample = |i: u32| until * f64::from(i) / f64::from(SAMPLES);
        (0..SAMPLES)
            .map(sample)
            .any(|time| time > 0.0 && self.gap(time) <= 0.0)
    }
}

/// Hits, misses, grazes and fast spins of three shapes.
pub(crate) fn impacts(table: &Table) {
    let ways = [
        ("hit", (-0.3, 0.3), 1.0),
        ("miss", (1.01, 2.0), 1.0),
        ("graze", (0.9, 1.0), 1.0),
        ("spinning at up to 40 rad/s", (-0.5, 0.5), 40.0),
    ];
    for kind in [Kind::Box, Kind::Regular(6), Kind::L] {
        for (way, aside, spin) in ways {
            let name = kind.name();
            table.row(
                &format!("time of impact, {name}–{name}, {way}"),
                &Flight::some(kind, aside, spin),
                |flight| {
                    let (a, b) = (&flight.pair.a, &flight.pair.b);
                    let [motion_a, motion_b] = &flight.motions;
                    time_of_impact(a, motion_a, b, motion_b, HORIZON)
                },
                |flight| {
                    let (a, b) = (&*flight.pair.their_a.0, &*flight.pair.their_b.0);
                    let [motion_a, motion_b] = &flight.their_motions;
                    let found =
                        query::cast_shapes_nonlinear(motion_a, a, motion_b, b, 0.0, HORIZON, true);
                    let found = found.expect("parry knows these shapes");
                    found.map(|hit| hit.time_of_impact)
                },
                |flight, ours, theirs| {
                    let our_hit = match ours {
                        TimeOfImpact::Hit(hit) => Some(hit.time),
                        TimeOfImpact::Touching(_) => Some(0.0),
                        TimeOfImpact::Clear => None,
                        // No answer is a wrong one.
                        TimeOfImpact::Unresolved { .. } => return [true, flight.refutes(*theirs)],
                    };
                    [flight.refutes(our_hit), flight.refutes(*theirs)]
                },
            );
        }
    }
}
