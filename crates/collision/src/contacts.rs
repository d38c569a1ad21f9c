//! The contacts of any two shapes, part by part.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2};

use crate::manifold::{Gap, Touch, along_boundary, touch};
use crate::parts::{is_single, near_parts};
use crate::way_out::way_out;
use crate::{Hull, Manifold, part, separating_axis};

/// The contact of one convex part of A with one of B.
#[derive(Clone, Debug, PartialEq)]
pub struct PartManifold {
    /// Index of A's part.
    pub part_a: u32,
    /// Index of B's part.
    pub part_b: u32,
    /// Where they touch, in A's frame; never without a point.
    pub manifold: Manifold,
}

/// Appends every contact of two shapes with a separation of at most `margin` (metres) to `out`.
///
/// Circles, segments and convex polygons have one part; a concave polygon has its pieces, and only
/// its true outline is touched: a box that slides over the seam of two pieces does not feel it.
/// In order of the parts.
///
/// # Examples
/// ```
/// use carom_collision::contacts;
/// use carom_geometry::{Circle, Polygon};
/// use carom_math::{Pose, vec2};
/// // A ball in the corner of an L touches both arms.
/// let l = Polygon::new([
///     vec2(0.0, 0.0), vec2(4.0, 0.0), vec2(4.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 4.0), vec2(0.0, 4.0),
/// ])?;
/// let mut found = Vec::new();
/// contacts(&l.into(), &Circle::new(1.0)?.into(), Pose::at(vec2(1.875, 1.875)), 0.0, &mut found);
/// let mut normals: Vec<_> = found.iter().map(|c| (c.manifold.normal.x, c.manifold.normal.y)).collect();
/// normals.sort_by(|p, q| p.0.total_cmp(&q.0));
/// assert_eq!(normals, [(0.0, 1.0), (1.0, 0.0)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn contacts(a: &Shape, b: &Shape, b_in_a: Pose, margin: f64, out: &mut Vec<PartManifold>) {
    contacts_and_gap(a, b, b_in_a, margin, out);
}

/// [`contacts`], and how far the shapes are apart as far as that was seen: a strip between two convex shapes; of
/// shapes of many parts, that nothing is nearer than the margin.
///
/// # Examples
/// ```
/// use carom_collision::contacts_and_gap;
/// use carom_geometry::{Circle, ConvexPolygon};
/// use carom_math::{Pose, vec2};
/// let (wall, ball) = (ConvexPolygon::rectangle(2.0, 6.0)?.into(), Circle::new(0.5)?.into());   // m
/// let gap = contacts_and_gap(&wall, &ball, Pose::at(vec2(4.0, 1.0)), 0.25, &mut Vec::new());
/// assert_eq!((gap.separation, gap.normal), (2.5, vec2(1.0, 0.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn contacts_and_gap(
    a: &Shape,
    b: &Shape,
    b_in_a: Pose,
    margin: f64,
    out: &mut Vec<PartManifold>,
) -> Gap {
    if is_single(a) && is_single(b) {
        let (touch, gap) = touch(&part(a, 0), &part(b, 0), b_in_a, margin);
        if let Touch::Contact(manifold) = touch {
            let (part_a, part_b) = (0, 0);
            out.push(PartManifold {
                part_a,
                part_b,
                manifold,
            });
        }
        return gap;
    }
    let first = out.len();
    let hidden = part_by_part(a, b, b_in_a, margin, out);
    let depths = out[first..].iter();
    let depths = depths.filter_map(|contact| contact.manifold.deepest());
    Gap {
        separation: depths.fold(hidden, f64::min),
        normal: Vec2::ZERO,
    }
}

/// Gives the least separation of parts that overlap where no contact can be, or the margin.
fn part_by_part(
    a: &Shape,
    b: &Shape,
    b_in_a: Pose,
    margin: f64,
    out: &mut Vec<PartManifold>,
) -> f64 {
    let first = out.len();
    let mut hidden = Vec::new();
    near_parts(a, b, b_in_a, Vec2::ZERO, margin, |i, j| {
        match touch(&part(a, i), &part(b, j), b_in_a, margin).0 {
            Touch::Apart => {}
            Touch::Contact(manifold) => push(out, first, i, j, manifold),
            Touch::Hidden { separation, .. } => hidden.push((i, j, separation)),
        }
    });
    if hidden.is_empty() {
        return margin;
    }
    let least = hidden.iter().map(|(.., separation)| *separation);
    let least = least.fold(margin, f64::min);
    let met = out.len();
    for (i, j, _) in hidden {
        let parts = (part(a, i), part(b, j));
        if !out[first..met]
            .iter()
            .any(|known| ends(known, &parts, b_in_a))
            && let Some(manifold) = along_boundary(&parts.0, &parts.1, b_in_a, margin)
        {
            push(out, first, i, j, manifold);
        }
    }
    let overlaps = |known: &PartManifold| known.manifold.deepest().is_some_and(|d| d <= 0.0);
    if !out[first..].iter().any(overlaps) {
        let found = way_out(a, b, b_in_a).map(|out| out.contacts());
        for (i, j, manifold) in found.into_iter().flatten() {
            push(out, first, i, j, manifold);
        }
    }
    out[first..].sort_by_key(|contact| (contact.part_a, contact.part_b));
    least
}

/// Whether the overlap of two parts is over, up to rounding, once that of a contact of the same shapes is.
fn ends(known: &PartManifold, parts: &(Hull<'_>, Hull<'_>), b_in_a: Pose) -> bool {
    /// Of the depth.
    const ROUNDING: f64 = 1e-6;
    let depth = known.manifold.deepest().map_or(0.0, |d| -d);
    depth > 0.0 && {
        let position = b_in_a.position + known.manifold.normal * depth;
        let then = Pose { position, ..b_in_a };
        separating_axis(&parts.0, &parts.1, then).separation >= -ROUNDING * depth
    }
}

/// Adds a contact unless a neighbouring piece has the same one: two pieces share a corner.
fn push(
    out: &mut Vec<PartManifold>,
    first: usize,
    part_a: usize,
    part_b: usize,
    manifold: Manifold,
) {
    if let [point] = manifold.points[..] {
        let same = |known: &PartManifold| {
            known.manifold.points.len() == 1
                && known.manifold.normal == manifold.normal
                && known.manifold.points[0].point == point.point
        };
        if out[first..].iter().any(same) {
            return;
        }
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "polygons have fewer than 2^32 vertices"
    )]
    out.push(PartManifold {
        part_a: part_a as u32,
        part_b: part_b as u32,
        manifold,
    });
}
