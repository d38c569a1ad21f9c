//! Pairs that outlast a tick: fat boxes, and which of them overlap.
//!
//! A mover has a fat box around its box, and around the boxes that it is expected to have in the next ticks. While all boxes stay
//! within the fat ones, the pairs of boxes that overlap are among those of fat ones: these are found once, and read in each
//! search. A piece that leaves its fat box, or came since, is *late*: it gets a new one, and its pairs lie apart until all are
//! found anew.

use crate::PieceIx;
use carom_geometry::Aabb;
use carom_math::Vec2;

use crate::pieces::Pieces;
/// A fat box holds the way of so many more ticks, as far as that is no longer than the box. 2: 1.02 of the instructions of a drum,
/// 5: 1.05.
const AHEAD: f64 = 3.0;

/// It is larger on all sides by this part of the lesser side of the box. 0.1: 1.015 of the instructions of a drum, 0.3: 1.04.
pub(super) const ROOM: f64 = 0.2;

// What is known of a piece; 0: it is nowhere.

/// Its pairs are in the lists.
pub(super) const LISTED: u8 = 1;
/// Its pairs lie apart.
pub(super) const LATE: u8 = 2;
/// One of both.
pub(super) const KNOWN: u8 = LISTED | LATE;
pub(super) const STANDS: u8 = 4;
/// The search is about it.
pub(super) const ASKED: u8 = 8;
/// Its pairs are not known yet.
pub(super) const NEW: u8 = 16;
/// A mover with a fat box that what stands overlapped since it has it.
pub(super) const BESIDE: u8 = 32;
/// The same of other movers' fat boxes.
pub(super) const AMONG: u8 = 64;

pub(super) const fn is_mover(state: u8) -> bool {
    state & KNOWN != 0 && state & STANDS == 0
}

/// By number of piece.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    pub(super) states: Vec<u8>,
    pub(super) fat: Vec<Aabb>,
    /// Pairs of listed pieces, as far as they still are.
    pub(super) pairs: Vec<[PieceIx; 2]>,
    /// Pairs of late pieces.
    pub(super) apart: Vec<[PieceIx; 2]>,
    /// Late movers and late pieces that stand, and some that are neither any more.
    pub(super) late: [Vec<PieceIx>; 2],
    /// New movers, likewise.
    pub(super) new: Vec<PieceIx>,
}

impl Lists {
    /// A mover that came, or left its fat box.
    pub(super) fn enter(&mut self, piece: PieceIx) {
        let was = self.cover(piece);
        if !is_mover(was) || was & LATE == 0 {
            self.late[0].push(piece);
        }
        if !is_mover(was) || was & NEW == 0 {
            self.new.push(piece);
        }
        self.states[piece] = was & ASKED | LATE | NEW;
        self.fat[piece] = Aabb::EMPTY;
    }

    /// It stands in this box from now on.
    pub(super) fn stand(&mut self, piece: PieceIx, bounds: Aabb) {
        self.cover(piece);
        self.late[1].push(piece);
        self.states[piece] = LATE | STANDS | NEW;
        self.fat[piece] = bounds;
    }

    pub(super) fn leave(&mut self, piece: PieceIx) {
        self.cover(piece);
        self.states[piece] = 0;
    }

    /// There is such a piece, and how it was.
    fn cover(&mut self, piece: PieceIx) -> u8 {
        let k = piece.at();
        if self.states.len() <= k {
            self.states.resize(k + 1, 0);
            self.fat.resize(k + 1, Aabb::EMPTY);
        }
        self.states[k]
    }

    /// Makes the fat box of a mover, which keeps its velocity for a while, around its box.
    pub(super) fn fatten(&mut self, piece: PieceIx, pieces: &Pieces, tick: f64) {
        let bounds = pieces.boxes[piece];
        let size = bounds.extents();
        let ahead = (pieces.discs[piece].velocity * (AHEAD * tick)).clamp(-size, size);
        let room = Vec2::splat(ROOM * size.min_element());
        self.fat[piece] = Aabb::new(
            bounds.min + ahead.min(Vec2::ZERO) - room,
            bounds.max + ahead.max(Vec2::ZERO) + room,
        );
    }

    /// Notes which pieces have pairs. What stands is the second of its pairs.
    pub(super) fn note_partners(&mut self, pairs: &[[PieceIx; 2]]) {
        let states = &mut self.states;
        for [a, b] in pairs {
            if states[*b] & STANDS != 0 {
                states[*a] |= BESIDE;
            } else {
                states[*a] |= AMONG;
                states[*b] |= AMONG;
            }
        }
    }

    /// The pairs of a piece will be in the lists.
    pub(super) fn list(&mut self, piece: PieceIx) {
        let state = &mut self.states[piece];
        *state = *state & !(LATE | NEW) | LISTED;
    }
}
