//! An outline: what is inside it, by exact signs, and where another one crosses it.

use carom_geometry::Aabb;
use carom_math::{Vec2, orient2d, vec2};

/// A closed outline, counter-clockwise.
pub(super) struct Ring {
    pub(super) points: Vec<Vec2>,
    /// Outward unit normals of the edges `i → i + 1`.
    pub(super) normals: Vec<Vec2>,
    pub(super) bounds: Aabb,
}

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Inside,
    On,
    Outside,
}

/// Where the edges of one ring cross another: for each edge the first way out and the last way in.
pub(super) struct Crossings {
    out: Vec<Option<usize>>,
    into: Vec<Option<usize>>,
}

impl Ring {
    pub(super) fn new(points: Vec<Vec2>) -> Self {
        let next = points.iter().cycle().skip(1);
        let normals = points
            .iter()
            .zip(next)
            .map(|(p, q)| {
                let along = (*q - *p).normalize_or_zero();
                vec2(along.y, -along.x)
            })
            .collect();
        Self {
            normals,
            bounds: Aabb::from_points(points.iter().copied()),
            points,
        }
    }

    pub(super) fn next(&self, i: usize) -> usize {
        if i + 1 == self.points.len() { 0 } else { i + 1 }
    }

    pub(super) fn previous(&self, i: usize) -> usize {
        if i == 0 { self.points.len() - 1 } else { i - 1 }
    }

    /// Both ends of an edge.
    pub(super) fn ends(&self, edge: usize) -> [usize; 2] {
        [edge, self.next(edge)]
    }

    /// Whether the outline bends outwards at a vertex.
    pub(super) fn is_convex(&self, i: usize) -> bool {
        let around = [self.previous(i), i, self.next(i)].map(|k| self.points[k]);
        orient2d(around[0], around[1], around[2]) > 0.0
    }

    /// Inside by winding number, on the outline within `touch` metres.
    pub(super) fn place(&self, point: Vec2, touch: f64) -> Place {
        let mut winding = 0_i32;
        for i in 0..self.points.len() {
            let (from, to) = (self.points[i], self.points[self.next(i)]);
            if reaches(from, to, point, touch) {
                return Place::On;
            }
            if (from.y <= point.y) != (to.y <= point.y) {
                let side = orient2d(from, to, point);
                if to.y > point.y && side > 0.0 {
                    winding += 1;
                } else if to.y <= point.y && side < 0.0 {
                    winding -= 1;
                }
            }
        }
        if winding == 0 {
            Place::Outside
        } else {
            Place::Inside
        }
    }

    /// Edges within `touch` metres of a point.
    pub(super) fn edges_at(&self, point: Vec2, touch: f64) -> Vec<usize> {
        (0..self.points.len())
            .filter(|&i| reaches(self.points[i], self.points[self.next(i)], point, touch))
            .collect()
    }

    /// Where this ring's edges cross the other's.
    pub(super) fn crossings(&self, other: &Self) -> Crossings {
        let n = self.points.len();
        let mut crossings = Crossings {
            out: vec![None; n],
            into: vec![None; n],
        };
        for i in 0..n {
            let (p, q) = (self.points[i], self.points[self.next(i)]);
            let bounds = Aabb::from_points([p, q]);
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for j in 0..other.points.len() {
                let (r, s) = (other.points[j], other.points[other.next(j)]);
                if !bounds.overlaps(Aabb::from_points([r, s])) {
                    continue;
                }
                // The other's inside is on the left of r → s.
                let (at_p, at_q) = (orient2d(r, s, p), orient2d(r, s, q));
                let (at_r, at_s) = (orient2d(p, q, r), orient2d(p, q, s));
                let crosses = at_r.min(at_s) <= 0.0 && at_r.max(at_s) >= 0.0;
                let share = at_p / (at_p - at_q);
                if crosses && at_p > 0.0 && at_q <= 0.0 && share < first {
                    first = share;
                    crossings.out[i] = Some(j);
                } else if crosses && at_p <= 0.0 && at_q > 0.0 && share > last {
                    last = share;
                    crossings.into[i] = Some(j);
                }
            }
        }
        crossings
    }
}

impl Crossings {
    /// Through which edges of the other ring the outline leaves behind a vertex that is inside, and
    /// came in before it.
    pub(super) fn around(&self, vertex: usize) -> [Option<usize>; 2] {
        let n = self.out.len();
        let ahead = (0..n).find_map(|k| self.out[(vertex + k) % n]);
        let behind = (1..=n).find_map(|k| self.into[(vertex + n - k) % n]);
        [ahead, behind]
    }
}

/// Whether a point is within `touch` of the segment.
fn reaches(from: Vec2, to: Vec2, point: Vec2, touch: f64) -> bool {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (from + along * share - point).length_squared() <= touch * touch
}
