//! Questions about a world at its present time: rays, points, boxes, casts.

use carom_collision::cast;
use carom_geometry::{Aabb, Shape};
use carom_math::{Pose, Vec2};

use crate::body::Collider;
use crate::{BodyId, World};

/// What a ray met first.
#[derive(Clone, Copy, Debug, PartialEq)]
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

impl World {
    /// The first shape on a ray from `origin` along `direction` (any length above 0), up to `max` m.
    ///
    /// `None` if there is none, or if the ray has no direction or is not finite.
    #[must_use]
    pub fn cast_ray(&self, origin: Vec2, direction: Vec2, max: f64) -> Option<RayHit> {
        let direction = direction.try_normalize()?;
        if !origin.is_finite() || max.is_nan() {
            return None;
        }
        let mut best: Option<RayHit> = None;
        for (body, shape, collider) in self.all_shapes() {
            let pose = body.motion.pose_at(self.clock.now);
            let reach = best.map_or(max, |hit| hit.distance);
            let local = (pose.inverse_point(origin), pose.inverse_vector(direction));
            if let Some(hit) = collider.solid.cast_ray(local.0, local.1, reach)
                && best.is_none_or(|known| hit.distance < known.distance)
            {
                best = Some(RayHit {
                    body: body.id,
                    shape,
                    distance: hit.distance,
                    point: pose.point(hit.point),
                    normal: pose.vector(hit.normal),
                });
            }
        }
        best
    }

    /// Bodies with a shape that contains `point` (in m), in order.
    #[must_use]
    pub fn bodies_at(&self, point: Vec2) -> Vec<BodyId> {
        let inside =
            |pose: Pose, collider: &Collider| collider.solid.contains(pose.inverse_point(point));
        self.bodies_with(inside)
    }

    /// Bodies with a shape whose box overlaps `bounds`, in order.
    #[must_use]
    pub fn bodies_in(&self, bounds: Aabb) -> Vec<BodyId> {
        self.bodies_with(|pose, collider| collider.solid.aabb(pose).overlaps(bounds))
    }

    /// The first body that `shape` at `pose` meets on its way along `translation` (in m), not turning.
    #[must_use]
    pub fn cast_shape(&self, shape: &Shape, pose: Pose, translation: Vec2) -> Option<ShapeHit> {
        let mut best: Option<ShapeHit> = None;
        for (body, index, collider) in self.all_shapes() {
            let target = body.motion.pose_at(self.clock.now);
            if let Some(hit) = cast(shape, pose, translation, &collider.solid, target)
                && best.is_none_or(|known| hit.fraction < known.fraction)
            {
                best = Some(ShapeHit {
                    body: body.id,
                    shape: index,
                    fraction: hit.fraction,
                    point: hit.point,
                    normal: hit.normal,
                });
            }
        }
        best
    }

    fn bodies_with(&self, matches: impl Fn(Pose, &Collider) -> bool) -> Vec<BodyId> {
        let mut found: Vec<BodyId> = Vec::new();
        for (body, _, collider) in self.all_shapes() {
            if found.last() != Some(&body.id)
                && matches(body.motion.pose_at(self.clock.now), collider)
            {
                found.push(body.id);
            }
        }
        found
    }

    /// Every shape with its body and its place there.
    fn all_shapes(
        &self,
    ) -> impl Iterator<Item = (&crate::body::BodyState, usize, &Collider)> + use<'_> {
        let colliders = &self.colliders;
        self.bodies.iter().flat_map(move |body| {
            let places = body.colliders.iter().enumerate();
            places.map(move |(i, at)| (body, i, &colliders[*at as usize]))
        })
    }
}
