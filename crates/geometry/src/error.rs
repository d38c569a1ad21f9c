//! What can be wrong with a shape.

use thiserror::Error;

/// Largest coordinate of a shape, in m: squares of it keep their digits in `f64`.
pub const COORDINATE_LIMIT: f64 = 1e12;

/// Smallest length that means something, in m: squares of areas of it stay above underflow.
pub const LENGTH_LIMIT: f64 = 1e-30;

/// Most vertices of one ring.
pub const VERTEX_LIMIT: usize = 1 << 24;

/// Why a ring of points is no polygon. Indices count the points as they were given.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// Fewer than three points that differ.
    #[error("a polygon needs 3 distinct vertices, got {count}")]
    TooFewVertices {
        /// How many points differ.
        count: usize,
    },
    /// More points than a ring may have.
    #[error("a polygon has at most {limit} vertices, got {count}")]
    TooManyVertices {
        /// How many points were given.
        count: usize,
        /// How many are accepted.
        limit: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {index} is not finite: {value} in its {axis} coordinate")]
    NotFinite {
        /// Which point.
        index: usize,
        /// x or y.
        axis: char,
        /// What it was.
        value: f64,
    },
    /// A coordinate lies beyond [`COORDINATE_LIMIT`].
    #[error("vertex {index} is too large: {value:e} in its {axis} coordinate, limit {limit:e}")]
    TooLarge {
        /// Which point.
        index: usize,
        /// x or y.
        axis: char,
        /// What it was.
        value: f64,
        /// Largest magnitude that is accepted.
        limit: f64,
    },
    /// All points lie within less than [`LENGTH_LIMIT`].
    #[error("the polygon is too small: {extent:e} m across, limit {limit:e}")]
    TooSmall {
        /// Larger side of its box, in m.
        extent: f64,
        /// Smallest that is accepted.
        limit: f64,
    },
    /// All points lie on one line, or the ring encloses no area.
    #[error("the polygon is degenerate: its vertices enclose no area")]
    Degenerate,
    /// Two edges cross, touch or overlap. Edge `i` goes from vertex `i` to the next.
    #[error("the polygon intersects itself: edge {first} meets edge {second}")]
    SelfIntersecting {
        /// The earlier edge.
        first: usize,
        /// The later edge.
        second: usize,
    },
    /// The ring turns the wrong way at a vertex, where a convex one is asked for.
    #[error("the polygon is not convex at vertex {index}")]
    NotConvex {
        /// Which vertex.
        index: usize,
    },
    /// A length or angle of a generator is not above zero (or not finite).
    #[error("{name} is {value}, not a finite number above 0")]
    NotPositive {
        /// Which parameter.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// A parameter of a generator lies outside its range.
    #[error("{name} is {value}, outside {low}..{high}")]
    OutOfRange {
        /// Which parameter.
        name: &'static str,
        /// What it was.
        value: f64,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

/// Why rings are no region. Ring 0 is the outer one, ring `k` the `k`-th hole.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RegionError {
    /// A ring is no polygon.
    #[error("ring {ring}: {error}")]
    Ring {
        /// Which ring.
        ring: usize,
        /// What is wrong with it.
        error: PolygonError,
    },
    /// Two rings cross or touch. Edge `i` goes from vertex `i` to the next, as they were given.
    #[error("edge {first_edge} of ring {first} meets edge {second_edge} of ring {second}")]
    Meeting {
        /// The earlier ring.
        first: usize,
        /// Its edge.
        first_edge: usize,
        /// The later ring.
        second: usize,
        /// Its edge.
        second_edge: usize,
    },
    /// A hole lies outside of the outer ring.
    #[error("ring {ring}, a hole, lies outside of the outer ring")]
    Outside {
        /// Which ring.
        ring: usize,
    },
    /// A hole lies inside of another.
    #[error("ring {ring}, a hole, lies inside of ring {within}, another")]
    Nested {
        /// Which ring.
        ring: usize,
        /// The ring around it.
        within: usize,
    },
}

/// Why a shape was not made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A number is NaN or infinite.
    #[error("{name} is {value}, not a finite number")]
    NotFinite {
        /// Which parameter.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number must be above zero.
    #[error("{name} is {value}, not above 0")]
    NotPositive {
        /// Which parameter.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number lies beyond [`COORDINATE_LIMIT`] (or a length below [`LENGTH_LIMIT`]).
    #[error("{name} is {value:e}, outside {low:e}..{high:e}")]
    OutOfRange {
        /// Which parameter.
        name: &'static str,
        /// What it was.
        value: f64,
        /// Smallest magnitude that is accepted.
        low: f64,
        /// Largest magnitude that is accepted.
        high: f64,
    },
    /// Both ends of a segment are at one place.
    #[error("the segment has no length: both ends are at ({x}, {y})")]
    NoLength {
        /// x of both ends, in m.
        x: f64,
        /// y of both ends, in m.
        y: f64,
    },
    /// A vector that has to point somewhere is zero.
    #[error("{name} is (0, 0), which points nowhere")]
    NoDirection {
        /// Which parameter.
        name: &'static str,
    },
    /// A half-plane has no area, and is no part of anything.
    #[error("a half-plane has no end: it has no mass, and cannot be part of a compound")]
    Unbounded,
    /// A compound of nothing.
    #[error("the compound has no parts")]
    NoParts,
    /// The ring of a polygon.
    #[error(transparent)]
    Polygon(#[from] PolygonError),
}
