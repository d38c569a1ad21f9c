//! Free pairs, of two bodies that contacts alone move, keep their angular momentum `Σ m c × v + I ω` to rounding.
//!
//! ```text
//! impulses act at one point of both bodies, at the poses that the sub-step begins with
//! d += h v₁,  v₁ = start + M⁻¹ Jᵀ j₁           as the pass with bias leaves them
//! v' = start + M⁻¹ Jᵀ j'                        as the sub-step ends
//! Σ m h v₁ × v' = h Σ (j₁ − j') × (v'_B − v'_A)  is what the displacement adds, contact by contact
//! v'_B − v'_A turns by what gives that back      as it turns with the line between both centres on a curved way
//! ```
//! Displacements that part an overlap count as impulses `j₁` that do not last.

use carom_math::perp;

use super::block::LANES;
use super::graph::Graph;
use super::turn_back::{Turn, turn_all};
use crate::bodies::Bodies;
use crate::{ContactIx, LineIx};

/// The contacts of free pairs in a sub-step.
#[derive(Clone, Debug, Default)]
pub(crate) struct FreePairs {
    /// In the order of colours and lanes.
    rows: Vec<FreeRow>,
    /// Rows with displacements that came after velocities had been found.
    late: Vec<usize>,
    /// Scratch.
    turns: Vec<Turn>,
}

#[derive(Clone, Copy, Debug)]
struct FreeRow {
    /// Colour, block and lane.
    at: (usize, usize, usize),
    lines: [LineIx; 2],
    /// Impulses that displaced the bodies, along the normal and across, in N·s.
    along: f64,
    across: f64,
}

impl FreePairs {
    /// Gathers them, and has their impulses act at one point of both bodies: v stays, and what contacts did to it changes.
    pub(crate) fn meet(&mut self, graph: &mut Graph, bodies: &mut Bodies) {
        self.rows.clear();
        if !bodies.any_is_free() {
            return;
        }
        for (colour, c) in graph.awake().iter_mut().zip(0..) {
            for (block, k) in colour.blocks.iter_mut().zip(0..) {
                for lane in 0..LANES {
                    let lines = block.lines(lane);
                    if !lines.iter().all(|line| bodies.is_free(*line)) {
                        continue;
                    }
                    let [j1, j2, jt] = block.impulses(lane);
                    let (lever, height) = block.meet(lane, bodies);
                    let moment = lever * (j1 + j2) + height * jt;
                    for at in lines {
                        let turn = moment * bodies.lines[at].inverse_inertia();
                        bodies.start[at].0[2] -= turn;
                    }
                    self.rows.push(FreeRow {
                        at: (c, k, lane),
                        lines,
                        along: 0.0,
                        across: 0.0,
                    });
                }
            }
        }
    }

    /// Notes the impulses that bodies are displaced by.
    pub(crate) fn note_impulses(&mut self, graph: &Graph) {
        for row in &mut self.rows {
            [row.along, row.across] = row.lasting(graph);
        }
    }

    /// A contact displaced its bodies, besides, as by an impulse along the normal, in N·s.
    pub(crate) fn add(&mut self, graph: &Graph, id: ContactIx, impulse: f64) {
        if let Some(known) = self.find(graph, id) {
            self.rows[known].along += impulse;
        }
    }

    /// The same along the normal and across once velocities have been found: see [`Self::turn_back_late`].
    pub(crate) fn add_late(&mut self, graph: &Graph, id: ContactIx, (along, across): (f64, f64)) {
        if let Some(known) = self.find(graph, id) {
            self.rows[known].along += along;
            self.rows[known].across += across;
            self.late.push(known);
        }
    }

    /// The row of a contact, if its bodies are free.
    fn find(&self, graph: &Graph, id: ContactIx) -> Option<usize> {
        let contact = &graph.contacts[id];
        let (k, lane) = contact.place();
        let at = (contact.colour as usize, k, lane);
        self.rows.binary_search_by_key(&at, |row| row.at).ok()
    }

    /// Gives back the angular momentum that displacements added within `h` seconds, before rows are rotated.
    pub(crate) fn turn_back(&mut self, graph: &Graph, bodies: &mut Bodies, h: f64) {
        self.turns.clear();
        let turns = self
            .rows
            .iter_mut()
            .filter_map(|row| row.turn(graph, bodies, h));
        self.turns.extend(turns);
        turn_all(bodies, &self.turns);
    }

    /// The same of displacements that came afterwards.
    pub(crate) fn turn_back_late(&mut self, graph: &Graph, bodies: &mut Bodies, h: f64) {
        self.late.sort_unstable();
        self.late.dedup();
        self.turns.clear();
        for known in self.late.drain(..) {
            let row = &mut self.rows[known];
            let turn = row
                .turn(graph, bodies, h)
                .map(|turn| Turn { limit: 0.0, ..turn });
            self.turns.extend(turn);
            row.lines
                .into_iter()
                .for_each(|line| bodies.note_change(line));
        }
        turn_all(bodies, &self.turns);
    }
}

impl FreeRow {
    /// Its impulses along the normal and across, in N·s.
    fn lasting(&self, graph: &Graph) -> [f64; 2] {
        let (colour, k, lane) = self.at;
        let [j1, j2, jt] = graph.colours[colour].blocks[k].impulses(lane);
        [j1 + j2, jt]
    }

    /// How its pair turns back, if it does. Displacements that come later count from here.
    fn turn(&mut self, graph: &Graph, bodies: &Bodies, h: f64) -> Option<Turn> {
        let lasting = self.lasting(graph);
        let (along, across) = (self.along - lasting[0], self.across - lasting[1]);
        if along.abs() + across.abs() <= 0.0 {
            return None;
        }
        [self.along, self.across] = lasting;
        let (colour, k, lane) = self.at;
        let n = graph.colours[colour].blocks[k].normal(lane);
        let push = n * along + perp(n) * across;
        let [a, b] = self.lines.map(|line| &bodies.lines[line]);
        let v = b.v() - a.v();
        let began = v + push * (a.inverse_mass() + b.inverse_mass());
        Some(Turn {
            lines: self.lines,
            moment: -(push.perp_dot(v) * h),
            limit: v.length_squared().max(began.length_squared()),
        })
    }
}
