//! Deep overlaps: what was put into each other, or crushed, parts at a bounded speed and without energy.
//!
//! A row that pushed them apart by an impulse would leave some of it as velocity, the more the more bodies share a place. So
//! the sweeps see no overlap deeper than a part of the smaller piece, and what is deeper is undone by displacement alone:
//! no body goes by more than the fastest push-out in a sub-step.

use super::graph::Graph;
use super::law::Law;
use crate::bodies::Bodies;
use crate::rows::Quad;

/// Contacts that are too deep for the sweeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Deep {
    /// In the order of their bodies.
    contacts: Vec<u32>,
    /// What each body of theirs is displaced by: line and displacement. Scratch.
    moves: Vec<(u32, Quad)>,
    /// The least of their gaps, in m.
    least_gap: f64,
}

impl Deep {
    /// Gathers the contacts for the sub-steps until contacts change.
    pub(crate) fn gather(&mut self, graph: &mut Graph, bodies: &Bodies) {
        let mut contacts = core::mem::take(&mut graph.deep);
        contacts.retain(|id| graph.is_deep(*id));
        graph.sort(bodies, &mut contacts);
        self.contacts.clone_from(&contacts);
        graph.deep = contacts;
    }

    pub(crate) const fn least_gap(&self) -> f64 {
        self.least_gap
    }

    /// Displaces the bodies of all deep contacts.
    pub(crate) fn part(&mut self, law: &Law, bodies: &mut Bodies, graph: &mut Graph) {
        self.least_gap = 0.0;
        if self.contacts.is_empty() {
            return;
        }
        let most = law.push_out * law.h;
        self.moves.clear();
        for &id in &self.contacts {
            if !graph.is_deep(id) {
                continue;
            }
            let (block, cold, lane) = graph.lane(id);
            let (at, bt) = (block.a[lane], block.b[lane]);
            let [a, b] = [at, bt].map(|line| &bodies.lines[line as usize]);
            let n = carom_math::vec2(block.nx[lane], block.ny[lane]);
            let opened = block.opened(lane, a, b);
            let gaps = cold.depths[lane];
            let first = gaps[0] + opened[0];
            let gap = if block.points(lane) == 2 {
                first.min(gaps[1] + opened[1])
            } else {
                first
            };
            self.least_gap = self.least_gap.min(gap);
            let push = (-gap).max(0.0).min(most);
            let (ma, mb) = (a.inverse_mass(), b.inverse_mass());
            // Hard rows part what is deep by themselves.
            let soft = !graph.contacts[id as usize].is_hard();
            if soft && push > 0.0 && ma + mb > 0.0 {
                self.moves
                    .push((at, Quad::new(n * (-push * ma / (ma + mb)), 0.0)));
                self.moves
                    .push((bt, Quad::new(n * (push * mb / (ma + mb)), 0.0)));
            }
        }
        // Line by line: a stable sort keeps the order of the contacts.
        self.moves.sort_by_key(|moved| moved.0);
        let mut k = 0;
        while k < self.moves.len() {
            let line = self.moves[k].0;
            let mut sum = carom_math::Vec2::ZERO;
            while k < self.moves.len() && self.moves[k].0 == line {
                sum += self.moves[k].1.v();
                k += 1;
            }
            let length = sum.length();
            let sum = if length > most {
                sum * (most / length)
            } else {
                sum
            };
            bodies.lines[line as usize].displace(sum);
        }
        for &id in &self.contacts {
            if graph.is_deep(id) {
                show(graph, bodies, id);
            }
        }
    }
}

/// Shows the sweeps a contact as deep as it is, but no deeper than they may see it.
fn show(graph: &mut Graph, bodies: &Bodies, id: u32) {
    let contact = &graph.contacts[id as usize];
    let (k, lane) = contact.place();
    let colour = &mut graph.colours[contact.colour as usize];
    let (block, cold) = (&mut colour.blocks[k], &colour.cold[k]);
    let [a, b] = [block.a[lane], block.b[lane]].map(|line| &bodies.lines[line as usize]);
    let opened = block.opened(lane, a, b);
    let shown = [0, 1].map(|i| {
        let gap = cold.depths[lane][i] + opened[i];
        gap.max(cold.deepest[lane]) - opened[i]
    });
    block.s1[lane] = shown[0];
    if block.points(lane) == 2 {
        block.s2[lane] = shown[1];
    }
}
