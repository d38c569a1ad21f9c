//! Eight pairs, and their manifolds in columns.

use carom_math::Vec2;

use super::Manifold;
use crate::outline::Outline;
use crate::pieces::Pieces;
use crate::rows::{Block, LANES};
use crate::{LineIx, PieceIx};

/// Which pairs: pieces that have outlines, and the lines of their bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight<'a> {
    pub(super) outlines: [[&'a Outline; LANES]; 2],
    pub(crate) lines: [[LineIx; LANES]; 2],
    /// What the margin is at least, in m.
    pub(crate) least: [f64; LANES],
    /// Faces that separate them against it are none, if it is there: a normal from A to B.
    pub(crate) side: Option<Vec2>,
    /// A bit for each lane that has a pair.
    pub(crate) used: u8,
    /// All outlines are boxes.
    pub(super) boxes: bool,
    /// No outline has more than four corners.
    pub(super) four: bool,
    /// Some outline has a cut.
    pub(super) cuts: bool,
}

impl<'a> Eight<'a> {
    /// No pairs: the first piece against itself.
    pub(crate) fn new(pieces: &'a Pieces, lines: [[LineIx; LANES]; 2]) -> Self {
        Self {
            outlines: [[&pieces.outlines[0]; LANES]; 2],
            lines,
            least: [0.0; LANES],
            side: None,
            used: 0,
            boxes: true,
            four: true,
            cuts: false,
        }
    }

    /// Puts two pieces into a lane, if both have outlines.
    pub(crate) fn set(&mut self, pieces: &'a Pieces, lane: usize, pair: [PieceIx; 2]) -> bool {
        let [a, b] = pair.map(|piece| pieces.outline(piece));
        let all = a.count().min(b.count()) > 0.0;
        if all {
            (self.outlines[0][lane], self.outlines[1][lane]) = (a, b);
            self.used |= 1 << lane;
            // Boxes have four corners and no cuts.
            if !(a.is_box() && b.is_box()) {
                self.boxes = false;
                self.four &= a.count().max(b.count()) <= 4.0;
                self.cuts |= a.has_cuts() || b.has_cuts();
            }
        }
        all
    }
}

/// Manifolds of eight pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// Without bodies, impulses and friction.
    pub(crate) rows: Block,
    /// A bit for each pair that is near.
    pub(crate) near: u8,
    /// A bit for each of these that is so short that it may be a ghost, and for each with a side that slants away from a face.
    pub(crate) short: u8,
    pub(crate) slants: u8,
    /// A bit for each of these between pieces that may be flush.
    pub(crate) seam: u8,
    /// A bit for each of these that lies on a face of A, and of B: corner on corner has none, nor has what was found otherwise.
    pub(crate) of_a: u8,
    pub(crate) of_b: u8,
}

impl Found {
    pub(crate) const NONE: Self = Self {
        rows: Block::EMPTY,
        near: 0,
        short: 0,
        slants: 0,
        seam: 0,
        of_a: 0,
        of_b: 0,
    };

    /// Puts a manifold that was found otherwise into a lane.
    pub(crate) fn set(&mut self, lane: usize, manifold: &Manifold) {
        self.rows.put(lane, manifold);
        let bit = 1 << lane;
        self.near |= bit;
        self.short |= bit;
        self.seam |= bit;
        self.of_a &= !bit;
        self.of_b &= !bit;
    }

    /// Copies a lane of another one, into one that has no manifold yet.
    pub(crate) fn copy_lane(&mut self, to: usize, other: &Self, from: usize) {
        self.rows.copy_lane(to, &other.rows, from);
        let bit = |bits: u8| (bits >> from & 1) << to;
        self.near |= bit(other.near);
        self.short |= bit(other.short);
        self.slants |= bit(other.slants);
        self.seam |= bit(other.seam);
        self.of_a |= bit(other.of_a);
        self.of_b |= bit(other.of_b);
    }

    /// The gap of a pair with B gone so far from A since the base poses, in m.
    pub(crate) fn gap(&self, lane: usize, gone: Vec2) -> f64 {
        let rows = &self.rows;
        rows.s1[lane].min(rows.s2[lane]) + rows.normal(lane).dot(gone)
    }

    pub(crate) fn manifold(&self, lane: usize) -> Manifold {
        let rows = &self.rows;
        let two = rows.points(lane) == 2;
        let second = if two { rows.s2[lane] } else { rows.s1[lane] };
        Manifold {
            normal: rows.normal(lane),
            arm_a: rows.a1[lane],
            arm_b: rows.b1[lane],
            length: rows.l[lane],
            points: if two { 2 } else { 1 },
            tangent_a: rows.at[lane],
            tangent_b: rows.bt[lane],
            gaps: [rows.s1[lane], second],
        }
    }
}
