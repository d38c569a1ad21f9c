//! What is written of a shape, and what is read back by the constructors: the feature `serde`.
//!
//! A polygon is the list of its vertices, a region that of its rings, a compound that of its parts. A polygon that was moved far
//! out may be cut into other pieces when it is read, or refused where rounding bent it.

use carom_math::{Pose, Vec2};
use serde::{Deserialize, Serialize};

use crate::{
    Circle, Compound, ConvexPolygon, HalfPlane, Polygon, PolygonError, Region, RegionError,
    Segment, Shape, ShapeError,
};

/// A normal that was written is one already: normalised again it may differ by this.
const ROUNDING: f64 = 1e-15;

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CircleData {
    #[serde(default)]
    centre: Vec2,
    radius: f64,
}

impl From<Circle> for CircleData {
    fn from(circle: Circle) -> Self {
        Self {
            centre: circle.centre(),
            radius: circle.radius(),
        }
    }
}

impl TryFrom<CircleData> for Circle {
    type Error = ShapeError;

    fn try_from(data: CircleData) -> Result<Self, ShapeError> {
        Self::at(data.centre, data.radius)
    }
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SegmentData {
    a: Vec2,
    b: Vec2,
}

impl From<Segment> for SegmentData {
    fn from(segment: Segment) -> Self {
        Self {
            a: segment.a(),
            b: segment.b(),
        }
    }
}

impl TryFrom<SegmentData> for Segment {
    type Error = ShapeError;

    fn try_from(data: SegmentData) -> Result<Self, ShapeError> {
        Self::new(data.a, data.b)
    }
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HalfPlaneData {
    point: Vec2,
    normal: Vec2,
}

impl From<HalfPlane> for HalfPlaneData {
    fn from(half_plane: HalfPlane) -> Self {
        Self {
            point: half_plane.point(),
            normal: half_plane.normal(),
        }
    }
}

impl TryFrom<HalfPlaneData> for HalfPlane {
    type Error = ShapeError;

    fn try_from(HalfPlaneData { point, normal }: HalfPlaneData) -> Result<Self, ShapeError> {
        let made = Self::new(point, normal)?;
        let same = (made.normal() - normal).length() <= ROUNDING;
        Ok(if same { made.with_unit(normal) } else { made })
    }
}

impl From<ConvexPolygon> for Vec<Vec2> {
    fn from(polygon: ConvexPolygon) -> Self {
        polygon.vertices().to_vec()
    }
}

impl TryFrom<Vec<Vec2>> for ConvexPolygon {
    type Error = PolygonError;

    fn try_from(vertices: Vec<Vec2>) -> Result<Self, PolygonError> {
        Self::new(vertices)
    }
}

impl From<Polygon> for Vec<Vec2> {
    fn from(polygon: Polygon) -> Self {
        polygon.vertices().to_vec()
    }
}

impl TryFrom<Vec<Vec2>> for Polygon {
    type Error = PolygonError;

    fn try_from(vertices: Vec<Vec2>) -> Result<Self, PolygonError> {
        Self::new(vertices)
    }
}

impl From<Region> for Vec<Vec<Vec2>> {
    fn from(region: Region) -> Self {
        region.into_rings()
    }
}

impl TryFrom<Vec<Vec<Vec2>>> for Region {
    type Error = RegionError;

    fn try_from(rings: Vec<Vec<Vec2>>) -> Result<Self, RegionError> {
        let mut rings = rings.into_iter();
        // An empty outer ring is refused by name.
        let outer = rings.next().unwrap_or_default();
        Self::new(outer, rings)
    }
}

impl From<Compound> for Vec<Shape> {
    fn from(compound: Compound) -> Self {
        compound.parts().to_vec()
    }
}

impl TryFrom<Vec<Shape>> for Compound {
    type Error = ShapeError;

    fn try_from(parts: Vec<Shape>) -> Result<Self, ShapeError> {
        Self::new(parts.into_iter().map(|part| (part, Pose::IDENTITY)))
    }
}
