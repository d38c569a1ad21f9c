//! Broad phase: which pieces may touch within the tick.

mod pairs;
mod sweep;
mod table;

use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;
use fearless_simd::Level;

use crate::bodies::Bodies;
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
    /// What moves and what stands is no more what it was when the sweep was sorted.
    stale: bool,
    /// Pieces that stand since the last tick: movers that rest have not met them.
    arrived: Vec<u32>,
    /// Pieces that got other boxes since the sweep was sorted.
    few: Vec<u32>,
    /// Pairs of pieces with overlapping boxes, one of which moved.
    pub(crate) found: Vec<[u32; 2]>,
}

impl Broad {
    pub(crate) fn new() -> Self {
        Self {
            sweep: Sweep::default(),
            standing: BoxTree::new(),
            nodes: Vec::new(),
            endless: Vec::new(),
            stale: true,
            arrived: Vec::new(),
            few: Vec::new(),
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
        self.stale();
    }

    /// A mover came: the sweep does not know it.
    pub(crate) const fn stale(&mut self) {
        self.stale = true;
    }

    /// A piece has a larger box than the sweep knows.
    pub(crate) fn enlarged(&mut self, piece: u32) {
        if !self.few.contains(&piece) {
            self.few.push(piece);
        }
    }

    /// It stands no more, or never did.
    pub(crate) fn leave(&mut self, piece: u32) {
        if let Some(node) = self.nodes.get_mut(piece as usize).and_then(Option::take) {
            self.standing.remove(node);
        }
        self.endless.retain(|other| *other != piece);
        self.arrived.retain(|other| *other != piece);
        self.stale();
    }

    /// Whether some piece stands that no mover has been asked about.
    pub(crate) const fn has_arrivals(&self) -> bool {
        !self.arrived.is_empty()
    }

    /// Finds the pairs of which one piece moved or arrived.
    pub(crate) fn find(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        self.found.clear();
        let awake = 2..bodies.lines.len();
        if self.arrived.is_empty() && !bodies.moved[2..].contains(&true) {
            return;
        }
        self.sort(bodies, pieces);
        let found = &mut self.found;
        self.sweep
            .pairs(level, pieces, tick, |a, b| found.push([a, b]));
        let moved = |piece: u32| {
            let slot = pieces.list[piece as usize].body;
            bodies.moved[bodies.records[slot as usize].line as usize]
        };
        for at in awake.filter(|at| bodies.moved[*at]) {
            for piece in bodies.pieces_of_line(at) {
                let bounds = pieces.boxes[piece as usize];
                self.standing.query(bounds, |other| {
                    if may_touch(pieces, [piece, other], tick) {
                        found.push([piece, other]);
                    }
                });
                found.extend(self.endless.iter().map(|other| [piece, *other]));
            }
        }
        for &piece in &self.arrived {
            let bounds = pieces.boxes[piece as usize];
            self.sweep.all_in(pieces, bounds, |other| {
                if !moved(other) && may_touch(pieces, [other, piece], tick) {
                    found.push([other, piece]);
                }
            });
        }
        self.arrived.clear();
    }

    /// Queries are answered by the sweep again, if movers came or went since it was sorted.
    pub(crate) fn prepare_queries(&mut self, bodies: &Bodies, pieces: &Pieces) {
        if self.stale {
            self.sort(bodies, pieces);
        }
    }

    fn sort(&mut self, bodies: &Bodies, pieces: &Pieces) {
        self.few.clear();
        let movers = (2..bodies.lines.len()).flat_map(|line| {
            let moved = bodies.moved[line];
            bodies.pieces_of_line(line).map(move |piece| (piece, moved))
        });
        self.sweep.sort(movers, pieces);
        self.stale = false;
    }

    /// Calls `found` with the pieces that stand in `bounds`.
    pub(crate) fn standing_in(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        self.standing.query(bounds, &mut found);
        self.endless.iter().copied().for_each(found);
    }

    /// Calls `found` with pieces that may be in `bounds`: movers until the end of the tick.
    pub(crate) fn pieces_in(
        &self,
        bodies: &Bodies,
        pieces: &Pieces,
        bounds: Aabb,
        mut tell: impl FnMut(u32),
    ) {
        self.standing_in(bounds, &mut tell);
        self.movers_in(bodies, pieces, bounds, tell);
    }

    /// The same of movers alone.
    pub(crate) fn movers_in(
        &self,
        bodies: &Bodies,
        pieces: &Pieces,
        bounds: Aabb,
        mut tell: impl FnMut(u32),
    ) {
        if self.stale {
            // Pieces came or went: the sweep names others.
            for line in 2..bodies.lines.len() {
                bodies
                    .pieces_of_line(line)
                    .filter(|piece| pieces.boxes[*piece as usize].overlaps(bounds))
                    .for_each(&mut tell);
            }
        } else {
            self.sweep.all_in(pieces, bounds, &mut tell);
            // Their boxes are newer than the sweep.
            self.few
                .iter()
                .copied()
                .filter(|piece| pieces.boxes[*piece as usize].overlaps(bounds))
                .for_each(&mut tell);
        }
    }

    /// Finds the pairs of the few that moved since [`Self::find`] in the same tick.
    pub(crate) fn find_few(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        if self.stale || self.has_arrivals() {
            self.find(level, bodies, pieces, tick);
            return;
        }
        self.found.clear();
        let found = &mut self.found;
        let mut few = Vec::new();
        for line in (2..bodies.lines.len()).filter(|line| bodies.moved[*line]) {
            few.extend(bodies.pieces_of_line(line));
        }
        // The sweep knows where the others' boxes are, and of these where they were: so these are compared as well.
        for &piece in &few {
            let bounds = pieces.boxes[piece as usize];
            self.sweep
                .all_in(pieces, bounds, |other| found.push([piece, other]));
            self.standing
                .query(bounds, |other| found.push([piece, other]));
            found.extend(self.endless.iter().map(|other| [piece, *other]));
        }
        let left = |piece: &u32| pieces.boxes[*piece as usize].min.x;
        few.sort_unstable_by(|a, b| left(a).total_cmp(&left(b)).then(a.cmp(b)));
        for (k, piece) in few.iter().enumerate() {
            let bounds = pieces.boxes[*piece as usize];
            for other in few[k + 1..]
                .iter()
                .take_while(|other| left(other) <= bounds.max.x)
            {
                if pieces.boxes[*other as usize].overlaps(bounds) {
                    found.push([*piece, *other]);
                }
            }
        }
        self.few.extend(few);
        // A pair may have been found from both sides, and by both ways.
        for pair in &mut *found {
            pair.sort_unstable();
        }
        found.sort_unstable();
        found.dedup();
        found.retain(|pair| may_touch(pieces, *pair, tick));
    }
}

/// Pieces of two bodies that may meet within the tick.
fn may_touch(pieces: &Pieces, pair: [u32; 2], tick: f64) -> bool {
    let [a, b] = pair.map(|piece| &pieces.discs[piece as usize]);
    let [of_a, of_b] = pair.map(|piece| pieces.owners[piece as usize].body);
    of_a != of_b && a.may_meet(b, tick)
}
