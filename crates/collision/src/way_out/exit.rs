//! The sides and round corners of the set of translations for which two parts overlap.

use arrayvec::ArrayVec;
use carom_math::{Pose, Vec2, cross, perp, vec2};

use crate::sat::{Face, face};
use crate::{Hull, Side};

/// A way to leave the set: what lies beyond one side, or before one round corner.
#[derive(Clone, Copy)]
pub(super) enum Exit {
    /// k·t ≥ d: B goes by d along the unit normal k in A's frame, from A to B.
    Side {
        normal: Vec2,
        depth: f64,
        edge: (Side, Face),
    },
    /// |t − c| ≥ r between the normals of two edges: a vertex of a polygon against a disc. Without
    /// edges all around: two discs.
    Corner {
        centre: Vec2,
        radius: f64,
        /// Unit directions u of the edges before and after: u·(t − c) ≥ 0 and ≤ 0.
        edges: Option<[Vec2; 2]>,
    },
}

/// A line k·t = d or a circle that bounds what lies beyond an exit.
#[derive(Clone, Copy)]
enum Curve {
    Line(Vec2, f64),
    Circle(Vec2, f64),
}

impl Exit {
    /// How far a translation is beyond this, in metres.
    pub(super) fn height(&self, t: Vec2) -> f64 {
        match *self {
            Self::Side { normal, depth, .. } => normal.dot(t) - depth,
            Self::Corner { centre, radius, .. } => {
                let from = t - centre;
                (from.length() - radius).min(self.within(from))
            }
        }
    }

    /// How far a vector from the centre of a corner is between the normals of its edges.
    fn within(&self, from: Vec2) -> f64 {
        match *self {
            Self::Corner {
                edges: Some([before, after]),
                ..
            } => before.dot(from).min(-after.dot(from)),
            _ => f64::INFINITY,
        }
    }

    /// The unit normal and how deep B is along it where the way ends on this, up to a slack; where a
    /// corner goes over into a side the side has it.
    pub(super) fn tight(&self, way: Vec2, slack: f64) -> Option<(Vec2, f64)> {
        match *self {
            Self::Side { normal, depth, .. } => {
                (self.height(way).abs() <= slack).then_some((normal, depth))
            }
            Self::Corner { centre, radius, .. } => {
                let from = way - centre;
                let normal = from.try_normalize()?;
                let ends = (from.length() - radius).abs() <= slack && self.within(from) > slack;
                ends.then(|| (normal, normal.dot(centre) + radius))
            }
        }
    }

    /// Equal for equal conditions. Equal points can stand for others that lead elsewhere.
    pub(super) fn bits(&self) -> [u64; 3] {
        match *self {
            Self::Side { normal, depth, .. } => [normal.x, normal.y, depth],
            Self::Corner { centre, radius, .. } => [centre.x, centre.y, radius],
        }
        .map(f64::to_bits)
    }

    pub(super) const fn is_corner(&self) -> bool {
        matches!(self, Self::Corner { .. })
    }

    /// The points nearest to 0 on what bounds this, one for each line or arc.
    pub(super) fn nearest(&self) -> ArrayVec<Vec2, 3> {
        let mut points = ArrayVec::new();
        match *self {
            Self::Side { normal, depth, .. } => points.push(normal * depth),
            Self::Corner {
                centre,
                radius,
                edges,
            } => {
                // Centres that coincide part along A's x axis.
                let ahead = (-centre).try_normalize().unwrap_or(Vec2::X);
                points.push(centre + ahead * radius);
                for edge in edges.into_iter().flatten() {
                    let normal = -perp(edge);
                    points.push(centre + normal * radius.max(-centre.dot(normal)));
                }
            }
        }
        points
    }

    fn curves(&self) -> ArrayVec<Curve, 3> {
        let mut curves = ArrayVec::new();
        match *self {
            Self::Side { normal, depth, .. } => curves.push(Curve::Line(normal, depth)),
            Self::Corner {
                centre,
                radius,
                edges,
            } => {
                curves.push(Curve::Circle(centre, radius));
                let lines = edges.into_iter().flatten();
                curves.extend(lines.map(|edge| Curve::Line(edge, edge.dot(centre))));
            }
        }
        curves
    }

    /// Where what bounds this meets what bounds another one.
    pub(super) fn meetings(&self, other: &Self) -> Vec<Vec2> {
        let mut points = Vec::new();
        for p in self.curves() {
            for q in other.curves() {
                points.extend(meet(p, q));
            }
        }
        points
    }
}

/// The points that two curves have in common.
fn meet(p: Curve, q: Curve) -> ArrayVec<Vec2, 2> {
    let mut points = ArrayVec::new();
    match (p, q) {
        (Curve::Line(p, d), Curve::Line(q, e)) => {
            let sine = cross(p, q);
            if sine != 0.0 {
                // p·t = d, q·t = e: t = (d q⊥ − e p⊥) / (p × q), turned backwards.
                points.push(vec2(d * q.y - e * p.y, e * p.x - d * q.x) / sine);
            }
        }
        (Curve::Line(normal, depth), Curve::Circle(centre, radius))
        | (Curve::Circle(centre, radius), Curve::Line(normal, depth)) => {
            let height = depth - normal.dot(centre);
            let half = (radius - height) * (radius + height);
            if half >= 0.0 {
                let (foot, along) = (centre + normal * height, perp(normal) * half.sqrt());
                points.extend([foot - along, foot + along]);
            }
        }
        (Curve::Circle(centre, radius), Curve::Circle(other, others)) => {
            let apart = other - centre;
            let squared = apart.length_squared();
            if squared > 0.0 {
                // From |t| = r and |t − a| = s: t·a = (a² + r² − s²) / 2.
                let share = 0.5 + (radius - others) * (radius + others) / (2.0 * squared);
                let half = radius * radius / squared - share * share;
                if half >= 0.0 {
                    let (foot, along) = (centre + apart * share, perp(apart) * half.sqrt());
                    points.extend([foot - along, foot + along]);
                }
            }
        }
    }
    points
}

/// All ways out of the set of translations for which two parts overlap.
pub(super) fn exits(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Vec<Exit> {
    let mut exits = Vec::new();
    let poses = [b_in_a, b_in_a.inverse()];
    for owner in [Side::A, Side::B] {
        let (own, other) = match owner {
            Side::A => (a, b),
            Side::B => (b, a),
        };
        for edge in 0..own.normals.len() {
            let face = face(own, edge, other, poses[owner as usize], None);
            let normal = match owner {
                Side::A => own.normals[edge],
                Side::B => -b_in_a.vector(own.normals[edge]),
            };
            if face.separation.is_finite() {
                exits.push(Exit::Side {
                    normal,
                    depth: -face.separation,
                    edge: (owner, face),
                });
            }
        }
    }
    let radius = a.radius + b.radius;
    if a.is_disc() || b.is_disc() {
        for i in 0..a.vertices.len() {
            for j in 0..b.vertices.len() {
                let centre = a.vertices[i] - b_in_a.point(b.vertices[j]);
                // Edges run along A's outline, and against B's.
                let edges = match (a.normals.len(), b.normals.len()) {
                    (0, 0) => None,
                    (1, _) | (_, 1) => continue,
                    (_, 0) => Some([a.previous(i), i].map(|edge| perp(a.normals[edge]))),
                    _ => Some([b.previous(j), j].map(|edge| b_in_a.vector(-perp(b.normals[edge])))),
                };
                exits.push(Exit::Corner {
                    centre,
                    radius,
                    edges,
                });
            }
        }
    }
    exits
}
