//! Broad phase: which pieces may touch within the tick.

mod keys;
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

/// The sweep is sorted anew if more than one of so many movers came or got another box.
const FEW: usize = 8;

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
    /// Pieces that woke since the last search, and perhaps sleep again: bodies at rest came near them while they slept.
    woken: Vec<u32>,
    /// Movers that came or got other boxes since the sweep was sorted, and some that are none any more.
    few: Vec<u32>,
    /// Those since the last tick that a caller has not looked at.
    news: Vec<u32>,
    /// Whether something may stand in the box of a piece, by its number: true unless the last search of it found nothing.
    by_standing: Vec<bool>,
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
            arrived: Vec::new(),
            woken: Vec::new(),
            few: Vec::new(),
            news: Vec::new(),
            by_standing: Vec::new(),
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

    /// A mover came, or has a larger box than the sweep knows.
    pub(crate) fn enter(&mut self, piece: u32) {
        self.few.push(piece);
        self.news.push(piece);
        let k = piece as usize;
        if self.by_standing.len() <= k {
            self.by_standing.resize(k + 1, true);
        }
        self.by_standing[k] = true;
    }

    /// Whether something may stand where a piece is until the tick ends, unless it leaves its box.
    pub(crate) fn is_by_standing(&self, piece: u32) -> bool {
        // What arrived since has asked for no piece yet.
        let unasked = !self.arrived.is_empty() || !self.endless.is_empty();
        unasked || self.by_standing[piece as usize]
    }

    /// A piece that stood moves from now on, where it stood.
    pub(crate) fn wake(&mut self, piece: u32) {
        self.leave(piece);
        self.enter(piece);
        self.woken.push(piece);
    }

    /// Whether the sweep had better be sorted anew, once so many more pieces got other boxes.
    const fn is_stale(&self, more: usize) -> bool {
        FEW * (self.few.len() + more) > self.sweep.len()
    }

    /// It stands no more, or never did.
    pub(crate) fn leave(&mut self, piece: u32) {
        if let Some(node) = self.nodes.get_mut(piece as usize).and_then(Option::take) {
            self.standing.remove(node);
        }
        self.endless.retain(|other| *other != piece);
        self.arrived.retain(|other| *other != piece);
    }

    /// Whether some piece stands, or moves again, that no mover has been asked about.
    pub(crate) const fn has_arrivals(&self) -> bool {
        !self.arrived.is_empty() || !self.woken.is_empty()
    }

    /// Pieces that woke since the last search, and perhaps sleep again.
    pub(crate) fn woken(&self) -> &[u32] {
        &self.woken
    }

    /// Finds the pairs of which one piece moved, arrived or woke: at a tick.
    pub(crate) fn find(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        let moved = bodies.moved_count();
        if moved == 0 && !self.has_arrivals() {
            self.found.clear();
        } else if self.is_stale(moved) {
            self.find_all(level, bodies, pieces, tick);
        } else {
            self.find_few(level, bodies, pieces, tick);
        }
        self.news.clear();
    }

    fn find_all(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        self.found.clear();
        self.sort(bodies, pieces);
        let found = &mut self.found;
        self.sweep
            .pairs(level, pieces, tick, |a, b| found.push([a, b]));
        let woken = &self.woken;
        let asks = |piece: u32| asks(bodies, pieces, woken, piece);
        let asked = || {
            let movers = (2..bodies.lines.len()).flat_map(|line| bodies.pieces_of_line(line));
            movers.filter(|piece| asks(*piece))
        };
        for endless in &self.endless {
            found.extend(asked().map(|piece| [piece, *endless]));
        }
        let by_standing = &mut self.by_standing;
        for piece in asked() {
            by_standing[piece as usize] = false;
        }
        // The fewer ask the more: what stands asks all movers of unusual size one by one.
        let few_stand = self.standing.len() * (1 + self.sweep.unusual()) < bodies.moved_count();
        if !few_stand {
            for piece in asked() {
                self.standing.query(pieces.boxes[piece as usize], |other| {
                    by_standing[piece as usize] = true;
                    if may_touch(pieces, [piece, other], tick) {
                        found.push([piece, other]);
                    }
                });
            }
        }
        let mut meet = |piece: u32, are_asked: bool| {
            let bounds = pieces.boxes[piece as usize];
            self.sweep.all_in(pieces, bounds, |other| {
                by_standing[other as usize] = true;
                if asks(other) == are_asked && may_touch(pieces, [other, piece], tick) {
                    found.push([other, piece]);
                }
            });
        };
        if few_stand {
            let standing = self.standing.ids();
            let standing = standing.filter_map(|id| self.standing.data(id));
            standing.for_each(|piece| meet(piece, true));
        }
        self.arrived.iter().for_each(|piece| meet(*piece, false));
        self.arrived.clear();
        self.woken.clear();
    }

    /// Queries are answered by the sweep, though many movers came since it was sorted.
    pub(crate) fn prepare_queries(&mut self, bodies: &Bodies, pieces: &Pieces) {
        if self.is_stale(0) {
            self.sort(bodies, pieces);
        }
        self.news.sort_unstable();
        self.news.dedup();
        self.news
            .retain(|piece| pieces.boxes[*piece as usize].is_valid());
    }

    fn sort(&mut self, bodies: &Bodies, pieces: &Pieces) {
        self.few.clear();
        self.woken.sort_unstable();
        let woken = &self.woken;
        let movers = (2..bodies.lines.len()).flat_map(|line| {
            let moved = bodies.moved[line];
            let pieces = bodies.pieces_of_line(line);
            pieces.map(move |piece| (piece, moved || woken.binary_search(&piece).is_ok()))
        });
        self.sweep.sort(movers, pieces);
    }

    /// Whether a piece is one of those that move, in `bounds`: the sweep may know it as another one, that was there before.
    fn moves_in(&self, pieces: &Pieces, piece: u32, bounds: Aabb) -> bool {
        let its = pieces.boxes[piece as usize];
        let is_endless = !its.is_finite() && self.endless.contains(&piece);
        let stands = self.nodes.get(piece as usize).is_some_and(Option::is_some);
        its.overlaps(bounds) && !stands && !is_endless
    }

    /// Calls `found` with the pieces that stand in `bounds`.
    pub(crate) fn standing_in(&self, bounds: Aabb, mut found: impl FnMut(u32)) {
        self.standing.query(bounds, &mut found);
        self.endless.iter().copied().for_each(found);
    }

    /// Calls `found` with pieces that may be in `bounds`: movers until the end of the tick.
    pub(crate) fn pieces_in(&self, pieces: &Pieces, bounds: Aabb, mut tell: impl FnMut(u32)) {
        self.standing_in(bounds, &mut tell);
        self.movers_in(pieces, bounds, tell);
    }

    /// The same of movers alone.
    pub(crate) fn movers_in(&self, pieces: &Pieces, bounds: Aabb, mut tell: impl FnMut(u32)) {
        let mut tell = |piece: u32| {
            if self.moves_in(pieces, piece, bounds) {
                tell(piece);
            }
        };
        self.sweep.all_in(pieces, bounds, &mut tell);
        // Their boxes are newer than the sweep.
        self.few.iter().copied().for_each(tell);
    }

    /// Movers that came or got other boxes since the last tick, or since [`Self::forget_news`], and these.
    pub(crate) fn news(&self, pieces: &Pieces) -> impl Iterator<Item = (u32, Aabb)> {
        let news = self
            .news
            .iter()
            .map(|piece| (*piece, pieces.boxes[*piece as usize]));
        news.filter(|(piece, bounds)| self.moves_in(pieces, *piece, *bounds))
    }

    pub(crate) fn forget_news(&mut self) {
        self.news.clear();
    }

    /// The same within a tick, of the few that moved since.
    pub(crate) fn find_few(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        for line in (2..bodies.lines.len()).filter(|line| bodies.moved[*line]) {
            for piece in bodies.pieces_of_line(line) {
                self.enter(piece);
            }
        }
        if self.is_stale(0) || !self.arrived.is_empty() {
            return self.find_all(level, bodies, pieces, tick);
        }
        let mut few = core::mem::take(&mut self.few);
        few.retain(|piece| self.moves_in(pieces, *piece, pieces.boxes[*piece as usize]));
        let left = |piece: &u32| pieces.boxes[*piece as usize].min.x;
        few.sort_unstable_by(|a, b| left(a).total_cmp(&left(b)).then(a.cmp(b)));
        few.dedup();
        self.found.clear();
        self.woken.sort_unstable();
        let (found, woken) = (&mut self.found, &self.woken);
        let asks = |piece: u32| asks(bodies, pieces, woken, piece);
        // What the sweep knows may have gone elsewhere.
        let mut note = |piece: u32, other: u32| {
            let [a, b] = [piece, other].map(|piece| pieces.boxes[piece as usize]);
            if a.overlaps(b) && may_touch(pieces, [piece, other], tick) {
                found.push([piece.min(other), piece.max(other)]);
            }
        };
        // The sweep knows where the others' boxes are, and of these where they were: so these are compared as well.
        for &piece in few.iter().filter(|piece| asks(**piece)) {
            let bounds = pieces.boxes[piece as usize];
            self.sweep
                .all_in(pieces, bounds, |other| note(piece, other));
            let mut by_standing = false;
            self.standing.query(bounds, |other| {
                by_standing = true;
                note(piece, other);
            });
            self.by_standing[piece as usize] = by_standing;
            self.endless.iter().for_each(|other| note(piece, *other));
        }
        for (k, &piece) in few.iter().enumerate() {
            let (bounds, moves) = (pieces.boxes[piece as usize], asks(piece));
            for &other in few[k + 1..]
                .iter()
                .take_while(|other| left(other) <= bounds.max.x)
            {
                if moves || asks(other) {
                    note(piece, other);
                }
            }
        }
        self.few = few;
        self.woken.clear();
        // A pair may have been found from both sides, and by both ways.
        self.found.sort_unstable();
        self.found.dedup();
    }
}

/// Whether a mover is asked about: its body moved, or it is one of these that `woken` holds in order.
fn asks(bodies: &Bodies, pieces: &Pieces, woken: &[u32], piece: u32) -> bool {
    let slot = pieces.owners[piece as usize].body;
    bodies.moved[bodies.records[slot as usize].line as usize] || woken.binary_search(&piece).is_ok()
}

/// Pieces of two bodies that may meet within the tick.
fn may_touch(pieces: &Pieces, pair: [u32; 2], tick: f64) -> bool {
    let [a, b] = pair.map(|piece| &pieces.discs[piece as usize]);
    let [of_a, of_b] = pair.map(|piece| pieces.owners[piece as usize].body);
    of_a != of_b && a.may_meet(b, tick)
}
