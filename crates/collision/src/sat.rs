//! The separating axis theorem on two convex hulls.
//!
//! Two convex polygons are apart exactly if the normal of one of their edges, of either one,
//! separates them. If none does, the normal along which they overlap least is the shortest way out.
//! A circle adds the directions from its centre to the vertices of the other shape.

use carom_math::{Pose, Vec2, perp};

use crate::Hull;
use crate::four;
use crate::lanes::{self, heights};

/// One of the two shapes of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The first shape.
    A,
    /// The second shape.
    B,
}

impl Side {
    /// The one that this is not.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// What of the two hulls an axis comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisFeature {
    /// The normal of an edge, against the vertex of the other hull that is deepest behind it.
    Edge {
        /// The hull that owns the edge.
        owner: Side,
        /// Index of the edge.
        edge: usize,
        /// Index of the vertex of the other hull.
        vertex: usize,
    },
    /// The line through a vertex of each hull.
    Vertices {
        /// Index of A's vertex.
        a: usize,
        /// Index of B's vertex.
        b: usize,
    },
}

impl AxisFeature {
    /// The same with A and B exchanged.
    #[must_use]
    pub const fn swapped(self) -> Self {
        match self {
            Self::Edge {
                owner,
                edge,
                vertex,
            } => Self::Edge {
                owner: owner.other(),
                edge,
                vertex,
            },
            Self::Vertices { a, b } => Self::Vertices { a: b, b: a },
        }
    }
}

/// A direction and how far apart two hulls are along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Gap along the normal in metres; below zero the hulls overlap by as much.
    pub separation: f64,
    /// Unit normal in A's frame, from A to B.
    pub normal: Vec2,
    /// Where the axis comes from.
    pub feature: AxisFeature,
}

/// The axis along which two hulls are farthest apart, or overlap least.
///
/// Polygons: the largest separation over all n + m edge normals; it is the distance where an edge
/// is closest, less than the distance where two vertices are, and the depth of the overlap where
/// it is negative. A circle: the true distance in every case. A half-plane: along its normal. Among
/// equals A's edges come first, then the lowest index. Centres of circles that coincide have A's x
/// axis as their normal. Two half-planes overlap without end, −∞, unless they face each other exactly.
///
/// # Examples
/// ```
/// use carom_collision::{Convex, separating_axis};
/// use carom_geometry::ConvexPolygon;
/// use carom_math::{Pose, vec2};
/// let square = ConvexPolygon::square(2.0)?;                                    // m
/// let axis = separating_axis(&square.hull(), &square.hull(), Pose::at(vec2(1.5, 0.25)));
/// assert_eq!((axis.separation, axis.normal), (-0.5, vec2(1.0, 0.0)));
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn separating_axis(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Axis {
    if b.is_disc() {
        return point_axis(a, b_in_a.point(b.vertices[0]), b.radius);
    }
    if a.is_disc() {
        let axis = point_axis(b, b_in_a.inverse_point(a.vertices[0]), a.radius);
        return axis.of_swapped(b_in_a);
    }
    let poses = [b_in_a, b_in_a.inverse()];
    let widest = [widest_edge(a, b, poses[0]), widest_edge(b, a, poses[1])];
    wider_axis([a, b], poses, widest)
}

/// [`separating_axis`] of two polygons or segments with known widest edges; `poses`: of the other hull in the
/// frame of each.
pub(crate) fn wider_axis([a, b]: [&Hull<'_>; 2], poses: [Pose; 2], widest: [Widest; 2]) -> Axis {
    let [of_a, of_b] = widest;
    let axis = if of_b.separation > of_a.separation {
        let face = of_b.face(b, a, poses[1]);
        face.axis(b, Side::A).of_swapped(poses[0])
    } else {
        of_a.face(a, b, poses[0]).axis(a, Side::A)
    };
    if a.normals.len() == 2 && b.normals.len() == 2 {
        return along_segments(a, b, poses[0], axis);
    }
    axis
}

/// The shortest translation of B that ends the overlap, in metres in A's frame; `None` if apart, or
/// if there is no such way: two half-planes.
///
/// The thesis's minimum push vector, pointing away from A. Zero if the shapes touch.
///
/// # Examples
/// ```
/// use carom_collision::{Convex, minimum_push};
/// use carom_geometry::ConvexPolygon;
/// use carom_math::{Pose, vec2};
/// let square = ConvexPolygon::square(2.0)?;                                    // m
/// let push = |x| minimum_push(&square.hull(), &square.hull(), Pose::at(vec2(x, 0.0)));
/// assert_eq!(push(-1.5), Some(vec2(-0.5, 0.0)));
/// assert_eq!(push(2.5), None);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn minimum_push(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Option<Vec2> {
    let axis = separating_axis(a, b, b_in_a);
    (axis.separation <= 0.0 && axis.separation.is_finite()).then(|| axis.normal * -axis.separation)
}

/// An edge of one hull and the vertex of the other that is deepest behind it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub(crate) separation: f64,
    pub(crate) edge: usize,
    pub(crate) vertex: usize,
}

/// The edge of `own` that separates `other` most, or the least deep one.
pub(crate) fn best_face(own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> Face {
    widest_edge(own, other, other_in_own).face(own, other, other_in_own)
}

/// The edge of a hull that separates another most (the first of equals).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Widest {
    pub(crate) separation: f64,
    pub(crate) edge: usize,
}

impl Widest {
    pub(crate) fn face(self, own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> Face {
        face(own, self.edge, other, other_in_own, None)
    }
}

/// The edge of `own` that separates `other` most: the bits of [`widest_edge_by_edge`].
#[inline]
pub(crate) fn widest_edge(own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> Widest {
    if let (Some(mine), Some(theirs)) = (four::only(own), four::only(other)) {
        let (rotation, position) = (other_in_own.rotation, other_in_own.position);
        let (edge, height) = four::widest_edge(mine, theirs, rotation, position);
        let separation = height - other.radius - own.radius;
        return Widest { separation, edge };
    }
    widest_of_many(own, other, other_in_own)
}

fn widest_of_many(own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> Widest {
    /// Above this many vertices of the other, edges are left out by a look at one of them.
    const WIDE: usize = 12;
    if own.blocks.is_empty() || other.is_half_plane() || other.vertices.len() > WIDE {
        return widest_edge_by_edge(own, other, other_in_own);
    }
    let mut best = Widest {
        separation: f64::NEG_INFINITY,
        edge: 0,
    };
    let (rotation, position) = (other_in_own.rotation, other_in_own.position);
    for (number, block) in own.blocks.iter().enumerate() {
        let four = heights(block, other, rotation, position);
        for (lane, height) in four.into_iter().enumerate() {
            let separation = height - other.radius - own.radius;
            if separation > best.separation {
                best.separation = separation;
                best.edge = 4 * number + lane;
            }
        }
    }
    best
}

/// One edge after the other; what [`widest_edge`] is held against.
fn widest_edge_by_edge(own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> Widest {
    let mut best = Widest {
        separation: f64::NEG_INFINITY,
        edge: 0,
    };
    let mut hint = None;
    for edge in 0..own.normals.len() {
        // Nothing is less far beyond the edge than the deepest vertex, rounded alike: one vertex is
        // enough to see that the edge does not separate more.
        if let Some(vertex) = hint
            && beyond(own, edge, other, other_in_own, vertex) <= best.separation
        {
            continue;
        }
        let face = face(own, edge, other, other_in_own, hint);
        hint = Some(face.vertex);
        if face.separation > best.separation {
            best.separation = face.separation;
            best.edge = edge;
        }
    }
    best
}

/// How far one vertex of `other` is beyond an edge of `own`: the arithmetic of [`face`]. Of a
/// half-plane nothing is known.
fn beyond(own: &Hull<'_>, edge: usize, other: &Hull<'_>, other_in_own: Pose, vertex: usize) -> f64 {
    if other.is_half_plane() {
        return f64::INFINITY;
    }
    let normal = own.normals[edge];
    let along = other_in_own
        .inverse_vector(normal)
        .dot(other.vertices[vertex]);
    separation(own, edge, other, other_in_own, along)
}

/// The separation along an edge, from the height of the deepest vertex in its own frame.
fn separation(
    own: &Hull<'_>,
    edge: usize,
    other: &Hull<'_>,
    other_in_own: Pose,
    along: f64,
) -> f64 {
    let normal = own.normals[edge];
    along + normal.dot(other_in_own.position - own.vertices[edge]) - other.radius - own.radius
}

/// Whether both are half-planes, each in front of the other one's line.
fn face_each_other(own: &Hull<'_>, other: &Hull<'_>, other_in_own: Pose) -> bool {
    let local = other_in_own.vector(other.normals[0]);
    own.is_half_plane() && local == -own.normals[0]
}

/// How far `other` is beyond one edge of `own`; `hint` is the deepest vertex of the edge before.
#[inline]
pub(crate) fn face(
    own: &Hull<'_>,
    edge: usize,
    other: &Hull<'_>,
    other_in_own: Pose,
    hint: Option<usize>,
) -> Face {
    if other.is_half_plane() && !face_each_other(own, other, other_in_own) {
        // It goes on without end behind every edge.
        return Face {
            separation: f64::NEG_INFINITY,
            edge,
            vertex: 0,
        };
    }
    // n·(R v + t − p) = (Rᵀ n)·v + n·(t − p): the vertices stay in their own frame.
    let normal = own.normals[edge];
    let local = other_in_own.inverse_vector(normal);
    let (vertex, along) = lowest(other, local, hint);
    Face {
        separation: separation(own, edge, other, other_in_own, along),
        edge,
        vertex,
    }
}

/// The vertex that is lowest along `direction`, and its height.
#[inline]
fn lowest(hull: &Hull<'_>, direction: Vec2, hint: Option<usize>) -> (usize, f64) {
    /// Above this many vertices a walk along the outline is cheaper than a look at all.
    const WALK_ABOVE: usize = 12;
    if let Some(block) = four::only(hull) {
        return four::lowest(block, direction);
    }
    let height = |i: usize| direction.dot(hull.vertices[i]);
    match hint {
        Some(start) if hull.vertices.len() > WALK_ABOVE => {
            // Heights fall and then rise once around a convex outline.
            let mut best = (start, height(start));
            for step in [Hull::next, Hull::previous] {
                let beside = |i: usize| {
                    let i = step(hull, i);
                    (i, height(i))
                };
                let mut next = beside(best.0);
                // It ends where a height is no number, too.
                while next.1 < best.1 {
                    best = next;
                    next = beside(best.0);
                }
            }
            best
        }
        None if hull.vertices.len() > WALK_ABOVE => {
            // The other edges walk, and leave the blocks alone: they stay out of the cache.
            lanes::lowest(
                &Hull {
                    blocks: &[],
                    ..*hull
                },
                direction,
            )
        }
        _ => lanes::lowest(hull, direction),
    }
}

impl Face {
    /// As an axis in the frame of `own`, the hull with the edge.
    fn axis(self, own: &Hull<'_>, owner: Side) -> Axis {
        Axis {
            separation: self.separation,
            normal: own.normals[self.edge],
            feature: AxisFeature::Edge {
                owner,
                edge: self.edge,
                vertex: self.vertex,
            },
        }
    }
}

impl Axis {
    /// The axis of (A, B), from the one of (B, A) in B's frame.
    fn of_swapped(self, b_in_a: Pose) -> Self {
        Self {
            separation: self.separation,
            normal: -b_in_a.vector(self.normal),
            feature: self.feature.swapped(),
        }
    }
}

/// The axis from a hull to a disc about `centre`, in the frame of the hull: face or vertex region.
fn point_axis(hull: &Hull<'_>, centre: Vec2, radius: f64) -> Axis {
    let radii = hull.radius + radius;
    let edge_axis = |height: f64, edge: usize| Axis {
        separation: height - radii,
        normal: hull.normals[edge],
        feature: AxisFeature::Edge {
            owner: Side::A,
            edge,
            vertex: 0,
        },
    };
    let vertex_axis = |vertex: usize, fallback: Vec2| {
        let way = centre - hull.vertices[vertex];
        let length = way.length();
        let unit = if length > 0.0 { way / length } else { fallback };
        Axis {
            separation: length - radii,
            normal: unit,
            feature: AxisFeature::Vertices { a: vertex, b: 0 },
        }
    };
    match hull.normals.len() {
        0 => return vertex_axis(0, Vec2::X),
        2 => {
            // Without thickness there is no inside: the side, then the ends.
            let height = hull.normals[0].dot(centre - hull.vertices[0]);
            let edge = usize::from(height < 0.0);
            return match beyond_end(hull, 0, centre) {
                Some(vertex) => vertex_axis(vertex, hull.normals[edge]),
                None => edge_axis(height.abs(), edge),
            };
        }
        _ => {}
    }
    let mut highest = (f64::NEG_INFINITY, 0);
    let mut nearest: Option<Axis> = None;
    for (edge, normal) in hull.normals.iter().enumerate() {
        let height = normal.dot(centre - hull.vertices[edge]);
        if height > highest.0 {
            highest = (height, edge);
        }
        if height > 0.0 {
            // Outside: the distance to the edge itself, which ends.
            let candidate = match beyond_end(hull, edge, centre) {
                Some(vertex) => vertex_axis(vertex, *normal),
                None => edge_axis(height, edge),
            };
            if nearest.is_none_or(|known| candidate.separation < known.separation) {
                nearest = Some(candidate);
            }
        }
    }
    nearest.unwrap_or_else(|| edge_axis(highest.0, highest.1))
}

/// The end of an edge that `point` lies beyond, along the edge.
pub(crate) fn beyond_end(hull: &Hull<'_>, edge: usize, point: Vec2) -> Option<usize> {
    let (from, to) = hull.edge(edge);
    let along = to - from;
    if (point - from).dot(along) < 0.0 {
        Some(edge)
    } else if (point - to).dot(along) > 0.0 {
        Some(hull.next(edge))
    } else {
        None
    }
}

/// The directions of two segments, both ways, in A's frame.
pub(crate) fn along_both(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> [Vec2; 4] {
    let (of_a, of_b) = (perp(a.normals[0]), b_in_a.vector(perp(b.normals[0])));
    [of_a, -of_a, of_b, -of_b]
}

/// Two segments on one line are apart along that line, which no normal shows.
fn along_segments(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Axis {
    let ends = [b_in_a.point(b.vertices[0]), b_in_a.point(b.vertices[1])];
    let mut best = axis;
    for direction in along_both(a, b, b_in_a) {
        let heights = |p: &[Vec2]| [direction.dot(p[0]), direction.dot(p[1])];
        let (of_a, of_b) = (heights(a.vertices), heights(&ends));
        let (high, low) = (
            usize::from(of_a[1] > of_a[0]),
            usize::from(of_b[1] < of_b[0]),
        );
        let separation = of_b[low] - of_a[high];
        if separation > 0.0 && separation > best.separation {
            best = Axis {
                separation,
                normal: direction,
                feature: AxisFeature::Vertices { a: high, b: low },
            };
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use carom_geometry::ConvexPolygon;
    use carom_math::{Rot, vec2};
    use proptest::prelude::*;

    use super::*;
    use crate::Convex;

    proptest! {
        #[test]
        fn four_edges_at_a_time_have_the_bits_of_one_by_one(
            sides in 3..14_usize, other in 3..20_usize, turn in -4.0..4.0_f64, tidy in any::<bool>(), x in -2.0..2.0_f64, y in -2.0..2.0_f64,
        ) {
            let (a, b) = (ConvexPolygon::regular(sides, 1.0).unwrap(), ConvexPolygon::regular(other, 0.7).unwrap());
            let rotation = if tidy { Rot::from_degrees((turn * 4.0).round() * 30.0) } else { Rot::from_angle(turn) };
            let pose = Pose::new(vec2(x, y), rotation);
            let (fast, slow) = (widest_edge(&a.hull(), &b.hull(), pose), widest_edge_by_edge(&a.hull(), &b.hull(), pose));
            prop_assert_eq!((fast.separation.to_bits(), fast.edge), (slow.separation.to_bits(), slow.edge));
        }
    }
}
