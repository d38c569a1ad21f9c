//! Questions about a world at its present time: rays, points, boxes, casts.
//!
//! The tree of boxes and the grid of free bodies name those that may answer, the shapes themselves answer. Of equal answers
//! the first body's first shape counts, whatever the order in which the tree named them.

use carom_collision::{cast, roundable, shape_distance};
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2};

use crate::store::state::{BodyState, Collider};
use crate::{BodyId, BodyIx, ColliderIx, Filter, Ix, Mode, World};

/// What a ray met first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayHit {
    /// The body.
    pub body: BodyId,
    /// Which of its shapes, in the order of insertion.
    pub shape: usize,
    /// Metres along the ray.
    pub distance: f64,
    /// Where, in m.
    pub point: Vec2,
    /// Outward unit normal of the shape there.
    pub normal: Vec2,
}

/// What a moved shape met first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeHit {
    /// The body.
    pub body: BodyId,
    /// Which of its shapes, in the order of insertion.
    pub shape: usize,
    /// Part of the way that is free, 0..1; 0 if they overlap at the start.
    pub fraction: f64,
    /// Where they touch, in m.
    pub point: Vec2,
    /// Unit normal from the moved shape to the one it meets.
    pub normal: Vec2,
}

/// The shape that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The body.
    pub body: BodyId,
    /// Which of its shapes, in the order of insertion.
    pub shape: usize,
    /// How far the point is from it, in m; 0 inside.
    pub distance: f64,
    /// The nearest point of the shape, in m: the point itself inside.
    pub point: Vec2,
}

/// The questions of a [`World`], answered by the shapes that a filter touches alone.
///
/// # Examples
/// A ray that starts inside a body, and does not see its own kind.
/// ```
/// use carom_dynamics::{BodyDef, Filter, Material, Settings, World};
/// use carom_geometry::Circle;
/// use carom_math::{Vec2, vec2};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = World::new(Settings::default())?;
/// let own = Filter { group: -1, ..Filter::default() };
/// world.insert(BodyDef::dynamic().filtered(own), Circle::new(1.0)?, Material::default())?;
/// let wall = world.insert(BodyDef::fixed().at(vec2(5.0, 0.0)), Circle::new(1.0)?, Material::default())?;
/// let hit = world.filtered(own).cast_ray(Vec2::ZERO, Vec2::X, 10.0).ok_or("the wall")?;
/// assert_eq!((hit.body, hit.distance), (wall, 4.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Filtered<'w> {
    world: &'w World,
    /// `None`: all shapes.
    filter: Option<Filter>,
}

impl World {
    /// The same questions, answered by the shapes that `filter` touches alone.
    #[must_use]
    pub const fn filtered(&self, filter: Filter) -> Filtered<'_> {
        Filtered {
            world: self,
            filter: Some(filter),
        }
    }

    const fn unfiltered(&self) -> Filtered<'_> {
        Filtered {
            world: self,
            filter: None,
        }
    }

    /// The first shape on a ray from `origin` along `direction` (any length above 0), up to `max` m.
    ///
    /// `None` if there is none, or if the ray has no direction or is not finite.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        self.unfiltered().cast_ray(origin, direction, max)
    }

    /// All shapes on a ray from `origin` along `direction` (any length above 0), up to `max` m, the nearest first: where the ray
    /// meets each first.
    ///
    /// Empty if there is none, or if the ray has no direction or is not finite.
    #[must_use]
    pub fn cast_ray_all(&self, origin: Vec2, direction: Vec2, max: f64) -> Vec<RayHit> {
        self.unfiltered().cast_ray_all(origin, direction, max)
    }

    /// Bodies with a shape that contains `point` (in m), in order.
    #[must_use]
    pub fn bodies_at(&self, point: Vec2) -> Vec<BodyId> {
        self.unfiltered().bodies_at(point)
    }

    /// Bodies with a shape that `shape` at `pose` overlaps or touches, in order.
    #[must_use]
    pub fn bodies_overlapping(&self, shape: &Shape, pose: Pose) -> Vec<BodyId> {
        self.unfiltered().bodies_overlapping(shape, pose)
    }

    /// The shape that is nearest to `point` (in m), at most `max` m away; one that contains the point is 0 m away.
    #[must_use]
    pub fn nearest(&self, point: Vec2, max: f64) -> Option<Nearest> {
        self.unfiltered().nearest(point, max)
    }

    /// Bodies with the box of a shape overlapping `bounds`, in order.
    #[must_use]
    pub fn bodies_in(&self, bounds: Aabb) -> Vec<BodyId> {
        self.unfiltered().bodies_in(bounds)
    }

    /// The first body that `shape` at `pose` meets on its way along `translation` (in m), not turning.
    ///
    /// `None` if there is none, or a number is not finite.
    #[must_use]
    pub fn cast_shape(&self, shape: &Shape, pose: Pose, translation: Vec2) -> Option<ShapeHit> {
        self.unfiltered().cast_shape(shape, pose, translation)
    }
}

impl Filtered<'_> {
    /// The first shape on a ray from `origin` along `direction` (any length above 0), up to `max` m.
    ///
    /// `None` if there is none, or if the ray has no direction or is not finite.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        let direction = direction.try_normalize()?;
        if !origin.is_finite() || max.is_nan() {
            return None;
        }
        let start = Aabb::new(origin, origin);
        self.first_on_way(start, direction, max, |at, reach| {
            let hit = self.ray_hit(at, origin, direction, reach)?;
            Some(((hit.distance, (hit.body.index, hit.shape)), hit))
        })
    }

    /// All shapes on a ray from `origin` along `direction` (any length above 0), up to `max` m, the nearest first: where the ray
    /// meets each first.
    ///
    /// Empty if there is none, or if the ray has no direction or is not finite.
    #[must_use]
    pub fn cast_ray_all(&self, origin: Vec2, direction: Vec2, max: f64) -> Vec<RayHit> {
        let mut hits = Vec::new();
        let Some(direction) = direction.try_normalize() else {
            return hits;
        };
        if !origin.is_finite() || max.is_nan() {
            return hits;
        }
        let mut meet = |at| {
            hits.extend(self.ray_hit(at, origin, direction, max));
            f64::INFINITY
        };
        let start = Aabb::new(origin, origin);
        for at in self.shapes_outside_trees(box_of_way(start, direction, max)) {
            meet(at);
        }
        let tree = &self.world.broad.tree;
        tree.sweep(start, direction, max, |at| meet(ColliderIx::new(at)));
        hits.sort_by(|a, b| {
            let key = |hit: &RayHit| (hit.body.index, hit.shape);
            a.distance.total_cmp(&b.distance).then(key(a).cmp(&key(b)))
        });
        hits
    }

    /// Bodies with a shape that `shape` at `pose` overlaps or touches, in order.
    #[must_use]
    pub fn bodies_overlapping(&self, shape: &Shape, pose: Pose) -> Vec<BodyId> {
        if !pose.position.is_finite() {
            return Vec::new();
        }
        let bounds = shape.aabb(pose);
        self.bodies_with(bounds.grown(roundable(bounds)), |target, collider| {
            let seen = target.seen_from(pose);
            shape_distance(shape, &collider.solid, seen).distance <= 0.0
        })
    }

    /// The shape that is nearest to `point` (in m), at most `max` m away; one that contains the point is 0 m away.
    #[must_use]
    pub fn nearest(&self, point: Vec2, max: f64) -> Option<Nearest> {
        if !point.is_finite() || max.is_nan() || max < 0.0 {
            return None;
        }
        let mut best: Option<((f64, Place), Nearest)> = None;
        self.each_in(
            Aabb::new(point, point).grown(max),
            |body, shape, collider| {
                let pose = body.centre_pose(self.world.clock.now);
                let local = pose.inverse_point(point);
                let (distance, on) = if collider.solid.contains(local) {
                    (0.0, local)
                } else {
                    let on = collider.solid.closest_point(local);
                    ((on - local).length(), on)
                };
                let order = (distance, (body.id.index, shape));
                if distance <= max && best.is_none_or(|(known, _)| order < known) {
                    let found = Nearest {
                        body: body.id,
                        shape,
                        distance,
                        point: pose.point(on),
                    };
                    best = Some((order, found));
                }
            },
        );
        best.map(|(_, found)| found)
    }

    /// Bodies with a shape that contains `point` (in m), in order.
    #[must_use]
    pub fn bodies_at(&self, point: Vec2) -> Vec<BodyId> {
        self.bodies_with(Aabb::new(point, point), |pose, collider| {
            collider.solid.contains(pose.inverse_point(point))
        })
    }

    /// Bodies with the box of a shape overlapping `bounds`, in order.
    #[must_use]
    pub fn bodies_in(&self, bounds: Aabb) -> Vec<BodyId> {
        // The engine has boxes of convex pieces: a corner of a star's box is in none of them.
        let engine = self.world.stepping.as_ref();
        let near = bounds.grown(engine.map_or(0.0, |stepping| stepping.widest));
        self.bodies_with(near, |pose, collider| {
            collider.solid.aabb(pose).overlaps(bounds)
        })
    }

    /// The first body that `shape` at `pose` meets on its way along `translation` (in m), not turning.
    ///
    /// `None` if there is none, or a number is not finite.
    #[must_use]
    pub fn cast_shape(&self, shape: &Shape, pose: Pose, translation: Vec2) -> Option<ShapeHit> {
        if !translation.is_finite() || !pose.position.is_finite() {
            return None;
        }
        let start = shape.aabb(pose);
        let start = start.grown(roundable(start));
        self.first_on_way(start, translation, 1.0, |at, _| {
            let (body, index, collider) = self.seen_at(at)?;
            let target = body.centre_pose(self.world.clock.now);
            let hit = cast(shape, pose, translation, &collider.solid, target)?;
            let told = ShapeHit {
                body: body.id,
                shape: index,
                fraction: hit.fraction,
                point: hit.point,
                normal: hit.normal,
            };
            Some(((hit.fraction, (body.id.index, index)), told))
        })
    }

    /// The first hit of a box on its way, up to `max` lengths of it. `hit`: that of a shape, if it comes before so many lengths, and how
    /// far it is.
    fn first_on_way<T: Copy>(
        &self,
        start: Aabb,
        way: Vec2,
        max: f64,
        hit: impl Fn(ColliderIx, f64) -> Option<((f64, Place), T)>,
    ) -> Option<T> {
        let mut best: Option<((f64, Place), T)> = None;
        let mut meet = |at| {
            if let Some((order, hit)) = hit(at, best.map_or(max, |((far, _), _)| far))
                && best.is_none_or(|(known, _)| order < known)
            {
                best = Some((order, hit));
            }
            best.map_or(f64::INFINITY, |((far, _), _)| far)
        };
        let mut reach = max;
        for at in self.shapes_outside_trees(box_of_way(start, way, max)) {
            reach = reach.min(meet(at));
        }
        let tree = &self.world.broad.tree;
        tree.sweep(start, way, reach, |at| meet(ColliderIx::new(at)));
        best.map(|(_, hit)| hit)
    }

    /// Bodies with a shape near `bounds` that `matches` at its pose, in order.
    fn bodies_with(&self, bounds: Aabb, matches: impl Fn(Pose, &Collider) -> bool) -> Vec<BodyId> {
        let mut found: Vec<BodyId> = Vec::new();
        self.each_in(bounds, |body, _, collider| {
            if matches(body.centre_pose(self.world.clock.now), collider) {
                found.push(body.id);
            }
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Where a ray along a unit vector meets a shape first, up to `max` m.
    fn ray_hit(&self, at: ColliderIx, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        let (body, shape, collider) = self.seen_at(at)?;
        let pose = body.centre_pose(self.world.clock.now);
        let local = (pose.inverse_point(origin), pose.inverse_vector(direction));
        let hit = collider.solid.cast_ray(local.0, local.1, max)?;
        Some(RayHit {
            body: body.id,
            shape,
            distance: hit.distance,
            point: pose.point(hit.point),
            normal: pose.vector(hit.normal),
        })
    }

    /// Calls `look` with each shape near `bounds`, its body and its place there.
    fn each_in(&self, bounds: Aabb, mut look: impl FnMut(&BodyState, usize, &Collider)) {
        let mut look = |at| {
            if let Some((body, shape, collider)) = self.seen_at(at) {
                look(body, shape, collider);
            }
        };
        self.shapes_outside_trees(bounds)
            .into_iter()
            .for_each(&mut look);
        self.world.broad.query(bounds, look);
    }

    /// Shapes that are in no tree and have a piece that may be in `bounds`: of free bodies in the grid, or of the engine where it moves
    /// everything.
    fn shapes_outside_trees(&self, bounds: Aabb) -> Vec<ColliderIx> {
        let engine = self.world.stepping.as_ref();
        let in_engine = engine.map(|stepping| stepping.shapes_in(&self.world.bodies, bounds));
        let in_engine = in_engine.unwrap_or_default();
        if self.world.settings.mode == Mode::Stepped {
            return in_engine;
        }
        let bodies = self
            .world
            .free
            .present(&self.world.bodies, bounds, self.world.clock.now);
        let shapes = bodies
            .iter()
            .flat_map(|body| &self.world.bodies.get(*body).colliders);
        let members = in_engine.into_iter();
        let is_member = |at: &ColliderIx| {
            let owner = self.world.bodies.colliders[*at].body;
            let state = self.world.bodies.get(owner);
            state.in_engine() && !state.is_asleep()
        };
        shapes.copied().chain(members.filter(is_member)).collect()
    }

    /// A shape that the tree named, with its body and its place there, if the filter touches it.
    fn seen_at(&self, at: ColliderIx) -> Option<(&BodyState, usize, &Collider)> {
        let collider = &self.world.bodies.colliders[at];
        let body = self.world.bodies.get(collider.body);
        self.filter
            .is_none_or(|filter| filter.touches(collider.surface.filter))
            .then(|| (body, body.shape_of(at), collider))
    }
}

/// Box around the way of a box, of `max` lengths.
fn box_of_way(start: Aabb, way: Vec2, max: f64) -> Aabb {
    // Along an axis 0 · ∞ is no number.
    let end = Vec2::select(way.cmpeq(Vec2::ZERO), Vec2::ZERO, way * max);
    start.union(Aabb::new(start.min + end, start.max + end))
}

/// A body and which of its shapes.
type Place = (BodyIx, usize);

#[cfg(test)]
mod tests;
