//! Where the parts of a compound hide each other: what lies in a seam cannot be touched.
//!
//! An edge that other parts cover on its outside is no boundary. A corner that lies in or on other
//! parts is touched only in directions in which all of them are touched there: the cut of their
//! normal cones. So two tiles side by side have one straight top, and an edge of a chain no end.

use carom_math::{Vec2, cross, perp};

use crate::{Aabb, Circle, Cone, ConvexPiece, PartTree};

/// A convex part of a compound.
#[derive(Clone, Debug, PartialEq)]
pub enum ConvexPart {
    /// A disc.
    Disc(Circle),
    /// A convex polygon, or a wall of two vertices and two opposite normals; it knows where other
    /// parts of the compound hide it.
    Piece(ConvexPiece),
}

/// Parts closer than this, as a fraction of the compound's size, touch: above what placing them by
/// a pose rounds (1e-15), far below what could be a gap on purpose.
const TOUCH: f64 = 1e-9;

impl ConvexPart {
    /// The box around the part, in the frame of its compound.
    #[must_use]
    pub fn aabb(&self) -> Aabb {
        match self {
            Self::Disc(disc) => {
                Aabb::from_points(disc.vertices().iter().copied()).grown(disc.radius())
            }
            Self::Piece(piece) => Aabb::from_points(piece.vertices().iter().copied()),
        }
    }
}

/// Marks the hidden edges and corners of parts of one body.
pub(crate) fn weld(parts: &mut [ConvexPart]) {
    let boxes: Vec<Aabb> = parts.iter().map(ConvexPart::aabb).collect();
    let all = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let touch = TOUCH * all.extents().max_element();
    let tree = PartTree::new(boxes.iter().copied());
    let original = parts.to_vec();
    for (k, part) in parts.iter_mut().enumerate() {
        let ConvexPart::Piece(piece) = part else {
            continue;
        };
        let mut others = Vec::new();
        let near = boxes[k].grown(touch);
        tree.search(
            |bounds| bounds.overlaps(near),
            |other| others.push(other as usize),
        );
        others.sort_unstable();
        let others: Vec<&ConvexPart> = others
            .into_iter()
            .filter(|other| *other != k)
            .map(|other| &original[other])
            .collect();
        hide(piece, &others, touch);
    }
}

fn hide(piece: &mut ConvexPiece, others: &[&ConvexPart], touch: f64) {
    for i in 0..piece.vertices().len() {
        let next = (i + 1) % piece.vertices().len();
        let (from, to) = (piece.vertices()[i], piece.vertices()[next]);
        if piece.is_boundary(i) && is_covered(from, to, piece.normals()[i], others, touch) {
            piece.hide_edge(i);
        }
        let cones = others
            .iter()
            .filter_map(|other| cone_at(other, from, touch));
        let cone = cones.fold(piece.cones()[i], common);
        piece.set_cone(i, cone);
    }
}

/// Whether the outer side of an edge lies in other parts all along.
fn is_covered(from: Vec2, to: Vec2, normal: Vec2, others: &[&ConvexPart], touch: f64) -> bool {
    let length = (to - from).length();
    let mut stretches: Vec<(f64, f64)> = others
        .iter()
        .filter_map(|other| match other {
            ConvexPart::Piece(other) => covered_by(from, to, normal, other, touch),
            ConvexPart::Disc(disc) => in_disc(from, to, disc),
        })
        .collect();
    stretches.sort_by(|p, q| p.0.total_cmp(&q.0));
    let slack = touch / length;
    let mut reached = 0.0;
    for (start, end) in stretches {
        if start > reached + slack {
            return false;
        }
        reached = reached.max(end);
    }
    reached >= 1.0 - slack
}

/// From where to where an edge lies in another part that is on its outer side, as parts of the edge.
fn covered_by(
    from: Vec2,
    to: Vec2,
    normal: Vec2,
    other: &ConvexPiece,
    touch: f64,
) -> Option<(f64, f64)> {
    if other.vertices().len() < 3 {
        // A wall covers nothing.
        return None;
    }
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    for (corner, out) in other.vertices().iter().zip(other.normals()) {
        let (h0, h1) = (out.dot(from - *corner), out.dot(to - *corner));
        if h0.abs() <= touch && h1.abs() <= touch {
            if out.dot(normal) > 0.0 {
                // Flush: the other part ends here, too.
                return None;
            }
            continue;
        }
        // Heights change from h0 to h1 along the edge; inside is where they are below 0.
        if h0 > touch && h1 > touch {
            return None;
        }
        let rise = h1 - h0;
        if rise.abs() > touch {
            let crossing = -h0 / rise;
            if rise > 0.0 {
                end = end.min(crossing);
            } else {
                start = start.max(crossing);
            }
        }
    }
    (start < end).then_some((start, end))
}

/// From where to where an edge lies in a disc.
fn in_disc(from: Vec2, to: Vec2, disc: &Circle) -> Option<(f64, f64)> {
    let along = to - from;
    let square = along.length_squared();
    let to_centre = disc.centre() - from;
    let across = cross(along, to_centre);
    let half = square * disc.radius() * disc.radius() - across * across;
    if half <= 0.0 {
        return None;
    }
    let (middle, half) = (to_centre.dot(along) / square, half.sqrt() / square);
    let (start, end) = ((middle - half).max(0.0), (middle + half).min(1.0));
    (start < end).then_some((start, end))
}

/// In which directions a part can be touched at `point`; `None` if the point is not on or in it.
fn cone_at(part: &ConvexPart, point: Vec2, touch: f64) -> Option<Cone> {
    let piece = match part {
        ConvexPart::Piece(piece) => piece,
        ConvexPart::Disc(disc) => {
            let away = (point - disc.centre()).length() - disc.radius();
            return (away <= touch).then_some(Cone::NONE);
        }
    };
    let (vertices, normals) = (piece.vertices(), piece.normals());
    if let Some(i) = vertices.iter().position(|v| (*v - point).length() <= touch) {
        let before = normals[(i + normals.len() - 1) % normals.len()];
        return Some(Cone {
            from: before,
            to: normals[i],
        });
    }
    let inside = |(corner, out): (&Vec2, &Vec2)| out.dot(point - *corner) <= touch;
    let in_it = vertices.iter().zip(normals).all(inside)
        && Aabb::from_points(vertices.iter().copied())
            .grown(touch)
            .contains_point(point);
    // On an edge its normal is left, which the edge itself answers for.
    in_it.then_some(Cone::NONE)
}

/// The directions in both of two cones; none where only single ones are left, which belong to edges.
fn common(a: Cone, b: Cone) -> Cone {
    if a.is_empty() || b.is_empty() {
        return Cone::NONE;
    }
    let first = |p: Vec2, q: Vec2| {
        if b.contains(p) {
            Some(p)
        } else {
            Some(q).filter(|q| a.contains(*q))
        }
    };
    let (Some(from), Some(to)) = (first(a.from, b.from), first(a.to, b.to)) else {
        return Cone::NONE;
    };
    // Counter-clockwise from `from` to `to`: half a turn has its middle at a right angle.
    let middle = (from + to).try_normalize().unwrap_or(perp(from));
    if cross(from, to) <= 0.0 && (from + to).length_squared() > 0.5 {
        return Cone::NONE;
    }
    let cone = Cone { from, to };
    if a.contains(middle) && b.contains(middle) {
        cone
    } else {
        Cone::NONE
    }
}
