//! Broad phase: which pieces may touch within the tick.

mod pairs;
mod sweep;

use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;

use crate::bodies::{Bodies, BodyKind};
use crate::pieces::Pieces;
pub(crate) use pairs::Pairs;
use sweep::Sweep;

/// Movers in a sweep, what stands in a tree, half-planes in a list.
#[derive(Clone, Debug)]
pub(crate) struct Broad {
    sweep: Sweep,
    standing: BoxTree,
    /// Node of each piece that stands.
    nodes: Vec<Option<NodeId>>,
    endless: Vec<u32>,
    /// Pieces that stand since the last tick: movers that rest have not met them.
    arrived: Vec<u32>,
    /// Pairs of pieces whose boxes overlap, one of which moved.
    pub(crate) found: Vec<[u32; 2]>,
}

impl Broad {
    pub(crate) fn new() -> Self {
        Self {
            sweep: Sweep::default(),
            standing: BoxTree::new(),
            nodes: Vec::new(),
            endless: Vec::new(),
            arrived: Vec::new(),
            found: Vec::new(),
        }
    }

    /// Makes a piece one of those that stand, in `bounds`.
    pub(crate) fn stand(&mut self, piece: u32, bounds: Aabb) {
        if bounds.is_finite() {
            let k = piece as usize;
            if self.nodes.len() <= k {
                self.nodes.resize(k + 1, None);
            }
            self.nodes[k] = Some(self.standing.insert(bounds, piece));
        } else {
            self.endless.push(piece);
        }
        self.arrived.push(piece);
    }

    /// It stands no more, or never did.
    pub(crate) fn leave(&mut self, piece: u32) {
        if let Some(node) = self.nodes.get_mut(piece as usize).and_then(Option::take) {
            self.standing.remove(node);
        }
        self.endless.retain(|other| *other != piece);
        self.arrived.retain(|other| *other != piece);
    }

    /// Finds the pairs of which one piece moved or arrived.
    pub(crate) fn find(&mut self, bodies: &Bodies, pieces: &Pieces) {
        self.found.clear();
        let awake = 2..bodies.lines.len();
        if self.arrived.is_empty() && !bodies.moved[2..].contains(&true) {
            return;
        }
        let of_line = |line: usize| {
            let record = &bodies.records[bodies.slot_of[line] as usize];
            record.first_piece..record.first_piece + record.pieces
        };
        self.sweep
            .sort(awake.clone().flat_map(of_line), &pieces.boxes);
        let line = |piece: u32| {
            let slot = pieces.list[piece as usize].body;
            bodies.records[slot as usize].line as usize
        };
        let moved = |piece: u32| bodies.moved[line(piece)];
        let found = &mut self.found;
        self.sweep
            .pairs(&pieces.boxes, moved, |a, b| found.push([a, b]));
        for at in awake.filter(|at| bodies.moved[*at]) {
            for piece in of_line(at) {
                let bounds = pieces.boxes[piece as usize];
                self.standing
                    .query(bounds, |other| found.push([piece, other]));
                found.extend(self.endless.iter().map(|other| [piece, *other]));
            }
        }
        for &piece in &self.arrived {
            let bounds = pieces.boxes[piece as usize];
            self.sweep.all_in(&pieces.boxes, bounds, |other| {
                if !moved(other) {
                    found.push([other, piece]);
                }
            });
        }
        self.arrived.clear();
        self.found.retain(|pair| may_touch(bodies, pieces, *pair));
    }
}

/// Pieces of two bodies of which contacts move at least one.
fn may_touch(bodies: &Bodies, pieces: &Pieces, pair: [u32; 2]) -> bool {
    let [a, b] = pair.map(|piece| pieces.list[piece as usize].body);
    let dynamic = |slot: u32| bodies.records[slot as usize].kind == BodyKind::Dynamic;
    a != b && (dynamic(a) || dynamic(b))
}
