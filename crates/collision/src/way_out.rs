//! The shortest way out of an overlap of whole shapes, concave ones and compounds too.
//!
//! B moved by t overlaps A if some part of it overlaps some part of A: if t lies in the union of the
//! convex sets { t : k·t < d for all axes k of the two parts }. The shortest way out is the nearest
//! point to 0 outside that union. It leaves every set through one of its sides, or past a corner that
//! a disc makes round, so that it is the nearest point that satisfies a list of conditions, k·t ≥ d or
//! |t − c| ≥ r between two edges, one for every set that is in the way.
//! A search by length tries the lists: the first t that lies in no set is the answer.

mod exit;

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use arrayvec::ArrayVec;
use carom_geometry::Shape;
use carom_math::{Pose, Vec2, vec2};

use crate::cast::touch_point;
use crate::manifold::{Faces, FeatureId, Manifold};
use crate::outline::Pair;
use crate::parts::{is_single, near_parts};
use crate::sat::Face;
use crate::{Side, distance, minimum_push, part, separating_axis};
use exit::{Exit, exits};

/// Lists of conditions that are tried before the search is given up and B is pushed out of A's bounding box.
///
/// Two L-shapes need some ten, stars of 40 points in each other some hundred.
const TRIES: usize = 1024;

/// The shortest translation of B, in metres in A's frame, that ends the overlap of two shapes; `None`
/// if they do not overlap, or if both are half-planes.
///
/// Of convex shapes this is [`crate::minimum_push`]. Concave shapes and compounds are separated as
/// wholes, not part by part. The search is bounded: between shapes of very many parts it may be
/// exhausted, and B is then pushed out of A's bounding box, which is longer than the minimum.
///
/// # Examples
/// ```
/// use carom_collision::shape_push;
/// use carom_geometry::{ConvexPolygon, Polygon};
/// use carom_math::{Pose, vec2};
/// // A box deep in an L, past the cut between its arms: the way out is through the outline.
/// let l = Polygon::new([
///     vec2(0.0, 0.0), vec2(4.0, 0.0), vec2(4.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 4.0), vec2(0.0, 4.0),
/// ])?;
/// let box_ = ConvexPolygon::square(0.5)?;
/// let push = shape_push(&l.into(), &box_.into(), Pose::at(vec2(0.5, 0.625)));
/// assert_eq!(push, Some(vec2(-0.75, 0.0)));                                    // m
/// # Ok::<(), carom_geometry::PolygonError>(())
/// ```
#[must_use]
pub fn shape_push(a: &Shape, b: &Shape, b_in_a: Pose) -> Option<Vec2> {
    if is_single(a) && is_single(b) {
        let push = minimum_push(&part(a, 0), &part(b, 0), b_in_a);
        return push.filter(|push| *push != Vec2::ZERO);
    }
    way_out(a, b, b_in_a).map(|out| out.way)
}

/// The way out of an overlap.
pub(crate) struct WayOut<'a> {
    overlap: Overlap<'a>,
    /// The translation of B.
    way: Vec2,
    /// Whether it is the nearest, and not the way out of the box.
    found: bool,
}

/// What B leans on once it has gone the way.
struct Held {
    parts: (usize, usize),
    /// Unit normal in A's frame, from A to B, and how deep B is along it now, in metres.
    normal: Vec2,
    depth: f64,
    /// The edge; none at a round corner.
    edge: Option<(Side, Face)>,
}

/// Two shapes and what counts as touching, in metres.
#[derive(Clone, Copy)]
struct Overlap<'a> {
    a: &'a Shape,
    b: &'a Shape,
    b_in_a: Pose,
    touch: f64,
}

/// The shortest way out of the overlap of two shapes; `None` if they do not overlap.
pub(crate) fn way_out<'a>(a: &'a Shape, b: &'a Shape, b_in_a: Pose) -> Option<WayOut<'a>> {
    let (box_a, box_b) = (a.aabb(Pose::IDENTITY), b.aabb(b_in_a));
    let size = box_a
        .extents()
        .max_element()
        .min(box_b.extents().max_element());
    // Heights of what lies far from the origins of both frames are rounded by more.
    let corners = [box_a.min, box_a.max, box_b.min, box_b.max, b_in_a.position];
    let coordinates = corners
        .into_iter()
        .flat_map(|corner| corner.abs().to_array());
    let far = coordinates.filter(|x| x.is_finite()).fold(0.0, f64::max);
    let rounding = 16.0 * f64::EPSILON * far;
    let touch = rounding.max(1e-12 * if size.is_finite() { size } else { 0.0 });
    let overlap = Overlap {
        a,
        b,
        b_in_a,
        touch,
    };
    overlap.blocking(Vec2::ZERO)?;
    // Past the bounding box along an axis nothing overlaps. Half-planes end along one axis at most.
    let leave = [
        vec2(box_a.max.x - box_b.min.x, 0.0),
        vec2(box_a.min.x - box_b.max.x, 0.0),
        vec2(0.0, box_a.max.y - box_b.min.y),
        vec2(0.0, box_a.min.y - box_b.max.y),
    ];
    let finite = leave.into_iter().filter(|way| way.is_finite());
    let shorter = |p: &Vec2, q: &Vec2| p.length_squared().total_cmp(&q.length_squared());
    let longest = finite.min_by(shorter);
    let found = overlap.search(longest.map_or(f64::INFINITY, Vec2::length_squared));
    let way = found.or(longest)?;
    way.is_finite().then_some(WayOut {
        overlap,
        way,
        found: found.is_some(),
    })
}

/// Conditions and the nearest point that satisfies them: it holds to one or two of them. What is
/// beyond a corner is not convex, so that a third one may have led to the farther of two points.
#[derive(Clone)]
struct Try {
    conditions: ArrayVec<Exit, 3>,
    way: Vec2,
}

impl Overlap<'_> {
    fn moved(&self, t: Vec2) -> Pose {
        Pose::new(self.b_in_a.position + t, self.b_in_a.rotation)
    }

    /// The two parts that overlap most once B has gone a way.
    fn blocking(&self, t: Vec2) -> Option<(usize, usize)> {
        let gone = self.moved(t);
        let mut worst = (-self.touch, None);
        near_parts(self.a, self.b, gone, Vec2::ZERO, 0.0, |i, j| {
            let separation = separating_axis(&part(self.a, i), &part(self.b, j), gone).separation;
            if separation < worst.0 {
                worst = (separation, Some((i, j)));
            }
        });
        worst.1
    }

    /// The nearest translation for which no parts overlap, if it is found and within a length.
    fn search(&self, longest_squared: f64) -> Option<Vec2> {
        let start = Try {
            conditions: ArrayVec::new(),
            way: Vec2::ZERO,
        };
        // The shortest first; the earliest of equals.
        let mut tries = vec![start];
        let mut open = BinaryHeap::from([Reverse((0, 0))]);
        let mut seen = BTreeSet::new();
        for _ in 0..TRIES {
            let Reverse((_, at)) = open.pop()?;
            let next = tries[at].clone();
            let Some(parts) = self.blocking(next.way) else {
                return Some(next.way);
            };
            let (a, b) = (part(self.a, parts.0), part(self.b, parts.1));
            for exit in exits(&a, &b, self.b_in_a) {
                // What does not hold the point back is left out: the point that is looked for
                // satisfies the rest, too, so that it is not farther than the answer.
                if let Some(found) = nearest_point(&next.conditions, exit, self.touch)
                    && found.way.length_squared() <= longest_squared
                {
                    // Lengths are not negative, so that their bits are in order.
                    let length = found.way.length_squared().to_bits();
                    let mut conditions: ArrayVec<_, 4> =
                        found.conditions.iter().map(Exit::bits).collect();
                    if found.conditions.iter().any(Exit::is_corner) {
                        // Two curves can meet twice.
                        conditions.push([found.way.x.to_bits(), found.way.y.to_bits(), 0]);
                    }
                    conditions.sort_unstable();
                    if seen.insert(conditions) {
                        open.push(Reverse((length, tries.len())));
                        tries.push(found);
                    }
                }
            }
        }
        None
    }
}

impl WayOut<'_> {
    /// The sides of sets that the way ends on, where the outlines touch then.
    fn sides(&self) -> Vec<Held> {
        let Overlap {
            a,
            b,
            b_in_a,
            touch,
        } = self.overlap;
        let slack = 4.0 * touch;
        let gone = self.overlap.moved(self.way);
        let mut sides = Vec::new();
        near_parts(a, b, gone, Vec2::ZERO, slack, |i, j| {
            let (part_a, part_b) = (part(a, i), part(b, j));
            let exits = exits(&part_a, &part_b, b_in_a);
            if exits.iter().any(|exit| exit.height(self.way) > slack) {
                return;
            }
            let pair = Pair::new(&part_a, &part_b, gone);
            // What B is beyond already does not hold it now.
            for exit in exits.iter().filter(|exit| exit.height(Vec2::ZERO) < 0.0) {
                let Some((normal, depth)) = exit.tight(self.way, slack) else {
                    continue;
                };
                let edge = match *exit {
                    Exit::Side { edge, .. } => Some(edge),
                    Exit::Corner { .. } => None,
                };
                if edge.is_none_or(|(owner, face)| pair.allows(owner, face)) {
                    sides.push(Held {
                        parts: (i, j),
                        normal,
                        depth,
                        edge,
                    });
                }
            }
        });
        sides
    }

    /// What touches once B has gone the way: the points half-way between where A's and B's surfaces
    /// are now, and as deep as the way is along the normal.
    pub(crate) fn contacts(&self) -> Vec<(usize, usize, Manifold)> {
        let Overlap { a, b, .. } = self.overlap;
        let sides = if self.found { self.sides() } else { Vec::new() };
        if sides.is_empty() {
            return self.along_the_way().into_iter().collect();
        }
        let gone = self.overlap.moved(self.way);
        let contact = |held: Held| {
            let (i, j) = held.parts;
            let (part_a, part_b) = (part(a, i), part(b, j));
            let mut manifold = match held.edge {
                Some((owner, face)) if !part_a.is_disc() && !part_b.is_disc() => {
                    let pair = Pair::new(&part_a, &part_b, gone);
                    let separation = 0.0;
                    let faces = Faces::new(&pair, owner, Face { separation, ..face });
                    let shared = faces.shared();
                    let found = shared.and_then(|ends| faces.manifold(ends, held.depth));
                    found.unwrap_or_else(|| faces.deepest())
                }
                _ => {
                    let surface = touch_point(&part_a, &part_b, gone, held.normal);
                    Manifold::single(held.normal, surface, 0.0, FeatureId(0))
                }
            };
            for point in &mut manifold.points {
                point.separation -= held.depth;
                point.point -= self.way * 0.5;
            }
            (i, j, manifold)
        };
        sides.into_iter().map(contact).collect()
    }

    /// One contact in the middle of what overlaps most, along the way: where that leads out of the box.
    fn along_the_way(&self) -> Option<(usize, usize, Manifold)> {
        let Overlap { a, b, b_in_a, .. } = self.overlap;
        let (i, j) = self.overlap.blocking(Vec2::ZERO)?;
        let common = distance(&part(a, i), &part(b, j), b_in_a).point_a;
        let length = self.way.length();
        let manifold = Manifold::single(self.way / length, common, -length, FeatureId(0));
        Some((i, j, manifold))
    }
}

/// The point nearest to 0 that satisfies a list of conditions and another one, which it does not
/// satisfy yet; `None` if there is none.
fn nearest_point(conditions: &[Exit], new: Exit, touch: f64) -> Option<Try> {
    let satisfies = |t: Vec2| {
        let mut all = conditions.iter().chain([&new]);
        all.all(|exit| exit.height(t) >= -touch)
    };
    let mut best: Option<Try> = None;
    let offer = |best: &mut Option<Try>, way: Vec2, held: &[Exit]| {
        let shorter = |known: &Try| way.length_squared() < known.way.length_squared();
        if best.as_ref().is_none_or(shorter) && satisfies(way) {
            let conditions = held.iter().copied().collect();
            *best = Some(Try { conditions, way });
        }
    };
    if new.height(Vec2::ZERO) < 0.0 {
        for way in new.nearest() {
            offer(&mut best, way, &[new]);
        }
        if best.is_some() && !new.is_corner() {
            // What is beyond a line is convex: nothing that meets it is nearer.
            return best;
        }
    }
    for old in conditions {
        for way in old.meetings(&new) {
            offer(&mut best, way, &[*old, new]);
        }
    }
    // Of two lines the one point does not satisfy the new condition; curves can meet in others.
    if conditions.iter().any(Exit::is_corner) {
        for (i, old) in conditions.iter().enumerate() {
            for other in &conditions[..i] {
                for way in old.meetings(other) {
                    offer(&mut best, way, &[*other, *old, new]);
                }
            }
        }
    }
    best
}
