//! What touches at the instant: the ends of a common stretch, and their features.

use carom_math::within;

use super::approach::{Approach, Axis};
use crate::{AxisFeature, Hull, Side};

/// An end of the stretch along which vertices touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Metres along the tangent.
    pub(super) along: f64,
    pub(super) vertices: [usize; 2],
}

/// The stretch that a face and the vertices on it have in common, from low to high along the tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) ends: [End; 2],
}

impl Stretch {
    pub(super) const fn at(end: End) -> Self {
        Self { ends: [end, end] }
    }

    pub(super) fn and(mut self, end: End) -> Self {
        if end.along < self.ends[0].along {
            self.ends[0] = end;
        }
        if end.along > self.ends[1].along {
            self.ends[1] = end;
        }
        self
    }

    /// What touches at each end along a direction that no edge gives, or against a face without ends.
    pub(super) fn features(&self, axis: Axis) -> [AxisFeature; 2] {
        self.ends.map(|end| feature(axis, end.vertices))
    }

    /// The part of it that is on the face of `owner`, with corners at `face` (from, to), and what
    /// touches at its ends. Where the face ends first its corner touches the other's edge; where
    /// nothing but corners meet, corners touch. Ends within `near` metres of a corner are on the face.
    pub(super) fn on_face(
        &self,
        approach: &Approach<'_>,
        (owner, edge): (usize, usize),
        face: (f64, f64),
        near: f64,
    ) -> ([f64; 2], [AxisFeature; 2]) {
        let (own, other) = (&approach.hulls[owner], &approach.hulls[1 - owner]);
        let [low, high] = self.ends;
        let (e0, e1) = (face.0.min(face.1), face.0.max(face.1));
        let stretch = [low, high].map(|end| within(end.along, e0, e1));
        let corners = if face.0 <= face.1 {
            [edge, own.next(edge)]
        } else {
            [own.next(edge), edge]
        };
        let vertices = [low, high].map(|end| end.vertices[1 - owner]);
        let cut = [low.along < e0 - near, high.along > e1 + near];
        let mut features = self.features(Axis::Edge { owner, edge });
        let point = stretch[1] - stretch[0] <= near;
        for k in [0, 1] {
            if point && (cut[0] || cut[1]) {
                let end = usize::from(cut[1]);
                features[k] = corner_on_corner(owner, corners[end], vertices[1 - end]);
            } else if cut[k] {
                features[k] = AxisFeature::Edge {
                    owner: side(1 - owner),
                    edge: between(other, vertices),
                    vertex: corners[k],
                };
            }
        }
        (stretch, features)
    }
}

const fn side(k: usize) -> Side {
    if k == 0 { Side::A } else { Side::B }
}

const fn feature(axis: Axis, vertices: [usize; 2]) -> AxisFeature {
    match axis {
        Axis::Edge { owner, edge } => AxisFeature::Edge {
            owner: side(owner),
            edge,
            vertex: vertices[1 - owner],
        },
        Axis::World { .. } => AxisFeature::Vertices {
            a: vertices[0],
            b: vertices[1],
        },
    }
}

const fn corner_on_corner(owner: usize, own: usize, other: usize) -> AxisFeature {
    if owner == 0 {
        AxisFeature::Vertices { a: own, b: other }
    } else {
        AxisFeature::Vertices { a: other, b: own }
    }
}

/// The edge between two vertices; of nearly straight corners the first on the way.
fn between(hull: &Hull<'_>, [i, j]: [usize; 2]) -> usize {
    if hull.next(j) == i { j } else { i }
}
