//! The shortest way out of an overlap of whole shapes, concave ones and compounds too.
//!
//! B moved by t overlaps A if some part of it overlaps some part of A: if t lies in the union of the
//! convex sets { t : k·t < d for all axes k of the two parts }. The shortest way out is the nearest
//! point to 0 outside that union. It leaves every set through one of its sides, so that it is the
//! nearest point that satisfies a list of conditions k·t ≥ d, one for every set that is in the way.
//! A search by length tries the lists: the first t that lies in no set is the answer.

use carom_geometry::Shape;
use carom_math::{Pose, Rot, Vec2, cross};

use crate::cast::touch_point;
use crate::manifold::{Faces, FeatureId, Manifold};
use crate::outline::Pair;
use crate::parts::near_parts;
use crate::sat::{Face, face};
use crate::{Hull, Side, part, separating_axis};

/// Lists of conditions that are tried before the search is given up and B leaves the box of A.
///
/// Two L-shapes need some ten, two stars of 16 points in each other a few hundred.
const TRIES: usize = 4096;

/// The shortest translation of B, in metres in A's frame, that ends the overlap of two shapes; `None`
/// if they do not overlap, or if one is a half-plane and so is the other.
///
/// Of convex shapes this is [`crate::minimum_push`]. Concave shapes and compounds leave as a whole,
/// and not through their own parts. With a disc in a corner of other parts it can be a little longer
/// than the shortest; and the search is bounded: in a thicket of very many parts B may be led out of
/// the box around A, which is longer than need be.
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
    let out = way_out(a, b, b_in_a);
    (!out.sets.is_empty()).then_some(out.way)
}

/// A side of the set of translations for which two parts overlap.
#[derive(Clone, Copy)]
struct Exit {
    /// Unit normal in A's frame, from A to B.
    normal: Vec2,
    /// How far B has to go along the normal.
    depth: f64,
    /// The edge, where there is one.
    face: Option<(Side, Face)>,
}

/// The translations for which part `i` of A and part `j` of B overlap.
struct Set {
    parts: (usize, usize),
    exits: Vec<Exit>,
}

impl Set {
    fn new(a: &Hull<'_>, b: &Hull<'_>, parts: (usize, usize), b_in_a: Pose) -> Self {
        let mut exits = Vec::new();
        let poses = [b_in_a, b_in_a.inverse()];
        for owner in [Side::A, Side::B] {
            let (own, other) = match owner {
                Side::A => (a, b),
                Side::B => (b, a),
            };
            for edge in 0..own.normals.len() {
                let face = face(own, edge, other, poses[owner as usize], None);
                let normal = match owner {
                    Side::A => own.normals[edge],
                    Side::B => -b_in_a.vector(own.normals[edge]),
                };
                exits.push(Exit {
                    normal,
                    depth: -face.separation,
                    face: Some((owner, face)),
                });
            }
        }
        if exits.is_empty() {
            exits = around(a, b, b_in_a);
        }
        exits.retain(|exit| exit.depth.is_finite());
        Self { parts, exits }
    }

    fn contains(&self, t: Vec2, touch: f64) -> bool {
        let inside = |exit: &Exit| exit.normal.dot(t) < exit.depth - touch;
        !self.exits.is_empty() && self.exits.iter().all(inside)
    }
}

impl WayOut<'_> {
    /// Whether two parts overlap once B has gone a way. The sides around a set with a disc meet in
    /// corners where the set is round.
    fn blocks(&self, set: &Set, t: Vec2, touch: f64) -> bool {
        let (a, b) = (
            part(self.shapes.0, set.parts.0),
            part(self.shapes.1, set.parts.1),
        );
        set.contains(t, touch) && {
            let gone = Pose::new(self.b_in_a.position + t, self.b_in_a.rotation);
            let round = a.is_disc() || b.is_disc();
            !round || separating_axis(&a, &b, gone).separation < -touch
        }
    }
}

/// Two discs: sides around the disc of translations, the first one straight ahead.
fn around(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose) -> Vec<Exit> {
    const SIDES: i32 = 16;
    let apart = b_in_a.point(b.vertices[0]) - a.vertices[0];
    let ahead = apart.try_normalize().unwrap_or(Vec2::X);
    let turned = |i| Rot::from_degrees(360.0 / f64::from(SIDES) * f64::from(i)) * ahead;
    (0..SIDES)
        .map(turned)
        .map(|normal| Exit {
            normal,
            depth: a.radius + b.radius - normal.dot(apart),
            face: None,
        })
        .collect()
}

/// The way out, and what is in the way.
pub(crate) struct WayOut<'a> {
    shapes: (&'a Shape, &'a Shape),
    b_in_a: Pose,
    sets: Vec<Set>,
    /// The translation of B.
    way: Vec2,
    /// The sides that it ends on: the same for one place, several in a corner.
    last: Vec<(usize, Exit)>,
}

/// The shortest way out of the overlap of two shapes.
pub(crate) fn way_out<'a>(a: &'a Shape, b: &'a Shape, b_in_a: Pose) -> WayOut<'a> {
    let mut out = WayOut {
        shapes: (a, b),
        b_in_a,
        sets: Vec::new(),
        way: Vec2::ZERO,
        last: Vec::new(),
    };
    // Whoever leaves the box along an axis is out: no set farther away than that is in the way.
    let (box_a, box_b) = (a.aabb(Pose::IDENTITY), b.aabb(b_in_a));
    let leave = [
        Vec2::X * (box_a.max.x - box_b.min.x),
        Vec2::X * (box_a.min.x - box_b.max.x),
        Vec2::Y * (box_a.max.y - box_b.min.y),
        Vec2::Y * (box_a.min.y - box_b.max.y),
    ];
    let longest = leave.into_iter().fold(Vec2::INFINITY, |best, way| {
        if way.length_squared() < best.length_squared() {
            way
        } else {
            best
        }
    });
    let reach = longest.abs().max_element();
    let margin = if reach.is_finite() { reach } else { 0.0 };
    near_parts(a, b, b_in_a, Vec2::ZERO, margin, |i, j| {
        out.sets
            .push(Set::new(&part(a, i), &part(b, j), (i, j), b_in_a));
    });
    let size = box_a
        .extents()
        .max_element()
        .min(box_b.extents().max_element());
    let touch = 1e-12 * if size.is_finite() { size } else { 0.0 };
    if !out
        .sets
        .iter()
        .any(|set| out.blocks(set, Vec2::ZERO, touch))
    {
        out.sets.clear();
        return out;
    }
    out.search(touch, longest);
    out
}

/// A list of conditions and the nearest point that satisfies them.
struct Try {
    conditions: Vec<(usize, Exit)>,
    way: Vec2,
}

impl WayOut<'_> {
    fn search(&mut self, touch: f64, longest: Vec2) {
        let mut open = vec![Try {
            conditions: Vec::new(),
            way: Vec2::ZERO,
        }];
        for _ in 0..TRIES {
            // The shortest first; the earliest of equals.
            let nearest = |p: &(usize, &Try), q: &(usize, &Try)| {
                p.1.way
                    .length_squared()
                    .total_cmp(&q.1.way.length_squared())
            };
            let Some((at, _)) = open.iter().enumerate().min_by(nearest) else {
                break;
            };
            let next = open.swap_remove(at);
            let blocking = self
                .sets
                .iter()
                .position(|set| self.blocks(set, next.way, touch));
            let Some(blocking) = blocking else {
                self.way = next.way;
                self.last = self.sides_at(next.way, touch);
                return;
            };
            for exit in &self.sets[blocking].exits {
                let mut conditions = next.conditions.clone();
                conditions.push((blocking, *exit));
                if let Some(way) = nearest_point(&conditions, touch)
                    && way.length_squared() <= longest.length_squared()
                {
                    open.push(Try { conditions, way });
                }
            }
        }
        self.way = longest;
    }

    /// The sides of sets that a translation lies on, where the outlines touch for it.
    fn sides_at(&self, t: Vec2, touch: f64) -> Vec<(usize, Exit)> {
        let gone = Pose::new(self.b_in_a.position + t, self.b_in_a.rotation);
        let mut sides = Vec::new();
        for (index, set) in self.sets.iter().enumerate() {
            let height = |exit: &Exit| exit.normal.dot(t) - exit.depth;
            if set.exits.iter().any(|exit| height(exit) > 4.0 * touch) {
                continue;
            }
            let (a, b) = (
                part(self.shapes.0, set.parts.0),
                part(self.shapes.1, set.parts.1),
            );
            let pair = Pair::new(&a, &b, gone);
            let tight = set
                .exits
                .iter()
                .filter(|exit| height(exit).abs() <= 4.0 * touch);
            let open = tight.filter(|exit| {
                let allows = |(owner, face)| pair.allows(owner, face);
                exit.face.is_none_or(allows)
            });
            sides.extend(open.map(|exit| (index, *exit)));
        }
        sides
    }

    /// What touches once B has gone the way: the points half-way between where A's and B's surfaces
    /// are now, and as deep as the way is along the normal.
    pub(crate) fn contacts(&self) -> Vec<(usize, usize, Manifold)> {
        let gone = Pose::new(self.b_in_a.position + self.way, self.b_in_a.rotation);
        let contact = |(set, exit): &(usize, Exit)| {
            let (i, j) = self.sets[*set].parts;
            let (a, b) = (part(self.shapes.0, i), part(self.shapes.1, j));
            let mut manifold = match exit.face {
                Some((owner, face)) if !a.is_disc() && !b.is_disc() => {
                    let pair = Pair::new(&a, &b, gone);
                    let separation = 0.0;
                    let faces = Faces::new(&pair, owner, Face { separation, ..face });
                    let shared = faces.shared();
                    let found = shared.and_then(|ends| faces.manifold(ends, exit.depth));
                    found.unwrap_or_else(|| faces.deepest())
                }
                _ => {
                    let surface = touch_point(&a, &b, gone, exit.normal);
                    Manifold::single(exit.normal, surface, 0.0, FeatureId(0))
                }
            };
            for point in &mut manifold.points {
                point.separation -= exit.depth;
                point.point -= self.way * 0.5;
            }
            (i, j, manifold)
        };
        self.last.iter().map(contact).collect()
    }
}

/// The point nearest to 0 with k·t ≥ d for all conditions; `None` if there is none.
fn nearest_point(conditions: &[(usize, Exit)], touch: f64) -> Option<Vec2> {
    let satisfies = |t: Vec2| {
        conditions
            .iter()
            .all(|(_, exit)| exit.normal.dot(t) >= exit.depth - touch)
    };
    let mut best: Option<Vec2> = satisfies(Vec2::ZERO).then_some(Vec2::ZERO);
    let mut consider = |t: Vec2| {
        let shorter = |known: Vec2| t.length_squared() < known.length_squared();
        if best.is_none_or(shorter) && satisfies(t) {
            best = Some(t);
        }
    };
    for (i, (_, p)) in conditions.iter().enumerate() {
        consider(p.normal * p.depth);
        for (_, q) in &conditions[..i] {
            let sine = cross(p.normal, q.normal);
            if sine != 0.0 {
                // p·t = d, q·t = e: t = (d q⊥ − e p⊥) / (p × q), turned backwards.
                let t = Vec2::new(
                    p.depth * q.normal.y - q.depth * p.normal.y,
                    q.depth * p.normal.x - p.depth * q.normal.x,
                );
                consider(t / sine);
            }
        }
    }
    best
}
