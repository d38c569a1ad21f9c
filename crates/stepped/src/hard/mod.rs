//! Hard rows: islands with loads that Gauss–Seidel sweeps cannot carry are solved for directly, by Signorini's condition and
//! Coulomb's law at velocity level. They have no springs.
//!
//! ```text
//! v' = start + M⁻¹ Jᵀ j        0 ≤ jₙ ⟂ v'ₙ + max(gap, 0)/h ≥ 0        |jₜ| ≤ µ Σ jₙ, against the slip
//! d += h w                     w: as of all bodies, then moved by as little as leaves no gap below 0
//! ```
//! Overlaps are displacement alone: they add no velocity, and no energy. All islands of few bodies obey the same conditions where
//! [`crate::Settings::hard_bodies`] asks for it: swept, as near as few sweeps come.

mod conditions;
mod energy;
mod islands;
mod part;
mod solve;

use crate::bodies::Bodies;
use crate::rows::{FreePairs, Graph, Law, OPEN};
use crate::{ContactIx, Settings};
use islands::{Found, Key, Search};
use solve::Island;

/// Islands in hard rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct HardRows {
    islands: Vec<Found>,
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
                .map(|island| islands::keys(graph, bodies, &island.contacts))
                .collect();
            self.unanswered.retain(|island| keys.contains(island));
            let mut keys = keys.iter();
            found.retain(|_| {
                keys.next()
                    .is_none_or(|island| !self.unanswered.contains(island))
            });
        }
        if graph.has_hard() {
            let mut hard: Vec<ContactIx> = contacts_of(&found).collect();
            hard.sort_unstable();
            let mut back: Vec<ContactIx> = graph.hard_ids().collect();
            back.retain(|id| hard.binary_search(id).is_err());
            graph.sort(bodies, &mut back);
            for id in back {
                graph.clear_warm_start(bodies, id);
                graph.set_hard(id, false);
            }
        }
        for id in contacts_of(&found) {
            graph.set_hard(id, true);
        }
        self.islands = found;
    }

    /// Takes what contacts did in the last sub-step from the velocities: a light body that bears a heavy one would seem to arrive
    /// wherever rows changed since.
    pub(crate) fn free(&self, bodies: &mut Bodies, graph: &Graph) {
        for id in contacts_of(&self.islands) {
            let (block, _, lane) = graph.lane(id);
            for line in block.lines(lane) {
                let start = bodies.start[line];
                bodies.lines[line].set_velocity(start.v(), start.w());
            }
        }
    }

    /// Solves for the velocities at the end of the sub-step, once gravity acts; impulses go into the rows. Islands without an
    /// answer get soft rows; whether there are some.
    pub(crate) fn solve(&mut self, law: &Law, bodies: &mut Bodies, graph: &mut Graph) -> bool {
        self.heat = 0.0;
        self.solved.clear();
        let mut failed = false;
        self.islands.retain(|found| {
            let ids = &found.contacts;
            let mut island = Island::of(law, graph, bodies, found);
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

    /// Parts what overlaps once the bodies moved, in islands with free pairs, which give back what they are parted by, or in all others,
    /// which are parted by what bounces left of the energy; the least gap there, in m.
    pub(crate) fn part(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        (graph, free): (&Graph, &mut FreePairs),
        settings: &Settings,
        gives_back: bool,
    ) -> f64 {
        let mut least = OPEN;
        for island in &mut self.solved {
            if island.gives_back == gives_back {
                least = least.min(island.part(law, bodies, (graph, free), settings));
            }
        }
        least
    }
}

fn contacts_of(islands: &[Found]) -> impl Iterator<Item = ContactIx> {
    islands.iter().flat_map(|island| &island.contacts).copied()
}
