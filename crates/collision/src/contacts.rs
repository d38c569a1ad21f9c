//! The contacts of any two shapes, part by part.

use carom_geometry::{Aabb, Shape};
use carom_math::Pose;

use crate::{Hull, Manifold, collide_within, hulls, part, part_count};

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

/// Appends every contact of two shapes whose separation is at most `margin` (metres) to `out`.
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
    /// Pairs of parts above which boxes are sorted instead of compared one by one.
    const SORT_ABOVE: usize = 32 * 32;
    let (count_a, count_b) = (part_count(a), part_count(b));
    let first = out.len();
    let mut meet = |part_a: usize, hull_a: &Hull<'_>, part_b: usize, hull_b: &Hull<'_>| {
        let manifold = collide_within(hull_a, hull_b, b_in_a, margin);
        if !manifold.points.is_empty() {
            push(out, first, part_a, part_b, manifold);
        }
    };
    if count_a == 1 && count_b == 1 {
        meet(0, &part(a, 0), 0, &part(b, 0));
    } else if count_a * count_b <= SORT_ABOVE {
        for (j, hull_b) in hulls(b).enumerate() {
            let box_b = hull_b.aabb(b_in_a).grown(margin);
            for (i, hull_a) in hulls(a).enumerate() {
                if hull_a.aabb(Pose::IDENTITY).overlaps(box_b) {
                    meet(i, &hull_a, j, &hull_b);
                }
            }
        }
    } else {
        for (i, j) in near_parts(a, b, b_in_a, margin) {
            meet(i, &part(a, i), j, &part(b, j));
        }
    }
    out[first..].sort_by_key(|contact| (contact.part_a, contact.part_b));
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

/// Pairs of parts whose boxes overlap, by a sweep along x.
fn near_parts(a: &Shape, b: &Shape, b_in_a: Pose, margin: f64) -> Vec<(usize, usize)> {
    let sorted = |shape: &Shape, pose: Pose, margin: f64| {
        let mut boxes: Vec<(usize, Aabb)> = hulls(shape)
            .map(|hull| hull.aabb(pose).grown(margin))
            .enumerate()
            .collect();
        boxes.sort_by(|p, q| p.1.min.x.total_cmp(&q.1.min.x));
        boxes
    };
    let (boxes_a, boxes_b) = (sorted(a, Pose::IDENTITY, 0.0), sorted(b, b_in_a, margin));
    // Whoever begins later looks at those of the other list that have not ended.
    let mut open_a: Vec<(usize, Aabb)> = Vec::new();
    let mut open_b: Vec<(usize, Aabb)> = Vec::new();
    let mut pairs = Vec::new();
    let (mut i, mut j) = (0, 0);
    while i < boxes_a.len() || j < boxes_b.len() {
        let a_first =
            j == boxes_b.len() || (i < boxes_a.len() && boxes_a[i].1.min.x <= boxes_b[j].1.min.x);
        if a_first {
            let (part, bounds) = boxes_a[i];
            open_b.retain(|(_, other)| other.max.x >= bounds.min.x);
            pairs.extend(
                open_b
                    .iter()
                    .filter(|(_, o)| o.overlaps(bounds))
                    .map(|(k, _)| (part, *k)),
            );
            open_a.push((part, bounds));
            i += 1;
        } else {
            let (part, bounds) = boxes_b[j];
            open_a.retain(|(_, other)| other.max.x >= bounds.min.x);
            pairs.extend(
                open_a
                    .iter()
                    .filter(|(_, o)| o.overlaps(bounds))
                    .map(|(k, _)| (*k, part)),
            );
            open_b.push((part, bounds));
            j += 1;
        }
    }
    pairs.sort_unstable();
    pairs
}
