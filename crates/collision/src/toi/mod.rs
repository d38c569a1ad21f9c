//! Time of impact: when two moving shapes first touch.
//!
//! Certified advancement along a separating axis. While an axis separates two convex hulls, the
//! smallest gap of a vertex along it is a lower bound of their distance at *every* time, and it
//! has a bounded second derivative. So from a gap g with rate g' the smallest root of
//! `g + g' τ − M τ²/2` is a step that cannot pass a contact, and converges quadratically at one.
//! When the axis closes, the axes are looked at again: another one is open, or this is the impact.

mod approach;
mod corners;
mod discs;
mod even;
#[cfg(test)]
mod even_tests;
mod facing;
mod parts;
mod search;
mod sight;
mod touching;
mod turns;

use arrayvec::ArrayVec;
use carom_geometry::Shape;
use carom_math::{SimTime, Vec2, cross, perp};
use fearless_simd::Level;

use crate::parts::is_single;
use crate::{AxisFeature, Hull, Motion, part};
use approach::{Approach, Axis};
use parts::first_of_parts;

/// Contacts are flush where they part by less than this fraction of the stretch between them, and
/// normals that differ by less are one.
const FLUSH: f64 = 1e-9;

/// What became of two moving shapes.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeOfImpact {
    /// They touch for the first time, approaching.
    Hit(Impact),
    /// Up to the horizon they do not come nearer to each other while they touch: they stay apart, or what
    /// touches or overlaps at the start rests, slides or parts. How deep shapes overlap,
    /// [`crate::shape_push`] tells.
    Clear,
    /// They touch or overlap at the start already and approach there: their gap shrinks, and does so at
    /// once. What rests is [`Clear`](Self::Clear).
    Touching(Impact),
    /// The search ran out of its budget; until `safe_until` nothing happens.
    Unresolved {
        /// Seconds after the start.
        safe_until: f64,
    },
}

/// The instant at which two shapes touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Seconds after the later of the two motions' starts.
    pub time: f64,
    /// Unit normal from A to B, in the world.
    pub normal: Vec2,
    /// Where they touch, in the world, in m: one point, or both ends of a common stretch.
    pub points: ArrayVec<Vec2, 2>,
    /// What touches at each of the points, in their order.
    pub features: ArrayVec<ImpactFeature, 2>,
    /// Rate of the gap, in m/s; negative when approaching. The worse end of a common stretch.
    pub gap_rate: f64,
}

/// What of two shapes touches at a point of an impact.
///
/// A corner that lands on an edge is [`AxisFeature::Edge`], owned by the edge's shape. Of two edges that
/// land flat on each other each end of the common stretch is the corner of the one on the edge of the
/// other. Corners that meet, and what touches the rim of a disc, are [`AxisFeature::Vertices`], unless
/// the other shape's edge touches the disc; the vertex of a disc is its centre, number 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImpactFeature {
    /// Indices of the convex parts, of A and of B: see [`part`]; 0 for shapes that have one.
    pub parts: (u32, u32),
    /// The edge and the vertex, or the two vertices, by their indices in these parts.
    pub feature: AxisFeature,
}

impl ImpactFeature {
    /// Of shapes that have one part each.
    const fn of(feature: AxisFeature) -> Self {
        Self {
            parts: (0, 0),
            feature,
        }
    }
}

impl TimeOfImpact {
    /// The same of two convex parts by their numbers in their shapes: see [`time_of_impact_of_parts`].
    #[must_use]
    pub fn of_parts(mut self, parts: (u32, u32)) -> Self {
        if let Self::Hit(impact) | Self::Touching(impact) = &mut self {
            for feature in &mut impact.features {
                feature.parts = parts;
            }
        }
        self
    }
}

impl Impact {
    /// The point of contact, in the world, in m: the middle of a common stretch.
    #[must_use]
    pub fn point(&self) -> Vec2 {
        match self.points.as_slice() {
            [one] => *one,
            [first, second] => (*first + *second) * 0.5,
            _ => unreachable!("an impact has one or two points"),
        }
    }
}

/// When two moving shapes first touch, within `horizon` seconds of the later motion's start.
///
/// Each shape is given about the centre of its motion. A hit is right to a few roundings of
/// (sizes + distance + travel) over the gap rate. Concave polygons are searched piece by piece;
/// a cut between pieces can separate but never touch. Two half-planes never meet: neither can move.
/// Of motions with numbers that are not finite the answer means nothing.
///
/// # Examples
/// ```
/// use carom_collision::{Motion, TimeOfImpact, time_of_impact};
/// use carom_geometry::{Circle, ConvexPolygon, Shape};
/// use carom_math::vec2;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let floor = Shape::from(ConvexPolygon::rectangle(10.0, 2.0)?);
/// let ball = Shape::from(Circle::new(0.5)?);
/// let falling = Motion { acceleration: vec2(0.0, -10.0), ..Motion::resting(vec2(0.0, 6.5)) };
/// let first = time_of_impact(&floor, &Motion::resting(vec2(0.0, 0.0)), &ball, &falling, 2.0);
/// let TimeOfImpact::Hit(hit) = first else { panic!("it falls 5 m") };
/// assert!((hit.time - 1.0).abs() < 1e-15);                     // √(2 · 5 / 10) s
/// assert!((hit.gap_rate + 10.0).abs() < 1e-14);                // m/s
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn time_of_impact(
    a: &Shape,
    motion_a: &Motion,
    b: &Shape,
    motion_b: &Motion,
    horizon: f64,
) -> TimeOfImpact {
    if is_single(a) && is_single(b) {
        return time_of_impact_of_parts(&part(a, 0), motion_a, &part(b, 0), motion_b, horizon);
    }
    first_of_parts(a, motion_a, b, motion_b, (horizon, f64::NEG_INFINITY))
}

/// Whether an axis is of an edge that there is: a feature may be of other shapes, or of numbers that are none.
fn is_there(axis: Axis, shapes: [&Shape; 2]) -> bool {
    match axis {
        Axis::Edge { owner, edge } => edge < part(shapes[owner], 0).normals.len(),
        Axis::World { .. } => true,
    }
}

/// [`time_of_impact`] from `start` on: [`Impact::time`] is in seconds after `start`, and neither motion begins later than that.
///
/// `last`: a feature of the impact just resolved, if any. A hint: it changes the speed, not the answer.
#[must_use]
pub fn time_of_impact_from(
    start: SimTime,
    last: Option<ImpactFeature>,
    a: &Shape,
    motion_a: &Motion,
    b: &Shape,
    motion_b: &Motion,
    horizon: f64,
) -> TimeOfImpact {
    let struck = last.and_then(|last| Axis::of(last.feature));
    let struck = struck.filter(|axis| is_there(*axis, [a, b]));
    let (motions, span) = ((motion_a, motion_b), (start, horizon));
    match even::first_contact_of_shapes(Level::new(), (a, b), motions, span, struck) {
        Some(found) => found.into(),
        None if is_single(a) && is_single(b) => {
            general((&part(a, 0), &part(b, 0)), motions, span, struck)
        }
        None => {
            let motions = [motion_a.rebased(start), motion_b.rebased(start)];
            first_of_parts(a, &motions[0], b, &motions[1], (horizon, f64::NEG_INFINITY))
        }
    }
}

/// [`time_of_impact_from`] of shapes that touch and approach by rounding alone: the first contact of two of their parts that approach
/// faster than `slow` m/s. Any other touch may last, and a search for the first one of all sees nothing beyond it.
///
/// Shapes of one part each have no other place to touch.
#[must_use]
pub fn time_of_impact_beside(
    (start, slow): (SimTime, f64),
    a: &Shape,
    motion_a: &Motion,
    b: &Shape,
    motion_b: &Motion,
    horizon: f64,
) -> TimeOfImpact {
    if is_single(a) && is_single(b) {
        return TimeOfImpact::Clear;
    }
    let motions = [motion_a.rebased(start), motion_b.rebased(start)];
    first_of_parts(a, &motions[0], b, &motions[1], (horizon, slow))
}

/// [`time_of_impact`] of two convex parts, which count as part 0 of their shapes in
/// [`Impact::features`]: [`TimeOfImpact::of_parts`] says otherwise.
#[must_use]
pub fn time_of_impact_of_parts(
    a: &Hull<'_>,
    motion_a: &Motion,
    b: &Hull<'_>,
    motion_b: &Motion,
    horizon: f64,
) -> TimeOfImpact {
    let start = motion_a.start.max(motion_b.start);
    of_parts((a, b), (motion_a, motion_b), (start, horizon), None)
}

/// The search begins with the axis along which the parts have just struck each other, if they have.
fn of_parts(
    hulls: (&Hull<'_>, &Hull<'_>),
    motions: (&Motion, &Motion),
    (start, horizon): (SimTime, f64),
    struck: Option<Axis>,
) -> TimeOfImpact {
    match even::first_contact(Level::new(), hulls, motions, (start, horizon), struck) {
        Some(found) => found.into(),
        None => general(hulls, motions, (start, horizon), struck),
    }
}

/// The search for everything that [`even`] does not know.
#[cold]
#[inline(never)]
fn general(
    (a, b): (&Hull<'_>, &Hull<'_>),
    (motion_a, motion_b): (&Motion, &Motion),
    (start, horizon): (SimTime, f64),
    struck: Option<Axis>,
) -> TimeOfImpact {
    if a.is_half_plane() && b.is_half_plane() {
        // Neither can move.
        return TimeOfImpact::Clear;
    }
    let (motion_a, motion_b) = (motion_a.rebased(start), motion_b.rebased(start));
    let approach = Approach::new(*a, &motion_a, *b, &motion_b);
    search::first_contact(&approach, horizon, struck)
}

/// The one that happens first; a contact that is there already goes before all, the faster first.
///
/// Two flush contacts at one instant are one: parts of one edge that land together.
#[must_use]
pub fn earlier(x: TimeOfImpact, y: TimeOfImpact) -> TimeOfImpact {
    use TimeOfImpact::{Clear, Hit, Touching, Unresolved};
    match (&x, &y) {
        (Hit(a), Hit(b)) => {
            if let Some(both) = a.joined(b) {
                return Hit(both);
            }
        }
        (Touching(a), Touching(b)) => {
            if let Some(both) = a.joined(b) {
                return Touching(both);
            }
        }
        _ => {}
    }
    let when = |outcome: &TimeOfImpact| match outcome {
        Touching(contact) => (-1.0, contact.gap_rate),
        Hit(impact) => (impact.time, impact.gap_rate),
        Unresolved { safe_until } => (*safe_until, f64::INFINITY),
        Clear => (f64::INFINITY, f64::INFINITY),
    };
    let ((tx, rx), (ty, ry)) = (when(&x), when(&y));
    if ty < tx || (ty <= tx && ry < rx) {
        y
    } else {
        x
    }
}

impl Impact {
    /// Both as one, if they are flush: one normal, and a difference in time that lifts the one end
    /// by less than [`FLUSH`] of the stretch between them.
    fn joined(&self, other: &Self) -> Option<Self> {
        if self.normal.dot(other.normal) <= 0.0 || cross(self.normal, other.normal).abs() > FLUSH {
            return None;
        }
        let tangent = perp(self.normal);
        let touching = |impact: &Self| {
            let all = impact.points.iter().zip(&impact.features);
            all.map(|(p, f)| (*p, *f)).collect::<ArrayVec<_, 2>>()
        };
        let mut points: ArrayVec<(Vec2, ImpactFeature), 4> =
            touching(self).into_iter().chain(touching(other)).collect();
        points.sort_by(|p, q| tangent.dot(p.0).total_cmp(&tangent.dot(q.0)));
        let ((low, at_low), (high, at_high)) = (points[0], points[points.len() - 1]);
        let stretch = tangent.dot(high - low);
        let lift = (self.time - other.time).abs() * self.gap_rate.abs().max(other.gap_rate.abs());
        if lift > FLUSH * stretch || stretch <= 0.0 {
            return None;
        }
        Some(Self {
            time: self.time.min(other.time),
            normal: self.normal,
            points: ArrayVec::from([low, high]),
            features: ArrayVec::from([at_low, at_high]),
            gap_rate: self.gap_rate.min(other.gap_rate),
        })
    }
}
