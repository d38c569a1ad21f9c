//! Edges in blocks of four: what wide arithmetic takes.

use std::sync::OnceLock;

use carom_math::Vec2;

/// Four edges of a convex polygon side by side, each number as an array of four.
///
/// A loop over the four lanes has no branch in it, and compiles to wide instructions.
/// 128 bytes; where the edges are no multiple of four the last one is repeated, which changes
/// neither a smallest nor a largest value.
///
/// # Examples
/// ```
/// use carom_geometry::ConvexPolygon;
/// let triangle = ConvexPolygon::regular(3, 1.0)?;
/// let [block] = triangle.blocks() else { panic!("three edges fit in one") };
/// assert_eq!(block.x[2], triangle.vertices()[2].x);
/// assert_eq!(block.x[3], block.x[2]);
/// assert_eq!(block.normal_y[1], triangle.normals()[1].y);
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(16))]
pub struct EdgeBlock {
    /// Corners at which the edges begin, in m.
    pub x: [f64; 4],
    /// Corners at which the edges begin, in m.
    pub y: [f64; 4],
    /// Outward unit normals.
    pub normal_x: [f64; 4],
    /// Outward unit normals.
    pub normal_y: [f64; 4],
}

/// The blocks of a polygon, made when they are first asked for: shapes that are only drawn never have any.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks(OnceLock<Box<[EdgeBlock]>>);

impl Blocks {
    #[inline]
    pub(crate) fn of(&self, vertices: &[Vec2], normals: &[Vec2]) -> &[EdgeBlock] {
        self.0.get_or_init(|| edge_blocks(vertices, normals))
    }
}

/// Always equal: blocks follow from corners and normals.
impl PartialEq for Blocks {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The edges in order, four at a time; `normals[i]` belongs to the edge that begins at `vertices[i]`.
fn edge_blocks(vertices: &[Vec2], normals: &[Vec2]) -> Box<[EdgeBlock]> {
    let blocks = vertices.chunks(4).zip(normals.chunks(4));
    let block = |(vertices, normals): (&[Vec2], &[Vec2])| {
        let vertex = |lane: usize| vertices[lane.min(vertices.len() - 1)];
        let normal = |lane: usize| normals[lane.min(normals.len() - 1)];
        let lanes = [0, 1, 2, 3];
        EdgeBlock {
            x: lanes.map(|lane| vertex(lane).x),
            y: lanes.map(|lane| vertex(lane).y),
            normal_x: lanes.map(|lane| normal(lane).x),
            normal_y: lanes.map(|lane| normal(lane).y),
        }
    };
    blocks.map(block).collect()
}
