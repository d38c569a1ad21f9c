//! Two shapes at rest: contact manifolds and distances.

use carom_collision::{PartManifold, contacts, shape_distance};
use carom_math::Pose;
use parry2d_f64::math::Pose as TheirPose;
use parry2d_f64::query::{
    self, ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher,
};

use crate::naive::{self, Solid};
use crate::race::Table;
use crate::shapes::{Kind, Pair, solid};

/// Pairs of each row.
const COUNT: u64 = 2000;

/// Contacts of pairs that overlap as often as not.
pub(crate) fn manifolds(table: &Table) {
    let rows = [
        (Kind::Box, Kind::Box, 0.9),
        (Kind::Regular(6), Kind::Regular(6), 1.0),
        (Kind::Regular(32), Kind::Regular(32), 1.1),
        (Kind::Disc, Kind::Regular(6), 1.0),
        (Kind::L, Kind::L, 1.2),
        (Kind::Star(5), Kind::Star(5), 1.2),
        (Kind::Star(40), Kind::Star(40), 1.4),
    ];
    for (a, b, reach) in rows {
        let mut found = Vec::new();
        let mut their_found: Vec<ContactManifold<(), ()>> = Vec::new();
        let convex = a.is_convex_polygon() && b.is_convex_polygon();
        table.row(
            &format!("manifold, {}–{}", a.name(), b.name()),
            &Pair::some(COUNT, (a, b), reach),
            |pair| {
                found.clear();
                contacts(&pair.a, &pair.b, pair.pose, 0.0, &mut found);
                deepest(&found)
            },
            |pair| {
                // Without what it remembers of the step before: so is ours.
                their_found.clear();
                let answered = DefaultQueryDispatcher.contact_manifolds(
                    &pair.their_pose,
                    &*pair.their_a.0,
                    &*pair.their_b.0,
                    0.0,
                    &mut their_found,
                    &mut None,
                );
                answered.expect("parry knows these shapes");
                let points = their_found.iter().flat_map(|found| &found.points);
                points.map(|point| point.dist).fold(f64::INFINITY, f64::min)
            },
            |pair, ours, theirs| {
                let truth = Truth::of(pair, convex);
                [!truth.allows(*ours), !truth.allows(*theirs)]
            },
        );
    }
}

fn deepest(found: &[PartManifold]) -> f64 {
    let each = found
        .iter()
        .filter_map(|contact| contact.manifold.deepest());
    each.fold(f64::INFINITY, f64::min)
}

/// What brute force knows of a pair, in m.
struct Truth {
    apart: f64,
    /// Least overlap of two convex polygons.
    depth: Option<f64>,
}

impl Truth {
    fn of(pair: &Pair, convex: bool) -> Self {
        let (a, b) = (solid(&pair.a, Pose::IDENTITY), solid(&pair.b, pair.pose));
        let depth = match (&a, &b) {
            (Solid::Ring(p), Solid::Ring(q)) if convex => {
                Some(naive::least_overlap((p, q), (q, p)))
            }
            _ => None,
        };
        Self {
            apart: naive::distance(&a, &b),
            depth,
        }
    }

    /// Whether a deepest point may be that: no overlap of what is apart, the least overlap of convex
    /// polygons to a micrometre, and some contact of everything else that overlaps.
    fn allows(&self, deepest: f64) -> bool {
        const ROUNDING: f64 = 1e-9;
        if self.apart > 0.0 {
            return self.apart <= ROUNDING || deepest >= -ROUNDING;
        }
        match self.depth {
            Some(depth) => depth <= ROUNDING || (deepest + depth).abs() < 1e-6,
            None => deepest <= ROUNDING,
        }
    }
}

/// Distances of pairs that are apart more often than not.
pub(crate) fn distances(table: &Table) {
    let rows = [
        (Kind::Box, Kind::Box),
        (Kind::Regular(6), Kind::Regular(6)),
        (Kind::Regular(32), Kind::Regular(32)),
        (Kind::Disc, Kind::Regular(6)),
        (Kind::L, Kind::L),
        (Kind::Star(40), Kind::Star(40)),
    ];
    for (a, b) in rows {
        table.row(
            &format!("distance, {}–{}", a.name(), b.name()),
            &Pair::some(COUNT, (a, b), 3.0),
            |pair| shape_distance(&pair.a, &pair.b, pair.pose).distance,
            |pair| {
                let (a, b) = (&*pair.their_a.0, &*pair.their_b.0);
                let found = query::distance(&TheirPose::IDENTITY, a, &pair.their_pose, b);
                found.expect("parry knows these shapes").distance
            },
            |pair, ours, theirs| {
                let (a, b) = (solid(&pair.a, Pose::IDENTITY), solid(&pair.b, pair.pose));
                let apart = naive::distance(&a, &b);
                [ours, theirs].map(|found| (found - apart).abs() > 1e-9)
            },
        );
    }
}
