//! Any shape, and what it is made of.

use carom_math::{Pose, Rot, Vec2};

use crate::{
    Aabb, AreaProperties, Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Segment, ShapeError,
};

/// A shape of any kind, in its own frame, in m.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum Shape {
    /// A disc.
    Circle(Circle),
    /// A wall without thickness.
    Segment(Segment),
    /// Everything behind a line.
    HalfPlane(HalfPlane),
    /// A convex polygon.
    Convex(ConvexPolygon),
    /// Any simple polygon.
    Polygon(Polygon),
    /// Several shapes that move as one.
    Compound(Compound),
}

/// What to draw of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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
    /// Closed rings, holes the other way round: filled by the non-zero rule, or the even-odd one.
    Rings(&'a [Vec<Vec2>]),
    /// A line without end.
    HalfPlane {
        /// A point of the line, in m.
        point: Vec2,
        /// Unit normal, away from what is solid.
        normal: Vec2,
    },
    /// The outlines of these shapes, one after the other.
    Parts(&'a [Shape]),
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
            Self::HalfPlane(half_plane) => Outline::HalfPlane {
                point: half_plane.point(),
                normal: half_plane.normal(),
            },
            Self::Convex(polygon) => Outline::Closed(polygon.vertices()),
            Self::Polygon(polygon) => Outline::Closed(polygon.vertices()),
            Self::Compound(compound) => Outline::Parts(compound.parts()),
        }
    }

    /// Area and its moments; a segment has no area, and its middle is its centroid.
    ///
    /// # Errors
    /// A half-plane has none.
    pub fn area_properties(&self) -> Result<AreaProperties, ShapeError> {
        match self {
            Self::Circle(circle) => Ok(circle.area_properties()),
            Self::Segment(segment) => Ok(AreaProperties {
                centroid: (segment.a() + segment.b()) * 0.5,
                ..AreaProperties::ZERO
            }),
            Self::HalfPlane(_) => Err(ShapeError::Unbounded),
            Self::Convex(polygon) => Ok(polygon.area_properties()),
            Self::Polygon(polygon) => Ok(polygon.area_properties()),
            Self::Compound(compound) => Ok(compound.area_properties()),
        }
    }

    /// Whether the shape has an end: all but half-planes have.
    #[must_use]
    pub const fn is_bounded(&self) -> bool {
        !matches!(self, Self::HalfPlane(_))
    }

    /// The box around the shape when its frame is at `pose`.
    #[must_use]
    pub fn aabb(&self, pose: Pose) -> Aabb {
        let around = |points: &[Vec2]| Aabb::from_points(points.iter().map(|p| pose.point(*p)));
        match self {
            Self::Circle(circle) => around(circle.vertices()).grown(circle.radius()),
            Self::HalfPlane(half_plane) => half_plane.aabb(pose),
            Self::Compound(compound) => {
                let boxes = compound.parts().iter().map(|part| part.aabb(pose));
                boxes.fold(Aabb::EMPTY, Aabb::union)
            }
            _ => around(self.vertices()),
        }
    }

    /// Largest distance of a point of the shape from `point`, in m; infinite for a half-plane.
    #[must_use]
    pub fn reach_about(&self, point: Vec2) -> f64 {
        let farthest = |points: &[Vec2]| {
            let squares = points.iter().map(|p| (*p - point).length_squared());
            squares.fold(0.0, f64::max).sqrt()
        };
        match self {
            Self::Circle(circle) => farthest(circle.vertices()) + circle.radius(),
            Self::HalfPlane(_) => f64::INFINITY,
            Self::Compound(compound) => {
                let reaches = compound.parts().iter().map(|part| part.reach_about(point));
                reaches.fold(0.0, f64::max)
            }
            _ => farthest(self.vertices()),
        }
    }

    /// The same shape moved by `offset`, in m.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        match self {
            Self::Circle(circle) => circle.translated(offset).into(),
            Self::Segment(segment) => segment.translated(offset).into(),
            Self::HalfPlane(half_plane) => half_plane.translated(offset).into(),
            Self::Convex(polygon) => polygon.translated(offset).into(),
            Self::Polygon(polygon) => polygon.translated(offset).into(),
            Self::Compound(compound) => compound.translated(offset).into(),
        }
    }

    /// The same shape where it is when its frame is at `pose`, told in the frame around it.
    ///
    /// Corners are rounded to where they come to lie and checked again: a convex polygon may lose a
    /// corner that rounding makes straight.
    ///
    /// # Errors
    /// If it comes to lie beyond the limits, or so far out that rounding spoils its ring.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::{Segment, Shape};
    /// use carom_math::{Pose, Rot, Vec2, vec2};
    /// let wall = Shape::from(Segment::new(Vec2::ZERO, vec2(2.0, 0.0))?);
    /// let upright = wall.placed(Pose::new(vec2(5.0, 1.0), Rot::from_degrees(90.0)))?;
    /// assert_eq!(upright.vertices(), [vec2(5.0, 1.0), vec2(5.0, 3.0)]);    // m
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    pub fn placed(&self, pose: Pose) -> Result<Self, ShapeError> {
        let points = || -> Vec<Vec2> { self.vertices().iter().map(|p| pose.point(*p)).collect() };
        if pose.rotation == Rot::IDENTITY && pose.position == Vec2::ZERO {
            return Ok(self.clone());
        }
        Ok(match self {
            Self::Circle(circle) => {
                Circle::at(pose.point(circle.centre()), circle.radius())?.into()
            }
            Self::Segment(segment) => {
                Segment::new(pose.point(segment.a()), pose.point(segment.b()))?.into()
            }
            Self::HalfPlane(wall) => {
                HalfPlane::new(pose.point(wall.point()), pose.vector(wall.normal()))?.into()
            }
            Self::Convex(_) => ConvexPolygon::hull(points())?.into(),
            Self::Polygon(_) => Polygon::new(points())?.into(),
            Self::Compound(compound) => compound.placed(pose)?.into(),
        })
    }

    /// Corners, in m: the centre of a circle, the ends of a segment, the given point of a
    /// half-plane; of a compound those of all parts.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        match self {
            Self::Circle(circle) => circle.vertices(),
            Self::Segment(segment) => segment.vertices(),
            Self::HalfPlane(half_plane) => half_plane.vertices(),
            Self::Convex(polygon) => polygon.vertices(),
            Self::Polygon(polygon) => polygon.vertices(),
            Self::Compound(compound) => compound.vertices(),
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

impl From<HalfPlane> for Shape {
    fn from(half_plane: HalfPlane) -> Self {
        Self::HalfPlane(half_plane)
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

impl From<Compound> for Shape {
    fn from(compound: Compound) -> Self {
        Self::Compound(compound)
    }
}
