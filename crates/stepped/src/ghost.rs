//! Ghost contacts: rows with sides of pieces that other pieces hide, as those of flush tiles are.
//!
//! Body by body, over all rows of the tick. A row with piece P is hidden if some other row of the body has a plane that all
//! of P lies behind, and its points lie in this plane or behind it, where just beyond P on the side of the row's normal
//! another touched piece goes on. Ends have no such piece, at convex bends it lies on the other side, and at inner corners P
//! reaches through the plane.

use carom_math::{Vec2, perp};

use crate::bodies::{Bodies, BodyKind};
use crate::pieces::{Outline, Pieces};
use crate::rows::Graph;

/// Pieces are flush within this part of the smaller extent. Smaller than rounding far out hides nothing; larger hides steps.
const FLUSH: f64 = 1e-4;

/// Sine of the angle by which a normal must lean from that of the plane to be that of a side.
const LEANS: f64 = 0.02;

/// A body with more rows is a floor itself: all pairs of its rows would be too many.
const MOST: usize = 32;

/// A row as a body sees it.
struct Seen {
    contact: u32,
    piece: u32,
    /// Unit normal from the piece to the body.
    normal: Vec2,
    /// Points on the surface of the piece, in space.
    points: [Vec2; 2],
}

/// Hides rows of moved bodies until they are computed anew.
pub(crate) fn hide(graph: &mut Graph, bodies: &mut Bodies, pieces: &Pieces) {
    let mut rows = Vec::new();
    let mut ghosts = Vec::new();
    for line in (2..bodies.lines.len()).filter(|line| bodies.moved[*line]) {
        let slot = bodies.slot_of[line];
        if bodies.records[slot as usize].kind != BodyKind::Dynamic {
            continue;
        }
        rows.clear();
        let ids = graph.of_body(bodies, slot).take(MOST + 1);
        rows.extend(ids.map(|(id, side)| seen(graph, bodies, id, side)));
        if (2..=MOST).contains(&rows.len()) {
            let hidden = (0..rows.len()).filter(|k| is_ghost(bodies, pieces, &rows, *k));
            ghosts.extend(hidden.map(|k| rows[k].contact));
        }
    }
    for id in ghosts {
        graph.hide(bodies, id);
    }
}

fn seen(graph: &Graph, bodies: &Bodies, id: u32, side: usize) -> Seen {
    let contact = &graph.contacts[id as usize];
    let (block, _, lane) = graph.lane(id);
    let n = Vec2::new(block.nx[lane], block.ny[lane]);
    let at = bodies.base_of(contact.bodies[0]).position + n * block.at[lane];
    // Points lie midway between the surfaces: half a gap along the normal is the piece's own.
    let first = at - perp(n) * block.a1[lane];
    let half = 0.5 * block.s1[lane];
    let (normal, half) = if side == 0 { (-n, half) } else { (n, -half) };
    let first = first + n * half;
    let two = block.points(lane) == 2;
    let last = if two {
        first - perp(n) * block.l[lane]
    } else {
        first
    };
    Seen {
        contact: id,
        piece: contact.pieces[1 - side],
        normal,
        points: [first, last],
    }
}

fn is_ghost(bodies: &Bodies, pieces: &Pieces, rows: &[Seen], k: usize) -> bool {
    let row = &rows[k];
    rows.iter().any(|other| {
        let along = row.normal.dot(other.normal);
        // Cheap tests first: most pairs of rows are two sides of a heap.
        if other.piece == row.piece || along * along > 1.0 - LEANS * LEANS || along < -LEANS {
            return false;
        }
        let extent = |piece: u32| pieces.list[piece as usize].extent;
        let flush = FLUSH * extent(row.piece).min(extent(other.piece));
        let height = |point: Vec2| other.normal.dot(point - other.points[0]);
        if row.points.iter().any(|point| height(*point) > flush) {
            return false;
        }
        let Some((p, p_at)) = outline(bodies, pieces, row.piece) else {
            return false;
        };
        // All of P lies behind the plane of the other row, and where its side goes on beyond the points another piece is.
        let lean = row.normal - other.normal * along;
        let lean = lean * (10.0 * flush / lean.length());
        (0..p.corners).all(|i| height(p_at + p.corner(i)) + p.radius <= flush)
            && row.points.iter().all(|point| {
                let beyond = *point + lean;
                rows.iter().any(|third| {
                    third.piece != row.piece
                        && outline(bodies, pieces, third.piece)
                            .is_some_and(|(q, q_at)| holds(q, beyond - q_at, flush))
                })
            })
    })
}

fn outline<'a>(bodies: &Bodies, pieces: &'a Pieces, piece: u32) -> Option<(&'a Outline, Vec2)> {
    let turned = &pieces.turned[piece as usize];
    let at = bodies.base_of(pieces.list[piece as usize].body).position;
    (turned.corners > 2).then_some((turned, at))
}

/// Whether a point is in an outline, or so near to it.
fn holds(outline: &Outline, point: Vec2, near: f64) -> bool {
    (0..outline.corners)
        .all(|i| outline.normal(i).dot(point) - outline.off[i] <= outline.radius + near)
}
