//! What of two parts touches at a point of contact that turns: a corner or a disc on an edge, a disc on a corner.

use arrayvec::ArrayVec;
use carom_collision::{Hull, hulls};
use carom_geometry::Shape;
use carom_math::{Pose, Vec2, perp};

use crate::analytic::tipping::{End, Joint};
use crate::impact::ImpactBody;
use crate::model::edges::{disc_room, end_room, flush_edge};
use crate::store::few::Few;

/// Sine of the angle up to which an edge lies along a contact: far above rounding.
const FLUSH: f64 = 1e-9;

/// A convex part of a body at an instant.
pub(super) struct Held<'a> {
    pub(super) hull: Hull<'a>,
    /// The shape that it is a part of.
    pub(super) shape: &'a Shape,
    /// All shapes of its body that meet the other part's.
    pub(super) shapes: Few<&'a Shape>,
    pub(super) pose: Pose,
    pub(super) moves: ImpactBody,
}

impl Held<'_> {
    fn is_disc(&self) -> bool {
        self.hull.normals.is_empty()
    }

    /// The vertex next to a point, and how far it is, in m.
    fn vertex_near(&self, point: Vec2) -> Option<(usize, f64)> {
        let local = self.pose.inverse_point(point);
        let far = |vertex: &Vec2| (*vertex - local).length();
        let all = self.hull.vertices.iter().map(far).enumerate();
        all.min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// Corners beside a corner of the shape, on either side of all its parts that have it: what lies between lands later.
    fn beside(&self, corner: Vec2) -> ArrayVec<Vec2, 2> {
        let mut found: ArrayVec<Vec2, 2> = ArrayVec::new();
        for hull in hulls(self.shape) {
            let (vertices, count) = (hull.vertices, hull.vertices.len());
            let Some(at) = vertices.iter().position(|vertex| *vertex == corner) else {
                continue;
            };
            let ends = [
                vertices[(at + 1) % count],
                vertices[(at + count - 1) % count],
            ];
            let turns = |from: Vec2, to: Vec2| (from - corner).perp_dot(to - corner);
            match &mut found[..] {
                [first, last] => {
                    if turns(*first, ends[0]) < 0.0 {
                        *first = ends[0];
                    }
                    if turns(*last, ends[1]) > 0.0 {
                        *last = ends[1];
                    }
                }
                _ if count > 1 => found.extend(ends),
                _ => {}
            }
        }
        found
    }

    /// The corners that come down on an edge first when the body turns over `tip`, on either side: those beside it, or where the body is
    /// concave or has several shapes, others that stick out farther. `on_line` tells the place of a corner along the edge, and its height.
    fn first_down(
        &self,
        tip: Vec2,
        (ends, near): ([f64; 2], f64),
        on_line: impl Fn(Vec2) -> (f64, f64),
    ) -> ArrayVec<Vec2, 2> {
        let mut first = self.beside(tip);
        let parts = || self.shapes.iter().flat_map(|shape| hulls(shape));
        if parts().nth(1).is_none() {
            return first;
        }
        let along = on_line(tip).0;
        let solid = parts().filter(|hull| !hull.normals.is_empty() && hull.radius == 0.0);
        for corner in solid.flat_map(|hull| hull.vertices) {
            for (known, side) in first.iter_mut().zip([-1.0, 1.0]) {
                let lands = along + side * (*corner - tip).length();
                let turn = side * (*known - tip).perp_dot(*corner - tip);
                let is_above = |corner: Vec2| on_line(corner).1 >= -near;
                if turn > 0.0
                    && (ends[0] - near..=ends[1] + near).contains(&lands)
                    && is_above(*known)
                    && is_above(*corner)
                {
                    *known = *corner;
                }
            }
        }
        first
    }

    fn edge_line(&self, edge: usize) -> (Vec2, f64, [f64; 2]) {
        let normal = self.hull.normals[edge];
        if self.hull.is_half_plane() {
            let ends = [f64::NEG_INFINITY, f64::INFINITY];
            return (normal, normal.dot(self.hull.vertices[0]), ends);
        }
        let (from, to) = self.hull.edge(edge);
        let (x, y) = (perp(normal).dot(from), perp(normal).dot(to));
        let ends = if x < y { [x, y] } else { [y, x] };
        (normal, normal.dot(from), ends)
    }
}

/// What two parts touch with at a point; `normal` points from A to B.
pub(super) fn joint(
    a: &Held<'_>,
    b: &Held<'_>,
    normal: Vec2,
    point: Vec2,
    points: usize,
    near: f64,
) -> Option<Joint> {
    match (a.is_disc(), b.is_disc()) {
        (true, true) => Some(Joint::Points {
            a: a.hull.vertices[0],
            b: b.hull.vertices[0],
            radii: (a.hull.radius, b.hull.radius),
            cone: None,
        }),
        (false, true) => disc_on(a, b, End::A, normal, near),
        (true, false) => disc_on(b, a, End::B, -normal, near),
        (false, false) => {
            let of_b = corner_on(a, b, End::A, normal, point, points, near);
            let of_a = || corner_on(b, a, End::B, -normal, point, points, near);
            match of_b {
                // Of two corners that meet the one that slides inwards is on the other's edge.
                Some((joint, true)) => Some(of_a().map_or(joint, |(other, _)| other)),
                Some((joint, false)) => Some(joint),
                None => of_a().map(|(joint, _)| joint),
            }
        }
    }
}

/// Whether a point of `other` at `point` is at an end of the edge of `own` with this normal and goes over it: there it is the way it goes
/// that tells edge from corner.
fn goes_over(
    (own, other): (&Held<'_>, &Held<'_>),
    (normal, ends): (Vec2, [f64; 2]),
    point: Vec2,
    room: f64,
) -> bool {
    let t = own.pose.vector(perp(normal));
    let along = t.dot(point - own.pose.position);
    let slip = t.dot(other.moves.velocity_of(point) - own.moves.velocity_of(point));
    along <= ends[0] + room && slip < 0.0 || along >= ends[1] - room && slip > 0.0
}

/// A disc on an edge or a corner of `own`; `outward` points from `own` to the disc.
fn disc_on(own: &Held<'_>, disc: &Held<'_>, owner: End, outward: Vec2, near: f64) -> Option<Joint> {
    let (tip, radius) = (disc.hull.vertices[0], disc.hull.radius);
    let centre = disc.pose.point(tip);
    if let Some(edge) = flush_edge(&own.hull, own.pose, outward) {
        let (normal, height, ends) = own.edge_line(edge);
        let room = near * FLUSH + disc_room(radius, own.pose, disc.pose);
        if !goes_over((own, disc), (normal, ends), centre, room) {
            return Some(Joint::Line {
                owner,
                normal,
                height,
                ends,
                tip,
                radius,
                beside: ArrayVec::new(),
            });
        }
    }
    let (vertex, _) = own.vertex_near(centre)?;
    let corner = own.hull.vertices[vertex];
    let count = own.hull.vertices.len();
    let normals = [
        own.hull.normals[(vertex + count - 1) % count],
        own.hull.normals[vertex],
    ];
    let cone = Some((owner, normals));
    let (a, b) = owner.first(corner, tip);
    let radii = owner.first(0.0, radius);
    Some(Joint::Points { a, b, radii, cone })
}

/// A corner of `other` on an edge of `own`, and whether it goes over its end; `outward` points from `own` to `other`.
fn corner_on(
    own: &Held<'_>,
    other: &Held<'_>,
    owner: End,
    outward: Vec2,
    point: Vec2,
    points: usize,
    near: f64,
) -> Option<(Joint, bool)> {
    let edge = flush_edge(&own.hull, own.pose, outward)?;
    let (vertex, far) = other.vertex_near(point)?;
    if far > near {
        return None;
    }
    let (normal, height, ends) = own.edge_line(edge);
    let local = |corner: Vec2| own.pose.inverse_point(other.pose.point(corner));
    let tip = other.hull.vertices[vertex];
    let along = perp(normal).dot(local(tip));
    if along < ends[0] - near || along > ends[1] + near {
        return None;
    }
    let on_line = |corner: Vec2| {
        let at = local(corner);
        (perp(normal).dot(at), normal.dot(at) - height)
    };
    let mut beside = ArrayVec::new();
    for corner in other.first_down(tip, (ends, near), on_line) {
        // What lies flush is a point of the contact itself, or beyond its end.
        let lies = points > 1 && on_line(corner).1 <= near;
        if !lies && !beside.contains(&corner) {
            beside.push(corner);
        }
    }
    let room = near * FLUSH + end_room(own.pose.position, other.pose.position);
    let over = goes_over((own, other), (normal, ends), other.pose.point(tip), room);
    let joint = Joint::Line {
        owner,
        normal,
        height,
        ends,
        tip,
        radius: 0.0,
        beside,
    };
    Some((joint, over))
}
