//! Where two convex hulls touch: a normal and up to two points.

use arrayvec::ArrayVec;
use carom_math::{Pose, Vec2, perp, within};

use crate::distance::apart;
use crate::outline::{Pair, nearest_boundary};
use crate::sat::{Face, wider_axis, widest_edge};
use crate::{Axis, AxisFeature, Convex, Hull, Side, separating_axis};

/// A's edge is preferred to B's unless B's separates by more than this fraction of A's edge.
///
/// Above rounding, so that flush edges keep one owner; below any overlap that matters.
const TIE: f64 = 1.0 / (1u64 << 40) as f64;

/// What touches at a contact point: a vertex of A and one of B, at the end of the two edges that
/// face each other there.
///
/// It does not depend on which edge serves as the reference, so it stays the same from step to step
/// while the contact persists, and a pair given the other way round gives [`FeatureId::mirrored`].
/// A circle has one contact and no features: the vertices count as number 0. Numbers beyond 65535
/// wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FeatureId(pub u32);

impl FeatureId {
    fn new(vertex_a: usize, vertex_b: usize) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "wraps, as documented")]
        let half = |i: usize| u32::from(i as u16);
        Self(half(vertex_a) << 16 | half(vertex_b))
    }

    /// The vertex of A and the vertex of B.
    #[must_use]
    pub const fn vertices(self) -> (usize, usize) {
        ((self.0 >> 16) as usize, (self.0 & 0xffff) as usize)
    }

    /// The same contact, for the shapes in the other order.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        Self(self.0.rotate_left(16))
    }
}

/// One point of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldPoint {
    /// Midway between the two surfaces, in A's frame, in metres.
    pub point: Vec2,
    /// Gap along the normal in metres; below zero the shapes overlap.
    pub separation: f64,
    /// What touches here.
    pub feature: FeatureId,
}

/// How two convex shapes touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Manifold {
    /// Unit normal in A's frame, from A to B; zero if there is no point.
    pub normal: Vec2,
    /// One point, two for edge on edge, none if the shapes are apart.
    pub points: ArrayVec<ManifoldPoint, 2>,
}

impl Manifold {
    /// Least separation of the points in metres, or `None` without a contact.
    #[must_use]
    pub fn deepest(&self) -> Option<f64> {
        self.points
            .iter()
            .map(|p| p.separation)
            .min_by(f64::total_cmp)
    }

    pub(crate) fn single(normal: Vec2, point: Vec2, separation: f64, feature: FeatureId) -> Self {
        let mut points = ArrayVec::new();
        points.push(ManifoldPoint {
            point,
            separation,
            feature,
        });
        Self { normal, points }
    }
}

/// The contact of two convex shapes that overlap or touch; no points if they are apart.
///
/// The normal is the direction of least overlap. Edge on edge gives the two ends of the stretch
/// that they share, everything else one point.
///
/// # Examples
/// ```
/// use carom_collision::collide;
/// use carom_geometry::ConvexPolygon;
/// use carom_math::{Pose, vec2};
/// let floor = ConvexPolygon::rectangle(10.0, 2.0)?;                            // m
/// let box_ = ConvexPolygon::square(1.0)?;
/// let contact = collide(&floor, &box_, Pose::at(vec2(3.0, 1.375)));
/// assert_eq!(contact.normal, vec2(0.0, 1.0));                                  // from A to B
/// let mut points: Vec<_> = contact.points.iter().map(|p| (p.point.x, p.separation)).collect();
/// points.sort_by(|p, q| p.0.total_cmp(&q.0));
/// assert_eq!(points, [(2.5, -0.125), (3.5, -0.125)]);                          // m
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn collide(a: &impl Convex, b: &impl Convex, b_in_a: Pose) -> Manifold {
    collide_within(&a.hull(), &b.hull(), b_in_a, 0.0)
}

/// The contact of two convex hulls, with every point at a separation of at most `margin` (metres).
///
/// Of a piece of a concave polygon only the true outline is touched: see [`Hull::allows`]. Two
/// half-planes have no contact: neither can move.
#[must_use]
pub fn collide_within(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, margin: f64) -> Manifold {
    match touch(a, b, b_in_a, margin).0 {
        Touch::Contact(manifold) => manifold,
        Touch::Hidden {
            across_cut: true, ..
        } => along_boundary(a, b, b_in_a, margin).unwrap_or_default(),
        Touch::Apart | Touch::Hidden { .. } => Manifold::default(),
    }
}

/// A strip between two shapes: along its normal they are at least so far apart.
///
/// It goes on to say so while they move: a translation of B by d adds normal · d, and a turn takes away what it
/// moves B's farthest point by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// In metres; below zero they may overlap by as much.
    pub separation: f64,
    /// Unit normal in A's frame, from A to B; zero if the shapes are that far apart, but no strip is known.
    pub normal: Vec2,
}

impl Gap {
    const fn new(separation: f64, normal: Vec2) -> Self {
        Self { separation, normal }
    }
}

/// How two convex parts meet.
pub(crate) enum Touch {
    Apart,
    Contact(Manifold),
    /// They overlap, but not where the outlines can touch: at a corner in a seam, beyond which the
    /// outline goes on, or across cuts alone.
    Hidden {
        /// Of the least overlap, in metres.
        separation: f64,
        /// That way leads through a cut.
        across_cut: bool,
    },
}

pub(crate) fn touch(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, margin: f64) -> (Touch, Gap) {
    if a.is_disc() || b.is_disc() {
        let axis = separating_axis(a, b, b_in_a);
        let gap = Gap::new(axis.separation, axis.normal);
        if axis.separation > margin {
            return (Touch::Apart, gap);
        }
        return (collide_round(a, b, b_in_a, axis), gap);
    }
    if a.is_half_plane() && b.is_half_plane() {
        return (Touch::Apart, Gap::new(f64::INFINITY, Vec2::ZERO));
    }
    collide_polygons(&Pair::new(a, b, b_in_a), margin)
}

/// The contact of two overlapping parts along the edge that overlaps least among those which the
/// outlines can touch along.
pub(crate) fn along_boundary(
    a: &Hull<'_>,
    b: &Hull<'_>,
    b_in_a: Pose,
    margin: f64,
) -> Option<Manifold> {
    if a.is_disc() || b.is_disc() {
        return None;
    }
    let pair = Pair::new(a, b, b_in_a);
    let (owner, face) = pair.least_overlap()?;
    let faces = Faces::new(&pair, owner, face);
    faces.manifold(faces.shared()?, margin)
}

/// A disc against anything: one point on the way from its centre to the nearest feature.
fn collide_round(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, axis: Axis) -> Touch {
    let hidden = if axis.separation <= 0.0 {
        Touch::Hidden {
            separation: axis.separation,
            across_cut: false,
        }
    } else {
        Touch::Apart
    };
    let disc_is_b = b.is_disc();
    let (hull, disc) = if disc_is_b { (a, b) } else { (b, a) };
    let (mut normal, mut separation) = (axis.normal, axis.separation);
    if hull.boundary.is_some() {
        // From the hull to the disc, in the hull's frame.
        let outward = if disc_is_b {
            normal
        } else {
            b_in_a.inverse_vector(-normal)
        };
        let touchable = match axis.feature {
            AxisFeature::Edge { edge, .. } => hull.is_boundary(edge),
            AxisFeature::Vertices { a, b } => hull.allows(if disc_is_b { a } else { b }, outward),
        };
        if !touchable {
            let AxisFeature::Edge { .. } = axis.feature else {
                return hidden;
            };
            let centre = if disc_is_b {
                b_in_a.point(disc.vertices[0])
            } else {
                b_in_a.inverse_point(disc.vertices[0])
            };
            let Some((height, edge)) = nearest_boundary(hull, centre, disc.radius) else {
                return hidden;
            };
            separation = height - disc.radius;
            let outward = hull.normals[edge];
            normal = if disc_is_b {
                outward
            } else {
                -b_in_a.vector(outward)
            };
        }
    }
    let point = if disc_is_b {
        b_in_a.point(b.vertices[0]) - normal * (b.radius + 0.5 * separation)
    } else {
        a.vertices[0] + normal * (a.radius + 0.5 * separation)
    };
    Touch::Contact(Manifold::single(normal, point, separation, FeatureId(0)))
}

/// Two polygons (or segments): the edge of least overlap, and the facing edge clipped to it.
fn collide_polygons(pair: &Pair<'_>, margin: f64) -> (Touch, Gap) {
    let [a, b] = &pair.hulls;
    let of_a = widest_edge(a, b, pair.poses[0]);
    if of_a.separation > margin {
        let gap = Gap::new(of_a.separation, a.normals[of_a.edge]);
        return (Touch::Apart, gap);
    }
    let of_b = widest_edge(b, a, pair.poses[1]);
    if of_b.separation > margin {
        let normal = -pair.poses[0].vector(b.normals[of_b.edge]);
        return (Touch::Apart, Gap::new(of_b.separation, normal));
    }
    let tie = || {
        let (from, to) = a.edge(of_a.edge);
        TIE * (to - from).length()
    };
    let best = if of_b.separation > of_a.separation && of_b.separation > of_a.separation + tie() {
        (Side::B, of_b.face(b, a, pair.poses[1]))
    } else {
        (Side::A, of_a.face(a, b, pair.poses[0]))
    };
    let overlap = best.1.separation <= 0.0;
    let touchable = !pair.has_cuts() || pair.allows(best.0, best.1);
    let faces = Faces::new(pair, best.0, best.1);
    let gap = Gap::new(best.1.separation, faces.normal_in_a());
    if overlap && !touchable {
        let hidden = Touch::Hidden {
            separation: best.1.separation,
            across_cut: !pair.hulls[best.0 as usize].is_boundary(best.1.edge),
        };
        return (hidden, gap);
    }
    if let Some(found) = faces.shared().and_then(|ends| faces.manifold(ends, margin)) {
        let touch = if touchable {
            Touch::Contact(found)
        } else {
            Touch::Apart
        };
        return (touch, gap);
    }
    // The vertex is beyond the end of the edge: vertex on vertex, if they are apart at all. Closer
    // than rounding the way from vertex to vertex has no direction, but the edge still has.
    let axis = wider_axis([a, b], pair.poses, [of_a, of_b]);
    match apart(a, b, pair.poses[0], axis).filter(|way| way.distance > tie()) {
        Some(way) if way.distance <= margin && pair.allows_way(&way) => {
            let (i, j) = way.vertices(a, b, pair.poses[0]);
            let middle = 0.5 * (way.point_a + way.point_b);
            let feature = FeatureId::new(i, j);
            let manifold = Manifold::single(way.normal, middle, way.distance, feature);
            (Touch::Contact(manifold), Gap::new(way.distance, way.normal))
        }
        Some(way) => (Touch::Apart, Gap::new(way.distance, way.normal)),
        None if touchable => (Touch::Contact(faces.deepest()), gap),
        None => (Touch::Apart, gap),
    }
}

/// An edge and the edge of the other hull that faces it, in the frame of the first.
pub(crate) struct Faces<'a, 'b> {
    pair: &'b Pair<'a>,
    owner: Side,
    normal: Vec2,
    /// Start of the reference edge and its direction.
    origin: Vec2,
    along: Vec2,
    /// Length of the reference edge; of the facing one, if the reference is a line without end.
    length: f64,
    /// Where the reference edge starts and ends, along itself.
    span: [f64; 2],
    /// Reference vertices at the low and at the high end.
    own: [usize; 2],
    face: Face,
    /// The facing edge, or twice the vertex if that edge is a cut.
    other: [usize; 2],
    points: [Vec2; 2],
}

/// A place on the facing edge: along the reference edge, above it, and at which of its ends.
#[derive(Clone, Copy)]
pub(crate) struct End {
    along: f64,
    height: f64,
    vertices: (usize, usize),
}

impl<'a, 'b> Faces<'a, 'b> {
    pub(crate) fn new(pair: &'b Pair<'a>, owner: Side, face: Face) -> Self {
        let (own, other) = (&pair.hulls[owner as usize], &pair.hulls[1 - owner as usize]);
        let pose = pair.poses[owner as usize];
        let normal = own.normals[face.edge];
        let (from, to) = own.edge(face.edge);
        let along = perp(normal);

        // Of the two edges at the deepest vertex, the one that faces the reference more.
        let local = pose.inverse_vector(normal);
        let (before, after) = (other.previous(face.vertex), face.vertex);
        let facing = if other.normals[before].dot(local) < other.normals[after].dot(local) {
            before
        } else {
            after
        };
        // Both run counter-clockwise, so the facing edge ends at the low end of the reference.
        let facing = if other.is_boundary(facing) {
            [other.next(facing), facing]
        } else {
            [face.vertex; 2]
        };
        let points = facing.map(|i| pose.point(other.vertices[i]));
        let (length, span) = if own.is_half_plane() {
            let facing = (points[1] - points[0]).length();
            (facing, [f64::NEG_INFINITY, f64::INFINITY])
        } else {
            let length = (to - from).dot(along);
            (length, [0.0, length])
        };
        Self {
            pair,
            owner,
            normal,
            origin: from,
            along,
            length,
            span,
            own: [face.edge, own.next(face.edge)],
            face,
            other: facing,
            points,
        }
    }

    /// The middle of what touches when the hulls just touch.
    pub(crate) fn touch(&self) -> Vec2 {
        /// Edges that rise by less than this fraction of what they share are flush.
        const FLUSH: f64 = 1e-9;
        let Some([low, high]) = self.shared() else {
            return self.deepest().points[0].point;
        };
        let rise = high.height - low.height;
        let end = if rise.abs() <= FLUSH * (high.along - low.along) {
            End {
                along: 0.5 * (low.along + high.along),
                height: 0.5 * (low.height + high.height),
                ..low
            }
        } else if rise > 0.0 {
            low
        } else {
            high
        };
        self.point(end).point
    }

    /// The stretch of the facing edge over the reference edge.
    pub(crate) fn shared(&self) -> Option<[End; 2]> {
        let [low, high] = [0, 1].map(|i| {
            let from_origin = self.points[i] - self.origin;
            End {
                along: from_origin.dot(self.along),
                height: from_origin.dot(self.normal),
                vertices: (self.own[i], self.other[i]),
            }
        });
        let (start, end) = (low.along.max(self.span[0]), high.along.min(self.span[1]));
        if start > end {
            return None;
        }
        // From the end itself, so that nothing is added where nothing is cut off.
        let run = high.along - low.along;
        let slope = if run > 0.0 {
            (high.height - low.height) / run
        } else {
            0.0
        };
        let at = |along: f64, end: End| End {
            along,
            height: end.height + (along - end.along) * slope,
            vertices: end.vertices,
        };
        Some([at(start, low), at(end, high)])
    }

    pub(crate) fn manifold(&self, ends: [End; 2], margin: f64) -> Option<Manifold> {
        let mut points: ArrayVec<ManifoldPoint, 2> = ArrayVec::new();
        let [low, high] = ends;
        let ends = if high.along - low.along <= TIE * self.length {
            // They share no more than a point: the lower end, at the vertices that meet there.
            let [before, after] = self.other;
            let vertices = if low.along <= self.span[0] {
                (self.own[0], after)
            } else if high.along >= self.span[1] {
                (self.own[1], before)
            } else {
                low.vertices
            };
            let end = if high.height < low.height { high } else { low };
            [Some(End { vertices, ..end }), None]
        } else if self.other[0] == self.other[1] {
            [Some(low), None]
        } else {
            [Some(low), Some(high)]
        };
        for end in ends.into_iter().flatten() {
            if end.height <= margin {
                points.push(self.point(end));
            }
        }
        (!points.is_empty()).then(|| Manifold {
            normal: self.normal_in_a(),
            points,
        })
    }

    /// One point at the deepest vertex, wherever it is.
    pub(crate) fn deepest(&self) -> Manifold {
        let i = usize::from(self.other[1] == self.face.vertex);
        let along = (self.points[i] - self.origin).dot(self.along);
        let point = self.point(End {
            along: within(along, self.span[0], self.span[1]),
            height: self.face.separation,
            vertices: (self.own[i], self.other[i]),
        });
        Manifold::single(
            self.normal_in_a(),
            point.point,
            point.separation,
            point.feature,
        )
    }

    fn point(&self, end: End) -> ManifoldPoint {
        let local = self.origin + self.along * end.along + self.normal * (0.5 * end.height);
        let (own, other) = end.vertices;
        let (point, feature) = match self.owner {
            Side::A => (local, FeatureId::new(own, other)),
            Side::B => (self.pair.poses[0].point(local), FeatureId::new(other, own)),
        };
        ManifoldPoint {
            point,
            separation: end.height,
            feature,
        }
    }

    pub(crate) fn normal_in_a(&self) -> Vec2 {
        match self.owner {
            Side::A => self.normal,
            Side::B => -self.pair.poses[0].vector(self.normal),
        }
    }
}
