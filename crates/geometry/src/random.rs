//! Polygons by chance: the same numbers make the same polygon, and no numbers make a bad one.
//!
//! `next` gives numbers from 0 to 1, as any generator can; values outside are clamped.

use carom_math::{Vec2, orient2d, vec2};

use crate::generate::{check_count, check_length, part_of_turn, real};
use crate::{Aabb, ConvexPolygon, Polygon, PolygonError};

/// How often numbers that make a degenerate polygon are thrown away before a shape that cannot be
/// degenerate is made of them.
const TRIES: usize = 4;

impl ConvexPolygon {
    /// An irregular polygon with its corners on a circle about the origin; `circumradius` in m.
    ///
    /// `next` gives numbers from 0 to 1 (values outside are clamped), one a corner; the same numbers
    /// make the same polygon. Corners keep a tenth of an even share apart, so that none is needless.
    ///
    /// # Errors
    /// If there are fewer than 3 sides or too many, or the radius is not above 0.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let mut step = 0.0;
    /// let mut next = || { step += 0.618; step % 1.0 };
    /// let stone = ConvexPolygon::random(7, 0.5, &mut next)?;
    /// assert_eq!(stone.vertices().len(), 7);
    /// assert!(stone.vertices().iter().all(|v| (v.length() - 0.5).abs() < 1e-15));
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn random(
        sides: usize,
        circumradius: f64,
        next: &mut impl FnMut() -> f64,
    ) -> Result<Self, PolygonError> {
        check_length("circumradius", circumradius)?;
        check_count(sides)?;
        let corners = (0..sides)
            .map(|i| part_of_turn(real(i) + 0.9 * share(next()), sides) * vec2(circumradius, 0.0));
        Self::new(corners.collect::<Vec<Vec2>>())
    }

    /// A random convex polygon of `sides` corners in a box about the origin, which it touches on all
    /// sides; `width` and `height` in m.
    ///
    /// Sides go in all directions, corners lie at all distances: unlike [`Self::random`] it can be thin.
    /// Source: P. Valtr, *Probability that n random points are in convex position*, 1995.
    ///
    /// # Errors
    /// If there are fewer than 3 sides or too many, or a length is not above 0.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::ConvexPolygon;
    /// let mut state = 1_u64;
    /// let mut next = || {
    ///     state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    ///     (state >> 40) as f64 / (1 << 24) as f64
    /// };
    /// let stone = ConvexPolygon::random_in_box(9, 4.0, 3.0, &mut next)?;
    /// assert_eq!(stone.vertices().len(), 9);
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn random_in_box(
        sides: usize,
        width: f64,
        height: f64,
        next: &mut impl FnMut() -> f64,
    ) -> Result<Self, PolygonError> {
        check_length("width", width)?;
        check_length("height", height)?;
        check_count(sides)?;
        for _ in 0..TRIES {
            let corners = valtr(sides, next);
            let corners = fitted(&corners, vec2(width, height));
            if let Ok(polygon) = Self::new(corners)
                && polygon.vertices().len() == sides
            {
                return Ok(polygon);
            }
        }
        // Corners on an ellipse: nothing can make them straight.
        let round = Self::random(sides, 1.0, next)?;
        Self::new(fitted(round.vertices(), vec2(width, height)))
    }
}

impl Polygon {
    /// A random polygon of `count` corners that sees all of them from the origin: at even turns but
    /// for chance, at distances between `inner` and `outer`, in m.
    ///
    /// # Errors
    /// If there are fewer than 3 corners or too many, or a radius is not above 0.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::Polygon;
    /// let mut step = 0.0;
    /// let mut next = || { step += 0.618; step % 1.0 };
    /// let rock = Polygon::random_star(11, 0.5, 2.0, &mut next)?;
    /// assert!(rock.contains(carom_geometry::math::vec2(0.0, 0.0)));
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn random_star(
        count: usize,
        inner: f64,
        outer: f64,
        next: &mut impl FnMut() -> f64,
    ) -> Result<Self, PolygonError> {
        check_length("inner", inner)?;
        check_length("outer", outer)?;
        check_count(count)?;
        // No gap may reach half a turn: (1 + late) / count of a turn.
        let late = if count == 3 { 0.45 } else { 0.9 };
        let corners = (0..count).map(|i| {
            let turn = part_of_turn(real(i) + late * share(next()), count);
            turn * vec2(inner + (outer - inner) * share(next()), 0.0)
        });
        Self::new(corners.collect::<Vec<Vec2>>())
    }

    /// A random polygon of `count` corners in a box about the origin; `width` and `height` in m.
    ///
    /// Anything can come out: spirals, needles, deep bays. Corners are spread over the box by
    /// chance, and joined by cutting them in two again and again: O(n log n) as a rule.
    /// Source: T. Auer, M. Held, *Heuristics for the generation of random polygons*, 1996 ("space
    /// partitioning").
    ///
    /// # Errors
    /// If there are fewer than 3 corners or too many, or a length is not above 0.
    ///
    /// # Examples
    /// ```
    /// use carom_geometry::Polygon;
    /// let mut state = 1_u64;
    /// let mut next = || {
    ///     state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    ///     (state >> 40) as f64 / (1 << 24) as f64
    /// };
    /// let outline = Polygon::random(100, 4.0, 3.0, &mut next)?;
    /// assert_eq!(outline.vertices().len(), 100);
    /// # Ok::<(), carom_geometry::PolygonError>(())
    /// ```
    pub fn random(
        count: usize,
        width: f64,
        height: f64,
        next: &mut impl FnMut() -> f64,
    ) -> Result<Self, PolygonError> {
        check_length("width", width)?;
        check_length("height", height)?;
        check_count(count)?;
        let size = vec2(width, height);
        for _ in 0..TRIES {
            let mut points: Vec<Vec2> = (0..count)
                .map(|_| (vec2(share(next()), share(next())) - 0.5) * size)
                .collect();
            if thread(&mut points, next)
                && let Ok(polygon) = Self::new(points)
                && polygon.vertices().len() == count
            {
                return Ok(polygon);
            }
        }
        let star = Self::random_star(count, 0.1, 0.5, next)?;
        Self::new(fitted(star.vertices(), size))
    }
}

/// A number of the generator's as a part of 1.
fn share(number: f64) -> f64 {
    // NaN is clamped to NaN, and max takes the number.
    number.clamp(0.0, 1.0).max(0.0)
}

/// A whole number below `count`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and at most the count"
)]
fn pick(count: usize, next: &mut impl FnMut() -> f64) -> usize {
    ((share(next()) * real(count)) as usize).min(count - 1)
}

/// Stretched to fill a box about the origin; the outermost corners lie exactly on it.
fn fitted(points: &[Vec2], size: Vec2) -> Vec<Vec2> {
    let bounds = Aabb::from_points(points.iter().copied());
    let (centre, extents) = (bounds.centre(), bounds.extents());
    points
        .iter()
        .map(|p| (*p - centre) / extents * size)
        .collect()
}

/// Corners of a convex polygon, counter-clockwise, on a grid that keeps their sums exact; fewer than
/// `sides`, or on one line, where the numbers fall together.
fn valtr(sides: usize, next: &mut impl FnMut() -> f64) -> Vec<Vec2> {
    let along_x = loop_of_steps(sides, next);
    let mut along_y = loop_of_steps(sides, next);
    for i in (1..sides).rev() {
        along_y.swap(i, pick(i + 1, next));
    }
    let steps = along_x.into_iter().zip(along_y).map(|(x, y)| vec2(x, y));
    // A step of no length has no direction to be sorted by.
    let mut steps: Vec<Vec2> = steps.filter(|step| *step != Vec2::ZERO).collect();
    let lower = |v: &Vec2| v.y < 0.0 || (v.y == 0.0 && v.x < 0.0);
    steps.sort_by(|a, b| {
        let turn = orient2d(Vec2::ZERO, *a, *b);
        lower(a).cmp(&lower(b)).then(0.0_f64.total_cmp(&turn))
    });
    let mut here = Vec2::ZERO;
    let walk = steps.into_iter().map(|step| {
        here += step;
        here
    });
    walk.collect()
}

/// Whole numbers that add to zero: the ways between random places, from the first to the last and
/// back, each place on the way there or back by chance.
fn loop_of_steps(count: usize, next: &mut impl FnMut() -> f64) -> Vec<f64> {
    /// Sums of 2²⁴ of them stay below 2⁵³: exact.
    const GRID: f64 = (1_u64 << 40) as f64;
    let mut places: Vec<f64> = (0..count).map(|_| (share(next()) * GRID).round()).collect();
    places.sort_by(f64::total_cmp);
    let (first, last) = (places[0], places[count - 1]);
    let mut steps = Vec::with_capacity(count);
    let (mut there, mut back) = (first, first);
    for place in &places[1..count - 1] {
        if next() < 0.5 {
            steps.push(place - there);
            there = *place;
        } else {
            steps.push(back - place);
            back = *place;
        }
    }
    steps.extend([last - there, back - last]);
    steps
}

/// Puts points into an order in which they make a simple ring; false if chance did not allow it.
///
/// Two points cut all others in two by the line between them. Then again and again: a stretch from
/// its first to its last point is cut by a line through one of its points that parts those two, and
/// what lies on either side becomes a stretch of its own. The hulls of the two touch only there.
fn thread(points: &mut [Vec2], next: &mut impl FnMut() -> f64) -> bool {
    let count = points.len();
    points.swap(0, pick(count, next));
    points.swap(count - 1, 1 + pick(count - 1, next));
    let (first, last) = (points[0], points[count - 1]);
    // The ring is first → those on the right → last → those on the left.
    let middle = 1 + partition(&mut points[1..count - 1], |p| {
        orient2d(first, last, p) < 0.0
    });
    points.swap(middle, count - 1);
    // Stretches by their ends: both belong to it.
    let mut open = vec![(0, middle), (middle, count)];
    while let Some((from, to)) = open.pop() {
        if to - from < 2 {
            continue;
        }
        // The stretch that closes the ring ends where it begins.
        let last = points[to % count];
        let first = points[from];
        let within = &mut points[from + 1..to];
        let Some(through) = cut(within, first, last, next) else {
            return false;
        };
        let at = from + 1 + through;
        open.extend([(from, at), (at, to)]);
    }
    true
}

/// Parts what lies between the ends of a stretch by a line through one of its points; where that
/// point is then. `None` if no line was found.
fn cut(
    within: &mut [Vec2],
    first: Vec2,
    last: Vec2,
    next: &mut impl FnMut() -> f64,
) -> Option<usize> {
    let end = within.len() - 1;
    within.swap(pick(end + 1, next), end);
    let pivot = within[end];
    for _ in 0..TRIES {
        let beyond = first + (last - first) * (0.01 + 0.98 * share(next()));
        let side = |p: Vec2| orient2d(pivot, beyond, p);
        let (of_first, of_last) = (side(first), side(last));
        if of_first * of_last < 0.0 && within[..end].iter().all(|p| side(*p) != 0.0) {
            let at = partition(&mut within[..end], |p| (side(p) > 0.0) == (of_first > 0.0));
            within.swap(at, end);
            return Some(at);
        }
    }
    None
}

/// Brings the points that pass the test to the front; how many they are.
fn partition(points: &mut [Vec2], test: impl Fn(Vec2) -> bool) -> usize {
    let mut passed = 0;
    for i in 0..points.len() {
        if test(points[i]) {
            points.swap(passed, i);
            passed += 1;
        }
    }
    passed
}
