//! Triangles joined to convex pieces (S. Hertel, K. Mehlhorn, 1983).
//!
//! A cut is taken out if both its ends stay strictly convex without it. What is left has at most
//! four times as many pieces as any partition needs. Longest cuts go first: short ones stay.

use carom_math::{Vec2, orient2d};

use crate::ears::{OUTLINE, Triangles};

/// One edge of a piece: where it begins on the ring, and whether it belongs to the outline.
pub(crate) struct PieceEdge {
    pub(crate) origin: usize,
    pub(crate) is_boundary: bool,
}

/// The pieces, each counter-clockwise.
pub(crate) fn merge(ring: &[Vec2], triangles: &Triangles) -> Vec<Vec<PieceEdge>> {
    let mut mesh = Mesh::new(ring, triangles);
    for cut in mesh.cuts() {
        mesh.take_out(cut);
    }
    mesh.pieces()
}

struct Mesh<'a> {
    ring: &'a [Vec2],
    origins: &'a [usize],
    twins: &'a [usize],
    /// Around each piece, both ways.
    next: Vec<usize>,
    previous: Vec<usize>,
    /// Edges that are gone, or already handed out.
    done: Vec<bool>,
}

impl<'a> Mesh<'a> {
    fn new(ring: &'a [Vec2], triangles: &'a Triangles) -> Self {
        let count = triangles.origins.len();
        let around = |edge: usize, step: usize| edge - edge % 3 + (edge + step) % 3;
        Self {
            ring,
            origins: &triangles.origins,
            twins: &triangles.twins,
            next: (0..count).map(|edge| around(edge, 1)).collect(),
            previous: (0..count).map(|edge| around(edge, 2)).collect(),
            done: vec![false; count],
        }
    }

    /// One of the two edges of each cut, longest first.
    fn cuts(&self) -> Vec<usize> {
        let mut cuts: Vec<(u64, usize)> = (0..self.origins.len())
            .filter(|&edge| self.twins[edge] != OUTLINE && edge < self.twins[edge])
            .map(|edge| {
                let length = self
                    .from(edge)
                    .distance_squared(self.from(self.twins[edge]));
                (length.to_bits(), edge)
            })
            .collect();
        cuts.sort_unstable_by(|a, b| b.cmp(a));
        cuts.into_iter().map(|(_, edge)| edge).collect()
    }

    /// Joins the pieces on both sides of a cut, if the result is strictly convex.
    fn take_out(&mut self, cut: usize) {
        let twin = self.twins[cut];
        let joints = [(cut, twin), (twin, cut)].map(|(edge, other)| {
            // Where `edge` begins, `other` ends: the edge before the one meets that after the other.
            (self.previous[edge], self.next[other])
        });
        let stays_convex = joints.iter().all(|&(arriving, leaving)| {
            let end = self.from(self.next[leaving]);
            orient2d(self.from(arriving), self.from(leaving), end) > 0.0
        });
        if stays_convex {
            for (arriving, leaving) in joints {
                self.next[arriving] = leaving;
                self.previous[leaving] = arriving;
            }
            self.done[cut] = true;
            self.done[twin] = true;
        }
    }

    fn pieces(mut self) -> Vec<Vec<PieceEdge>> {
        let mut pieces = Vec::new();
        for start in 0..self.origins.len() {
            let mut piece = Vec::new();
            let mut edge = start;
            while !self.done[edge] {
                self.done[edge] = true;
                piece.push(PieceEdge {
                    origin: self.origins[edge],
                    is_boundary: self.twins[edge] == OUTLINE,
                });
                edge = self.next[edge];
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        pieces
    }

    /// Where an edge begins, in m.
    fn from(&self, edge: usize) -> Vec2 {
        self.ring[self.origins[edge]]
    }
}
