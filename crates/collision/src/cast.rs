//! A shape moved along a line until it meets another, in closed form.
//!
//! Without turning, every gap changes at a constant rate. Two polygons touch once the last axis
//! that separates them has closed, unless an earlier one has opened again: a division per edge.
//! A disc is its centre on a ray against the other shape grown by its radius: straight sides and
//! round corners.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2, cross};

use crate::manifold::Faces;
use crate::outline::Pair;
use crate::parts::near_parts;
use crate::sat::{Face, along_both, beyond_end, face};
use crate::{AxisFeature, Hull, Side, part, separating_axis};

/// What a moved shape met first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastHit {
    /// Part of the translation that is free, 0 to 1; 0 if the shapes overlap at the start.
    pub fraction: f64,
    /// Where they touch, in the world.
    pub point: Vec2,
    /// Unit normal in the world, from the moving shape to the target.
    pub normal: Vec2,
}

/// Moves a shape along `translation` (world, metres) without turning it, until it meets `target`.
///
/// `None` if it never does. Shapes that overlap at the start hit at 0, with the normal of their
/// least overlap; shapes that touch at the start hit at 0 if the translation presses them together,
/// and not if they slide or part.
///
/// # Examples
/// ```
/// use carom_collision::cast;
/// use carom_geometry::{Circle, ConvexPolygon};
/// use carom_math::{Pose, vec2};
/// let ball = Circle::new(0.5)?.into();                                         // m
/// let wall = ConvexPolygon::rectangle(1.0, 8.0)?.into();
/// let hit = cast(&ball, Pose::at(vec2(-5.0, 1.0)), vec2(16.0, 0.0), &wall, Pose::IDENTITY)
///     .expect("the wall is in the way");
/// assert_eq!(hit.fraction, 0.25);                                              // 4 m of 16 m
/// assert_eq!((hit.point, hit.normal), (vec2(-0.5, 1.0), vec2(1.0, 0.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn cast(
    moving: &Shape,
    pose: Pose,
    translation: Vec2,
    target: &Shape,
    target_pose: Pose,
) -> Option<CastHit> {
    // In the frame of the moving shape, the target comes along −translation.
    let b_in_a = target_pose.seen_from(pose);
    let step = -pose.inverse_vector(translation);
    let mut best: Option<Local> = None;
    near_parts(moving, target, b_in_a, -step, 0.0, |i, j| {
        if let Some(hit) = cast_hulls(&part(moving, i), &part(target, j), b_in_a, step)
            && best.is_none_or(|known| hit.before(&known))
        {
            best = Some(hit);
        }
    });
    best.map(|hit| CastHit {
        fraction: hit.fraction,
        // The point was found where the shapes touch, in a frame that had moved along.
        point: pose.point(hit.point) + translation * hit.fraction,
        normal: pose.vector(hit.normal),
    })
}

/// A hit in the frame of the moving shape at the instant of the hit.
#[derive(Clone, Copy)]
struct Local {
    fraction: f64,
    point: Vec2,
    normal: Vec2,
    /// Met along the cut of a piece: its neighbour is met no later, and knows better.
    cut: bool,
}

impl Local {
    fn before(&self, other: &Self) -> bool {
        self.fraction < other.fraction
            || (self.fraction <= other.fraction && other.cut && !self.cut)
    }
}

/// B moves by `step` in A's frame.
fn cast_hulls(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, step: Vec2) -> Option<Local> {
    let start = separating_axis(a, b, b_in_a);
    let touch = |fraction: f64, normal: Vec2| {
        let pose = Pose::new(b_in_a.position + step * fraction, b_in_a.rotation);
        touch_point(a, b, pose, normal)
    };
    if start.separation < 0.0 {
        let pair = Pair::new(a, b, b_in_a);
        let cut = match start.feature {
            AxisFeature::Edge {
                owner,
                edge,
                vertex,
            } => !pair.allows(
                owner,
                Face {
                    separation: start.separation,
                    edge,
                    vertex,
                },
            ),
            AxisFeature::Vertices { .. } => false,
        };
        return Some(Local {
            fraction: 0.0,
            point: crate::distance(a, b, b_in_a).point_a,
            normal: start.normal,
            cut,
        });
    }
    if b.is_disc() {
        let (fraction, normal) = ray_to_round(a, b_in_a.point(b.vertices[0]), step, b.radius)?;
        return Some(Local {
            fraction,
            point: touch(fraction, normal),
            normal,
            cut: false,
        });
    }
    if a.is_disc() {
        let centre = b_in_a.inverse_point(a.vertices[0]);
        let (fraction, normal) = ray_to_round(b, centre, -b_in_a.inverse_vector(step), a.radius)?;
        let normal = -b_in_a.vector(normal);
        return Some(Local {
            fraction,
            point: touch(fraction, normal),
            normal,
            cut: false,
        });
    }
    cast_polygons(a, b, b_in_a, step)
}

/// Which axes are closed, from when to when.
struct Interval {
    enter: f64,
    leave: f64,
    /// The axis that closed last, and whether it is one of a cut.
    last: Option<(Closed, bool)>,
}

#[derive(Clone, Copy)]
enum Closed {
    Face(Side, Face),
    /// A direction from a vertex of A to one of B.
    Along(Vec2, [usize; 2]),
}

impl Interval {
    /// Takes an axis into account: its gap and the rate at which that grows. `None` if it never
    /// closes.
    fn add(
        &mut self,
        gap: f64,
        rate: f64,
        closed: Closed,
        cut: impl FnOnce() -> bool,
    ) -> Option<()> {
        if gap < 0.0 {
            if rate > 0.0 {
                self.leave = self.leave.min(gap / -rate);
            }
            return Some(());
        }
        if rate >= 0.0 {
            return None;
        }
        let at = gap / -rate;
        if self.last.is_none() || at >= self.enter {
            let cut = cut();
            if self.last.is_none() || at > self.enter || !cut {
                self.enter = at;
                self.last = Some((closed, cut));
            }
        }
        Some(())
    }
}

/// The last axis to close, if none opens before.
fn cast_polygons(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, step: Vec2) -> Option<Local> {
    let pair = Pair::new(a, b, b_in_a);
    let steps = [step, -b_in_a.inverse_vector(step)];
    let lines = a.normals.len() == 2 && b.normals.len() == 2;
    let mut interval = Interval {
        enter: 0.0,
        leave: f64::INFINITY,
        last: None,
    };
    for owner in [Side::A, Side::B] {
        let (own, other) = (owner as usize, owner.other() as usize);
        let (hull, pose) = (&pair.hulls[own], pair.poses[own]);
        for edge in 0..hull.normals.len() {
            let face = face(hull, edge, &pair.hulls[other], pose, None);
            let rate = hull.normals[edge].dot(steps[own]);
            if lines && face.separation == 0.0 && rate == 0.0 {
                // Segments that stay on one line: it does not separate them, their ends may.
                continue;
            }
            let cut = || pair.has_cuts() && !pair.allows(owner, face);
            interval.add(face.separation, rate, Closed::Face(owner, face), cut)?;
        }
    }
    if lines {
        for direction in along_both(a, b, b_in_a) {
            let (vertex, of_a) = a.support(direction);
            let (other, of_b) = b.support(b_in_a.inverse_vector(-direction));
            let gap = direction.dot(b_in_a.position) - of_b - of_a;
            let closed = Closed::Along(direction, [vertex, other]);
            interval.add(gap, direction.dot(step), closed, || false)?;
        }
    }
    let (closed, cut) = interval.last?;
    let fraction = interval.enter;
    if fraction > 1.0 || fraction > interval.leave {
        return None;
    }
    let (point, normal) = match closed {
        Closed::Face(owner, face) => {
            let pose = Pose::new(b_in_a.position + step * fraction, b_in_a.rotation);
            let pair = Pair::new(a, b, pose);
            let faces = Faces::new(&pair, owner, face);
            (faces.touch(), faces.normal_in_a())
        }
        Closed::Along(direction, [vertex, other]) => {
            /// Sine of the angle to the direction below which a segment lies across it.
            const FLUSH: f64 = 1e-9;
            // A segment across the direction is met by the end of the other one.
            let along = a.vertices[a.next(vertex)] - a.vertices[vertex];
            let across = direction.dot(along).abs() <= FLUSH * along.length();
            let point = if across {
                b_in_a.point(b.vertices[other]) + step * fraction
            } else {
                a.vertices[vertex]
            };
            (point, direction)
        }
    };
    Some(Local {
        fraction,
        point,
        normal,
        cut,
    })
}

/// The first fraction of `step` at which a point comes within `radius` of a hull, and the normal
/// from the hull to the point there.
fn ray_to_round(hull: &Hull<'_>, point: Vec2, step: Vec2, radius: f64) -> Option<(f64, Vec2)> {
    let reach = hull.radius + radius;
    let mut best: Option<(f64, Vec2)> = None;
    let mut keep = |fraction: f64, normal: Vec2| {
        if (0.0..=1.0).contains(&fraction) && best.is_none_or(|(known, _)| fraction < known) {
            best = Some((fraction, normal));
        }
    };
    for (edge, normal) in hull.normals.iter().enumerate() {
        let height = normal.dot(point - hull.vertices[edge]) - reach;
        let rate = normal.dot(step);
        if height >= 0.0 && rate < 0.0 && hull.is_boundary(edge) {
            let fraction = height / -rate;
            if beyond_end(hull, edge, point + step * fraction).is_none() {
                keep(fraction, *normal);
            }
        }
    }
    let corners = if hull.is_half_plane() {
        &[]
    } else {
        hull.vertices
    };
    for vertex in corners {
        // |q + s w|² = r² with q·w < 0: s = (|q|² − r²) / (−q·w + √D), D = |w|² r² − (q × w)².
        // The cross product keeps the digits that (q·w)² − |w|² (|q|² − r²) would lose.
        let q = point - *vertex;
        let (along, aside) = (q.dot(step), cross(q, step));
        let discriminant = step.length_squared() * reach * reach - aside * aside;
        let outside = (q.length() - reach) * (q.length() + reach);
        if along < 0.0 && discriminant >= 0.0 && outside >= 0.0 {
            let fraction = outside / (-along + discriminant.sqrt());
            if let Some(normal) = (q + step * fraction).try_normalize() {
                keep(fraction, normal);
            }
        }
    }
    best
}

/// Where a disc touches: on its rim.
pub(crate) fn touch_point(a: &Hull<'_>, b: &Hull<'_>, b_in_a: Pose, normal: Vec2) -> Vec2 {
    if b.is_disc() {
        b_in_a.point(b.vertices[0]) - normal * b.radius
    } else {
        a.vertices[0] + normal * a.radius
    }
}
