//! From a list of points to a ring without repetitions, in counter-clockwise order.

use carom_math::{Vec2, orient2d};

use crate::error::{COORDINATE_LIMIT, LENGTH_LIMIT, VERTEX_LIMIT};
use crate::{Aabb, PolygonError, simple};

/// A checked ring: finite, of some size, not all on one line, no point twice in a row.
pub(crate) struct Ring {
    pub(crate) points: Vec<Vec2>,
    /// Where each point was in the list that came in: the first of a run of equal ones.
    pub(crate) given: Vec<usize>,
    /// Where the last of that run was: the edge to the next point begins there.
    leaves: Vec<usize>,
}

impl Ring {
    /// Checks a ring for everything but crossings; keeps the order of turn.
    pub(crate) fn new(points: &[Vec2]) -> Result<Self, PolygonError> {
        check_points(points)?;
        let ring = Self::without_repetitions(points);
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
        if ring.is_straight() {
            return Err(PolygonError::Degenerate);
        }
        Ok(ring)
    }

    /// Checks that no two edges touch but neighbours at their common vertex.
    ///
    /// Before the ring is turned: edges are named as they were given.
    pub(crate) fn check_simple(&self) -> Result<(), PolygonError> {
        match simple::first_contact(&self.points) {
            None => Ok(()),
            Some((i, j)) => {
                let (i, j) = (self.edge_as_given(i), self.edge_as_given(j));
                Err(PolygonError::SelfIntersecting {
                    first: i.min(j),
                    second: i.max(j),
                })
            }
        }
    }

    /// The number of an edge in the list that came in.
    pub(crate) fn edge_as_given(&self, edge: usize) -> usize {
        self.leaves[edge]
    }

    /// Whether some edge runs straight back over the one before.
    pub(crate) fn folds(&self) -> bool {
        simple::fold(&self.points).is_some()
    }

    /// The ring with a positive turn, for a ring that does not cross itself.
    pub(crate) fn counter_clockwise(mut self) -> Self {
        if self.is_clockwise() {
            self.points.reverse();
            self.given.reverse();
            // Point i now leaves along the edge by which point i − 1 left before.
            self.leaves.reverse();
            self.leaves.rotate_left(1);
        }
        self
    }

    /// Drops the points that lie exactly between their neighbours.
    pub(crate) fn without_straight(&self) -> Self {
        let mut points = Vec::with_capacity(self.points.len());
        let mut given = Vec::with_capacity(self.points.len());
        let mut leaves = Vec::with_capacity(self.points.len());
        for (i, (before, here, after)) in corners(&self.points).enumerate() {
            if orient2d(before, here, after) != 0.0 {
                points.push(here);
                given.push(self.given[i]);
                leaves.push(self.leaves[i]);
            }
        }
        Self {
            points,
            given,
            leaves,
        }
    }

    fn without_repetitions(points: &[Vec2]) -> Self {
        let mut ring = Self {
            points: Vec::with_capacity(points.len()),
            given: Vec::with_capacity(points.len()),
            leaves: Vec::with_capacity(points.len()),
        };
        for (i, p) in points.iter().enumerate() {
            // −0 becomes 0, so that an order by coordinates is one.
            let p = *p + Vec2::ZERO;
            if ring.points.last() == Some(&p) {
                if let Some(leaves) = ring.leaves.last_mut() {
                    *leaves = i;
                }
            } else {
                ring.points.push(p);
                ring.given.push(i);
                ring.leaves.push(i);
            }
        }
        // The end of the list may repeat its beginning.
        if ring.points.len() > 1 && ring.points.first() == ring.points.last() {
            ring.points.pop();
            ring.leaves.pop();
            ring.given.pop();
        }
        ring
    }

    fn check_count(&self) -> Result<(), PolygonError> {
        let mut distinct: Vec<Vec2> = Vec::with_capacity(3);
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

    fn is_straight(&self) -> bool {
        // Any two points that differ span the line.
        let (a, b) = (self.points[0], self.points[1]);
        self.points.iter().all(|p| orient2d(a, b, *p) == 0.0)
    }

    /// The turn at the leftmost point decides (the lowest of them); exact.
    fn is_clockwise(&self) -> bool {
        let mut best: Option<(Vec2, f64)> = None;
        for (before, here, after) in corners(&self.points) {
            if best.is_none_or(|(lowest, _)| (here.x, here.y) < (lowest.x, lowest.y)) {
                best = Some((here, orient2d(before, here, after)));
            }
        }
        best.is_some_and(|(_, turn)| turn < 0.0)
    }
}

/// Every point with the ones before and after it, from point 0 on.
pub(crate) fn corners(points: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2, Vec2)> {
    let before = points.last().into_iter().chain(points);
    let after = points.iter().skip(1).chain(points.first());
    before
        .zip(points)
        .zip(after)
        .map(|((before, here), after)| (*before, *here, *after))
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
