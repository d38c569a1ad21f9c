//! Tables that stand for many bodies.
//!
//! Each has its own `material`, `filter` and `colour`: were they flattened into one struct, serde could no longer refuse
//! unknown keys.

use serde::Deserialize;

use super::body::{Kind, MaterialChoice};
use super::filter::FilterTable;
use super::shape::ShapeTable;
use super::value::{Corners, CountRange, Point, Range};

/// `[plain]`: the bodies, the gravity and the sleeping of a plain scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlainTable {
    /// Its name.
    pub(crate) scene: String,
    /// The first body that is taken.
    #[serde(default)]
    pub(crate) first: u64,
    /// How many are taken; all that follow, if it is not given.
    #[serde(default)]
    pub(crate) count: Option<u64>,
}

/// `[walls]`: a closed box of four fixed walls.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WallsTable {
    /// The room between the walls.
    pub(crate) inner: Corners,
    #[serde(default = "one_metre")]
    pub(crate) thickness: f64,
    /// Whether the room has a ceiling.
    #[serde(default = "yes")]
    pub(crate) ceiling: bool,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}

fn one_metre() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// `[[population]]`: random bodies that do not overlap at the start.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PopulationTable {
    pub(crate) name: String,
    pub(crate) count: u64,
    /// Where whole bodies lie.
    pub(crate) region: Corners,
    /// Circumradius.
    pub(crate) radius: Range,
    #[serde(default)]
    pub(crate) speed: Option<Range>,
    #[serde(default)]
    pub(crate) spin: Option<Range>,
    #[serde(default = "discs")]
    pub(crate) shapes: Vec<RandomShape>,
    #[serde(default = "three_to_eight")]
    pub(crate) corners: CountRange,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}

fn discs() -> Vec<RandomShape> {
    vec![RandomShape::Disc]
}

fn three_to_eight() -> CountRange {
    CountRange { least: 3, most: 8 }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum RandomShape {
    /// A disc.
    Disc,
    /// A regular polygon.
    Regular,
    /// A convex polygon with its corners on a circle.
    Random,
    /// A rectangle of any proportion between 1 : 1 and 1 : 3.
    Rectangle,
    /// A star with as many points as `corners` says.
    Star,
}

/// `[[stack]]`: boxes on top of each other.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StackTable {
    pub(crate) name: String,
    pub(crate) count: u64,
    /// Middle of the lowest edge.
    pub(crate) base: Point,
    /// Width and height of a box.
    pub(crate) size: Point,
    #[serde(default)]
    pub(crate) gap: f64,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}

/// `[[pyramid]]`: rows of boxes, each one box shorter than the one below.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PyramidTable {
    pub(crate) name: String,
    pub(crate) rows: u64,
    /// Middle of the lowest edge.
    pub(crate) base: Point,
    /// Width and height of a box.
    pub(crate) size: Point,
    /// Between neighbours of a row, and between rows.
    #[serde(default)]
    pub(crate) gap: Option<Point>,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}

/// `[[grid]]`: one shape, `columns` x `rows` times.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GridTable {
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) kind: Kind,
    pub(crate) columns: u64,
    pub(crate) rows: u64,
    /// Origin of the lower left body.
    pub(crate) corner: Point,
    /// From origin to origin, to the right and up.
    pub(crate) spacing: Point,
    pub(crate) shape: ShapeTable,
    #[serde(default)]
    pub(crate) material: MaterialChoice,
    #[serde(default)]
    pub(crate) filter: FilterTable,
    #[serde(default)]
    pub(crate) colour: Option<String>,
}
