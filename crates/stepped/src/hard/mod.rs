//! Hard rows: islands whose loads Gauss–Seidel sweeps cannot carry are solved for directly, by Signorini's condition and
//! Coulomb's law at velocity level. They have no springs.
//!
//! ```text
//! v' = start + M⁻¹ Jᵀ j        0 ≤ jₙ ⟂ v'ₙ + max(gap, 0)/h ≥ 0        |jₜ| ≤ µ Σ jₙ, against the slip
//! d += h w                     w: the trapezoid of v and v', moved by as little as leaves no gap below 0
//! ```
//! Overlaps are displacement alone: they add no velocity, and no energy.

mod conditions;
mod islands;
mod solve;

use crate::bodies::Bodies;
use crate::rows::{ExtraSweeps, Graph, Law, OPEN, Quad};
use solve::Island;

/// Islands in hard rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct HardRows {
    /// Contacts of each island, in the order of their bodies.
    islands: Vec<Vec<u32>>,
    /// What is known of each body's component while islands are gathered.
    known: Vec<islands::Known>,
    /// Where their bodies are at the end of the sub-step: line and displacement.
    moves: Vec<(u32, Quad)>,
    /// Solves that met no answer within their bounds: those islands took soft rows for the rest of the tick.
    pub(crate) failed: u64,
    /// What friction turned to heat in the last sub-step, in J, and the least gap after it, in m.
    pub(crate) heat: f64,
    pub(crate) least_gap: f64,
}

impl HardRows {
    /// Sends islands to hard rows, and back, for the sub-steps until contacts change.
    pub(crate) fn gather(&mut self, graph: &mut Graph, bodies: &Bodies) {
        let found = islands::find(graph, bodies, &mut self.known);
        let mut hard: Vec<u32> = found.iter().flatten().copied().collect();
        hard.sort_unstable();
        for &id in self.islands.iter().flatten() {
            if hard.binary_search(&id).is_err() && graph.is_hard(id) {
                graph.set_hard(id, false);
            }
        }
        for id in hard {
            graph.set_hard(id, true);
        }
        self.islands = found;
    }

    /// Takes what contacts did in the last sub-step from the velocities: a light body that bears a heavy one would seem to arrive
    /// wherever rows changed since.
    pub(crate) fn free(&self, bodies: &mut Bodies, graph: &Graph) {
        for &id in self
            .islands
            .iter()
            .flatten()
            .filter(|id| graph.is_hard(**id))
        {
            let (block, _, lane) = graph.lane(id);
            for line in [block.a[lane], block.b[lane]] {
                let start = bodies.start[line as usize];
                bodies.lines[line as usize].set_velocity(start.v(), start.w());
            }
        }
    }

    /// Solves for the velocities at the end of the sub-step, once gravity acts; impulses go into the rows. Islands without an
    /// answer get soft rows.
    pub(crate) fn solve(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        graph: &mut Graph,
        extra: &mut ExtraSweeps,
    ) {
        self.moves.clear();
        (self.heat, self.least_gap) = (0.0, OPEN);
        let mut failed = Vec::new();
        for (k, ids) in self.islands.iter_mut().enumerate() {
            // Some may have gone since they were gathered.
            ids.retain(|id| graph.is_hard(*id));
            let mut island = Island::of(graph, bodies, ids);
            if island.solve(law, bodies, graph) {
                island.displace(law, bodies, graph, &mut self.moves);
                self.heat += island.heat(bodies, graph);
                self.least_gap = self.least_gap.min(island.least_gap(law, graph));
            } else {
                failed.push(k);
            }
        }
        for k in failed.into_iter().rev() {
            let ids = self.islands.remove(k);
            for &id in &ids {
                graph.set_hard(id, false);
            }
            extra.add(ids);
            self.failed += 1;
        }
    }

    /// Puts the bodies where the solve wants them, after whatever moved all bodies.
    pub(crate) fn place(&self, bodies: &mut Bodies) {
        for (line, to) in &self.moves {
            bodies.lines[*line as usize].set_displacement(to.v(), to.w());
        }
    }
}
