//! A search: fat boxes of what moved, their pairs, and which of these pairs of boxes overlap now.

use super::Broad;
use super::lists::{AMONG, ASKED, BESIDE, KNOWN, LATE, LISTED, NEW, STANDS, is_mover};
use crate::PieceIx;
use crate::bodies::Bodies;
use crate::pieces::Pieces;

/// The sweep is sorted anew if more than one of so many movers came or left its fat box.
const FEW: usize = 8;

/// To ask the sweep for the pairs of a piece takes as long as to read so many pairs off the lists.
const QUERY: usize = 64;

impl Broad {
    /// Whether the sweep had better be sorted anew.
    pub(super) const fn is_stale(&self) -> bool {
        let [movers, standing] = &self.lists.late;
        FEW * (movers.len() + standing.len()) > self.sweep.len()
    }

    /// Finds the pairs of which one piece moved, arrived or woke.
    pub(crate) fn find(&mut self, bodies: &Bodies, pieces: &Pieces, tick: f64, at_tick: bool) {
        self.found.clear();
        self.ask(bodies, pieces);
        if at_tick {
            self.news.clear();
        } else {
            let lists = &self.lists;
            let movers = self.asked.iter().copied();
            self.news
                .extend(movers.filter(|piece| is_mover(lists.states[*piece])));
        }
        if self.is_stale() {
            self.sort(bodies, pieces, tick);
        } else {
            self.add_new(pieces, tick);
        }
        self.read(pieces, tick);
        for piece in self.asked.drain(..) {
            self.lists.states[piece] &= !(ASKED);
        }
        self.arrived.clear();
        self.woken.clear();
    }

    /// Notes which pieces a search is about, and which of them left their fat boxes.
    fn ask(&mut self, bodies: &Bodies, pieces: &Pieces) {
        let Self { lists, asked, .. } = self;
        let mut ask = |piece: PieceIx| {
            let state = lists.states[piece];
            if state & KNOWN != 0 && state & ASKED == 0 {
                lists.states[piece] |= ASKED;
                asked.push(piece);
                if is_mover(state) && !lists.fat[piece].contains(pieces.boxes[piece]) {
                    lists.enter(piece);
                }
            }
        };
        for line in bodies.awake() {
            if bodies.moved[line] {
                bodies.pieces_of_line(line).for_each(&mut ask);
            }
        }
        let others = self.woken.iter().chain(&self.arrived);
        others.copied().for_each(ask);
    }

    /// Finds all pairs of fat boxes anew.
    pub(super) fn sort(&mut self, bodies: &Bodies, pieces: &Pieces, tick: f64) {
        let Self {
            sweep,
            lists,
            standing,
            ..
        } = self;
        let [_, late_standing] = core::mem::take(&mut lists.late);
        for piece in late_standing {
            if lists.states[piece] & STANDS != 0 {
                lists.list(piece);
            }
        }
        lists.new.clear();
        let movers = bodies.awake().flat_map(|line| bodies.pieces_of_line(line));
        for piece in movers.clone() {
            lists.states[piece] &= !(KNOWN | NEW | BESIDE | AMONG);
            if pieces.boxes[piece].is_valid() {
                lists.fatten(piece, pieces, tick);
                lists.list(piece);
            } else {
                lists.enter(piece);
            }
        }
        let mut pairs = core::mem::take(&mut lists.pairs);
        pairs.clear();
        let movers = movers.filter(|piece| lists.states[*piece] & LISTED != 0);
        sweep.sort(movers.clone(), &lists.fat);
        sweep.pairs(|a, b| {
            if pieces.are_of_two(a, b) {
                pairs.push([a, b]);
            }
        });
        for piece in movers {
            let bounds = lists.fat[piece];
            standing.query(bounds, |other| pairs.push([piece, PieceIx(other)]));
        }
        lists.note_partners(&pairs);
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
        new.retain(|piece| lists.states[*piece] & (NEW | STANDS) == NEW);
        if new.is_empty() && arrived.is_empty() {
            return;
        }
        new.sort_unstable();
        new.dedup();
        for &piece in &new {
            lists.fatten(piece, pieces, tick);
        }
        let mut apart = core::mem::take(&mut lists.apart);
        let mut late = core::mem::take(&mut lists.late);
        let lists = &mut self.lists;
        let state = |piece: PieceIx| lists.states[piece];
        let fat = |piece: PieceIx| lists.fat[piece];
        apart.retain(|pair| !pair.iter().any(|piece| state(*piece) & NEW != 0));
        let mut add = |a: PieceIx, b: PieceIx| {
            if pieces.are_of_two(a, b) {
                apart.push([a, b]);
            }
        };
        let listed = |piece: PieceIx| state(piece) & (LISTED | STANDS) == LISTED;
        for &piece in &new {
            sweep.all_in(fat(piece), |other| {
                if listed(other) {
                    add(piece, other);
                }
            });
            standing.query(fat(piece), |other| add(piece, PieceIx(other)));
        }
        let late_movers = &mut late[0];
        late_movers.retain(|piece| state(*piece) & (LATE | STANDS) == LATE);
        let left = |piece: PieceIx| fat(piece).min.x;
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
        let arrived: Vec<PieceIx> = arrived.copied().collect();
        for piece in new.into_iter().chain(arrived) {
            lists.states[piece] &= !NEW;
        }
        lists.note_partners(&apart);
        (lists.apart, lists.late) = (apart, late);
    }

    /// Finds the pairs that a search is about: they are read off the lists, or, of few pieces, asked for in the sweep.
    fn read(&mut self, pieces: &Pieces, tick: f64) {
        let Self {
            sweep,
            standing,
            lists,
            found,
            ..
        } = self;
        let (states, boxes, discs) = (&lists.states, &pieces.boxes, &pieces.discs);
        // What stands is the second.
        let mut note = |[a, b]: [PieceIx; 2]| {
            if boxes[a].overlaps(boxes[b])
                && (states[b] & STANDS == 0 || pieces.is_near(a, b))
                && discs[a].may_meet(&discs[b], tick)
                && !pieces.are_beside(a, b, tick)
            {
                found.push([a, b]);
            }
        };
        let state = |piece: PieceIx| states[piece];
        let is_asked = |pair: [PieceIx; 2], known: u8| {
            let [a, b] = pair.map(state);
            (a | b) & ASKED != 0 && a & known != 0 && b & known != 0
        };
        if QUERY * self.asked.len() < lists.pairs.len() {
            let listed = self.asked.iter().copied();
            for piece in listed.filter(|piece| state(*piece) & LISTED != 0) {
                let bounds = boxes[piece];
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
                        let other = PieceIx(other);
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
            let mut note = |piece: PieceIx| {
                if !pieces.is_beyond_plane(piece, endless, tick) {
                    found.push([piece, endless]);
                }
            };
            let movers = self.asked.iter().copied();
            movers
                .filter(|piece| is_mover(state(*piece)))
                .for_each(&mut note);
            if self.arrived.contains(&endless) {
                let others = (0..).map(PieceIx).zip(states);
                let others = others.filter(|(_, state)| is_mover(**state) && *state & ASKED == 0);
                others.for_each(|(piece, _)| note(piece));
            }
        }
    }
}

#[cfg(test)]
impl Broad {
    /// The slow twin of [`Self::find`]: all pairs, in order.
    pub(crate) fn all_pairs(
        &self,
        bodies: &Bodies,
        pieces: &Pieces,
        tick: f64,
    ) -> Vec<[PieceIx; 2]> {
        let line = |piece: PieceIx| bodies.line_of(pieces.owners[piece].body);
        let asks = |piece: PieceIx| {
            let came = self.woken.contains(&piece) || self.arrived.contains(&piece);
            came || line(piece) > crate::LineIx::GROUND && bodies.moved[line(piece)]
        };
        let movers = bodies.awake().flat_map(|line| bodies.pieces_of_line(line));
        let stands = (0..)
            .map(PieceIx)
            .zip(&self.nodes)
            .filter(|(_, node)| node.is_some());
        let stands = stands.map(|(piece, _)| piece).chain(self.endless.clone());
        let stands: Vec<PieceIx> = stands.collect();
        let mut all = Vec::new();
        for a in movers.clone() {
            let others = movers
                .clone()
                .filter(|b| a < *b && pieces.are_of_two(a, *b));
            for b in others.chain(stands.iter().copied()) {
                let overlap = pieces.boxes[a].overlaps(pieces.boxes[b])
                    && (!stands.contains(&b) || pieces.is_near(a, b));
                let meet = pieces.discs[a].may_meet(&pieces.discs[b], tick);
                let meet = meet && !pieces.are_beside(a, b, tick);
                let near = if self.endless.contains(&b) {
                    !pieces.is_beyond_plane(a, b, tick)
                } else {
                    overlap && meet
                };
                if (asks(a) || asks(b)) && near {
                    all.push([a.min(b), a.max(b)]);
                }
            }
        }
        all.sort_unstable();
        all
    }
}
