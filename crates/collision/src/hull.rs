//! The one convex view that every shape reduces to.
//!
//! A circle is a point with a radius, a segment a polygon of two vertices and two opposite
//! normals, a half-plane one vertex and one normal, a concave polygon several convex pieces.

use carom_geometry::{
    Aabb, Circle, ConvexPart, ConvexPiece, ConvexPolygon, EdgeBlock, HalfPlane, Segment, Shape,
};
use carom_math::{Pose, Vec2, cross};

/// Sine of the angle below which two directions count as one: far above rounding, far below what
/// moves a contact.
const FLUSH: f64 = 1e-9;

/// A borrowed convex shape: the convex hull of `vertices`, grown by `radius`.
///
/// Either there is one vertex and no normal (a circle), or vertex and normal `i` belong to the
/// edge `i → i + 1`, counter-clockwise. One vertex and one normal are a half-plane: everything behind
/// the line. Lengths in metres, in the frame of the shape.
#[derive(Clone, Copy, Debug)]
pub struct Hull<'a> {
    /// One vertex for a circle (its centre) or a half-plane (a point of its line), two for a
    /// segment, the corners of a polygon.
    pub vertices: &'a [Vec2],
    /// Outward unit normals; normal `i` belongs to the edge `i → i + 1`. Empty for a circle.
    pub normals: &'a [Vec2],
    /// Radius of a circle in metres, 0 for everything else.
    pub radius: f64,
    /// The edges of a polygon, four at a time; empty for a circle, a segment, a half-plane.
    pub blocks: &'a [EdgeBlock],
    /// The piece of a concave polygon that this is: it knows which edges are cuts.
    pub boundary: Option<&'a ConvexPiece>,
}

impl<'a> Hull<'a> {
    /// Whether this is everything behind a line, without end.
    #[must_use]
    pub const fn is_half_plane(&self) -> bool {
        self.normals.len() == 1
    }

    /// Whether this is a circle.
    pub(crate) const fn is_disc(&self) -> bool {
        self.normals.is_empty()
    }

    /// The hull with all edges moved inwards by `depth` m; a sharp corner moves by twice that at most. `None` where
    /// an edge has no length left, as of a segment or half-plane.
    #[must_use]
    pub fn inset(&self, depth: f64) -> Option<Shape> {
        if self.is_disc() {
            return Circle::at(self.vertices[0], self.radius - depth)
                .ok()
                .map(Shape::from);
        }
        let corner = |i: usize| {
            let before = if i == 0 { self.normals.len() } else { i } - 1;
            let (m, n) = (self.normals[before], self.normals[i]);
            // p + w with w·m = w·n = −depth: w = −depth (m + n)/(1 + m·n).
            let way = (m + n) / (1.0 + m.dot(n)).max(0.5 * (m + n).length());
            self.vertices[i] - way * depth
        };
        let corners: Vec<Vec2> = (0..self.vertices.len()).map(corner).collect();
        // Beyond its middle a hull is turned round, or inside out, and makes a ring again: outside of itself in the end.
        let keeps = |i: usize| {
            let (from, to) = self.edge(i);
            let edge = |i: usize| corners[self.next(i)] - corners[i];
            let (edge, next) = (edge(i), edge(self.next(i)));
            edge.dot(to - from) > 0.0 && cross(edge, next) > 0.0
        };
        if !(0..corners.len()).all(keeps) {
            return None;
        }
        ConvexPolygon::new(corners).ok().map(Shape::from)
    }

    /// Whether edge `i` belongs to the outline of its shape, and is no cut through it.
    ///
    /// # Panics
    /// If this is a piece and has no edge `i`.
    #[must_use]
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.boundary.is_none_or(|piece| piece.is_boundary(edge))
    }

    /// Whether the true outline can be touched at vertex `i` with a normal along `direction`.
    ///
    /// `direction` points away from the shape, in its frame. A whole convex shape always can; a
    /// piece of a concave one where the direction lies between the normals of the outline there,
    /// or is the normal of one of its edges that ends there.
    ///
    /// # Panics
    /// If this is a piece and has no vertex `i`.
    #[must_use]
    pub fn allows(&self, vertex: usize, direction: Vec2) -> bool {
        self.boundary.is_none_or(|piece| {
            piece.cones()[vertex].contains(direction)
                || [self.previous(vertex), vertex].into_iter().any(|edge| {
                    let normal = self.normals[edge];
                    piece.is_boundary(edge)
                        && normal.dot(direction) > 0.0
                        && cross(normal, direction).abs() <= FLUSH
                })
        })
    }

    /// Both ends of edge `i`.
    ///
    /// # Panics
    /// If there is no vertex `i`.
    #[must_use]
    pub fn edge(&self, i: usize) -> (Vec2, Vec2) {
        (self.vertices[i], self.vertices[self.next(i)])
    }

    /// The vertex farthest along `direction` (the first of equals) and how far it is; of a half-plane
    /// its one vertex.
    #[must_use]
    pub fn support(&self, direction: Vec2) -> (usize, f64) {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, v) in self.vertices.iter().enumerate() {
            let along = v.dot(direction);
            if along > best.1 {
                best = (i, along);
            }
        }
        best
    }

    /// The box of the shape when its frame is at `pose`.
    #[must_use]
    pub fn aabb(&self, pose: Pose) -> Aabb {
        self.aabb_of(pose, |_| true)
    }

    /// The box of what of the shape the outline can be touched at when its frame is at `pose`: of a piece of a concave polygon its
    /// edges on the outline and corners that stick out; empty if it has none.
    #[must_use]
    pub fn outline_aabb(&self, pose: Pose) -> Aabb {
        let Some(piece) = self.boundary else {
            return self.aabb(pose);
        };
        self.aabb_of(pose, |vertex| {
            let edges = [self.previous(vertex), vertex];
            edges.into_iter().any(|edge| piece.is_boundary(edge))
                || !piece.cones()[vertex].is_empty()
        })
    }

    fn aabb_of(&self, pose: Pose, counts: impl Fn(usize) -> bool) -> Aabb {
        if self.is_half_plane() {
            return Aabb::new(Vec2::NEG_INFINITY, Vec2::INFINITY);
        }
        let mut min = Vec2::INFINITY;
        let mut max = Vec2::NEG_INFINITY;
        for (vertex, v) in self.vertices.iter().enumerate() {
            if counts(vertex) {
                let p = pose.point(*v);
                min = min.min(p);
                max = max.max(p);
            }
        }
        Aabb::new(min, max).grown(self.radius)
    }

    /// Index after `i`, around the corner.
    pub(crate) fn next(&self, i: usize) -> usize {
        if i + 1 == self.vertices.len() {
            0
        } else {
            i + 1
        }
    }

    /// Index before `i`, around the corner.
    pub(crate) fn previous(&self, i: usize) -> usize {
        if i == 0 {
            self.vertices.len() - 1
        } else {
            i - 1
        }
    }
}

/// A shape that is one convex hull.
pub trait Convex {
    /// The shape as vertices, normals and a radius.
    fn hull(&self) -> Hull<'_>;
}

impl Convex for Circle {
    fn hull(&self) -> Hull<'_> {
        Hull {
            vertices: self.vertices(),
            normals: &[],
            radius: self.radius(),
            blocks: &[],
            boundary: None,
        }
    }
}

impl Convex for Segment {
    fn hull(&self) -> Hull<'_> {
        Hull {
            vertices: self.vertices(),
            normals: self.normals(),
            radius: 0.0,
            blocks: &[],
            boundary: None,
        }
    }
}

impl Convex for HalfPlane {
    fn hull(&self) -> Hull<'_> {
        Hull {
            vertices: self.vertices(),
            normals: self.normals(),
            radius: 0.0,
            blocks: &[],
            boundary: None,
        }
    }
}

impl Convex for ConvexPolygon {
    fn hull(&self) -> Hull<'_> {
        Hull {
            vertices: self.vertices(),
            normals: self.normals(),
            radius: 0.0,
            blocks: self.blocks(),
            boundary: None,
        }
    }
}

impl Convex for ConvexPiece {
    fn hull(&self) -> Hull<'_> {
        Hull {
            vertices: self.vertices(),
            normals: self.normals(),
            radius: 0.0,
            blocks: self.blocks(),
            boundary: Some(self),
        }
    }
}

impl Convex for Hull<'_> {
    fn hull(&self) -> Hull<'_> {
        *self
    }
}

/// How many convex parts a shape has: 1, or the pieces of a concave polygon, or those of all parts
/// of a compound.
#[must_use]
pub fn part_count(shape: &Shape) -> usize {
    match shape {
        Shape::Polygon(polygon) => polygon.pieces().len(),
        Shape::Compound(compound) => compound.convex_parts().len(),
        // A circle, a segment, a half-plane, a convex polygon.
        _ => 1,
    }
}

/// Convex part `i` of a shape.
///
/// # Panics
/// If `i` is not below [`part_count`].
#[must_use]
pub fn part(shape: &Shape, i: usize) -> Hull<'_> {
    match shape {
        Shape::Circle(circle) => circle.hull(),
        Shape::Segment(segment) => segment.hull(),
        Shape::HalfPlane(wall) => wall.hull(),
        Shape::Convex(polygon) => polygon.hull(),
        Shape::Polygon(polygon) => polygon.pieces()[i].hull(),
        Shape::Compound(compound) => match &compound.convex_parts()[i] {
            ConvexPart::Disc(circle) => circle.hull(),
            ConvexPart::Piece(piece) => piece.hull(),
        },
        // The crates of carom are released together and ask for each other's very version.
        _ => unreachable!("a shape that this version does not know"),
    }
}

/// The convex parts of a shape, in order.
pub fn hulls(shape: &Shape) -> impl ExactSizeIterator<Item = Hull<'_>> {
    (0..part_count(shape)).map(move |i| part(shape, i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_geometry::Polygon;
    use carom_math::vec2;

    #[test]
    fn the_outline_of_a_part_leaves_out_what_is_within() {
        // A valley: of the part under it only the bottom is outline.
        let ring = [(-5.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 1.0), (-5.0, 6.0)];
        let ground = Polygon::new(ring.map(|(x, y)| vec2(x, y))).expect("a valley");
        let shape = Shape::from(ground);
        let heights = hulls(&shape).map(|part| {
            let (whole, outline) = (part.aabb(Pose::IDENTITY), part.outline_aabb(Pose::IDENTITY));
            assert!(whole.union(outline) == whole, "{outline:?} in {whole:?}");
            (whole.max.y, outline.max.y)
        });
        let heights: Vec<_> = heights.collect();
        assert!(heights.contains(&(1.0, 0.0)), "{heights:?}");
        assert!(heights.iter().filter(|(_, top)| *top == 6.0).count() == 2);
        let square = ConvexPolygon::square(1.0).expect("a square");
        let (square, pose) = (square.hull(), Pose::IDENTITY);
        assert_eq!(square.outline_aabb(pose), square.aabb(pose));
    }

    #[test]
    fn edges_of_an_inset_hull_lie_deeper() {
        let triangle = ConvexPolygon::regular(3, 1.0).expect("a triangle");
        let inset = triangle.hull().inset(0.1).expect("a smaller triangle");
        for (n, v) in triangle.hull().normals.iter().zip(triangle.hull().vertices) {
            let outermost = inset.vertices().iter().map(|w| n.dot(*w - *v));
            let outermost = outermost.fold(f64::NEG_INFINITY, f64::max);
            assert!((outermost + 0.1).abs() < 1e-15, "{outermost}");
        }
        let disc = Circle::new(0.5).expect("a disc");
        let smaller = Shape::from(Circle::new(0.4).expect("a disc"));
        assert_eq!(disc.hull().inset(0.1), Some(smaller));
        assert_eq!(disc.hull().inset(0.6), None);
    }

    #[test]
    fn a_hull_that_is_moved_inwards_past_its_middle_is_gone() {
        for sides in 3..9 {
            let polygon = ConvexPolygon::regular(sides, 1.0).expect("regular");
            let middle = polygon.normals()[0].dot(polygon.vertices()[0]);
            for part in [1.01, 1.5, 3.0] {
                assert_eq!(polygon.hull().inset(part * middle), None, "{sides}, {part}");
            }
            assert!(polygon.hull().inset(0.99 * middle).is_some(), "{sides}");
        }
        let wedge = ConvexPolygon::triangle(1.0, 1.0, 0.05).expect("a wedge");
        assert_eq!(wedge.hull().inset(0.25), None);
        // Its blunt corner passes the side opposite to it, which goes slowly: both ends of that are sharp.
        let flat = ConvexPolygon::new([vec2(-1.0, 0.0), vec2(0.0, -0.3), vec2(1.0, 0.0)]);
        let flat = flat.expect("a triangle");
        for depth in [0.3, 0.35] {
            assert_eq!(flat.hull().inset(depth), None, "{depth}");
        }
    }
}
