//! A shape moved along a line until it meets another, in closed form.

use carom_geometry::Shape;
use carom_math::{Pose, Vec2};

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
#[must_use]
pub fn cast(
    moving: &Shape,
    pose: Pose,
    translation: Vec2,
    target: &Shape,
    target_pose: Pose,
) -> Option<CastHit> {
    let _ = (moving, pose, translation, target, target_pose);
    todo!()
}
