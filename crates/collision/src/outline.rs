//! Contact on the true outline only: what pieces of concave polygons must not feel.
//!
//! A cut between two pieces is a valid separating axis, since what lies beyond it is not part of
//! this piece. It is never a contact normal: nothing can touch it.

use carom_math::{Pose, Vec2};

use crate::sat::{Face, best_face, beyond_end, face};
use crate::{AxisFeature, Distance, Hull, Side};

/// Two hulls and their poses in each other's frames.
#[derive(Clone, Copy)]
pub(crate) struct Pair<'a> {
    pub(crate) hulls: [Hull<'a>; 2],
    /// Pose of the other hull in the frame of this one.
    pub(crate) poses: [Pose; 2],
}

impl<'a> Pair<'a> {
    pub(crate) fn new(a: &Hull<'a>, b: &Hull<'a>, b_in_a: Pose) -> Self {
        Self {
            hulls: [*a, *b],
            poses: [b_in_a, b_in_a.inverse()],
        }
    }

    /// Whether one of the hulls is a piece of something larger.
    pub(crate) fn has_cuts(&self) -> bool {
        self.hulls.iter().any(|hull| hull.boundary.is_some())
    }

    /// Whether the outlines can touch along the normal of this edge.
    pub(crate) fn allows(&self, owner: Side, face: Face) -> bool {
        let (own, other) = (owner as usize, 1 - owner as usize);
        self.hulls[own].is_boundary(face.edge) && {
            let local = self.poses[own].inverse_vector(self.hulls[own].normals[face.edge]);
            self.hulls[other].allows(face.vertex, -local)
        }
    }

    /// Whether the outlines can touch along the shortest way between the hulls.
    pub(crate) fn allows_way(&self, way: &Distance) -> bool {
        match way.feature {
            AxisFeature::Edge {
                owner,
                edge,
                vertex,
            } => self.allows(
                owner,
                Face {
                    separation: way.distance,
                    edge,
                    vertex,
                },
            ),
            AxisFeature::Vertices { a, b } => {
                let [hull_a, hull_b] = &self.hulls;
                hull_a.allows(a, way.normal)
                    && hull_b.allows(b, -self.poses[0].inverse_vector(way.normal))
            }
        }
    }

    /// The edge with the least overlap that the outlines can touch along; for overlapping polygons.
    ///
    /// Where another axis overlaps less, an edge must run through the other hull to count: else the
    /// hulls overlap across a cut only, and it is the neighbouring piece that is touched.
    pub(crate) fn least_overlap(&self) -> Option<(Side, Face)> {
        let across_cuts = [Side::A, Side::B].into_iter().any(|owner| {
            let hull = &self.hulls[owner as usize];
            (0..hull.normals.len()).any(|edge| !hull.is_boundary(edge) && self.meets(owner, edge))
        });
        let mut best: Option<(Side, Face)> = None;
        for owner in [Side::A, Side::B] {
            let (own, other) = (owner as usize, 1 - owner as usize);
            for edge in 0..self.hulls[own].normals.len() {
                let face = face(
                    &self.hulls[own],
                    edge,
                    &self.hulls[other],
                    self.poses[own],
                    None,
                );
                if best.is_none_or(|(_, known)| face.separation > known.separation)
                    && self.allows(owner, face)
                    && (!across_cuts || self.meets(owner, edge))
                {
                    best = Some((owner, face));
                }
            }
        }
        best
    }

    /// Whether an edge, as a segment, touches the other hull.
    fn meets(&self, owner: Side, edge: usize) -> bool {
        let (own, other) = (owner as usize, 1 - owner as usize);
        let (from, to) = self.hulls[own].edge(edge);
        let normal = self.hulls[own].normals[edge];
        let segment = Hull {
            vertices: &[from, to],
            normals: &[normal, -normal],
            radius: 0.0,
            blocks: &[],
            boundary: None,
        };
        let other_hull = &self.hulls[other];
        // Rounding of the two faces, as a fraction of the lengths that are in play.
        let slack = 1e-12 * ((to - from).length() + self.poses[own].position.length());
        best_face(&segment, other_hull, self.poses[own]).separation <= slack
            && best_face(other_hull, &segment, self.poses[other]).separation <= slack
    }
}

/// The boundary edge nearest to a disc's centre inside a piece (or inside its neighbours): one that
/// the disc reaches, with the foot of its centre on it. Height of the centre (≤ 0) and edge.
pub(crate) fn nearest_boundary(hull: &Hull<'_>, centre: Vec2, radius: f64) -> Option<(f64, usize)> {
    let mut best: Option<(f64, usize)> = None;
    let mut cut_reached = false;
    for (edge, normal) in hull.normals.iter().enumerate() {
        let height = normal.dot(centre - hull.vertices[edge]);
        if !hull.is_boundary(edge) {
            cut_reached |= height > -radius;
            continue;
        }
        if height > 0.0 {
            // In front of a true edge: what the disc touches, if anything, is nearer than a cut.
            return None;
        }
        if best.is_none_or(|(known, _)| height > known) && beyond_end(hull, edge, centre).is_none()
        {
            best = Some((height, edge));
        }
    }
    best.filter(|(height, _)| !cut_reached || *height > -radius)
}
