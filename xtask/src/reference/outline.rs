//! What a body of a case looks like.

use carom_geometry::{Circle, ConvexPolygon, HalfPlane, Polygon, Shape};
use carom_math::Vec2;
use serde_json::Value;

use super::book::{number_at, points_at};
use super::symmetry::Symmetry;

/// A circle or a ring of vertices, in m, or all behind a line through the origin.
#[derive(Clone, Debug)]
pub(super) enum Outline {
    Circle(f64),
    Polygon(Vec<Vec2>),
    /// Its outward normal.
    Behind(Vec2),
}

impl Outline {
    /// Reads `{"circle": …}` or `{"polygon": …}`.
    pub(super) fn read(shape: &Value) -> Result<Self, String> {
        if shape.get("circle").is_some() {
            Ok(Self::Circle(number_at(shape, "circle")?))
        } else {
            Ok(Self::Polygon(points_at(shape, "polygon")?))
        }
    }

    /// With M the mirror image and Q the quarter turns, Q M R(angle) v = R(∓angle) (Q M v): the vertices take both.
    /// They are perhaps run through backwards.
    pub(super) fn transform(&mut self, symmetry: &Symmetry) {
        match self {
            Self::Circle(_) => {}
            Self::Behind(normal) => *normal = symmetry.vector(*normal),
            Self::Polygon(points) => {
                points.iter_mut().for_each(|p| *p = symmetry.vector(*p));
                if !(symmetry.label / 2).is_multiple_of(2) {
                    points.reverse();
                }
            }
        }
    }

    /// The narrowest type that takes it.
    pub(super) fn built(&self) -> Result<Shape, String> {
        match self {
            Self::Circle(radius) => Circle::new(*radius)
                .map(Shape::from)
                .map_err(|error| error.to_string()),
            Self::Behind(normal) => HalfPlane::new(Vec2::ZERO, *normal)
                .map(Shape::from)
                .map_err(|error| error.to_string()),
            Self::Polygon(points) => ConvexPolygon::new(points.as_slice())
                .map(Shape::from)
                .or_else(|_| Polygon::new(points.as_slice()).map(Shape::from))
                .map_err(|error| error.to_string()),
        }
    }
}
