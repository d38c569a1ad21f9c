//! Ghost contacts: rows with sides of pieces that other pieces hide, as those of flush tiles are.
//!
//! Body by body, over all rows of the tick. A row with piece P is hidden if some other row of the body has a plane that all
//! of P lies behind, and its points lie in this plane or behind it, where just beyond P on the side of the row's normal
//! another touched piece goes on. Ends have no such piece, at convex bends it lies on the other side, and at inner corners P
//! reaches through the plane.

#![allow(clippy::inline_always, reason = "the wide instructions end at a call")]

use core::ops::Range;

use carom_math::{Vec2, perp, vec2};
use fearless_simd::{Level, Simd, SimdBase, SimdMask, dispatch, f64x4};

use crate::bodies::{Bodies, BodyKind};
use crate::outline::Outline;
use crate::pieces::Pieces;
use crate::rows::Graph;

/// Pieces are flush within this part of the smaller extent. Smaller than rounding far out hides nothing; larger hides steps.
const FLUSH: f64 = 1e-4;

/// Sine of the angle by which a normal must lean from that of the plane to be that of a side.
const LEANS: f64 = 0.02;

/// A body with more rows is a floor itself: all pairs of its rows would be too many.
const MOST: usize = 32;

/// Contacts that may be ghosts.
///
/// A ghost's body has all of its piece behind a plane that the body itself is in front of: the contact is as long as the
/// body is deep in the plane at most. Its piece is flush with another one: it stands, is driven, is one of several, or has
/// a seam.
#[derive(Clone, Debug, Default)]
pub(crate) struct Suspects {
    short: Vec<Short>,
    /// Bodies with a side that may go on in that of another body, as far as they moved.
    seamed: Vec<bool>,
}

/// A short contact of a moved body with a piece that may be flush.
#[derive(Clone, Copy, Debug)]
struct Short {
    /// Line of the body.
    body: u32,
    contact: u32,
    /// Line of the other body, if only a seam makes its piece flush.
    seam_of: Option<u32>,
}

impl Suspects {
    pub(crate) fn clear(&mut self) {
        self.short.clear();
        self.seamed.clear();
    }

    /// There are so many lines now.
    pub(crate) fn cover(&mut self, lines: usize) {
        self.seamed.resize(lines, false);
    }

    /// Adds a short contact of two pieces of the bodies of two lines.
    pub(crate) fn add_short(
        &mut self,
        (bodies, pieces): (&Bodies, &Pieces),
        [a, b]: [u32; 2],
        pair: [u32; 2],
        contact: u32,
    ) {
        for (body, other, piece) in [(a, b, pair[1]), (b, a, pair[0])] {
            if bodies.moved[body as usize] && has_sides(pieces.outline(piece)) {
                let driven = bodies.lines[other as usize].inverse_mass() == 0.0;
                // The seams of what did not move are those of before.
                let stays = !bodies.moved[other as usize];
                let is_flush = stays || driven || pieces.owners[piece as usize].several;
                self.short.push(Short {
                    body,
                    contact,
                    seam_of: (!is_flush).then_some(other),
                });
            }
        }
    }

    pub(crate) fn add_seam(&mut self, lines: [u32; 2]) {
        for line in lines {
            self.seamed[line as usize] = true;
        }
    }

    /// Lines of bodies, in order, with their contacts that may be ghosts.
    fn contacts(&self) -> Vec<(u32, u32)> {
        let seams = |short: &&Short| short.seam_of.is_none_or(|line| self.seamed[line as usize]);
        let asked = self.short.iter().filter(seams);
        let mut asked: Vec<(u32, u32)> = asked.map(|short| (short.body, short.contact)).collect();
        asked.sort_unstable();
        asked
    }
}

/// Rows as a body sees them, and what it takes to find those that may be hidden.
#[derive(Default)]
#[repr(C, align(64))]
struct Rows {
    /// Unit normals from the pieces to the body.
    nx: [f64; MOST],
    ny: [f64; MOST],
    /// Points on the surfaces of the pieces, in space.
    x1: [f64; MOST],
    y1: [f64; MOST],
    x2: [f64; MOST],
    y2: [f64; MOST],
    /// What is flush with the piece, and how much farther apart they are at the second point, in m.
    flush: [f64; MOST],
    slope: [f64; MOST],
    pieces: [u32; MOST],
    contacts: [u32; MOST],
    len: usize,
}

/// Hides rows of moved bodies until they are computed anew.
pub(crate) fn hide(level: Level, graph: &mut Graph, bodies: &mut Bodies, pieces: &Pieces) {
    let mut ids = Vec::new();
    let mut rows = Rows::default();
    let mut ghosts = Vec::new();
    let suspects = graph.suspects.contacts();
    for asked in suspects.chunk_by(|a, b| a.0 == b.0) {
        let line = asked[0].0 as usize;
        let record = &bodies.records[bodies.slot_of[line] as usize];
        if record.kind != BodyKind::Dynamic {
            continue;
        }
        ids.clear();
        let of_body = graph.of_body(bodies, bodies.slot_of[line]);
        ids.extend(of_body.map(|(id, _)| id).take(MOST + 1));
        if (2..=MOST).contains(&ids.len()) {
            rows.fill(graph, pieces, &ids, &record.pieces());
            for &(_, contact) in asked {
                let place = rows.contacts[..rows.len]
                    .iter()
                    .position(|id| *id == contact);
                if let Some(k) = place {
                    rows.end_near(pieces, k);
                    if dispatch!(level, simd => is_row_hidden(simd, &rows, pieces, k)) {
                        ghosts.push(contact);
                    }
                }
            }
        }
    }
    // Impulses of several are taken out of one body in an order that other islands do not change.
    graph.sort(bodies, &mut ghosts);
    for id in ghosts {
        graph.hide(bodies, id);
    }
}

/// Whether some other row hides row k. Few rows come past the tests of normals and heights: most pairs are two sides of a heap.
#[inline(always)]
fn is_row_hidden<S: Simd>(simd: S, rows: &Rows, pieces: &Pieces, k: usize) -> bool {
    let splat = |number: f64| f64x4::splat(simd, number);
    let (nx, ny) = (splat(rows.nx[k]), splat(rows.ny[k]));
    let (x1, y1) = (splat(rows.x1[k]), splat(rows.y1[k]));
    let (x2, y2) = (splat(rows.x2[k]), splat(rows.y2[k]));
    (0..rows.len).step_by(4).any(|at| {
        let (ox, oy) = (four(simd, &rows.nx, at), four(simd, &rows.ny, at));
        let (px, py) = (four(simd, &rows.x1, at), four(simd, &rows.y1, at));
        let along = nx * ox + ny * oy;
        let first = (x1 - px) * ox + (y1 - py) * oy;
        let second = (x2 - px) * ox + (y2 - py) * oy;
        let flush = splat(rows.flush[k]).min(four(simd, &rows.flush, at));
        let low = first.max(second).simd_le(flush);
        let side =
            (along * along).simd_le(splat(1.0 - LEANS * LEANS)) & along.simd_ge(splat(-LEANS));
        let mut bits = (low & side).to_bitmask();
        core::iter::from_fn(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits.wrapping_sub(1);
            (lane < 4).then_some(at + lane)
        })
        .any(|o| is_hidden(rows, pieces, k, o))
    })
}

#[inline(always)]
fn four<S: Simd>(simd: S, column: &[f64; MOST], at: usize) -> f64x4<S> {
    f64x4::from_slice(simd, &column[at..at + 4])
}

/// Whether all of the piece P of row k lies behind the plane of row o, and where its side goes on beyond the points another
/// piece is.
#[inline(always)]
fn is_hidden(rows: &Rows, pieces: &Pieces, k: usize, o: usize) -> bool {
    let p = pieces.outline(rows.pieces[k]);
    if rows.pieces[k] == rows.pieces[o] || !has_sides(p) {
        return false;
    }
    let (normal, plane) = (rows.normal(k), rows.normal(o));
    let flush = rows.flush[k].min(rows.flush[o]);
    let height = |point: Vec2| plane.dot(point - rows.points(o)[0]);
    let lean = normal - plane * normal.dot(plane);
    let lean = lean * (10.0 * flush / lean.length());
    (0..p.corners()).all(|i| height(p.centre() + p.corner(i)) + p.radius() <= flush)
        && rows.points(k).iter().all(|point| {
            (0..rows.len).any(|third| {
                let q = rows.pieces[third];
                let (point, bounds) = (*point + lean, pieces.boxes[q as usize]);
                q != rows.pieces[k]
                    && bounds.grown(flush).contains_point(point)
                    && has_sides(pieces.outline(q))
                    && !pieces.outline(q).is_beyond_side(point, flush)
            })
        })
}

/// Whether other pieces may hide sides of a piece: of discs they hide none.
const fn has_sides(piece: &Outline) -> bool {
    piece.corners() >= 2
}

impl Rows {
    /// The rows of the body that has the pieces `its`.
    fn fill(&mut self, graph: &Graph, pieces: &Pieces, ids: &[u32], its: &Range<u32>) {
        self.len = ids.len();
        for (k, id) in ids.iter().enumerate() {
            let pair = graph.contacts[*id as usize].pieces;
            let (block, _, lane) = graph.lane(*id);
            let (side, sign) = if its.contains(&pair[0]) {
                (1, -1.0)
            } else {
                (0, 1.0)
            };
            let n = vec2(block.nx[lane], block.ny[lane]);
            // r · n = a_t, r × n = a: so r = n a_t − t a.
            let arm = n * block.at[lane] - perp(n) * block.a1[lane];
            let normal = n * sign;
            // Points lie on the surface of A where both are nearest, or midway in what overlaps: from there to the piece's own.
            let first = pieces.outlines[pair[0] as usize].centre() + arm;
            let two = block.points(lane) == 2;
            let gaps = [block.s1[lane], block.s2[lane]];
            let near = gaps[0].min(gaps[1]);
            let apart = if side == 1 { near.max(0.0) } else { 0.0 };
            let first = first - normal * (apart + 0.5 * near.min(0.0));
            let last = first - perp(n) * block.l[lane];
            (self.nx[k], self.ny[k]) = (normal.x, normal.y);
            (self.x1[k], self.y1[k]) = (first.x, first.y);
            (self.x2[k], self.y2[k]) = (last.x, last.y);
            self.flush[k] = FLUSH * pieces.outlines[pair[side] as usize].extent();
            self.slope[k] = if two { gaps[1] - gaps[0] } else { 0.0 };
            (self.pieces[k], self.contacts[k]) = (pair[side], *id);
        }
        // What is beyond the last of the lanes is flush with nothing.
        let end = self.len.next_multiple_of(4);
        self.flush[self.len..end].fill(f64::NEG_INFINITY);
    }

    /// Where a side of the piece slants away from a face of the body it meets that with its near end alone.
    fn end_near(&mut self, pieces: &Pieces, k: usize) {
        if self.slope[k].abs() > self.flush[k] {
            let (piece, normal) = (pieces.outline(self.pieces[k]), self.normal(k));
            let is_face = |i: usize| piece.normal(i).dot(normal) > 1.0 - LEANS * LEANS;
            if !(0..piece.corners()).any(is_face) {
                let near = self.points(k)[usize::from(self.slope[k] < 0.0)];
                (self.x1[k], self.y1[k]) = (near.x, near.y);
                (self.x2[k], self.y2[k]) = (near.x, near.y);
            }
        }
    }

    const fn normal(&self, k: usize) -> Vec2 {
        vec2(self.nx[k], self.ny[k])
    }

    const fn points(&self, k: usize) -> [Vec2; 2] {
        [vec2(self.x1[k], self.y1[k]), vec2(self.x2[k], self.y2[k])]
    }
}
