//! A simple ring cut into convex pieces, without new vertices.
//!
//! Ears are clipped by exact predicates (G. H. Meisters, 1975), then cuts that no corner needs are
//! taken out again (S. Hertel, K. Mehlhorn, 1983): at most four times as many pieces as must be.

use carom_math::{Vec2, cross, orient2d};

use crate::convex::outward_normals;

/// A convex piece of a polygon: which edges are true, and where its corners can be touched.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPiece {
    vertices: Vec<Vec2>,
    normals: Vec<Vec2>,
    boundary: Vec<bool>,
    cones: Vec<Cone>,
}

impl ConvexPiece {
    /// Corners, strictly convex and counter-clockwise, in m.
    #[must_use]
    pub fn vertices(&self) -> &[Vec2] {
        &self.vertices
    }

    /// Outward unit normals; number `i` belongs to the edge from vertex `i` to the next.
    #[must_use]
    pub fn normals(&self) -> &[Vec2] {
        &self.normals
    }

    /// Whether edge `i` belongs to the outline; else it is a cut.
    #[must_use]
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.boundary[edge]
    }

    /// Outward normal cone of the *outline* at each corner.
    #[must_use]
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    pub(crate) fn translated(&self, offset: Vec2) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| *v + offset).collect(),
            ..self.clone()
        }
    }
}

/// The directions in which an outline can be touched at a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit normal of the outline's edge before the corner.
    from: Vec2,
    /// Unit normal of the outline's edge after the corner.
    to: Vec2,
    reflex: bool,
}

/// Slack of a cone, as the sine of an angle: a contact normal along an edge's own normal is inside
/// after any rounding, and one that is visibly off is not.
const CONE_SLACK: f64 = 1e-9;

impl Cone {
    /// Whether the unit `direction`, pointing away from the polygon, lies in the cone.
    #[must_use]
    pub fn contains(&self, direction: Vec2) -> bool {
        !self.reflex
            && cross(self.from, direction) >= -CONE_SLACK
            && cross(direction, self.to) >= -CONE_SLACK
            // A corner sharper than a right angle: both sines are positive behind it, too.
            && (self.from + self.to).dot(direction) >= -CONE_SLACK
    }

    /// Whether no direction lies in the cone: nothing convex can touch a reflex corner.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.reflex
    }
}

/// Convex pieces of a simple counter-clockwise ring without straight corners.
pub(crate) fn decompose(ring: &[Vec2]) -> Vec<ConvexPiece> {
    let n = ring.len();
    let normals = outward_normals(ring);
    let cones: Vec<Cone> = (0..n)
        .map(|i| {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            Cone {
                from: normals[before],
                to: normals[i],
                reflex: orient2d(ring[before], ring[i], ring[after]) <= 0.0,
            }
        })
        .collect();
    let convex = cones.iter().all(|cone| !cone.is_empty());
    let parts = if convex {
        vec![(0..n).collect()]
    } else {
        merge(ring, clip_ears(ring))
    };
    parts
        .into_iter()
        .map(|part| {
            let vertices: Vec<Vec2> = part.iter().map(|&i| ring[i]).collect();
            let next = part.iter().cycle().skip(1);
            ConvexPiece {
                normals: outward_normals(&vertices),
                boundary: part
                    .iter()
                    .zip(next)
                    .map(|(i, j)| (i + 1) % n == *j)
                    .collect(),
                cones: part.iter().map(|&i| cones[i]).collect(),
                vertices,
            }
        })
        .collect()
}

/// Triangles of the ring, as indices.
fn clip_ears(ring: &[Vec2]) -> Vec<Vec<usize>> {
    let n = ring.len();
    let mut before: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let mut after: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    // Only corners that do not bend outwards can lie in an ear; clipping never makes new ones.
    let dull = |a: usize, i: usize, b: usize| orient2d(ring[a], ring[i], ring[b]) <= 0.0;
    let mut blockers: Vec<usize> = (0..n).filter(|&i| dull(before[i], i, after[i])).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    let (mut i, mut left, mut misses) = (0, n, 0);
    while left > 3 {
        let (a, b) = (before[i], after[i]);
        let is_ear = !dull(a, i, b)
            && !blockers.iter().any(|&q| {
                q != a && q != i && q != b && in_triangle(ring[q], [ring[a], ring[i], ring[b]])
            });
        // Every simple ring has two ears; a full round without one can only be a broken promise,
        // and then any corner that bends outwards ends the search.
        if is_ear || (misses > left && (!dull(a, i, b) || misses > 2 * left)) {
            triangles.push(vec![a, i, b]);
            after[a] = b;
            before[b] = a;
            left -= 1;
            misses = 0;
            blockers.retain(|&q| q != i && dull(before[q], q, after[q]));
            // On from the far end, so that ears do not all meet in one corner.
            i = after[b];
        } else {
            misses += 1;
            i = b;
        }
    }
    triangles.push(vec![before[i], i, after[i]]);
    triangles
}

/// Closed triangle, counter-clockwise; exact.
fn in_triangle(q: Vec2, [a, b, c]: [Vec2; 3]) -> bool {
    orient2d(a, b, q) >= 0.0 && orient2d(b, c, q) >= 0.0 && orient2d(c, a, q) >= 0.0
}

/// Takes out every cut whose ends stay strictly convex without it.
fn merge(ring: &[Vec2], parts: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let n = ring.len();
    // Each cut belongs to two parts: find them by the cut's direction.
    let mut cuts: Vec<(usize, usize, usize)> = Vec::new();
    for (p, part) in parts.iter().enumerate() {
        for (i, j) in part.iter().zip(part.iter().cycle().skip(1)) {
            if (i + 1) % n != *j {
                cuts.push((*i, *j, p));
            }
        }
    }
    cuts.sort_unstable();
    let owner = |i: usize, j: usize| {
        let at = cuts.binary_search_by(|cut| (cut.0, cut.1).cmp(&(i, j)));
        at.ok().map(|at| cuts[at].2)
    };
    let mut parts: Vec<Option<Vec<usize>>> = parts.into_iter().map(Some).collect();
    let mut joined: Vec<usize> = (0..parts.len()).collect();
    for &(i, j, p) in cuts.iter().filter(|(i, j, _)| i < j) {
        let Some(q) = owner(j, i) else { continue };
        let (p, q) = (root(&mut joined, p), root(&mut joined, q));
        let (Some(one), Some(two)) = (&parts[p], &parts[q]) else {
            continue;
        };
        if p == q {
            continue;
        }
        if let Some(whole) = join(ring, one, two, i, j) {
            parts[p] = Some(whole);
            parts[q] = None;
            joined[q] = p;
        }
    }
    parts.into_iter().flatten().collect()
}

fn root(joined: &mut [usize], mut p: usize) -> usize {
    while joined[p] != p {
        joined[p] = joined[joined[p]];
        p = joined[p];
    }
    p
}

/// Both parts without their common cut `i → j` (of `one`), if that is strictly convex.
fn join(ring: &[Vec2], one: &[usize], two: &[usize], i: usize, j: usize) -> Option<Vec<usize>> {
    // `one` from j around to i, then `two` from after i around to before j.
    let from = |part: &[usize], start: usize| -> Option<Vec<usize>> {
        let at = part.iter().position(|k| *k == start)?;
        Some(part[at..].iter().chain(&part[..at]).copied().collect())
    };
    let (one, two) = (from(one, j)?, from(two, i)?);
    let inner = &two[1..two.len() - 1];
    let whole: Vec<usize> = one.iter().chain(inner).copied().collect();
    let strict =
        |before: usize, k: usize, after: usize| orient2d(ring[before], ring[k], ring[after]) > 0.0;
    let at_i = strict(one[one.len() - 2], i, inner[0]);
    let at_j = strict(inner[inner.len() - 1], j, one[1]);
    (at_i && at_j).then_some(whole)
}
