//! Broad phase: which pieces may touch within the tick.

mod keys;
mod lists;
mod pairs;
mod sweep;
mod table;

use carom_collision::{BoxTree, NodeId};
use carom_geometry::Aabb;
use fearless_simd::Level;

use crate::bodies::Bodies;
use crate::pieces::Pieces;
use lists::{ASKED, KNOWN, LATE, LISTED, Lists, NEW, STANDS, is_mover};
pub(crate) use pairs::Pairs;
use sweep::Sweep;

/// The sweep is sorted anew if more than one of so many movers came or left its fat box.
const FEW: usize = 8;

/// To ask the sweep for the pairs of a piece takes as long as to read so many pairs off the lists.
const QUERY: usize = 64;

/// Movers in a sweep, what stands in a tree, half-planes in a list.
#[derive(Clone, Debug)]
pub(crate) struct Broad {
    /// Fat boxes of movers.
    sweep: Sweep,
    lists: Lists,
    standing: BoxTree,
    /// Node of each piece that stands.
    nodes: Vec<Option<NodeId>>,
    endless: Vec<u32>,
    /// Pieces that stand since the last tick: movers that rest have not met them.
    arrived: Vec<u32>,
    /// Pieces that woke since the last search, and perhaps sleep again: bodies at rest came near them while they slept.
    woken: Vec<u32>,
    /// Movers that came or got other boxes since the last tick, and that a caller has not looked at.
    news: Vec<u32>,
    /// Whether something may stand in the box of a piece, by its number: true unless the last search of it found nothing.
    by_standing: Vec<bool>,
    /// Pairs of pieces with overlapping boxes, one of which moved.
    pub(crate) found: Vec<[u32; 2]>,
    /// Pieces that a search is about: scratch.
    asked: Vec<u32>,
}

impl Broad {
    pub(crate) fn new() -> Self {
        Self {
            sweep: Sweep::default(),
            lists: Lists::default(),
            standing: BoxTree::new(),
            nodes: Vec::new(),
            endless: Vec::new(),
            arrived: Vec::new(),
            woken: Vec::new(),
            news: Vec::new(),
            by_standing: Vec::new(),
            found: Vec::new(),
            asked: Vec::new(),
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
            self.lists.stand(piece, bounds);
        } else {
            self.lists.leave(piece);
            self.endless.push(piece);
        }
        self.arrived.push(piece);
    }

    /// A mover came, or has a larger box than the sweep knows.
    pub(crate) fn enter(&mut self, piece: u32) {
        self.lists.enter(piece);
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

    /// Whether the sweep had better be sorted anew.
    const fn is_stale(&self) -> bool {
        let [movers, standing] = &self.lists.late;
        FEW * (movers.len() + standing.len()) > self.sweep.len()
    }

    /// It stands no more, or never did.
    pub(crate) fn leave(&mut self, piece: u32) {
        if let Some(node) = self.nodes.get_mut(piece as usize).and_then(Option::take) {
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

    /// Pieces that woke since the last search, and perhaps sleep again.
    pub(crate) fn woken(&self) -> &[u32] {
        &self.woken
    }

    /// Finds the pairs of which one piece moved, arrived or woke.
    pub(crate) fn find(
        &mut self,
        level: Level,
        bodies: &Bodies,
        pieces: &Pieces,
        tick: f64,
        at_tick: bool,
    ) {
        self.found.clear();
        self.ask(bodies, pieces);
        if at_tick {
            self.news.clear();
        } else {
            let lists = &self.lists;
            let movers = self.asked.iter().copied();
            self.news
                .extend(movers.filter(|piece| is_mover(lists.states[*piece as usize])));
        }
        if self.is_stale() {
            self.sort(level, bodies, pieces, tick);
        } else {
            self.add_new(pieces, tick);
        }
        self.read(pieces, tick);
        for piece in self.asked.drain(..) {
            self.lists.states[piece as usize] &= !(ASKED);
        }
        self.arrived.clear();
        self.woken.clear();
    }

    /// Notes which pieces a search is about, and which of them left their fat boxes.
    fn ask(&mut self, bodies: &Bodies, pieces: &Pieces) {
        let Self {
            lists,
            asked,
            by_standing,
            ..
        } = self;
        let mut ask = |piece: u32| {
            let (k, state) = (piece as usize, lists.states[piece as usize]);
            if state & KNOWN != 0 && state & ASKED == 0 {
                lists.states[piece as usize] |= ASKED;
                asked.push(piece);
                if is_mover(state) {
                    by_standing[k] = false;
                    if !lists.fat[k].contains(pieces.boxes[k]) {
                        lists.enter(piece);
                    }
                }
            }
        };
        for line in 2..bodies.lines.len() {
            if bodies.moved[line] {
                bodies.pieces_of_line(line).for_each(&mut ask);
            }
        }
        let others = self.woken.iter().chain(&self.arrived);
        others.copied().for_each(ask);
    }

    /// Finds all pairs of fat boxes anew.
    fn sort(&mut self, level: Level, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        let Self {
            sweep,
            lists,
            standing,
            ..
        } = self;
        let [_, late_standing] = core::mem::take(&mut lists.late);
        for piece in late_standing {
            if lists.states[piece as usize] & STANDS != 0 {
                lists.list(piece);
            }
        }
        lists.new.clear();
        let movers = (2..bodies.lines.len()).flat_map(|line| bodies.pieces_of_line(line));
        for piece in movers.clone() {
            let k = piece as usize;
            lists.states[piece as usize] &= !(KNOWN | NEW);
            if pieces.boxes[k].is_valid() {
                lists.fatten(piece, pieces.boxes[k], pieces.discs[k].velocity, tick);
                lists.list(piece);
            } else {
                lists.enter(piece);
            }
        }
        let mut pairs = core::mem::take(&mut lists.pairs);
        pairs.clear();
        let movers = movers.filter(|piece| lists.states[*piece as usize] & LISTED != 0);
        sweep.sort(movers.clone(), &lists.fat);
        sweep.pairs(level, |a, b| {
            if pieces.are_of_two(a, b) {
                pairs.push([a, b]);
            }
        });
        for piece in movers {
            let bounds = lists.fat[piece as usize];
            standing.query(bounds, |other| pairs.push([piece, other]));
        }
        lists.pairs = pairs;
        lists.apart.clear();
    }

    /// Finds the pairs of new pieces.
    fn add_new(&mut self, pieces: &Pieces, tick: f64) {
        let Self {
            sweep,
            lists,
            standing,
            arrived,
            ..
        } = self;
        let mut new = core::mem::take(&mut lists.new);
        new.retain(|piece| lists.states[*piece as usize] & (NEW | STANDS) == NEW);
        if new.is_empty() && arrived.is_empty() {
            return;
        }
        new.sort_unstable();
        new.dedup();
        for &piece in &new {
            let k = piece as usize;
            lists.fatten(piece, pieces.boxes[k], pieces.discs[k].velocity, tick);
        }
        let mut apart = core::mem::take(&mut lists.apart);
        let mut late = core::mem::take(&mut lists.late);
        let lists = &mut self.lists;
        let state = |piece: u32| lists.states[piece as usize];
        let fat = |piece: u32| lists.fat[piece as usize];
        apart.retain(|pair| !pair.iter().any(|piece| state(*piece) & NEW != 0));
        let mut add = |a: u32, b: u32| {
            if pieces.are_of_two(a, b) {
                apart.push([a, b]);
            }
        };
        let listed = |piece: u32| state(piece) & (LISTED | STANDS) == LISTED;
        for &piece in &new {
            sweep.all_in(fat(piece), |other| {
                if listed(other) {
                    add(piece, other);
                }
            });
            standing.query(fat(piece), |other| add(piece, other));
        }
        let late_movers = &mut late[0];
        late_movers.retain(|piece| state(*piece) & (LATE | STANDS) == LATE);
        let left = |piece: u32| fat(piece).min.x;
        late_movers.sort_unstable_by(|a, b| left(*a).total_cmp(&left(*b)).then(a.cmp(b)));
        late_movers.dedup();
        for (k, &piece) in late_movers.iter().enumerate() {
            let (bounds, is_new) = (fat(piece), state(piece) & NEW != 0);
            let others = late_movers[k + 1..].iter();
            for &other in others.take_while(|other| left(**other) <= bounds.max.x) {
                if (is_new || state(other) & NEW != 0) && fat(other).overlaps(bounds) {
                    add(piece, other);
                }
            }
        }
        let arrived = arrived.iter().filter(|piece| state(**piece) & NEW != 0);
        for &piece in arrived.clone() {
            sweep.all_in(fat(piece), |other| {
                if listed(other) {
                    add(other, piece);
                }
            });
            for &other in late_movers.iter() {
                if state(other) & NEW == 0 && fat(other).overlaps(fat(piece)) {
                    add(other, piece);
                }
            }
        }
        let arrived: Vec<u32> = arrived.copied().collect();
        for piece in new.into_iter().chain(arrived) {
            lists.states[piece as usize] &= !NEW;
        }
        (lists.apart, lists.late) = (apart, late);
    }

    /// Finds the pairs that a search is about: they are read off the lists, or, of few pieces, asked for in the sweep.
    fn read(&mut self, pieces: &Pieces, tick: f64) {
        let Self {
            sweep,
            standing,
            lists,
            found,
            by_standing,
            ..
        } = self;
        let (states, boxes, discs) = (&lists.states[..], &pieces.boxes[..], &pieces.discs[..]);
        // What stands is the second.
        let mut note = |pair: [u32; 2]| {
            let [a, b] = pair.map(|piece| piece as usize);
            if boxes[a].overlaps(boxes[b]) {
                if states[b] & STANDS != 0 {
                    by_standing[a] = true;
                }
                if discs[a].may_meet(&discs[b], tick) {
                    found.push(pair);
                }
            }
        };
        let state = |piece: u32| states[piece as usize];
        let is_asked = |pair: [u32; 2], known: u8| {
            let [a, b] = pair.map(state);
            (a | b) & ASKED != 0 && a & known != 0 && b & known != 0
        };
        if QUERY * self.asked.len() < lists.pairs.len() {
            let listed = self.asked.iter().copied();
            for piece in listed.filter(|piece| state(*piece) & LISTED != 0) {
                let bounds = boxes[piece as usize];
                let moves = is_mover(state(piece));
                sweep.all_in(bounds, |other| {
                    let theirs = state(other);
                    let again = moves && theirs & ASKED != 0 && other < piece;
                    if theirs & (LISTED | STANDS) == LISTED && !again {
                        if !moves {
                            note([other, piece]);
                        } else if pieces.are_of_two(piece, other) {
                            note([piece, other]);
                        }
                    }
                });
                if moves {
                    standing.query(bounds, |other| {
                        if state(other) & (LISTED | ASKED) == LISTED {
                            note([piece, other]);
                        }
                    });
                }
            }
        } else {
            let listed = lists.pairs.iter().copied();
            listed
                .filter(|pair| is_asked(*pair, LISTED))
                .for_each(&mut note);
        }
        let late = lists.apart.iter().copied();
        late.filter(|pair| is_asked(*pair, KNOWN)).for_each(note);
        for &endless in &self.endless {
            let movers = self.asked.iter().copied();
            let movers = movers.filter(|piece| is_mover(lists.states[*piece as usize]));
            found.extend(movers.map(|piece| [piece, endless]));
            if self.arrived.contains(&endless) {
                let others = (0u32..).zip(&lists.states);
                let others = others.filter(|(_, state)| is_mover(**state) && *state & ASKED == 0);
                found.extend(others.map(|(piece, _)| [piece, endless]));
            }
        }
    }

    /// The slow twin of [`Self::find`]: all pairs, in order.
    #[cfg(test)]
    pub(crate) fn all_pairs(&self, bodies: &Bodies, pieces: &Pieces, tick: f64) -> Vec<[u32; 2]> {
        let line = |piece: u32| bodies.line_of(pieces.owners[piece as usize].body);
        let asks = |piece: u32| {
            let came = self.woken.contains(&piece) || self.arrived.contains(&piece);
            came || line(piece) >= 2 && bodies.moved[line(piece)]
        };
        let movers = (2..bodies.lines.len()).flat_map(|line| bodies.pieces_of_line(line));
        let stands = (0u32..).zip(&self.nodes).filter(|(_, node)| node.is_some());
        let stands = stands.map(|(piece, _)| piece).chain(self.endless.clone());
        let stands: Vec<u32> = stands.collect();
        let mut all = Vec::new();
        for a in movers.clone() {
            let others = movers
                .clone()
                .filter(|b| a < *b && pieces.are_of_two(a, *b));
            for b in others.chain(stands.iter().copied()) {
                let [of_a, of_b] = [a, b].map(|piece| piece as usize);
                let overlap = pieces.boxes[of_a].overlaps(pieces.boxes[of_b]);
                let meet = pieces.discs[of_a].may_meet(&pieces.discs[of_b], tick);
                if (asks(a) || asks(b)) && (self.endless.contains(&b) || overlap && meet) {
                    all.push([a.min(b), a.max(b)]);
                }
            }
        }
        all.sort_unstable();
        all
    }

    /// Queries are answered by the sweep, though many movers came since it was sorted.
    pub(crate) fn prepare_queries(
        &mut self,
        level: Level,
        bodies: &Bodies,
        pieces: &Pieces,
        tick: f64,
    ) {
        if self.is_stale() {
            self.sort(level, bodies, pieces, tick);
        }
        self.news.sort_unstable();
        self.news.dedup();
        self.news
            .retain(|piece| pieces.boxes[*piece as usize].is_valid());
    }

    /// Whether a piece is one of those that move, in `bounds`: the sweep may know it as another one, that was there before.
    fn moves_in(&self, pieces: &Pieces, piece: u32, bounds: Aabb) -> bool {
        // Most are elsewhere.
        let its = pieces.boxes[piece as usize];
        its.overlaps(bounds)
            && self.nodes.get(piece as usize).is_none_or(Option::is_none)
            && (its.is_finite() || !self.endless.contains(&piece))
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
        self.sweep.all_in(bounds, &mut tell);
        // Their boxes are newer than the sweep.
        self.lists.late[0].iter().copied().for_each(tell);
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
}
