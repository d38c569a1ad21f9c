//! What makes a ring of points a simple polygon.

use carom_math::{Vec2, orient2d};

use crate::error::{COORDINATE_LIMIT, LENGTH_LIMIT, VERTEX_LIMIT};
use crate::{Aabb, PolygonError};

/// A checked ring: finite, counter-clockwise, no point twice in a row, no two edges in contact.
pub(crate) struct Ring {
    pub(crate) points: Vec<Vec2>,
    /// Where each point was in the list that came in.
    pub(crate) given: Vec<usize>,
    /// It came in clockwise.
    reversed: bool,
}

impl Ring {
    /// Checks a ring for everything but crossings.
    pub(crate) fn new(points: &[Vec2]) -> Result<Self, PolygonError> {
        check_points(points)?;
        let mut given: Vec<usize> = Vec::with_capacity(points.len());
        for (i, p) in points.iter().enumerate() {
            if given.last().is_none_or(|&last| points[last] != *p) {
                given.push(i);
            }
        }
        while given.len() > 1 && points[given[0]] == points[given[given.len() - 1]] {
            given.pop();
        }
        let mut ring = Self {
            points: given.iter().map(|&i| points[i]).collect(),
            given,
            reversed: false,
        };
        ring.check_count()?;
        let extent = Aabb::from_points(ring.points.iter().copied())
            .extents()
            .max_element();
        if extent < LENGTH_LIMIT {
            return Err(PolygonError::TooSmall {
                extent,
                limit: LENGTH_LIMIT,
            });
        }
        let base = ring.points[0];
        let far = ring.points.iter().copied().fold(base, |far, p| {
            if (p - base).length_squared() > (far - base).length_squared() {
                p
            } else {
                far
            }
        });
        if ring.points.iter().all(|p| orient2d(base, far, *p) == 0.0) {
            return Err(PolygonError::Degenerate);
        }
        if ring.is_clockwise() {
            ring.points.reverse();
            ring.given.reverse();
            ring.reversed = true;
        }
        Ok(ring)
    }

    /// Checks that no two edges touch but neighbours at their common vertex.
    pub(crate) fn check_simple(&self) -> Result<(), PolygonError> {
        match self.first_contact() {
            None => Ok(()),
            Some((i, j)) => {
                // Named as the caller numbered them.
                let (i, j) = (self.given_edge(i), self.given_edge(j));
                Err(PolygonError::SelfIntersecting {
                    first: i.min(j),
                    second: i.max(j),
                })
            }
        }
    }

    /// Drops the points that lie exactly between their neighbours.
    pub(crate) fn without_straight(&self) -> Self {
        let n = self.points.len();
        let bends = |i: usize| {
            let (before, after) = (self.points[(i + n - 1) % n], self.points[(i + 1) % n]);
            orient2d(before, self.points[i], after) != 0.0
        };
        let kept: Vec<usize> = (0..n).filter(|i| bends(*i)).collect();
        Self {
            points: kept.iter().map(|&i| self.points[i]).collect(),
            given: kept.iter().map(|&i| self.given[i]).collect(),
            reversed: self.reversed,
        }
    }

    fn check_count(&self) -> Result<(), PolygonError> {
        let mut distinct: Vec<Vec2> = Vec::new();
        for p in &self.points {
            if !distinct.contains(p) {
                distinct.push(*p);
            }
            if distinct.len() == 3 {
                return Ok(());
            }
        }
        Err(PolygonError::TooFewVertices {
            count: distinct.len(),
        })
    }

    /// The turn at the lowest of the leftmost points decides, by exact sign.
    fn is_clockwise(&self) -> bool {
        let n = self.points.len();
        let key = |i: usize| (self.points[i].x, self.points[i].y);
        let low = (1..n).fold(0, |low, i| if key(i) < key(low) { i } else { low });
        let p = self.points[low];
        let turn = orient2d(
            self.points[(low + n - 1) % n],
            p,
            self.points[(low + 1) % n],
        );
        // No turn there is a fold: such a ring is refused whichever way it runs.
        turn < 0.0
    }

    fn edge(&self, i: usize) -> (Vec2, Vec2) {
        (self.points[i], self.points[(i + 1) % self.points.len()])
    }

    fn given_edge(&self, i: usize) -> usize {
        let n = self.points.len();
        self.given[if self.reversed { (i + 1) % n } else { i }]
    }

    /// Two edges that touch where they must not: the pair found first in order of x.
    ///
    /// Edges sorted by their left ends, each against those whose x ranges overlap: near-linear for
    /// outlines, quadratic at worst.
    fn first_contact(&self) -> Option<(usize, usize)> {
        let n = self.points.len();
        let boxes: Vec<Aabb> = (0..n)
            .map(|i| Aabb::from_points(<[Vec2; 2]>::from(self.edge(i))))
            .collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| boxes[*a].min.x.total_cmp(&boxes[*b].min.x));
        let mut found: Option<(usize, usize)> = None;
        let mut open: Vec<usize> = Vec::new();
        for &i in &order {
            open.retain(|&j| boxes[j].max.x >= boxes[i].min.x);
            for &j in &open {
                if boxes[i].overlaps(boxes[j]) && self.touch(i.min(j), i.max(j)) {
                    let pair = (i.min(j), i.max(j));
                    found = Some(found.map_or(pair, |known| known.min(pair)));
                }
            }
            if found.is_some() {
                return found;
            }
            open.push(i);
        }
        None
    }

    /// Whether edges i < j touch where they must not.
    fn touch(&self, i: usize, j: usize) -> bool {
        let n = self.points.len();
        let ((a, b), (c, d)) = (self.edge(i), self.edge(j));
        // Neighbours share a vertex; they may only fold back onto each other.
        let folds = |from: Vec2, corner: Vec2, to: Vec2| {
            orient2d(from, corner, to) == 0.0 && (to - corner).dot(from - corner) > 0.0
        };
        if j == i + 1 {
            return folds(a, b, d);
        }
        if i == 0 && j == n - 1 {
            return folds(c, d, b);
        }
        segments_touch(a, b, c, d)
    }
}

/// Whether two closed segments have a point in common; exact.
fn segments_touch(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let (o1, o2) = (orient2d(a, b, c), orient2d(a, b, d));
    let (o3, o4) = (orient2d(c, d, a), orient2d(c, d, b));
    let apart = |x: f64, y: f64| (x > 0.0 && y > 0.0) || (x < 0.0 && y < 0.0);
    if apart(o1, o2) || apart(o3, o4) {
        return false;
    }
    if o1 != 0.0 || o2 != 0.0 {
        return true;
    }
    // All four on one line: their boxes decide.
    Aabb::from_points([a, b]).overlaps(Aabb::from_points([c, d]))
}

/// Finite, within the limits, at least three of them.
pub(crate) fn check_points(points: &[Vec2]) -> Result<(), PolygonError> {
    if points.len() > VERTEX_LIMIT {
        return Err(PolygonError::TooManyVertices {
            count: points.len(),
            limit: VERTEX_LIMIT,
        });
    }
    for (index, p) in points.iter().enumerate() {
        for (axis, value) in [('x', p.x), ('y', p.y)] {
            if !value.is_finite() {
                return Err(PolygonError::NotFinite { index, axis, value });
            }
            if value.abs() > COORDINATE_LIMIT {
                return Err(PolygonError::TooLarge {
                    index,
                    axis,
                    value,
                    limit: COORDINATE_LIMIT,
                });
            }
        }
    }
    if points.len() < 3 {
        return Err(PolygonError::TooFewVertices {
            count: points.len(),
        });
    }
    Ok(())
}
