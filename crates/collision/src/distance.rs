//! How far two shapes are apart, and where they are closest.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2, cross, perp};

use crate::features::nearest_features;
use crate::nearest::nearest_parts;
use crate::parts::is_single;
use crate::sat::beyond_end;
use crate::{Axis, AxisFeature, Hull, Side, part, separating_axis};

/// The shortest way between two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Metres between the shapes; 0 exactly when they touch or overlap.
    pub distance: f64,
    /// Closest point of A, in A's frame; a common point if they overlap.
    pub point_a: Vec2,
    /// Closest point of B, in A's frame; a common point if they overlap.
    pub point_b: Vec2,
    /// Unit normal in A's frame, from A to B; that of the least overlap if they overlap.
    pub normal: Vec2,
    /// What is closest, or overlaps least.
    pub feature: AxisFeature,
}

impl Distance {
    /// From a shape without parts.
    const fn nowhere() -> Self {
        Self {
            distance: f64::INFINITY,
            point_a: Vec2::NAN,
            point_b: Vec2::NAN,
            normal: Vec2::ZERO,
            feature: AxisFeature::Vertices { a: 0, b: 0 },
        }
    }

    /// Vertices of A and B nearest to the way.
    pub(crate) fn vertices(&self, a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> (usize, usize) {
        let nearer_end = |hull: &Hull<'_>, edge: usize, point: Vec2| {
            let (from, to) = hull.edge(edge);
            if (point - to).length_squared() < (point - from).length_squared() {
                hull.next(edge)
            } else {
                edge
            }
        };
        match self.feature {
            AxisFeature::Edge {
                owner: Side::A,
                edge,
                vertex,
            } => (nearer_end(a, edge, self.point_a), vertex),
            AxisFeature::Edge { edge, vertex, .. } => {
                let point = b_in_a.inverse_point(self.point_b);
                (vertex, nearer_end(b, edge, point))
            }
            AxisFeature::Vertices { a, b } => (a, b),
        }
    }
}

/// The distance of two hulls with its witness points.
///
/// Cuts of pieces count like any edge here: the distance is that of the piece.
///
/// # Examples
/// ```
/// use carom_collision::{Convex, distance};
/// use carom_geometry::{Circle, ConvexPolygon};
/// use carom_math::{Pose, vec2};
/// let square = ConvexPolygon::square(2.0)?;                                    // m
/// let disc = Circle::new(1.0)?;
/// let way = distance(&square.hull(), &disc.hull(), Pose::at(vec2(4.0, 5.0)));
/// assert_eq!(way.distance, 4.0);                                               // m, 5 − 1
/// assert_eq!(way.point_a, vec2(1.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn distance(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Distance {
    let axis = separating_axis(a, b, b_in_a);
    if a.is_disc() || b.is_disc() {
        return round_distance(a, b, b_in_a, axis);
    }
    if axis.separation > 0.0 {
        return closest(a, b, b_in_a, axis);
    }
    let common = if a.is_half_plane() && b.is_half_plane() {
        behind_both(a, b, b_in_a)
    } else {
        common_point(a, b, b_in_a, axis)
    };
    touching(axis, common)
}

/// The distance of any two shapes: the least over their convex parts.
///
/// The feature's indices are those of the closest parts.
///
/// # Examples
/// ```
/// use carom_collision::shape_distance;
/// use carom_geometry::{ConvexPolygon, Polygon};
/// use carom_math::{Pose, vec2};
/// // A small box in the hollow of a U, a quarter metre from each of its three walls.
/// let u = Polygon::new([
///     vec2(-2.0, -2.0), vec2(2.0, -2.0), vec2(2.0, 2.0), vec2(1.0, 2.0),
///     vec2(1.0, -1.0), vec2(-1.0, -1.0), vec2(-1.0, 2.0), vec2(-2.0, 2.0),
/// ])?;
/// let small = ConvexPolygon::square(1.5)?;
/// let way = shape_distance(&u.into(), &small.into(), Pose::IDENTITY);
/// assert_eq!(way.distance, 0.25);                                              // m
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn shape_distance(a: &Shape, b: &Shape, b_in_a: Pose) -> Distance {
    if is_single(a) && is_single(b) {
        return distance(&part(a, 0), &part(b, 0), b_in_a);
    }
    nearest_parts(a, b, b_in_a).unwrap_or_else(Distance::nowhere)
}

/// The shortest way between two polygons or segments with this separating axis, or `None` if they touch or overlap.
pub(crate) fn apart(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Option<Distance> {
    (axis.separation > 0.0).then(|| closest(a, b, b_in_a, axis))
}

fn touching(axis: Axis, common: Vec2) -> Distance {
    Distance {
        distance: 0.0,
        point_a: common,
        point_b: common,
        normal: axis.normal,
        feature: axis.feature,
    }
}

/// With a disc the axis is the shortest way already.
fn round_distance(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Distance {
    let n = axis.normal;
    let radii = (a.radius, b.radius);
    if axis.separation > 0.0 {
        let (point_a, point_b) = if b.is_disc() {
            let point_b = b_in_a.point(b.vertices[0]) - n * b.radius;
            let corner = match axis.feature {
                AxisFeature::Vertices { a: i, .. } => Some(a.vertices[i] + n * a.radius),
                AxisFeature::Edge { .. } => None,
            };
            (corner.unwrap_or(point_b - n * axis.separation), point_b)
        } else {
            let point_a = a.vertices[0] + n * a.radius;
            let corner = match axis.feature {
                AxisFeature::Vertices { b: j, .. } => Some(b_in_a.point(b.vertices[j])),
                AxisFeature::Edge { .. } => None,
            };
            (point_a, corner.unwrap_or(point_a + n * axis.separation))
        };
        return Distance {
            distance: axis.separation,
            point_a,
            point_b,
            normal: n,
            feature: axis.feature,
        };
    }
    // Along the normal, from the nearest point of A's core: A reaches from −r_a to r_a, B from
    // core − r_b to core + r_b. The middle of what they share; a centre inside is common itself.
    let core = (axis.separation + radii.0 + radii.1).max(0.0);
    let middle = 0.5 * ((-radii.0).max(core - radii.1) + radii.0.min(core + radii.1));
    let common = if b.is_disc() {
        b_in_a.point(b.vertices[0]) - n * (core - middle)
    } else {
        a.vertices[0] + n * middle
    };
    touching(axis, common)
}

/// The shortest way between two polygons that `axis` separates.
fn closest(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Distance {
    let a_in_b = b_in_a.inverse();
    // A gap along an edge's normal is the least distance there can be: if the foot is on the edge,
    // it is the distance.
    if let AxisFeature::Edge {
        owner,
        edge,
        vertex,
    } = axis.feature
    {
        let (own, point) = match owner {
            Side::A => (a, b_in_a.point(b.vertices[vertex])),
            Side::B => (b, a_in_b.point(a.vertices[vertex])),
        };
        if beyond_end(own, edge, point).is_none() {
            return on_edge(a, b, b_in_a, axis);
        }
    }
    // Else vertex on vertex, but where edges are nearly parallel rounding can hide the best one.
    nearest_features(a, b, b_in_a, axis)
}

/// The way from an edge to a vertex above it.
pub(crate) fn on_edge(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Distance {
    let step = axis.normal * axis.separation;
    let (point_a, point_b) = match axis.feature {
        AxisFeature::Edge {
            owner: Side::A,
            vertex,
            ..
        } => {
            let point = b_in_a.point(b.vertices[vertex]);
            (point - step, point)
        }
        AxisFeature::Edge { vertex, .. } => (a.vertices[vertex], a.vertices[vertex] + step),
        AxisFeature::Vertices { a: i, b: j } => (a.vertices[i], b_in_a.point(b.vertices[j])),
    };
    Distance {
        distance: axis.separation,
        point_a,
        point_b,
        normal: axis.normal,
        feature: axis.feature,
    }
}

/// A point behind both of two lines: where they cross, or of parallel ones the lower point.
fn behind_both(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Vec2 {
    let (n, m) = (a.normals[0], b_in_a.vector(b.normals[0]));
    let (p, q) = (a.vertices[0], b_in_a.point(b.vertices[0]));
    let above = n.dot(q - p);
    let sine = cross(n, m);
    if sine == 0.0 {
        return if above > 0.0 { p } else { q };
    }
    // Along b's line from q until the height over a's line is 0: n·(q + s t) = n·p, t = perp(m).
    q + perp(m) * (above / sine)
}

/// A point of both of two overlapping polygons: a vertex of one inside the other, or a crossing.
fn common_point(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Vec2 {
    let inside = |hull: &Hull<'_>, point: Vec2| {
        hull.normals.len() != 2
            && hull
                .normals
                .iter()
                .zip(hull.vertices)
                .all(|(n, v)| n.dot(point - *v) <= 0.0)
    };
    for w in b.vertices {
        let point = b_in_a.point(*w);
        if inside(a, point) {
            return point;
        }
    }
    for v in a.vertices {
        if inside(b, b_in_a.inverse_point(*v)) {
            return *v;
        }
    }
    for j in 0..b.normals.len() {
        let (from, to) = b.edge(j);
        let (from, to) = (b_in_a.point(from), b_in_a.point(to));
        for (i, n) in a.normals.iter().enumerate() {
            let (below, above) = (n.dot(from - a.vertices[i]), n.dot(to - a.vertices[i]));
            if (below <= 0.0) != (above <= 0.0) {
                let point = from + (to - from) * (below / (below - above));
                if beyond_end(a, i, point).is_none() {
                    return point;
                }
            }
        }
    }
    // They touch to rounding: the vertex that touches.
    let axis = Axis {
        separation: 0.0,
        ..axis
    };
    on_edge(a, b, b_in_a, axis).point_a
}
