//! `{ circle = 0.5 }` and its like: one key says what the shape is, others place it.

use serde::Deserialize;

use super::body::MaterialChoice;
use super::filter::FilterTable;
use super::value::Point;

/// A shape. Exactly one of the fields up to `segment` is given.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ShapeTable {
    pub(crate) circle: Option<f64>,
    pub(crate) rectangle: Option<Point>,
    pub(crate) square: Option<f64>,
    pub(crate) regular: Option<RegularTable>,
    pub(crate) triangle: Option<TriangleTable>,
    pub(crate) polygon: Option<Vec<Point>>,
    pub(crate) hull: Option<Vec<Point>>,
    pub(crate) star: Option<StarTable>,
    pub(crate) segment: Option<[Point; 2]>,
    /// Where the shape's own origin is in the body's frame, in m.
    pub(crate) offset: Option<Point>,
    /// How it is turned there, in rad or degrees.
    pub(crate) turn: Option<f64>,
    pub(crate) turn_deg: Option<f64>,
    /// Instead of the body's material.
    pub(crate) material: Option<MaterialChoice>,
    /// Instead of the body's filter.
    pub(crate) filter: Option<FilterTable>,
}

/// The keys that name a shape.
pub(crate) const SHAPES: [&str; 9] = [
    "circle",
    "rectangle",
    "square",
    "regular",
    "triangle",
    "polygon",
    "hull",
    "star",
    "segment",
];

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RegularTable {
    pub(crate) sides: usize,
    pub(crate) radius: f64,
}

/// Two sides and the angle between them.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TriangleTable {
    pub(crate) a: f64,
    pub(crate) b: f64,
    #[serde(default)]
    pub(crate) angle: Option<f64>,
    #[serde(default)]
    pub(crate) angle_deg: Option<f64>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StarTable {
    pub(crate) points: usize,
    pub(crate) outer: f64,
    pub(crate) inner: f64,
}

impl ShapeTable {
    /// The shapes that are given: a valid table has one.
    pub(crate) fn given(&self) -> Vec<&'static str> {
        let given = [
            self.circle.is_some(),
            self.rectangle.is_some(),
            self.square.is_some(),
            self.regular.is_some(),
            self.triangle.is_some(),
            self.polygon.is_some(),
            self.hull.is_some(),
            self.star.is_some(),
            self.segment.is_some(),
        ];
        SHAPES
            .into_iter()
            .zip(given)
            .filter_map(|(name, given)| given.then_some(name))
            .collect()
    }
}
