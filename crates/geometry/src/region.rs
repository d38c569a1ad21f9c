//! Regions: polygons with holes, for their mass and for drawing.

use carom_math::Vec2;

use crate::moments::region_moments;
use crate::query::winds_around;
use crate::ring::Ring;
use crate::simple::Rings;
use crate::{Aabb, AreaProperties, Outline, Polygon, PolygonError, RayHit, RegionError};

/// A polygon with holes: what lies inside one simple ring and outside of others.
///
/// Rings do not touch each other. A region knows its mass and how it is drawn; what collides is made
/// of polygons.
///
/// # Examples
/// ```
/// use carom_geometry::{ConvexPolygon, Region};
/// // A square frame of 4 m around a square hole of 2 m.
/// let square = |side| ConvexPolygon::square(side).map(|square| square.vertices().to_vec());
/// let frame = Region::new(square(4.0)?, [square(2.0)?])?;
/// let area = frame.area_properties();
/// assert_eq!(area.area, 12.0);                                     // m²
/// assert_eq!(area.with_density(1.0).inertia, 40.0);                // kg·m², (4⁴ − 2⁴) / 6
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<Vec<Vec2>>", into = "Vec<Vec<Vec2>>")
)]
pub struct Region {
    /// The outer ring counter-clockwise, then the holes clockwise.
    rings: Vec<Vec<Vec2>>,
}

impl Region {
    /// The outer ring, then the holes.
    #[cfg(feature = "serde")]
    pub(crate) fn into_rings(self) -> Vec<Vec<Vec2>> {
        self.rings
    }

    /// The inside of the ring `outer` without those of the rings `holes`, in m, each in either order
    /// of turn.
    ///
    /// Checked exactly: every ring as [`Polygon::new`] does, all edges together in O(n log n), then
    /// what lies in what.
    ///
    /// # Errors
    /// If a ring is no polygon, two meet, or a hole lies outside or in another hole; the error names
    /// the rings, and the edges if they meet.
    pub fn new(
        outer: impl Into<Vec<Vec2>>,
        holes: impl IntoIterator<Item = impl Into<Vec<Vec2>>>,
    ) -> Result<Self, RegionError> {
        let given = core::iter::once(outer.into()).chain(holes.into_iter().map(Into::into));
        let mut rings = Vec::new();
        for (ring, points) in given.enumerate() {
            rings.push(Ring::new(&points).map_err(|error| RegionError::Ring { ring, error })?);
        }
        check_apart(&rings)?;
        let mut rings: Vec<Vec<Vec2>> = rings
            .into_iter()
            .map(|ring| ring.counter_clockwise().points)
            .collect();
        check_nesting(&rings)?;
        for hole in &mut rings[1..] {
            hole.reverse();
        }
        Ok(Self { rings })
    }

    /// The outer ring, counter-clockwise, in m.
    #[must_use]
    pub fn outer(&self) -> &[Vec2] {
        &self.rings[0]
    }

    /// The holes, each clockwise, in m.
    #[must_use]
    pub fn holes(&self) -> &[Vec<Vec2>] {
        &self.rings[1..]
    }

    /// What to draw.
    #[must_use]
    pub fn outline(&self) -> Outline<'_> {
        Outline::Rings(&self.rings)
    }

    /// Area and its moments: of all rings at once, so that a thin frame loses no digits.
    #[must_use]
    pub fn area_properties(&self) -> AreaProperties {
        region_moments(&self.rings)
    }

    /// Whether `point` (in m) lies in the region or on a ring; exact.
    #[must_use]
    pub fn contains(&self, point: Vec2) -> bool {
        self.outline().contains(point)
    }

    /// The box around the region, in m.
    #[must_use]
    pub fn aabb(&self) -> Aabb {
        Aabb::from_points(self.outer().iter().copied())
    }

    /// Distance of `point` from the nearest ring, in m; negative inside.
    #[must_use]
    pub fn signed_distance(&self, point: Vec2) -> f64 {
        self.outline().signed_distance(point)
    }

    /// The point of the rings nearest to `point`, in m: the first of equally near ones.
    #[must_use]
    pub fn closest_rim_point(&self, point: Vec2) -> Vec2 {
        self.outline().closest_rim_point(point)
    }

    /// Where a ray enters the region first, as [`crate::Shape::cast_ray`] tells: from outside or out of a
    /// hole.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        self.outline().cast_ray(origin, direction, max)
    }

    /// The same region moved by `offset`, in m.
    ///
    /// Vertices are rounded to where they come to lie, and not checked again.
    #[must_use]
    pub fn translated(&self, offset: Vec2) -> Self {
        let moved = |ring: &Vec<Vec2>| ring.iter().map(|v| *v + offset).collect();
        Self {
            rings: self.rings.iter().map(moved).collect(),
        }
    }
}

/// A polygon is a region without holes.
impl From<Polygon> for Region {
    fn from(polygon: Polygon) -> Self {
        Self {
            rings: vec![polygon.vertices().to_vec()],
        }
    }
}

/// No edge may touch another but its neighbours at their common vertex.
fn check_apart(rings: &[Ring]) -> Result<(), RegionError> {
    let points: Vec<Vec2> = rings
        .iter()
        .flat_map(|ring| ring.points.iter().copied())
        .collect();
    let lengths = || rings.iter().map(|ring| ring.points.len());
    let Some((i, j)) = Rings::several(&points, lengths()).first_contact() else {
        return Ok(());
    };
    let place = |edge: usize| {
        let mut rest = edge;
        for (ring, length) in lengths().enumerate() {
            if rest < length {
                return (ring, rings[ring].edge_as_given(rest));
            }
            rest -= length;
        }
        (rings.len(), rest)
    };
    let ((first, one), (second, other)) = (place(i), place(j));
    if first == second {
        return Err(RegionError::Ring {
            ring: first,
            error: PolygonError::SelfIntersecting {
                first: one.min(other),
                second: one.max(other),
            },
        });
    }
    Err(RegionError::Meeting {
        first,
        first_edge: one,
        second,
        second_edge: other,
    })
}

/// Holes inside of the outer ring, and none in another. Rings are apart: one point tells all.
fn check_nesting(rings: &[Vec<Vec2>]) -> Result<(), RegionError> {
    let boxes: Vec<Aabb> = rings
        .iter()
        .map(|ring| Aabb::from_points(ring.iter().copied()))
        .collect();
    let within = |ring: usize, other: usize| {
        boxes[other].contains(boxes[ring]) && winds_around(&rings[other], rings[ring][0])
    };
    for ring in 1..rings.len() {
        if !within(ring, 0) {
            return Err(RegionError::Outside { ring });
        }
        if let Some(other) = (1..rings.len()).find(|&other| other != ring && within(ring, other)) {
            return Err(RegionError::Nested {
                ring,
                within: other,
            });
        }
    }
    Ok(())
}
