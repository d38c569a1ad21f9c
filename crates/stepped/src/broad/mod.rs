//! Broad phase: which pieces may touch within the tick.

mod find;
mod lists;
mod pairs;
mod sweep;

use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;

use crate::PieceIx;
use crate::bodies::Bodies;
use crate::pieces::Pieces;
use lists::{AMONG, BESIDE, Lists, NEW, ROOM, is_mover};
pub(crate) use pairs::Pairs;
use sweep::Sweep;

/// Movers in a sweep, what stands in a tree, half-planes in a list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Broad {
    /// Fat boxes of movers.
    sweep: Sweep,
    lists: Lists,
    standing: BoxTree,
    /// Node of each piece that stands.
    nodes: Vec<Option<NodeId>>,
    endless: Vec<PieceIx>,
    /// Pieces that stand since the last tick: movers that rest have not met them.
    arrived: Vec<PieceIx>,
    /// Pieces that woke since the last search, and perhaps sleep again: bodies at rest came near them while they slept.
    pub(crate) woken: Vec<PieceIx>,
    /// Movers that came or got other boxes since the last tick, and that a caller has not looked at.
    pub(crate) news: Vec<PieceIx>,
    /// Pairs of pieces with overlapping boxes, one of which moved.
    pub(crate) found: Vec<[PieceIx; 2]>,
    /// Pieces that a search is about: scratch.
    asked: Vec<PieceIx>,
}

impl Broad {
    /// Makes a piece one of those that stand, in `bounds`.
    pub(crate) fn stand(&mut self, piece: PieceIx, bounds: Aabb) {
        if bounds.is_finite() {
            let k = piece.at();
            if self.nodes.len() <= k {
                self.nodes.resize(k + 1, None);
            }
            self.nodes[k] = Some(self.standing.insert(bounds, piece.0));
            self.lists.stand(piece, bounds);
        } else {
            self.lists.leave(piece);
            self.endless.push(piece);
        }
        self.arrived.push(piece);
    }

    /// A mover came, or has a larger box than the sweep knows.
    pub(crate) fn enter(&mut self, piece: PieceIx) {
        self.lists.enter(piece);
        self.news.push(piece);
    }

    /// A piece that stood moves from now on, where it stood.
    pub(crate) fn wake(&mut self, piece: PieceIx) {
        self.leave(piece);
        self.enter(piece);
        self.woken.push(piece);
    }

    /// It stands no more, or never did.
    pub(crate) fn leave(&mut self, piece: PieceIx) {
        if let Some(node) = self.nodes.get_mut(piece.at()).and_then(Option::take) {
            self.standing.remove(node);
        }
        self.lists.leave(piece);
        self.endless.retain(|other| *other != piece);
        self.arrived.retain(|other| *other != piece);
    }

    /// Whether some piece stands, or moves again, that no mover has been asked about.
    pub(crate) const fn has_arrivals(&self) -> bool {
        !self.arrived.is_empty() || !self.woken.is_empty()
    }

    /// Queries are answered by the sweep, though many movers came since it was sorted.
    pub(crate) fn prepare_queries(&mut self, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        if self.is_stale() {
            self.sort(bodies, pieces, tick);
        }
        self.news.sort_unstable();
        self.news.dedup();
        self.news.retain(|piece| pieces.boxes[*piece].is_valid());
    }

    /// Whether a piece is one of those that move, in `bounds`: the sweep may know it as another one, that was there before.
    fn moves_in(&self, pieces: &Pieces, piece: PieceIx, bounds: Aabb) -> bool {
        // Most are elsewhere.
        let its = pieces.boxes[piece];
        // What was removed has the empty box, which overlaps one without end.
        its.overlaps(bounds)
            && its.is_valid()
            && self.nodes.get(piece.at()).is_none_or(Option::is_none)
            && (its.is_finite() || !self.endless.contains(&piece))
    }

    /// Calls `found` with the pieces that stand in `bounds`.
    pub(crate) fn standing_in(&self, bounds: Aabb, mut found: impl FnMut(PieceIx)) {
        self.standing.query(bounds, |piece| found(PieceIx(piece)));
        self.endless.iter().copied().for_each(found);
    }

    /// What may be where a mover goes within the tick, if it goes as was foreseen, give or take two margins: what stands, and other
    /// movers that do.
    pub(crate) fn beside(
        &self,
        pieces: &Pieces,
        piece: PieceIx,
        (margin, tick): (f64, f64),
    ) -> [bool; 2] {
        let state = self.lists.states[piece];
        // Boxes hold half a margin, fat ones more.
        let is_known = is_mover(state) && state & NEW == 0 && 1.5 * margin <= ROOM;
        if !is_known || self.has_arrivals() || !self.lists.new.is_empty() {
            return [true; 2];
        }
        let is_beyond = |plane: &PieceIx| pieces.is_beyond_plane(piece, *plane, tick);
        let stand = state & BESIDE != 0 || !self.endless.iter().all(is_beyond);
        [stand, state & AMONG != 0]
    }

    /// Calls `found` with pieces that may be in `bounds`: movers until the end of the tick.
    pub(crate) fn pieces_in(&self, pieces: &Pieces, bounds: Aabb, mut tell: impl FnMut(PieceIx)) {
        self.standing_in(bounds, &mut tell);
        self.movers_in(pieces, bounds, tell);
    }

    /// The same of movers alone.
    pub(crate) fn movers_in(&self, pieces: &Pieces, bounds: Aabb, mut tell: impl FnMut(PieceIx)) {
        let mut tell = |piece: PieceIx| {
            if self.moves_in(pieces, piece, bounds) {
                tell(piece);
            }
        };
        self.sweep.all_in(bounds, &mut tell);
        // Their boxes are newer than the sweep.
        self.lists.late[0].iter().copied().for_each(tell);
    }

    /// All movers, and their boxes.
    pub(crate) fn movers(
        &self,
        bodies: &Bodies,
        pieces: &Pieces,
    ) -> impl Iterator<Item = (PieceIx, Aabb)> {
        let lines = bodies.awake();
        self.with_boxes(pieces, lines.flat_map(|line| bodies.pieces_of_line(line)))
    }

    /// Movers that came or got other boxes since the last tick, or since a caller looked at them, and these.
    pub(crate) fn news(&self, pieces: &Pieces) -> impl Iterator<Item = (PieceIx, Aabb)> {
        self.with_boxes(pieces, self.news.iter().copied())
    }

    /// Those that move, and their boxes.
    fn with_boxes(
        &self,
        pieces: &Pieces,
        some: impl Iterator<Item = PieceIx>,
    ) -> impl Iterator<Item = (PieceIx, Aabb)> {
        some.map(|piece| (piece, pieces.boxes[piece]))
            .filter(|(piece, bounds)| self.moves_in(pieces, *piece, *bounds))
    }
}
