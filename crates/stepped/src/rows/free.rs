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

use carom_math::{Vec2, perp};

use super::block::LANES;
use super::graph::Graph;
use super::line::Quad;
use crate::bodies::Bodies;

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
    lines: [u32; 2],
    /// Impulses that displaced the bodies, along the normal and across, in N·s.
    along: f64,
    across: f64,
}

/// How a pair turns back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) lines: [u32; 2],
    /// What it is to have more of angular momentum, in N·m·s.
    pub(super) moment: f64,
    /// The square of the greatest speed that B may have against A, in m²/s².
    pub(super) limit: f64,
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
                    let lines = [block.a[lane], block.b[lane]];
                    if !lines.iter().all(|line| bodies.is_free(*line)) {
                        continue;
                    }
                    let [j1, j2, jt] = block.impulses(lane);
                    let (lever, height) = block.meet(lane, bodies);
                    let moment = lever * (j1 + j2) + height * jt;
                    for at in lines.map(|line| line as usize) {
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
    pub(crate) fn add(&mut self, graph: &Graph, id: u32, impulse: f64) {
        if let Some(known) = self.find(graph, id) {
            self.rows[known].along += impulse;
        }
    }

    /// The same along the normal and across once velocities have been found: see [`Self::turn_back_late`].
    pub(crate) fn add_late(&mut self, graph: &Graph, id: u32, (along, across): (f64, f64)) {
        if let Some(known) = self.find(graph, id) {
            self.rows[known].along += along;
            self.rows[known].across += across;
            self.late.push(known);
        }
    }

    /// The row of a contact, if its bodies are free.
    fn find(&self, graph: &Graph, id: u32) -> Option<usize> {
        let contact = &graph.contacts[id as usize];
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
        self.turn_all(bodies);
    }

    /// The same of displacements that came afterwards.
    pub(crate) fn turn_back_late(&mut self, graph: &Graph, bodies: &mut Bodies, h: f64) {
        self.late.sort_unstable();
        self.late.dedup();
        self.turns.clear();
        for known in self.late.drain(..) {
            let row = &mut self.rows[known];
            self.turns.extend(row.turn(graph, bodies, h));
            row.lines
                .into_iter()
                .for_each(|line| bodies.note_change(line));
        }
        self.turn_all(bodies);
    }

    /// All moments are those of the velocities that the displacements came with.
    fn turn_all(&self, bodies: &mut Bodies) {
        for turn in &self.turns {
            let rest = turn_pair(bodies, turn);
            let lines = turn.lines.map(|line| line as usize);
            let inverse = lines.map(|line| bodies.lines[line].inverse_inertia());
            let [own_a, own_b] = inverse.map(|i| if i > 0.0 { 1.0 / i } else { 0.0 });
            if rest != 0.0 && own_a + own_b > 0.0 {
                let turn = Quad::new(Vec2::ZERO, rest / (own_a + own_b));
                for (line, i) in lines.into_iter().zip(inverse) {
                    if i > 0.0 {
                        bodies.lines[line].add(&turn);
                        bodies.start[line].add(&turn);
                    }
                }
            }
        }
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
        let [a, b] = self.lines.map(|line| &bodies.lines[line as usize]);
        let v = b.v() - a.v();
        let began = v + push * (a.inverse_mass() + b.inverse_mass());
        Some(Turn {
            lines: self.lines,
            moment: -(push.perp_dot(v) * h),
            limit: v.length_squared().max(began.length_squared()),
        })
    }
}

/// Turns the velocity of B against A so that both have the moment more. It is as long as before, or as what displaced them if that was
/// faster and no turn is enough, and on which side of the line between both it points stays. What no turn gives, in N·m·s.
pub(super) fn turn_pair(bodies: &mut Bodies, turn: &Turn) -> f64 {
    let [a, b] = turn.lines.map(|line| line as usize);
    let (first, second) = (&bodies.lines[a], &bodies.lines[b]);
    let (ma, mb) = (first.inverse_mass(), second.inverse_mass());
    let centre = |at: usize| bodies.base[at].position + bodies.lines[at].d();
    let (arm, v) = (centre(b) - centre(a), second.v() - first.v());
    // By which arm × v is to change.
    let more = turn.moment * (ma + mb);
    let square = arm.length_squared();
    if square <= 0.0 {
        return turn.moment;
    }
    let (turns, parts) = (arm.perp_dot(v), arm.dot(v));
    // (arm · v)² + (arm × v)² stays.
    let left = parts * parts - more * (turns + turns + more);
    // What displaced them may have been faster: that energy is there.
    let most = (square * turn.limit)
        .max(parts * parts + turns * turns)
        .sqrt();
    let wanted = turns + more;
    let change = if wanted * wanted <= most * most {
        more
    } else {
        most.copysign(wanted) - turns
    };
    let parting = left.max(0.0).sqrt().copysign(parts) - parts;
    let scale = 1.0 / (square * (ma + mb));
    let push = (arm * parting + perp(arm) * change) * scale;
    for (at, push) in [(a, push * -ma), (b, push * mb)] {
        let push = Quad::new(push, 0.0);
        bodies.lines[at].add(&push);
        bodies.start[at].add(&push);
    }
    (more - change) / (ma + mb)
}
