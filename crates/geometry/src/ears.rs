//! A simple ring cut into triangles by clipping ears (G. H. Meisters, 1975), with exact signs.
//!
//! An ear is a corner that bends outwards with nothing else of the ring in its closed triangle.
//! Clipping one leaves a simple ring, any simple ring has two, and only the neighbours of a
//! clipped corner can become ears or cease to be: so no search ever starts again.
//! The ear with the shortest cut goes first. That makes fat triangles, and small ones as long as
//! there are many corners: what lies in them is looked up in a grid, in near-linear time as a rule.
//! Long bays side by side (a comb) break the rule: then `monotone` takes over.

use std::cell::Cell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use carom_math::{Vec2, orient2d};

use crate::Aabb;
use crate::grid::Grid;
use crate::monotone;
use crate::ring::corners;

/// No edge on the other side: a piece of the outline.
pub(crate) const OUTLINE: usize = usize::MAX;

/// Triangles over the points of a ring, and their neighbours.
///
/// Edge `3 t + k` runs from corner k of triangle t to the next, counter-clockwise.
pub(crate) struct Triangles {
    /// Where each edge begins, as an index into the ring.
    pub(crate) origins: Vec<usize>,
    /// The same edge of the neighbouring triangle, or [`OUTLINE`].
    pub(crate) twins: Vec<usize>,
}

/// How many corners may be looked at for each one that is clipped, on the average.
///
/// Spirals and random outlines of 100,000 corners get by with 30, a saw with 100. Stars and combs of that
/// size do not, and go to `monotone`, which takes no longer (`--example large`).
const LOOKS: usize = 100;

/// Triangles of a simple counter-clockwise ring without straight corners.
pub(crate) fn triangulate(ring: &[Vec2]) -> Triangles {
    clipped(ring, LOOKS * ring.len())
        .or_else(|| monotone::triangulate(ring))
        // Only if a predicate underflowed.
        .or_else(|| clipped(ring, usize::MAX))
        .unwrap_or_else(|| unreachable!("ears end without a budget"))
}

/// The triangles, or `None` if more than `looks` corners would have to be looked at.
fn clipped(ring: &[Vec2], looks: usize) -> Option<Triangles> {
    let mut clipper = Clipper::new(ring);
    for corner in 0..ring.len() {
        clipper.offer(corner);
    }
    let mut left = ring.len();
    while left > 3 {
        if clipper.looks.get() > looks {
            return None;
        }
        let ear = clipper.best_ear();
        clipper.clip(ear);
        left -= 1;
    }
    Some(clipper.finish())
}

struct Clipper<'a> {
    ring: &'a [Vec2],
    /// Neighbours on the ring that is left.
    before: Vec<usize>,
    after: Vec<usize>,
    /// Changes with the neighbours of a corner; what the queue says of an older one is void.
    version: Vec<u32>,
    /// Corners of the ring that is left and do not bend outwards: only they can lie in an ear.
    dull: Vec<bool>,
    /// The triangle's edge on the other side of the ring's edge from a corner on.
    across: Vec<usize>,
    /// Corners that bend outwards, by the square of their cut.
    queue: BinaryHeap<Reverse<(u64, usize, u32)>>,
    grid: Grid,
    /// How many corners were looked at.
    looks: Cell<usize>,
    triangles: Triangles,
}

impl<'a> Clipper<'a> {
    fn new(ring: &'a [Vec2]) -> Self {
        let n = ring.len();
        let dull: Vec<bool> = corners(ring)
            .map(|(before, here, after)| orient2d(before, here, after) <= 0.0)
            .collect();
        let blockers = (0..n).filter(|&i| dull[i]).collect();
        Self {
            ring,
            before: (0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }).collect(),
            after: (0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }).collect(),
            version: vec![0; n],
            dull,
            across: vec![OUTLINE; n],
            queue: BinaryHeap::with_capacity(n),
            grid: Grid::new(ring, blockers),
            looks: Cell::new(0),
            triangles: Triangles {
                origins: Vec::with_capacity(3 * (n - 2)),
                twins: Vec::with_capacity(3 * (n - 2)),
            },
        }
    }

    /// Puts a corner into the queue if it bends outwards.
    fn offer(&mut self, i: usize) {
        if !self.dull[i] {
            let cut = self.ring[self.after[i]] - self.ring[self.before[i]];
            // The bits of positive doubles are in their order.
            let key = cut.length_squared().to_bits();
            self.queue.push(Reverse((key, i, self.version[i])));
        }
    }

    fn is_ear(&self, i: usize) -> bool {
        let (a, b) = (self.before[i], self.after[i]);
        let triangle = [self.ring[a], self.ring[i], self.ring[b]];
        let bounds = Aabb::from_points(triangle);
        !self.grid.any_near(bounds, |q| {
            self.looks.set(self.looks.get() + 1);
            self.dull[q] && q != a && q != b && {
                let p = self.ring[q];
                bounds.contains_point(p) && in_triangle(p, triangle)
            }
        })
    }

    fn best_ear(&mut self) -> usize {
        while let Some(Reverse((_, i, version))) = self.queue.pop() {
            // Looked at no earlier: long cuts see much of the ring, and most are void by then.
            // One that is no ear now is none before its neighbours change.
            if self.version[i] == version && self.is_ear(i) {
                return i;
            }
        }
        // Every simple ring has two ears: here a predicate must have underflowed. Any corner that
        // bends outwards keeps the count of triangles right.
        let start = self.before[self.triangles.origins.last().copied().unwrap_or(0)];
        let mut i = start;
        while self.dull[i] {
            i = self.after[i];
            if i == start {
                break;
            }
        }
        i
    }

    /// Cuts off corner `i`.
    fn clip(&mut self, i: usize) {
        let (a, b) = (self.before[i], self.after[i]);
        let cut = self.add_triangle([a, i, b]) + 2;
        self.across[a] = cut;
        self.after[a] = b;
        self.before[b] = a;
        self.dull[i] = false;
        self.version[i] += 1;
        for corner in [a, b] {
            self.version[corner] += 1;
            let [p, q, r] = [self.before[corner], corner, self.after[corner]].map(|k| self.ring[k]);
            // Cutting an ear only makes the angles beside it sharper.
            self.dull[corner] = self.dull[corner] && orient2d(p, q, r) <= 0.0;
            self.offer(corner);
        }
    }

    /// Adds a triangle of three corners in a row and joins it to those beyond the ring.
    ///
    /// Returns its first edge; the third, the cut, is still open.
    fn add_triangle(&mut self, corners: [usize; 3]) -> usize {
        let first = self.triangles.origins.len();
        self.triangles.origins.extend(corners);
        self.triangles.twins.extend([OUTLINE; 3]);
        for (edge, corner) in (first..).zip([corners[0], corners[1]]) {
            self.join(edge, self.across[corner]);
        }
        first
    }

    fn join(&mut self, edge: usize, other: usize) {
        if other != OUTLINE {
            self.triangles.twins[edge] = other;
            self.triangles.twins[other] = edge;
        }
    }

    /// The last three corners.
    fn finish(mut self) -> Triangles {
        // The last corner that was cut off lies between two of them.
        let cut = self.triangles.origins.len().checked_sub(3);
        let a = cut.map_or(0, |cut| self.triangles.origins[cut]);
        let (b, c) = (self.after[a], self.before[a]);
        let first = self.add_triangle([a, b, c]);
        self.join(first + 2, self.across[c]);
        self.triangles
    }
}

/// Closed triangle, counter-clockwise; exact.
fn in_triangle(p: Vec2, [a, b, c]: [Vec2; 3]) -> bool {
    orient2d(a, b, p) >= 0.0 && orient2d(b, c, p) >= 0.0 && orient2d(c, a, p) >= 0.0
}
