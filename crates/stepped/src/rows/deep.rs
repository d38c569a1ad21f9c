//! Deep overlaps: what was put into each other, or crushed, parts at a bounded speed and without energy.
//!
//! A row that pushed them apart by an impulse would leave some of it as velocity, the more the more bodies share a place. So
//! the sweeps see no overlap deeper than a part of the smaller piece, and what is deeper is undone by displacement alone:
//! what pushes a body adds up to no more than the fastest push-out in a sub-step, but where some of it balanced what became less.

use carom_math::Vec2;

use super::free::FreePairs;
use super::graph::Graph;
use super::law::Law;
use crate::bodies::Bodies;
use crate::{BodyIx, ContactIx, LineIx};

/// Contacts that are too deep for the sweeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Deep {
    /// In the order of their bodies.
    contacts: Vec<ContactIx>,
    /// What parts them: scratch.
    moves: Vec<Move>,
    /// By line, what would displace a body, in m: zero but while bodies are displaced.
    sums: Vec<Vec2>,
    /// The least of their gaps, in m.
    pub(crate) least_gap: f64,
}

impl Deep {
    /// Displaces the bodies of what is parted; tells of the impulse of each contact. Where those of a body add up to more than `most`
    /// they become less, by one factor for both bodies of a contact, so that their common centre stays.
    fn displace(&mut self, bodies: &mut Bodies, most: f64, mut tell: impl FnMut(ContactIx, f64)) {
        self.sums.resize(bodies.lines.len(), Vec2::ZERO);
        for moved in &self.moves {
            for (line, way) in moved.lines.into_iter().zip(moved.ways(bodies)) {
                self.sums[line.at()] += way;
            }
        }
        for moved in &mut self.moves {
            let part = moved.lines.map(|line| {
                let length = self.sums[line.at()].length();
                if length > most { most / length } else { 1.0 }
            });
            moved.impulse *= part[0].min(part[1]);
            for (line, way) in moved.lines.into_iter().zip(moved.ways(bodies)) {
                bodies.lines[line].displace(way);
            }
            tell(moved.id, moved.impulse);
        }
        for line in self.moves.iter().flat_map(|moved| moved.lines) {
            self.sums[line.at()] = Vec2::ZERO;
        }
    }

    /// Gathers the contacts for the sub-steps until contacts change.
    pub(crate) fn gather(&mut self, graph: &mut Graph, bodies: &Bodies) {
        let mut contacts = core::mem::take(&mut graph.deep);
        contacts.retain(|id| graph.is_deep(*id));
        graph.sort(bodies, &mut contacts);
        self.contacts.clone_from(&contacts);
        graph.deep = contacts;
    }

    /// Slots of the bodies of each of them.
    pub(crate) fn pairs(&self, graph: &Graph) -> impl Iterator<Item = [BodyIx; 2]> {
        let deep = self.contacts.iter().filter(|id| graph.is_deep(**id));
        deep.map(|id| graph.contacts[*id].bodies)
    }

    /// Displaces the bodies of all deep contacts.
    pub(crate) fn part(
        &mut self,
        law: &Law,
        bodies: &mut Bodies,
        graph: &mut Graph,
        free: &mut FreePairs,
    ) {
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
            let [a, b] = [at, bt].map(|line| &bodies.lines[line]);
            let n = block.normal(lane);
            let [first, second] = cold.gaps(block, lane, &bodies.lines);
            let gap = first.min(second);
            self.least_gap = self.least_gap.min(gap);
            // What bears a load is parted slowly, but whole: it comes back.
            let push = if cold.is_unloaded(lane) {
                (cold.shown[lane] - gap).max(0.0)
            } else {
                (-gap).max(0.0).min(most)
            };
            let (ma, mb) = (a.inverse_mass(), b.inverse_mass());
            // Hard rows part what is deep by themselves.
            let soft = !graph.contacts[id].is_hard();
            if soft && push > 0.0 && ma + mb > 0.0 {
                self.moves.push(Move {
                    id,
                    lines: [at, bt],
                    normal: n,
                    impulse: push / (ma + mb),
                });
            }
        }
        self.displace(bodies, most, |id, part| {
            free.add(graph, id, part * law.inverse_h);
        });
        for &id in &self.contacts {
            if graph.is_deep(id) {
                // As deep as it is now.
                let (colour, k, lane) = graph.colour_mut(id);
                let (block, cold) = (&mut colour.blocks[k], &mut colour.cold[k]);
                cold.show((block, lane), &bodies.lines);
            }
        }
    }
}

/// A contact that is parted.
#[derive(Clone, Copy, Debug)]
struct Move {
    id: ContactIx,
    lines: [LineIx; 2],
    normal: Vec2,
    /// Mass times displacement of either body, in kg m.
    impulse: f64,
}

impl Move {
    /// Displacements of both bodies.
    fn ways(&self, bodies: &Bodies) -> [Vec2; 2] {
        let [a, b] = self.lines.map(|line| bodies.lines[line].inverse_mass());
        [
            self.normal * (-self.impulse * a),
            self.normal * (self.impulse * b),
        ]
    }
}
