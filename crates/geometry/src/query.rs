//! Questions that one shape answers about a point or a ray.

use carom_math::{Vec2, cross, orient2d};

use crate::convex::outward_normal;
use crate::{Aabb, Outline, Shape};

/// Where a ray enters a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Along the ray, in lengths of its direction: metres for a unit direction.
    pub distance: f64,
    /// Where, in m.
    pub point: Vec2,
    /// Outward unit normal there.
    pub normal: Vec2,
}

impl Shape {
    /// Whether `point` (in m, in the frame of the shape) lies inside or on the rim.
    ///
    /// Exact for polygons and segments: a point beside an edge is never taken for one on it.
    #[must_use]
    pub fn contains(&self, point: Vec2) -> bool {
        self.outline().contains(point)
    }

    /// The point of the shape nearest to `point`, in m: `point` itself if it lies inside.
    #[must_use]
    pub fn closest_point(&self, point: Vec2) -> Vec2 {
        if self.contains(point) {
            point
        } else {
            self.closest_rim_point(point)
        }
    }

    /// The point of the rim nearest to `point`, in m, from inside and outside.
    ///
    /// The first of equally near ones; to the right of the centre of a circle. Of a compound, that
    /// of the part which the point is nearest to or deepest in: seams between parts count as rim.
    #[must_use]
    pub fn closest_rim_point(&self, point: Vec2) -> Vec2 {
        self.outline().closest_rim_point(point)
    }

    /// Distance of `point` from the rim, in m; negative inside.
    ///
    /// Of a compound the least of its parts' (G. H. Hart's union, 1996): outside it is the distance,
    /// inside the depth in the part that the point is deepest in, at most the depth in the whole.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::{ConvexPolygon, Shape};
    /// use carom_math::{Vec2, vec2};
    /// let square = Shape::from(ConvexPolygon::square(2.0)?);
    /// assert_eq!(square.signed_distance(Vec2::ZERO), -1.0);            // m
    /// assert_eq!(square.signed_distance(vec2(4.0, 5.0)), 5.0);         // from the corner (1, 1)
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    #[must_use]
    pub fn signed_distance(&self, point: Vec2) -> f64 {
        self.outline().signed_distance(point)
    }

    /// Where a ray from `origin` enters the shape first, within `max` lengths of `direction`.
    ///
    /// A ray that starts inside or on the rim does not enter: `None`. A ray through a corner does not
    /// slip between its edges, and one that grazes a corner touches it. Segments are hit from both
    /// sides, not end on.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::{ConvexPolygon, Shape};
    /// use carom_math::vec2;
    /// let square = Shape::from(ConvexPolygon::square(2.0)?);
    /// let hit = square.cast_ray(vec2(-5.0, 0.5), vec2(1.0, 0.0), 10.0).unwrap();
    /// assert_eq!((hit.distance, hit.normal), (4.0, vec2(-1.0, 0.0)));  // m, and against the ray
    /// assert_eq!(square.cast_ray(vec2(-5.0, 0.5), vec2(1.0, 0.0), 3.9), None);
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        self.outline().cast_ray(origin, direction, max)
    }

    /// The point of the shape farthest along `direction` (of any length above 0), in m: a corner,
    /// the first of equal ones. `None` where a half-plane goes on without end.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::{Circle, HalfPlane, Shape};
    /// use carom_math::{Vec2, vec2};
    /// let disc = Shape::from(Circle::new(2.0)?);
    /// assert_eq!(disc.support(vec2(0.0, 3.0)), Some(vec2(0.0, 2.0)));   // m
    /// let ground = Shape::from(HalfPlane::new(vec2(1.0, 5.0), Vec2::Y)?);
    /// assert_eq!(ground.support(Vec2::Y), Some(vec2(1.0, 5.0)));
    /// assert_eq!(ground.support(Vec2::X), None);
    /// # Ok::<(), carom_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn support(&self, direction: Vec2) -> Option<Vec2> {
        match self {
            Self::Circle(circle) => {
                let unit = direction / direction.abs().max_element();
                Some(circle.centre() + unit.normalize_or_zero() * circle.radius())
            }
            Self::HalfPlane(wall) => {
                let straight = cross(wall.normal(), direction) == 0.0;
                let out = wall.normal().dot(direction) >= 0.0;
                (straight && out).then_some(wall.point())
            }
            Self::Compound(compound) => {
                let points = compound.parts().iter().filter_map(|p| p.support(direction));
                points.reduce(|best, p| farther(best, p, direction))
            }
            _ => {
                let points = self.vertices().iter().copied();
                points.reduce(|best, p| farther(best, p, direction))
            }
        }
    }
}

/// The same questions, to whatever has an outline.
impl Outline<'_> {
    pub(crate) fn contains(self, point: Vec2) -> bool {
        match self {
            Outline::Circle { centre, radius } => {
                (point - centre).length_squared() <= radius * radius
            }
            Outline::Open(points) => edges(points, false).any(|edge| on_edge(edge, point)),
            Outline::Closed(points) => winds_around(points, point),
            Outline::Rings(rings) => wind_around(edges_of(rings), point),
            Outline::HalfPlane { point: on, normal } => normal.dot(point - on) <= 0.0,
            Outline::Parts(parts) => parts.iter().any(|part| part.contains(point)),
        }
    }

    pub(crate) fn closest_rim_point(self, point: Vec2) -> Vec2 {
        match self {
            Outline::Circle { centre, radius } => {
                centre + (point - centre).normalize_or(Vec2::X) * radius
            }
            Outline::Open(points) => nearest(point, edges(points, false)),
            Outline::Closed(points) => nearest(point, edges(points, true)),
            Outline::Rings(rings) => nearest(point, edges_of(rings)),
            Outline::HalfPlane { point: on, normal } => point - normal * normal.dot(point - on),
            Outline::Parts(parts) => {
                let deepest = |best: (f64, Vec2), part: &Shape| {
                    let distance = part.signed_distance(point);
                    if distance < best.0 {
                        (distance, part.closest_rim_point(point))
                    } else {
                        best
                    }
                };
                parts.iter().fold((f64::INFINITY, point), deepest).1
            }
        }
    }

    pub(crate) fn signed_distance(self, point: Vec2) -> f64 {
        match self {
            Outline::Circle { centre, radius } => (point - centre).length() - radius,
            Outline::HalfPlane { point: on, normal } => normal.dot(point - on),
            Outline::Parts(parts) => {
                let distances = parts.iter().map(|part| part.signed_distance(point));
                distances.fold(f64::INFINITY, f64::min)
            }
            Outline::Open(_) | Outline::Closed(_) | Outline::Rings(_) => {
                let distance = self.closest_rim_point(point).distance(point);
                if self.contains(point) {
                    -distance
                } else {
                    distance
                }
            }
        }
    }

    pub(crate) fn cast_ray(self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        if self.contains(origin) {
            return None;
        }
        let ray = Ray {
            origin,
            direction,
            max,
        };
        match self {
            Outline::Circle { centre, radius } => ray.at_circle(centre, radius),
            Outline::Open(points) => ray.at_wall(points[0], points[1]),
            Outline::Closed(points) => ray.at_edges(edges(points, true)),
            Outline::Rings(rings) => ray.at_edges(edges_of(rings)),
            Outline::HalfPlane { point, normal } => ray.at_line(point, normal),
            Outline::Parts(parts) => {
                let hits = parts
                    .iter()
                    .filter_map(|part| part.cast_ray(origin, direction, max));
                hits.min_by(|one, two| one.distance.total_cmp(&two.distance))
            }
        }
    }
}

struct Ray {
    origin: Vec2,
    direction: Vec2,
    max: f64,
}

impl Ray {
    /// From outside.
    fn at_circle(&self, centre: Vec2, radius: f64) -> Option<RayHit> {
        let from_centre = self.origin - centre;
        let square = self.direction.length_squared();
        let approach = -from_centre.dot(self.direction);
        // The discriminant by the distance of the line from the centre: it does not cancel.
        let across = cross(from_centre, self.direction);
        let discriminant = square * radius * radius - across * across;
        if approach <= 0.0 || discriminant < 0.0 {
            return None;
        }
        // The earlier root of a t² − 2 b t + c in the form that does not cancel either.
        let far = from_centre.length();
        let distance = (far - radius) * (far + radius) / (approach + discriminant.sqrt());
        (distance <= self.max).then(|| {
            let normal = (from_centre + self.direction * distance).normalize_or(Vec2::X);
            RayHit {
                distance,
                point: centre + normal * radius,
                normal,
            }
        })
    }

    /// From in front of a line.
    fn at_line(&self, point: Vec2, normal: Vec2) -> Option<RayHit> {
        let closing = -normal.dot(self.direction);
        if closing <= 0.0 {
            return None;
        }
        let distance = normal.dot(self.origin - point) / closing;
        (distance <= self.max).then(|| RayHit {
            distance,
            point: self.origin + self.direction * distance,
            normal,
        })
    }

    fn at_wall(&self, a: Vec2, b: Vec2) -> Option<RayHit> {
        self.at_edge(a, b).or_else(|| self.at_edge(b, a))
    }

    fn at_edges(&self, edges: impl Iterator<Item = (Vec2, Vec2)>) -> Option<RayHit> {
        let hits = edges.filter_map(|(a, b)| self.at_edge(a, b));
        hits.min_by(|one, two| one.distance.total_cmp(&two.distance))
    }

    /// Through an edge from its right to its left.
    fn at_edge(&self, a: Vec2, b: Vec2) -> Option<RayHit> {
        // On which side of the ray an end lies is the same number for both edges that meet there.
        let (to_a, to_b) = (a - self.origin, b - self.origin);
        let (left_a, left_b) = (cross(self.direction, to_a), cross(self.direction, to_b));
        if !(left_a >= 0.0 && left_b <= 0.0 && left_a > left_b) {
            return None;
        }
        let part = left_a / (left_a - left_b);
        let meeting = to_a + (b - a) * part;
        let distance = meeting.dot(self.direction) / self.direction.length_squared();
        (0.0..=self.max).contains(&distance).then(|| RayHit {
            distance,
            point: a + (b - a) * part,
            normal: outward_normal(a, b),
        })
    }
}

/// The one of two points that lies farther along `direction`; the first if neither does.
fn farther(first: Vec2, second: Vec2, direction: Vec2) -> Vec2 {
    if second.dot(direction) > first.dot(direction) {
        second
    } else {
        first
    }
}

/// Edges of a line or a ring.
fn edges(points: &[Vec2], closed: bool) -> impl Iterator<Item = (Vec2, Vec2)> {
    let closing = points.first().filter(|_| closed);
    let ends = points.iter().skip(1).chain(closing);
    points.iter().zip(ends).map(|(a, b)| (*a, *b))
}

/// Edges of several rings.
fn edges_of(rings: &[Vec<Vec2>]) -> impl Iterator<Item = (Vec2, Vec2)> {
    rings.iter().flat_map(|ring| edges(ring, true))
}

/// Whether `p` lies on a closed edge; exact.
fn on_edge((a, b): (Vec2, Vec2), p: Vec2) -> bool {
    Aabb::from_points([a, b]).contains_point(p) && orient2d(a, b, p) == 0.0
}

/// Whether a simple ring winds around `p`, its edges included; exact.
pub(crate) fn winds_around(ring: &[Vec2], p: Vec2) -> bool {
    wind_around(edges(ring, true), p)
}

/// Whether rings wind around `p` an odd number of times, their edges included; exact.
fn wind_around(edges: impl Iterator<Item = (Vec2, Vec2)>, p: Vec2) -> bool {
    let mut inside = false;
    for (a, b) in edges {
        // A horizontal ray to the right: an edge counts with its lower end, without its upper one.
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        if p.y < low.y || p.y > high.y {
            continue;
        }
        if on_edge((a, b), p) {
            return true;
        }
        if p.y < high.y && orient2d(low, high, p) > 0.0 {
            inside = !inside;
        }
    }
    inside
}

fn nearest(point: Vec2, edges: impl Iterator<Item = (Vec2, Vec2)>) -> Vec2 {
    let mut best = (f64::INFINITY, point);
    for (a, b) in edges {
        let along = b - a;
        let part = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let candidate = if part < 1.0 { a + along * part } else { b };
        let square = candidate.distance_squared(point);
        if square < best.0 {
            best = (square, candidate);
        }
    }
    best.1
}
