//! Any shape, and the questions that one shape can answer.

use carom_math::{Pose, Vec2};

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
        let (points, radius) = self.round_points();
        Aabb::from_points(points.iter().map(|p| pose.point(*p))).grown(radius)
    }

    /// Largest distance of a point of the shape from `point`, in m.
    #[must_use]
    pub fn reach_about(&self, point: Vec2) -> f64 {
        let (points, radius) = self.round_points();
        let squares = points.iter().map(|p| (*p - point).length_squared());
        squares.fold(0.0, f64::max).sqrt() + radius
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

    /// Corners, in m: the centre of a circle, the ends of a segment.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        self.round_points().0
    }

    /// The point of the shape farthest along `direction`, in m: a corner, the first of equal ones.
    #[must_use]
    pub fn support(&self, direction: Vec2) -> Vec2 {
        let (points, radius) = self.round_points();
        let mut best = points[0];
        for p in points {
            if p.dot(direction) > best.dot(direction) {
                best = *p;
            }
        }
        best + direction.normalize_or_zero() * radius
    }

    /// Vertices and the radius around them.
    fn round_points(&self) -> (&[Vec2], f64) {
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
