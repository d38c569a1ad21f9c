//! The search for the first touches of fast bodies.

use std::collections::BinaryHeap;

use carom_collision::{Impact, Motion, TimeOfImpact, shape_distance, time_of_impact};
use carom_math::{SimTime, Vec2};

use super::cores::{depth, parts};
use super::touching::Touching;
use super::{Fast, FastBody, Moving, SHORT};
use crate::bodies::number;
use crate::narrow::arc;
use crate::{BodyIx, Engine, LineIx, PairRules, PieceIx, Settings};

impl Engine {
    /// Enters the first touches of fast body `k` with others from `span.0` to `span.1` seconds on.
    pub(super) fn search(
        &self,
        fast: &mut Fast,
        k: usize,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let [standing, movers] = fast.sought[k];
        if !(standing || movers) && fast.leaving.is_empty() {
            return;
        }
        let bounds = fast.bounds(self, k, span.1);
        let mut others: Vec<PieceIx> = Vec::new();
        if standing {
            self.broad.standing_in(bounds, |piece| others.push(piece));
        }
        if movers {
            let found = |piece: PieceIx| others.push(piece);
            self.broad.movers_in(&self.pieces, bounds, found);
        }
        for &other in &fast.leaving {
            let record = &self.bodies.records[fast.noted[other].slot];
            if fast.bounds(self, other, span.1).overlaps(bounds) {
                others.extend(record.pieces());
            }
        }
        self.first_parts(&mut others);
        let birth = self.bodies.records[fast.noted[k].slot].birth;
        for piece in others {
            let slot = self.pieces.list[piece].body;
            let partner = fast.find(slot);
            // A pair of which both search among moving bodies is searched once.
            let earlier = self.bodies.records[slot].birth < birth;
            let again = partner.is_some_and(|other| earlier && fast.sought[other][1]);
            if slot != fast.noted[k].slot && !again {
                self.search_piece(fast, (k, partner), piece, span, rules, touches);
            }
        }
    }

    /// Whether a fast body is searched for among bodies that stand, and among moving ones: those that rows do not know of.
    pub(super) fn sought(&self, noted: &FastBody, leaves: bool) -> [bool; 2] {
        if noted.deviates || leaves {
            return [true, noted.is_unforeseen()];
        }
        let Settings { margin, tick, .. } = self.settings;
        let pieces = self.bodies.records[noted.slot].pieces();
        let beside = pieces.map(|piece| self.broad.beside(&self.pieces, piece, (margin, tick)));
        let [standing, movers] = beside.fold([false; 2], |[a, b], [c, d]| [a | c, b | d]);
        [standing, movers && noted.turns]
    }

    /// What [`Self::sought`] leaves out: how many of all others, one by one, and how many touches with them.
    #[cfg(test)]
    pub(crate) fn left_out(&self, rules: &dyn PairRules) -> [usize; 2] {
        let left = self.law.h;
        let mut fast = self.fast_of(self.fast_bodies.clone(), left);
        let (mut count, mut touches) = (0, BinaryHeap::new());
        for k in 0..fast.noted.len() {
            let [standing, movers] = fast.sought[k];
            let moves = fast.noted[k].is_unforeseen() && !movers;
            for piece in PieceIx(0).run(number(self.pieces.list.len())) {
                let other = &self.pieces.list[piece];
                let line = self.bodies.records[other.body].line;
                let stands = [LineIx::GROUND, LineIx::NONE].contains(&line);
                let is_left_out = if stands { !standing } else { moves };
                if self.pieces.boxes[piece].is_valid()
                    && other.part == 0
                    && other.body != fast.noted[k].slot
                    && is_left_out
                {
                    let partner = fast.find(other.body);
                    count += 1;
                    self.search_piece(
                        &mut fast,
                        (k, partner),
                        piece,
                        (0.0, left),
                        rules,
                        &mut touches,
                    );
                }
            }
        }
        [count, touches.len()]
    }

    /// The same of a body that goes on after a touch, with bodies that are not fast.
    pub(super) fn search_on(
        &self,
        fast: &mut Fast,
        k: usize,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let bounds = fast.bounds(self, k, span.1);
        let mut others: Vec<PieceIx> = Vec::new();
        let found = |piece: PieceIx| others.push(piece);
        self.broad.pieces_in(&self.pieces, bounds, found);
        self.first_parts(&mut others);
        for piece in others {
            let slot = self.pieces.list[piece].body;
            if fast.find(slot).is_none() {
                self.search_piece(fast, (k, None), piece, span, rules, touches);
            }
        }
    }

    /// The same of all fast bodies that still move with one that goes elsewhere, or stopped.
    pub(super) fn search_changed(
        &self,
        fast: &mut Fast,
        changed: usize,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let record = &self.bodies.records[fast.noted[changed].slot];
        let bounds = fast.bounds(self, changed, span.1);
        let mut others = fast.unboxed.clone();
        self.broad.pieces_in(&self.pieces, bounds, |piece| {
            others.extend(fast.find(self.pieces.list[piece].body));
        });
        others.sort_unstable();
        others.dedup();
        for k in others {
            if k == changed || fast.is_stopped(k) || !fast.bounds(self, k, span.1).overlaps(bounds)
            {
                continue;
            }
            let mut pieces: Vec<PieceIx> = record.pieces().collect();
            self.first_parts(&mut pieces);
            for piece in pieces {
                self.search_piece(fast, (k, Some(changed)), piece, span, rules, touches);
            }
        }
    }

    /// A shape is searched whole, from its first part on.
    fn first_parts(&self, pieces: &mut Vec<PieceIx>) {
        for piece in &mut *pieces {
            piece.0 -= number(self.pieces.list[*piece].part);
        }
        pieces.sort_unstable();
        pieces.dedup();
    }

    /// Enters the first touch of fast body `k` with a piece of another one, fast or not.
    fn search_piece(
        &self,
        fast: &mut Fast,
        (k, partner): (usize, Option<usize>),
        piece: PieceIx,
        span: (f64, f64),
        rules: &dyn PairRules,
        touches: &mut BinaryHeap<Touching>,
    ) {
        let body = *fast.of(self, k);
        let theirs = &self.pieces.list[piece];
        let motion = match partner {
            Some(other) => fast.of(self, other).motion,
            None => self.motion(theirs.body, None, span.1),
        };
        // Rows hold bodies that move little against each other, however fast both are, but not what a caller moves.
        let left = span.1 - span.0;
        let [limit, other] =
            [body.slot, theirs.body].map(|slot| &self.bodies.limits[self.bodies.line_of(slot)]);
        let against = (body.motion.velocity - motion.velocity) * left;
        let turns = (body.motion.spin * left, motion.spin * left);
        let moves_far =
            limit.is_far(against.length_squared(), turns.0) || other.is_far(0.0, turns.1);
        if !moves_far && !body.carried {
            return;
        }
        if let Some((wait, normal)) = self.first_touch(&body, (piece, &motion), span, rules) {
            let birth = self.bodies.records[theirs.body].birth;
            let moves = partner.filter(|other| !fast.is_stopped(*other));
            // Which it has a row with, if perhaps none that holds it.
            let mut neighbours = self.graph.neighbours(&self.bodies, body.slot);
            touches.push(Touching {
                wait,
                order: (body.birth, birth << 16 | u64::from(theirs.ordinal)),
                a: k,
                b: moves,
                other: theirs.body,
                touches: [body.touches, partner.map_or(0, |other| fast.touches(other))],
                normal: normal.filter(|_| neighbours.any(|other| other == theirs.body)),
                against: body.motion.velocity - motion.velocity,
            });
        }
    }

    /// When a body first touches the shape of a piece, in s, and the unit normal from it, if its core meets it.
    fn first_touch(
        &self,
        body: &Moving,
        (piece, motion): (PieceIx, &Motion),
        (from, to): (f64, f64),
        rules: &dyn PairRules,
    ) -> Option<(f64, Option<Vec2>)> {
        let mine = &self.bodies.records[body.slot];
        let start = SimTime::ZERO + from;
        let (own, other) = (body.motion.rebased(start), motion.rebased(start));
        let target = self.pieces.list[piece].shape();
        let between = own.pose_at(start).inverse() * other.pose_at(start);
        // By no more than this do they come nearer.
        let reach = self.bodies.records[self.pieces.list[piece].body].reach;
        let turns = arc(own.spin, mine.reach) + arc(other.spin, reach);
        let nearing = ((own.velocity - other.velocity).length() + turns) * (to - from);
        let mut first: Option<(f64, Option<Vec2>)> = None;
        for number in mine.pieces() {
            let piece_of_mine = &self.pieces.list[number];
            if piece_of_mine.part != 0
                || self.is_held([number, piece], body.slot)
                || self.pieces.surface([number, piece], rules).is_none()
            {
                continue;
            }
            let shape = piece_of_mine.shape();
            // Most keep apart: cores, which lie within, are made where they do not.
            let gap = shape_distance(shape, target, between).distance;
            let is_clear =
                || time_of_impact(shape, &own, target, &other, to - from) == TimeOfImpact::Clear;
            if gap > nearing || gap > 0.0 && is_clear() {
                continue;
            }
            for part in parts(piece_of_mine) {
                let core = part.core(target, between);
                let left = first.map_or(to, |first| first.0) - from;
                let deep = depth(piece_of_mine, body.carried);
                let drives = |hit: &Impact| -hit.gap_rate * (to - from) > deep;
                let met = match time_of_impact(&core, &own, target, &other, left) {
                    TimeOfImpact::Hit(hit) => (hit.time, Some(hit.normal)),
                    TimeOfImpact::Unresolved { safe_until } => (safe_until, None),
                    TimeOfImpact::Touching(hit) if drives(&hit) => (0.0, Some(hit.normal)),
                    // In touch from the start: its rows hold it.
                    TimeOfImpact::Clear | TimeOfImpact::Touching(_) => continue,
                };
                let (wait, normal) =
                    match time_of_impact(&part.whole(), &own, target, &other, met.0) {
                        TimeOfImpact::Hit(hit) => {
                            let wait = hit.time + SHORT * mine.reach / hit.gap_rate;
                            (wait.max(0.0), Some(hit.normal))
                        }
                        TimeOfImpact::Touching(hit) if drives(&hit) => (0.0, Some(hit.normal)),
                        _ => met,
                    };
                first = Some((from + wait, normal));
            }
        }
        first
    }

    /// Whether a row of two pieces is there that a body on its way cannot turn out of.
    fn is_held(&self, pair: [PieceIx; 2], slot: BodyIx) -> bool {
        let at = self.bodies.line_of(slot);
        let turn = self.bodies.lines[at].w() * self.law.h;
        // One sweep may leave much of a blow: what stands is sought whether there is a row or not.
        let stands = self.bodies.records[self.pieces.list[pair[1]].body].line == LineIx::GROUND;
        !stands && self.known.contains(pair) && !self.bodies.limits[at].is_far(0.0, turn)
    }
}
