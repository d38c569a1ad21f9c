//! Whether rings touch themselves or each other: exact, and in O(n log n) where they are large.
//!
//! Edges may meet only as neighbours, at their common vertex. Edges that cross, a vertex on an edge,
//! a vertex visited twice and edges that overlap all count as contact.

use carom_math::{Vec2, orient2d};

use crate::Aabb;

/// Below so many edges every pair is compared: no slower, and it names the first pair in order.
const FEW: usize = 64;

/// Two edges i < j that touch where they must not; edge i runs from point i to the next.
///
/// No two neighbours in `points` may be equal, and no coordinate −0.
pub(crate) fn first_contact(points: &[Vec2]) -> Option<(usize, usize)> {
    Rings::one(points).first_contact()
}

/// An edge that runs back over the one before.
pub(crate) fn fold(points: &[Vec2]) -> Option<(usize, usize)> {
    Rings::one(points).fold()
}

/// Points of one or several rings, one ring after the other; edge i runs from point i to the next of
/// its ring.
pub(crate) struct Rings<'a> {
    points: &'a [Vec2],
    /// The next point of the ring, and the last.
    after: Vec<usize>,
    before: Vec<usize>,
}

impl<'a> Rings<'a> {
    fn one(points: &'a [Vec2]) -> Self {
        Self::several(points, [points.len()])
    }

    /// Rings of these lengths.
    pub(crate) fn several(points: &'a [Vec2], lengths: impl IntoIterator<Item = usize>) -> Self {
        let mut after: Vec<usize> = (1..=points.len()).collect();
        let mut before: Vec<usize> = (0..points.len()).map(|i| i.wrapping_sub(1)).collect();
        let mut start = 0;
        for length in lengths {
            let end = start + length;
            if length > 0 {
                after[end - 1] = start;
                before[start] = end - 1;
            }
            start = end;
        }
        Self {
            points,
            after,
            before,
        }
    }

    /// Two edges i < j that touch where they must not.
    ///
    /// No two neighbours may be equal, and no coordinate −0.
    pub(crate) fn first_contact(&self) -> Option<(usize, usize)> {
        if self.points.len() < FEW {
            return self.all_pairs();
        }
        if let Some(pair) = self.fold() {
            return Some(pair);
        }
        match Sweep::new(self).run() {
            Ok(found) => found,
            // Only if a predicate underflowed.
            Err(LostOrder) => self.all_pairs(),
        }
    }

    /// Every pair, boxes first.
    fn all_pairs(&self) -> Option<(usize, usize)> {
        let n = self.points.len();
        let boxes: Vec<Aabb> = (0..n).map(|i| Aabb::from_points(self.edge(i))).collect();
        (0..n)
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .find(|&(i, j)| boxes[i].overlaps(boxes[j]) && self.in_contact(i, j))
    }

    /// An edge that runs back over the one before.
    fn fold(&self) -> Option<(usize, usize)> {
        let folds = |i: &usize| {
            let corner = [self.before[*i], *i, self.after[*i]];
            let [before, here, after] = corner.map(|k| self.points[k]);
            folds(before, here, after)
        };
        let at = (0..self.points.len()).find(folds)?;
        Some(pair(at, self.before[at]))
    }

    /// Both ends of an edge.
    fn edge(&self, i: usize) -> [Vec2; 2] {
        [self.points[i], self.points[self.after[i]]]
    }

    /// Whether edges i < j touch where they must not; exact.
    fn in_contact(&self, i: usize, j: usize) -> bool {
        let ([a, b], [c, d]) = (self.edge(i), self.edge(j));
        if self.after[i] == j {
            return folds(a, b, d);
        }
        if self.after[j] == i {
            return folds(c, a, b);
        }
        segments_touch([a, b], [c, d])
    }
}

fn folds(before: Vec2, here: Vec2, after: Vec2) -> bool {
    orient2d(before, here, after) == 0.0 && {
        // On one line: the same side in either coordinate is the same side.
        let back = (
            before.x > here.x,
            before.y > here.y,
            before.x < here.x,
            before.y < here.y,
        );
        let on = (
            after.x > here.x,
            after.y > here.y,
            after.x < here.x,
            after.y < here.y,
        );
        back == on
    }
}

/// Whether two closed segments have a point in common; exact.
fn segments_touch([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> bool {
    let apart = |x: f64, y: f64| (x > 0.0 && y > 0.0) || (x < 0.0 && y < 0.0);
    let (from_ab, to_ab) = (orient2d(a, b, c), orient2d(a, b, d));
    if apart(from_ab, to_ab) || apart(orient2d(c, d, a), orient2d(c, d, b)) {
        return false;
    }
    // Each crosses the line of the other; all four on one line if both are 0: then boxes decide.
    from_ab != 0.0 || to_ab != 0.0 || Aabb::from_points([a, b]).overlaps(Aabb::from_points([c, d]))
}

/// The edges are not in the order that the sweep left them in.
struct LostOrder;

/// A line that sweeps over the ring from left to right (M. I. Shamos, D. Hoey, 1976).
///
/// Points come in the order of x, then y, as if the plane were sheared a little: so vertical edges
/// are no special case. Two edges that touch are neighbours on the line before it gets there.
struct Sweep<'a> {
    rings: &'a Rings<'a>,
    points: &'a [Vec2],
    /// Edges that the line crosses, from low to high. A plain list: at 100,000 vertices the
    /// longest shift is 400 kB, and outlines cross a line in few places.
    crossed: Vec<usize>,
}

type Found = Option<(usize, usize)>;

impl<'a> Sweep<'a> {
    fn new(rings: &'a Rings<'a>) -> Self {
        Self {
            rings,
            points: rings.points,
            crossed: Vec::new(),
        }
    }

    fn run(mut self) -> Result<Found, LostOrder> {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by(|&i, &j| {
            let (p, q) = (self.points[i], self.points[j]);
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
        });
        let repeated = order
            .windows(2)
            .find(|same| self.points[same[0]] == self.points[same[1]]);
        if let Some(same) = repeated {
            return Ok(Some(pair(self.edge_into(same[0]), self.edge_into(same[1]))));
        }
        for vertex in order {
            if let Some(found) = self.pass(vertex)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// Moves the line over one vertex.
    fn pass(&mut self, vertex: usize) -> Result<Found, LostOrder> {
        let here = self.points[vertex];
        let edges = [self.edge_into(vertex), vertex];
        // Edges below the vertex; then those that end here; then those above.
        let low = self
            .crossed
            .partition_point(|&edge| self.side(edge, here) > 0.0);
        let ends = |edge: &usize| edges.contains(edge);
        let ending = self.crossed[low..]
            .iter()
            .take_while(|edge| ends(edge))
            .count();
        let high = low + ending;
        if let Some(&next) = self.crossed.get(high)
            && self.side(next, here) == 0.0
        {
            return Ok(Some(pair(next, edges[0])));
        }
        let begins = edges.map(|edge| self.right_of(edge, here));
        if begins.iter().filter(|begins| !**begins).count() != ending {
            return Err(LostOrder);
        }
        match begins {
            [true, true] => {
                // The lower of the two first; the ring does not fold, so they differ.
                let other = |edge: usize| self.far_end(edge, vertex);
                let turn = orient2d(here, other(edges[0]), other(edges[1]));
                let [lower, upper] = if turn > 0.0 {
                    edges
                } else {
                    [edges[1], edges[0]]
                };
                self.crossed.splice(low..low, [lower, upper]);
                Ok(self.meeting(low).or_else(|| self.meeting(low + 2)))
            }
            [false, false] => {
                self.crossed.drain(low..high);
                Ok(self.meeting(low))
            }
            [true, false] | [false, true] => {
                self.crossed[low] = if begins[0] { edges[0] } else { edges[1] };
                Ok(self.meeting(low).or_else(|| self.meeting(low + 1)))
            }
        }
    }

    /// Whether the edges just below and at place `at` of the line touch.
    fn meeting(&self, at: usize) -> Found {
        let below = *self.crossed.get(at.checked_sub(1)?)?;
        let (i, j) = pair(below, *self.crossed.get(at)?);
        self.rings.in_contact(i, j).then_some((i, j))
    }

    /// Positive where `p` lies above the edge.
    fn side(&self, edge: usize, p: Vec2) -> f64 {
        let [a, b] = self.rings.edge(edge);
        if (a.x, a.y) < (b.x, b.y) {
            orient2d(a, b, p)
        } else {
            orient2d(b, a, p)
        }
    }

    /// Whether an edge that has an end `here` lies ahead of the line.
    fn right_of(&self, edge: usize, here: Vec2) -> bool {
        let [a, b] = self.rings.edge(edge);
        let far = if a == here { b } else { a };
        (far.x, far.y) > (here.x, here.y)
    }

    fn far_end(&self, edge: usize, vertex: usize) -> Vec2 {
        if edge == vertex {
            self.points[self.rings.after[edge]]
        } else {
            self.points[edge]
        }
    }

    fn edge_into(&self, vertex: usize) -> usize {
        self.rings.before[vertex]
    }
}

/// The lower number first.
fn pair(i: usize, j: usize) -> (usize, usize) {
    (i.min(j), i.max(j))
}

#[cfg(test)]
mod tests {
    use carom_math::vec2;
    use proptest::prelude::*;

    use super::*;

    /// What the sweep says; `Err` where it lost its order.
    fn swept(points: &[Vec2]) -> Result<Found, LostOrder> {
        let rings = Rings::one(points);
        if let Some(pair) = rings.fold() {
            return Ok(Some(pair));
        }
        Sweep::new(&rings).run()
    }

    fn without_repetitions(points: Vec<(i32, i32)>) -> Vec<Vec2> {
        let mut points: Vec<Vec2> = points
            .into_iter()
            .map(|(x, y)| vec2(f64::from(x), f64::from(y)))
            .collect();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]
        #[test]
        fn the_sweep_finds_what_all_pairs_find(
            points in prop::collection::vec((0..7_i32, 0..7_i32), 3..12),
        ) {
            // On so small a grid every kind of contact comes up, and so do simple rings.
            let points = without_repetitions(points);
            if points.len() < 3 {
                return Ok(());
            }
            let Ok(found) = swept(&points) else {
                return Err(TestCaseError::fail("the sweep lost its order"));
            };
            prop_assert_eq!(found.is_some(), Rings::one(&points).all_pairs().is_some());
            if let Some((i, j)) = found {
                prop_assert!(i < j && Rings::one(&points).in_contact(i, j), "edges {} and {}", i, j);
            }
        }
    }

    #[test]
    fn one_bad_corner_among_many_is_found() {
        let n = 500;
        let circle = |i: usize| {
            let turn = carom_math::Rot::from_degrees(360.0 * i as f64 / n as f64);
            turn * vec2(if i.is_multiple_of(2) { 1.0 } else { 0.9 }, 0.0)
        };
        let good: Vec<Vec2> = (0..n).map(circle).collect();
        assert_eq!(first_contact(&good), None);
        for at in [1, 100, 250, 499] {
            let mut bad = good.clone();
            bad[at] *= -1.5;
            let Some((i, j)) = first_contact(&bad) else {
                panic!("vertex {at} on the other side went unnoticed");
            };
            assert!(Rings::one(&bad).in_contact(i, j));
        }
    }
}
