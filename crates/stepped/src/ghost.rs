//! Ghost contacts: rows with sides of pieces that other pieces hide, as those of flush tiles are.
//!
//! Body by body, over all rows of the tick. A row with piece P is hidden if some other row of the body has a plane that all
//! of P lies behind, and its points lie in this plane or behind it, where just beyond P on the side of the row's normal
//! another touched piece goes on. Ends have no such piece, and at convex bends it lies on the other side. At inner corners P
//! reaches through the plane: where it stands, a row with a side of it that does not reach through is one with the side that
//! does, as at the tip of a ramp that a body slides up to.

use std::collections::BTreeMap;

use carom_math::{Vec2, perp};

use crate::bodies::Bodies;
use crate::narrow::Manifold;
use crate::outline::Outline;
use crate::pieces::Pieces;
use crate::rows::Graph;
use crate::{BodyIx, ContactIx, LineIx, PieceIx};

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
    body: LineIx,
    contact: ContactIx,
    /// Line of the other body, if only a seam makes its piece flush.
    seam_of: Option<LineIx>,
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
        [a, b]: [LineIx; 2],
        pair: [PieceIx; 2],
        contact: ContactIx,
    ) {
        for (body, other, piece) in [(a, b, pair[1]), (b, a, pair[0])] {
            if bodies.moved[body] && has_sides(pieces.outline(piece)) {
                let driven = bodies.lines[other].inverse_mass() == 0.0;
                // The seams of what did not move are those of before.
                let stays = !bodies.moved[other];
                let is_flush = stays || driven || pieces.owners[piece].several;
                self.short.push(Short {
                    body,
                    contact,
                    seam_of: (!is_flush).then_some(other),
                });
            }
        }
    }

    pub(crate) fn add_seam(&mut self, lines: [LineIx; 2]) {
        for line in lines {
            self.seamed[line] = true;
        }
    }

    /// Lines of bodies, in order, with their contacts that may be ghosts.
    fn contacts(&self) -> Vec<(LineIx, ContactIx)> {
        let seams = |short: &&Short| short.seam_of.is_none_or(|line| self.seamed[line]);
        let asked = self.short.iter().filter(seams);
        let mut asked: Vec<(LineIx, ContactIx)> =
            asked.map(|short| (short.body, short.contact)).collect();
        asked.sort_unstable();
        asked
    }
}

/// A row as a body sees it, and what it takes to find whether it may be hidden.
struct Row {
    /// Unit normal from the piece to the body.
    normal: Vec2,
    /// Points on the surface of the piece, in space.
    points: [Vec2; 2],
    /// What is flush with the piece, and how much farther apart they are at the second point, in m.
    flush: f64,
    slope: f64,
    piece: PieceIx,
    contact: ContactIx,
    /// Whether the piece stands, or is driven, and the body's own has sides: a disc meets no tip before it meets the sides.
    is_tip: bool,
}

/// Takes ghosts out of the rows of moved bodies until these are computed anew: they are hidden, or put on the side that is exposed.
pub(crate) fn filter(graph: &mut Graph, bodies: &mut Bodies, pieces: &Pieces) {
    let mut rows: Vec<Row> = Vec::new();
    let (mut ghosts, mut sides) = (Vec::new(), BTreeMap::new());
    let suspects = graph.suspects.contacts();
    for asked in suspects.chunk_by(|a, b| a.0 == b.0) {
        let slot = bodies.slot_of[asked[0].0];
        if !bodies.is_dynamic(slot) {
            continue;
        }
        let ids = graph.of_body(bodies, slot).map(|(id, _)| id);
        rows.clear();
        rows.extend(
            ids.take(MOST + 1)
                .map(|id| Row::of(graph, (bodies, pieces), id, slot)),
        );
        if rows.len() > MOST {
            continue;
        }
        for &(_, contact) in asked {
            if let Some(k) = rows.iter().position(|row| row.contact == contact) {
                rows[k].end_near(pieces);
                let row = &rows[k];
                let exposed = rows
                    .iter()
                    .map(|other| exposed_over(&rows, pieces, row, other));
                match exposed.fold(Exposed::Whole, Exposed::less) {
                    Exposed::Whole => {}
                    Exposed::Nothing => ghosts.push(contact),
                    Exposed::Side(side) => {
                        ghosts.push(contact);
                        sides.insert(contact, row.on_side(graph, pieces, side));
                    }
                }
            }
        }
    }
    // Impulses of several are taken out of one body in an order that other islands do not change.
    graph.sort(bodies, &mut ghosts);
    for id in ghosts {
        match sides.get(&id) {
            Some(manifold) => graph.put_anew(bodies, id, manifold),
            None => graph.hide(bodies, id),
        }
    }
}

/// What of the piece P of a row a body can touch that is in front of the plane of another one.
#[derive(Clone, Copy)]
enum Exposed {
    Whole,
    /// The side that goes up from where the row is, by its number.
    Side(usize),
    Nothing,
}

impl Exposed {
    const fn less(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, _) | (_, Self::Nothing) => Self::Nothing,
            (Self::Side(_), _) => self,
            (Self::Whole, _) => other,
        }
    }
}

/// What is exposed of the piece P of a row over the plane of another one: nothing if all of P lies behind that, and one side where the
/// side with the row's normal does, if beyond the points another piece goes on.
fn exposed_over(rows: &[Row], pieces: &Pieces, row: &Row, other: &Row) -> Exposed {
    let (normal, plane) = (row.normal, other.normal);
    let along = normal.dot(plane);
    let flush = row.flush.min(other.flush);
    let height = |point: Vec2| plane.dot(point - other.points[0]);
    // Few rows come past this: most pairs are two sides of a heap.
    if along < -LEANS
        || along * along > 1.0 - LEANS * LEANS
        || row.points.iter().any(|point| height(*point) > flush)
    {
        return Exposed::Whole;
    }
    let p = pieces.outline(row.piece);
    if row.piece == other.piece || !has_sides(p) {
        return Exposed::Whole;
    }
    let count = p.corners();
    let is_behind = |i: usize| height(p.centre() + p.corner(i % count)) + p.radius() <= flush;
    let exposed = if (0..count).all(is_behind) {
        Exposed::Nothing
    } else if row.is_tip {
        let goes_up = |i: &usize| is_behind(*i) != is_behind(i + 1);
        let facing = |i: usize| p.normal(i).dot(normal);
        let sides = (0..count).filter(goes_up).map(|i| (facing(i), i));
        match sides.max_by(|x, y| x.0.total_cmp(&y.0)) {
            // The row's own side is exposed.
            Some((facing, side)) if facing > LEANS && facing < 1.0 - LEANS * LEANS => {
                Exposed::Side(side)
            }
            _ => return Exposed::Whole,
        }
    } else {
        return Exposed::Whole;
    };
    let lean = normal - plane * along;
    let lean = lean * (10.0 * flush / lean.length());
    let goes_on = |point: &Vec2| {
        rows.iter().any(|third| {
            let q = third.piece;
            let (point, bounds) = (*point + lean, pieces.boxes[q]);
            q != row.piece
                && bounds.grown(flush).contains_point(point)
                && has_sides(pieces.outline(q))
                && !pieces.outline(q).is_beyond_side(point, flush)
        })
    };
    if row.points.iter().all(goes_on) {
        exposed
    } else {
        Exposed::Whole
    }
}

/// Whether other pieces may hide sides of a piece: of discs they hide none.
const fn has_sides(piece: &Outline) -> bool {
    piece.corners() >= 2
}

impl Row {
    /// A contact of the body of a slot.
    fn of(
        graph: &Graph,
        (bodies, pieces): (&Bodies, &Pieces),
        contact: ContactIx,
        slot: BodyIx,
    ) -> Self {
        let pair = graph.contacts[contact].pieces;
        let (block, _, lane) = graph.lane(contact);
        let (side, sign) = if pieces.owners[pair[0]].body == slot {
            (1, -1.0)
        } else {
            (0, 1.0)
        };
        let n = block.normal(lane);
        // r · n = a_t, r × n = a: so r = n a_t − t a.
        let arm = n * block.at[lane] - perp(n) * block.a1[lane];
        let normal = n * sign;
        // Points lie on the surface of A where both are nearest, or midway in what overlaps: from there to the piece's own.
        let first = pieces.outline(pair[0]).centre() + arm;
        let two = block.points(lane) == 2;
        let gaps = [block.s1[lane], block.s2[lane]];
        let near = gaps[0].min(gaps[1]);
        let apart = if side == 1 { near.max(0.0) } else { 0.0 };
        let first = first - normal * (apart + 0.5 * near.min(0.0));
        Self {
            normal,
            points: [first, first - perp(n) * block.l[lane]],
            flush: FLUSH * pieces.outline(pair[side]).extent(),
            slope: if two { gaps[1] - gaps[0] } else { 0.0 },
            piece: pair[side],
            contact,
            is_tip: bodies.lines[[block.a, block.b][side][lane]].inverse_mass() == 0.0
                && has_sides(pieces.outline(pair[1 - side])),
        }
    }

    /// The contact with one side of the piece, at the nearest corner of the body's own.
    fn on_side(&self, graph: &Graph, pieces: &Pieces, side: usize) -> Manifold {
        let [a, b] = graph.contacts[self.contact].pieces;
        let own = pieces.outline(if a == self.piece { b } else { a });
        let piece = pieces.outline(self.piece);
        let out = piece.normal(side);
        let corners = (0..own.corners()).map(|i| own.centre() + own.corner(i));
        let height = |point: Vec2| out.dot(point - piece.centre() - piece.corner(side));
        let heights = corners.map(|corner| (height(corner), corner));
        let first = (f64::INFINITY, Vec2::ZERO);
        let (height, corner) = heights.fold(first, |x, y| if y.0 < x.0 { y } else { x });
        let gap = height - piece.radius() - own.radius();
        let at = corner - out * (own.radius() + 0.5 * gap);
        let normal = if a == self.piece { out } else { -out };
        let arms = [a, b].map(|k| at - pieces.outline(k).centre());
        Manifold::single(normal, arms, gap)
    }

    /// Where a side of the piece slants away from a face of the body it meets that with its near end alone.
    fn end_near(&mut self, pieces: &Pieces) {
        if self.slope.abs() > self.flush {
            let piece = pieces.outline(self.piece);
            let is_face = |i: usize| piece.normal(i).dot(self.normal) > 1.0 - LEANS * LEANS;
            if !(0..piece.corners()).any(is_face) {
                self.points = [self.points[usize::from(self.slope < 0.0)]; 2];
            }
        }
    }
}
