//! The nearest features of two convex polygons that are apart: corners and edges.
//!
//! Many corners: a walk. Take a corner of each and the nearest way between them, their edges and
//! their neighbours. If no corner of either is nearer along that way, it is the shortest of all, since
//! the shapes are convex; else go on from the corners that are.

use arrayvec::ArrayVec;
use carom_math::{Pose, Vec2};

use crate::distance::on_edge;
use crate::sat::beyond_end;
use crate::{Axis, AxisFeature, Distance, Hull, Side};

/// Corners of both together up to which a look at all pairs is faster than the walk.
const FEW: usize = 8;

/// The shortest way, from the neighbourhood of an axis that separates.
pub(crate) fn nearest_features(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Distance {
    if a.vertices.len() + b.vertices.len() > FEW
        && let Some(found) = walk(a, b, b_in_a, axis)
    {
        return found;
    }
    look_at_all(a, b, b_in_a)
}

fn look_at_all(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Distance {
    let corners = (Corner::all(a, b_in_a.inverse()), Corner::all(b, b_in_a));
    nearest_of(a, b, b_in_a, &corners.0, &corners.1)
}

/// A corner of one hull, and where the other hull's frame sees it.
#[derive(Clone, Copy, Debug)]
struct Corner {
    index: usize,
    seen: Vec2,
}

impl Corner {
    fn new(hull: &Hull<'_>, index: usize, in_other: Pose) -> Self {
        Self {
            index,
            seen: in_other.point(hull.vertices[index]),
        }
    }

    fn all(hull: &Hull<'_>, in_other: Pose) -> SmallList {
        let corners = (0..hull.vertices.len()).map(|i| Self::new(hull, i, in_other));
        if hull.vertices.len() <= FEW {
            SmallList::Few(corners.collect())
        } else {
            SmallList::Many(corners.collect())
        }
    }

    /// A corner and its two neighbours, in order.
    fn beside(hull: &Hull<'_>, corner: usize, in_other: Pose) -> ArrayVec<Self, 3> {
        let mut found: ArrayVec<usize, 3> =
            ArrayVec::from([hull.previous(corner), corner, hull.next(corner)]);
        found.sort_unstable();
        if hull.vertices.len() == 2 {
            found = ArrayVec::from_iter([0, 1]);
        }
        let corners = found.into_iter();
        corners.map(|i| Self::new(hull, i, in_other)).collect()
    }
}

/// Corners without a trip to the heap where they are few.
enum SmallList {
    Few(ArrayVec<Corner, FEW>),
    Many(Vec<Corner>),
}

impl core::ops::Deref for SmallList {
    type Target = [Corner];

    fn deref(&self) -> &[Corner] {
        match self {
            Self::Few(corners) => corners,
            Self::Many(corners) => corners,
        }
    }
}

fn walk(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Option<Distance> {
    /// Steps of the walk before a look at all decides.
    const STEPS: usize = 16;
    /// What a way may be longer than the bound that its own direction gives, as a fraction of the
    /// sizes: rounding. Corners that tie with the nearest ones are their neighbours.
    const TIE: f64 = 1e-14;
    let size = a.vertices[0].length() + b.vertices[0].length() + b_in_a.position.length();
    let a_in_b = b_in_a.inverse();
    let mut normal = axis.normal;
    let mut before = None;
    for _ in 0..STEPS {
        let (i, high) = a.support(normal);
        let (j, low) = b.support(b_in_a.inverse_vector(-normal));
        if let Some((way, corners)) = before {
            let way: Distance = way;
            let bound = normal.dot(b_in_a.position) - low - high;
            if way.distance - bound <= TIE * size {
                return Some(way);
            }
            if corners == (i, j) {
                // Rounding leads nowhere: a look at all decides.
                return None;
            }
        }
        let beside = (Corner::beside(a, i, a_in_b), Corner::beside(b, j, b_in_a));
        let way = nearest_of(a, b, b_in_a, &beside.0, &beside.1);
        normal = way.normal;
        before = Some((way, (i, j)));
    }
    None
}

/// The shortest way among some corners of each and the edges that start at them; the first of equals,
/// corners before edges.
fn nearest_of(
    a: &Hull<'_>,
    b: &Hull<'_>,
    b_in_a: Pose,
    of_a: &[Corner],
    of_b: &[Corner],
) -> Distance {
    let mut best = corner_on_corner(a, of_a, of_b);
    let mut over = |owner: Side, edge: usize, corner: &Corner| {
        let own = if owner == Side::A { a } else { b };
        let point = corner.seen;
        let height = own.normals[edge].dot(point - own.vertices[edge]);
        if height > 0.0 && height < best.distance && beyond_end(own, edge, point).is_none() {
            let normal = match owner {
                Side::A => own.normals[edge],
                Side::B => -b_in_a.vector(own.normals[edge]),
            };
            let feature = AxisFeature::Edge {
                owner,
                edge,
                vertex: corner.index,
            };
            let axis = Axis {
                separation: height,
                normal,
                feature,
            };
            best = on_edge(a, b, b_in_a, axis);
        }
    };
    for edge in of_a {
        for corner in of_b {
            over(Side::A, edge.index, corner);
        }
    }
    for edge in of_b {
        for corner in of_a {
            over(Side::B, edge.index, corner);
        }
    }
    best
}

/// The nearest two corners.
fn corner_on_corner(a: &Hull<'_>, of_a: &[Corner], of_b: &[Corner]) -> Distance {
    let mut best = (f64::INFINITY, 0, 0, Vec2::ZERO);
    for corner in of_b {
        for of_a in of_a {
            let square = (corner.seen - a.vertices[of_a.index]).length_squared();
            if square < best.0 {
                best = (square, of_a.index, corner.index, corner.seen);
            }
        }
    }
    let (_, i, j, point_b) = best;
    let point_a = a.vertices[i];
    let way = point_b - point_a;
    let length = way.length();
    Distance {
        distance: length,
        point_a,
        point_b,
        normal: way / length,
        feature: AxisFeature::Vertices { a: i, b: j },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Convex, separating_axis};
    use carom_geometry::ConvexPolygon;
    use carom_math::{Rot, vec2};
    use proptest::prelude::*;

    fn polygon() -> impl Strategy<Value = ConvexPolygon> {
        let ring = prop::collection::vec((0.0..6.3_f64, 0.5..1.0_f64), 3..40);
        let ring = ring.prop_filter_map("on a line", |corners| {
            let points = corners
                .iter()
                .map(|(turn, r)| Rot::from_angle(*turn).x_axis() * *r);
            ConvexPolygon::hull(points.collect::<Vec<Vec2>>()).ok()
        });
        let regular = (3..40_usize).prop_map(|n| ConvexPolygon::regular(n, 1.0).expect("regular"));
        prop_oneof![ring, regular]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn the_walk_gives_the_bits_of_a_look_at_all(a in polygon(), b in polygon(), x in -4.0..4.0_f64, y in -4.0..4.0_f64, turn in -4.0..4.0_f64, tidy in any::<bool>()) {
            let rotation = if tidy { Rot::from_degrees((turn * 4.0).round() * 30.0) } else { Rot::from_angle(turn) };
            let pose = Pose::new(vec2(x, y), rotation);
            let (a, b) = (a.hull(), b.hull());
            let axis = separating_axis(&a, &b, pose);
            if axis.separation > 0.0
                && let Some(found) = walk(&a, &b, pose, axis)
            {
                let all = look_at_all(&a, &b, pose);
                prop_assert_eq!(found, all);
            }
        }
    }
}
