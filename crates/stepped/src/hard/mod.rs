//! Hard rows: islands with loads that Gauss–Seidel sweeps cannot carry are solved for directly, by Signorini's condition and
//! Coulomb's law at velocity level. They have no springs.
//!
//! ```text
//! v' = start + M⁻¹ Jᵀ j        0 ≤ jₙ ⟂ v'ₙ + max(gap, 0)/h ≥ 0        |jₜ| ≤ µ Σ jₙ, against the slip
//! d += h w                     w: as of all bodies, then moved by as little as leaves no gap below 0
//! ```
//! Overlaps are displacement alone: they add no velocity, and no energy.

mod conditions;
mod islands;
mod part;
mod solve;

use crate::Settings;
use crate::bodies::Bodies;
use crate::rows::{FreePairs, Graph, Law, OPEN};
use islands::{Key, Search};
use solve::Island;

/// Islands in hard rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct HardRows {
    /// Contacts of each island, in the order of their bodies.
    islands: Vec<Vec<u32>>,
    /// The same, as they were solved for in this sub-step.
    solved: Vec<Island>,
    /// Contacts of each island that had no answer: it takes soft rows until it has other contacts.
    unanswered: Vec<Vec<Key>>,
    search: Search,
    /// Solves that met no answer.
    pub(crate) failed: u64,
    /// What friction turned to heat in the last sub-step, in J.
    pub(crate) heat: f64,
}

impl HardRows {
    /// Sends islands to hard rows, and back, for a sub-step: in every one of them, so that no island depends on when
    /// contacts of another one changed. What goes back begins with no impulses: the impulses that held a column which buckled are up to
    /// 1e6 N·s, and sweeps cannot take them back.
    pub(crate) fn gather(&mut self, settings: &Settings, graph: &mut Graph, bodies: &mut Bodies) {
        let mut found = islands::find(graph, bodies, settings, &mut self.search);
        if !self.unanswered.is_empty() {
            let keys: Vec<Vec<Key>> = found
                .iter()
                .map(|ids| islands::keys(graph, bodies, ids))
                .collect();
            self.unanswered.retain(|island| keys.contains(island));
            let mut keys = keys.iter();
            found.retain(|_| {
                keys.next()
                    .is_none_or(|island| !self.unanswered.contains(island))
            });
        }
        if graph.has_hard() {
            let mut hard: Vec<u32> = found.iter().flatten().copied().collect();
            hard.sort_unstable();
            for &id in self.islands.iter().flatten() {
                if hard.binary_search(&id).is_err() && graph.is_hard(id) {
                    graph.clear_warm_start(bodies, id);
                    graph.set_hard(id, false);
                }
            }
        }
        for &id in found.iter().flatten() {
            graph.set_hard(id, true);
        }
        self.islands = found;
    }

    /// Takes what contacts did in the last sub-step from the velocities: a light body that bears a heavy one would seem to arrive
    /// wherever rows changed since.
    pub(crate) fn free(&self, bodies: &mut Bodies, graph: &Graph) {
        for &id in self.islands.iter().flatten() {
            let (block, _, lane) = graph.lane(id);
            for line in [block.a[lane], block.b[lane]] {
                let start = bodies.start[line as usize];
                bodies.lines[line as usize].set_velocity(start.v(), start.w());
            }
        }
    }

    /// Solves for the velocities at the end of the sub-step, once gravity acts; impulses go into the rows. Islands without an
    /// answer get soft rows; whether there are some.
    pub(crate) fn solve(&mut self, law: &Law, bodies: &mut Bodies, graph: &mut Graph) -> bool {
        self.heat = 0.0;
        self.solved.clear();
        let mut failed = false;
        self.islands.retain(|ids| {
            let mut island = Island::of(law, graph, bodies, ids);
            let answered = island.solve(law, bodies, graph);
            if answered {
                self.heat += island.heat(bodies, graph);
                self.solved.push(island);
            } else {
                for &id in ids {
                    graph.set_hard(id, false);
                }
                self.unanswered.push(islands::keys(graph, bodies, ids));
                self.failed += 1;
                failed = true;
            }
            answered
        });
        failed
    }

    /// Parts what overlaps once the bodies moved; the least gap that is left, in m.
    pub(crate) fn part(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        graph: &Graph,
        settings: &Settings,
        free: &mut FreePairs,
    ) -> f64 {
        let mut least = OPEN;
        for island in &mut self.solved {
            least = least.min(island.part(law, bodies, (graph, free), settings));
        }
        least
    }
}
