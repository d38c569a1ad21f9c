//! Extra sweeps at large mass ratios.
//!
//! A Gauss–Seidel sweep over a light body between a heavy one and the ground leaves r/(r + 1) of the error at mass ratio r. So all
//! rows of a body that touches one more than [`UNEQUAL`] times as heavy are swept again after each sweep, group by group: how
//! often depends on the group alone.

use super::graph::Graph;
use super::kernel::Pass;
use super::law::Law;
use super::plain::row;
use crate::bodies::{Bodies, BodyKind};
use crate::groups::Groups;
use crate::{BodyIx, ContactIx};

/// Mass ratio above which rows get extra sweeps. A box of 20 times the mass comes back from a light one at 1.5 m/s of 4.4
/// without them, and one of 10 times does so at 1.6 m/s.
const UNEQUAL: f64 = 16.0;

/// Above this ratio sweeps are four times as many.
const VERY_UNEQUAL: f64 = 64.0;

/// Sweeps of a group: a load of 20 times the mass comes to rest with 30, one of 100 times with 120.
const SWEEPS: usize = 30;

/// Rows swept for one group and pass at most. 1,500: a heap of sizes of 1 to 20 takes 1.1 times as long and is as deep; 500: a press on a
/// column throws a box; 0: a smash is twice as deep.
const MOST: usize = 750;

/// Sweeps end that change the impulses of a group by less than this part of their sum. Without an end a heap of sizes of 1 to 20 takes
/// 1.07 of the instructions.
const SETTLED: f64 = 1e-4;

/// Over-relaxation of repeated sweeps, as a part of that of single ones beyond 1.
const PART: f64 = 0.6;

/// Rows with extra sweeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExtraSweeps {
    /// Contacts of each group, in the order of their bodies, and how often they are swept.
    groups: Vec<(Vec<ContactIx>, usize)>,
    /// The first light body about each body, while groups are gathered: scratch.
    owner: Vec<u32>,
}

impl Graph {
    /// Whether a contact is between two bodies of very different mass.
    pub(crate) fn is_unequal(bodies: &Bodies, ends: [BodyIx; 2]) -> bool {
        ratio(bodies, ends) > UNEQUAL
    }
}

/// How many times as heavy the heavier of two dynamic bodies is; 1 if they are not.
fn ratio(bodies: &Bodies, ends: [BodyIx; 2]) -> f64 {
    let [a, b] = ends.map(|slot| &bodies.records[slot]);
    if a.kind != BodyKind::Dynamic || b.kind != BodyKind::Dynamic {
        return 1.0;
    }
    a.mass.max(b.mass) / a.mass.min(b.mass)
}

impl ExtraSweeps {
    /// Gathers the groups of a sub-step: in every one of them, so that no island depends on when contacts of another one changed.
    pub(crate) fn gather(&mut self, graph: &mut Graph, bodies: &Bodies) {
        self.groups.clear();
        if graph.unequal.is_empty() {
            return;
        }
        // Those of what sleeps stay, and those that went go.
        let mut unequal = core::mem::take(&mut graph.unequal);
        unequal.sort_unstable();
        unequal.dedup();
        unequal.retain(|id| {
            let contact = &graph.contacts[*id];
            contact.sleeps()
                || graph.cold(*id).is_some() && Graph::is_unequal(bodies, contact.bodies)
        });
        graph.unequal = unequal;
        let graph = &*graph;
        // Light bodies, and the greatest ratio that each has to bear.
        let mut light: Vec<(BodyIx, f64)> = Vec::new();
        for &id in &graph.unequal {
            let contact = &graph.contacts[id];
            if contact.sleeps() || contact.is_hard() {
                continue;
            }
            let [a, b] = contact.bodies;
            let lighter = bodies.records[a].mass < bodies.records[b].mass;
            light.push((if lighter { a } else { b }, ratio(bodies, contact.bodies)));
        }
        light.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        light.dedup_by_key(|light| light.0);
        // Light bodies that touch each other, or the same heavy one, are one group.
        let mut groups = Groups::new(light.len());
        self.owner.resize(bodies.records.len(), u32::MAX);
        for ((slot, _), k) in light.iter().zip(0u32..) {
            for other in graph.neighbours(bodies, *slot).chain([*slot]) {
                if bodies.is_dynamic(other) {
                    let first = &mut self.owner[other.at()];
                    if *first == u32::MAX {
                        *first = k;
                    }
                    groups.join(*first as usize, k as usize);
                }
            }
        }
        self.owner.clear();
        let mut gathered = std::collections::BTreeMap::new();
        for (k, (slot, ratio)) in light.iter().enumerate() {
            let group: &mut (Vec<ContactIx>, f64) =
                gathered.entry(groups.find(k)).or_insert((Vec::new(), 1.0));
            group
                .0
                .extend(graph.of_body(bodies, *slot).map(|(id, _)| id));
            group.1 = group.1.max(*ratio);
        }
        for (mut rows, ratio) in gathered.into_values() {
            graph.sort(bodies, &mut rows);
            let wanted = if ratio >= VERY_UNEQUAL {
                4 * SWEEPS
            } else {
                SWEEPS
            };
            let sweeps = wanted.min(MOST / rows.len());
            self.groups.push((rows, sweeps));
        }
    }

    /// Sweeps the rows of all groups.
    pub(crate) fn sweep(&self, pass: Pass, law: &Law, bodies: &mut Bodies, graph: &mut Graph) {
        let omega = 1.0 + PART * (law.over_relaxation - 1.0);
        for (rows, sweeps) in &self.groups {
            for _ in 0..*sweeps {
                let (mut changes, mut sum) = (0.0, 0.0);
                for id in rows {
                    // Some may have gone since the groups were gathered.
                    let Some((cold, lane)) = graph.cold(*id) else {
                        continue;
                    };
                    let belt = cold.belt[lane];
                    let contact = &graph.contacts[*id];
                    debug_assert!(!contact.is_hard(), "a hard row is swept");
                    let (block, lane) = graph.block_mut(*id);
                    let [j1, j2, jt] = block.impulses(lane);
                    row(pass, law, &mut bodies.lines, block, lane, belt, Some(omega));
                    let [new1, new2, new_t] = block.impulses(lane);
                    changes += (new1 - j1).abs() + (new2 - j2).abs() + (new_t - jt).abs();
                    sum += new1 + new2;
                }
                if changes <= SETTLED * sum {
                    break;
                }
            }
            for id in rows {
                graph.note_pushing(*id);
            }
        }
    }
}
