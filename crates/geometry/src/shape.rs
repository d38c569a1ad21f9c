//! Any shape, and the questions that one shape can answer.

use carom_math::{Pose, Vec2, cross, orient2d};

use crate::polygon::winds_around;
use crate::{Aabb, AreaProperties, Circle, ConvexPolygon, Polygon, Segment};

/// A shape of any kind, in its own frame, in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A disc.
    Circle(Circle),
    /// A wall without thickness.
    Segment(Segment),
    /// A convex polygon.
    Convex(ConvexPolygon),
    /// Any simple polygon.
    Polygon(Polygon),
}

/// What to draw of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline<'a> {
    /// A circle.
    Circle {
        /// Centre, in m.
        centre: Vec2,
        /// Radius, in m.
        radius: f64,
    },
    /// A line from point to point.
    Open(&'a [Vec2]),
    /// A closed ring, counter-clockwise.
    Closed(&'a [Vec2]),
}

/// Where a ray enters a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Along the ray, in lengths of its direction.
    pub distance: f64,
    /// Where, in m.
    pub point: Vec2,
    /// Outward unit normal there.
    pub normal: Vec2,
}

impl Shape {
    /// What to draw.
    #[must_use]
    pub fn outline(&self) -> Outline<'_> {
        match self {
            Self::Circle(circle) => Outline::Circle {
                centre: circle.centre(),
                radius: circle.radius(),
            },
            Self::Segment(segment) => Outline::Open(segment.vertices()),
            Self::Convex(polygon) => Outline::Closed(polygon.vertices()),
            Self::Polygon(polygon) => Outline::Closed(polygon.vertices()),
        }
    }

    /// Area and its moments; a segment has no area, and its middle is its centroid.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        match self {
            Self::Circle(circle) => circle.area_properties(),
            Self::Segment(segment) => AreaProperties {
                centroid: (segment.a() + segment.b()) * 0.5,
                ..AreaProperties::ZERO
            },
            Self::Convex(polygon) => polygon.area_properties(),
            Self::Polygon(polygon) => polygon.area_properties(),
        }
    }

    /// The box around the shape when its frame is at `pose`.
    #[must_use]
    pub fn aabb(&self, pose: Pose) -> Aabb {
        let (points, radius) = self.points();
        Aabb::from_points(points.iter().map(|p| pose.point(*p))).grown(radius)
    }

    /// Largest distance of a point of the shape from `point`, in m.
    #[must_use]
    pub fn reach_about(&self, point: Vec2) -> f64 {
        let (points, radius) = self.points();
        let squares = points.iter().map(|p| (*p - point).length_squared());
        squares.fold(0.0, f64::max).sqrt() + radius
    }

    /// Whether `point` lies inside or on the rim. Polygons answer exactly.
    #[must_use]
    pub fn contains(&self, point: Vec2) -> bool {
        match self {
            Self::Circle(circle) => {
                (point - circle.centre()).length_squared() <= circle.radius() * circle.radius()
            }
            Self::Segment(segment) => {
                let (a, b) = (segment.a(), segment.b());
                orient2d(a, b, point) == 0.0 && Aabb::from_points([a, b]).contains_point(point)
            }
            Self::Convex(polygon) => winds_around(polygon.vertices(), point),
            Self::Polygon(polygon) => polygon.contains(point),
        }
    }

    /// The point of the shape nearest to `point`, in m: `point` itself if it lies inside.
    #[must_use]
    pub fn closest_point(&self, point: Vec2) -> Vec2 {
        if self.contains(point) {
            return point;
        }
        match self.outline() {
            Outline::Circle { centre, radius } => {
                centre + (point - centre).normalize_or(Vec2::X) * radius
            }
            Outline::Open(points) => nearest(point, points, false),
            Outline::Closed(points) => nearest(point, points, true),
        }
    }

    /// Distance of `point` from the rim, in m; negative inside.
    #[must_use]
    pub fn signed_distance(&self, point: Vec2) -> f64 {
        match self.outline() {
            Outline::Circle { centre, radius } => (point - centre).length() - radius,
            Outline::Open(points) => (nearest(point, points, false) - point).length(),
            Outline::Closed(points) => {
                let distance = (nearest(point, points, true) - point).length();
                if self.contains(point) {
                    -distance
                } else {
                    distance
                }
            }
        }
    }

    /// Where a ray from `origin` enters the shape first, within `max` lengths of `direction`.
    ///
    /// `None` from inside: a ray that starts in a shape does not enter it. A segment is hit from
    /// both sides.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        match self.outline() {
            Outline::Circle { centre, radius } => {
                cast_at_circle(origin - centre, direction, radius, max).map(|distance| {
                    let point = origin + direction * distance;
                    RayHit {
                        distance,
                        point,
                        normal: (point - centre).normalize_or(Vec2::X),
                    }
                })
            }
            Outline::Open(points) => cast_at_edges(origin, direction, max, points, false),
            Outline::Closed(points) => cast_at_edges(origin, direction, max, points, true),
        }
    }

    /// The same shape moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        match self {
            Self::Circle(circle) => circle.translated(offset).into(),
            Self::Segment(segment) => segment.translated(offset).into(),
            Self::Convex(polygon) => polygon.translated(offset).into(),
            Self::Polygon(polygon) => polygon.translated(offset).into(),
        }
    }

    /// Vertices and the radius around them.
    fn points(&self) -> (&[Vec2], f64) {
        match self {
            Self::Circle(circle) => (circle.vertices(), circle.radius()),
            Self::Segment(segment) => (segment.vertices(), 0.0),
            Self::Convex(polygon) => (polygon.vertices(), 0.0),
            Self::Polygon(polygon) => (polygon.vertices(), 0.0),
        }
    }
}

impl From<Circle> for Shape {
    fn from(circle: Circle) -> Self {
        Self::Circle(circle)
    }
}

impl From<Segment> for Shape {
    fn from(segment: Segment) -> Self {
        Self::Segment(segment)
    }
}

impl From<ConvexPolygon> for Shape {
    fn from(polygon: ConvexPolygon) -> Self {
        Self::Convex(polygon)
    }
}

impl From<Polygon> for Shape {
    fn from(polygon: Polygon) -> Self {
        Self::Polygon(polygon)
    }
}

/// Edges of a line or a ring.
fn edges(points: &[Vec2], closed: bool) -> impl Iterator<Item = (Vec2, Vec2)> {
    let count = if closed {
        points.len()
    } else {
        points.len() - 1
    };
    points
        .iter()
        .zip(points.iter().cycle().skip(1))
        .take(count)
        .map(|(a, b)| (*a, *b))
}

fn nearest(point: Vec2, points: &[Vec2], closed: bool) -> Vec2 {
    let mut best = (f64::INFINITY, point);
    for (a, b) in edges(points, closed) {
        let along = b - a;
        let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let candidate = a + along * t;
        let square = (candidate - point).length_squared();
        if square < best.0 {
            best = (square, candidate);
        }
    }
    best.1
}

/// The earlier root of |origin + t direction| = radius, if the ray starts outside.
fn cast_at_circle(origin: Vec2, direction: Vec2, radius: f64, max: f64) -> Option<f64> {
    let a = direction.length_squared();
    let b = origin.dot(direction);
    let c = origin.length_squared() - radius * radius;
    if c <= 0.0 || b >= 0.0 {
        return None;
    }
    // The discriminant by the distance of the line from the centre: it does not cancel.
    let across = cross(origin, direction);
    let discriminant = a * radius * radius - across * across;
    if discriminant < 0.0 {
        return None;
    }
    let t = c / (discriminant.sqrt() - b);
    (t <= max).then_some(t)
}

fn cast_at_edges(
    origin: Vec2,
    direction: Vec2,
    max: f64,
    points: &[Vec2],
    closed: bool,
) -> Option<RayHit> {
    if closed && winds_around(points, origin) {
        return None;
    }
    let mut best: Option<RayHit> = None;
    for (a, b) in edges(points, closed) {
        let along = b - a;
        let slope = cross(direction, along);
        // A ring is entered where its edge runs to the left of the ray; a wall from both sides.
        if slope == 0.0 || (closed && slope < 0.0) {
            continue;
        }
        let t = cross(a - origin, along) / slope;
        let s = cross(a - origin, direction) / slope;
        if !(0.0..=1.0).contains(&s) || !(0.0..=max).contains(&t) {
            continue;
        }
        if best.is_none_or(|hit| t < hit.distance) {
            let side = if slope > 0.0 { 1.0 } else { -1.0 };
            let outward = carom_math::vec2(along.y, -along.x) * side;
            best = Some(RayHit {
                distance: t,
                point: a + along * s,
                normal: outward.normalize_or(Vec2::X),
            });
        }
    }
    best
}
