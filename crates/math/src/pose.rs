//! Where a frame is and how it is turned.

use core::ops::Mul;

use crate::{Rot, Vec2};

/// Position (in metres) and rotation of one frame in another.
///
/// # Examples
/// ```
/// use carom_math::{Pose, Rot, vec2};
/// let a = Pose::new(vec2(1.0, 2.0), Rot::from_degrees(90.0));
/// let b = Pose::at(vec2(1.0, 5.0));
/// assert_eq!(b.seen_from(a).position, vec2(3.0, 0.0));        // B's origin in A's frame
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Pose {
    /// Origin of the frame, in metres.
    pub position: Vec2,
    /// How the frame is turned.
    pub rotation: Rot,
}

impl Pose {
    /// The frame itself.
    pub const IDENTITY: Self = Self {
        position: Vec2::ZERO,
        rotation: Rot::IDENTITY,
    };

    /// A frame with its origin at `position`, turned by `rotation`.
    #[must_use]
    pub const fn new(position: Vec2, rotation: Rot) -> Self {
        Self { position, rotation }
    }

    /// A frame with its origin at `position`, not turned.
    #[must_use]
    pub const fn at(position: Vec2) -> Self {
        Self::new(position, Rot::IDENTITY)
    }

    /// The principal angle that the frame is turned by, in radians, in (−π, π].
    #[must_use]
    pub fn angle(self) -> f64 {
        self.rotation.angle()
    }

    /// The frame a part of the way to `other`: straight, and by the shorter turn. 0 is this one, 1 the other.
    #[must_use]
    pub fn blend(self, other: Self, part: f64) -> Self {
        Self {
            position: self.position + (other.position - self.position) * part,
            rotation: self.rotation.blend(other.rotation, part),
        }
    }

    /// A point of this frame, seen from the parent.
    #[must_use]
    pub fn point(self, local: Vec2) -> Vec2 {
        self.rotation * local + self.position
    }

    /// A direction of this frame, seen from the parent.
    #[must_use]
    pub fn vector(self, local: Vec2) -> Vec2 {
        self.rotation * local
    }

    /// A point of the parent, seen from this frame.
    #[must_use]
    pub fn inverse_point(self, point: Vec2) -> Vec2 {
        self.rotation.inverse_mul(point - self.position)
    }

    /// A direction of the parent, seen from this frame.
    #[must_use]
    pub fn inverse_vector(self, vector: Vec2) -> Vec2 {
        self.rotation.inverse_mul(vector)
    }

    /// The parent, seen from this frame.
    #[must_use]
    pub fn inverse(self) -> Self {
        let rotation = self.rotation.inverse();
        Self::new(rotation * -self.position, rotation)
    }

    /// This frame, seen from `frame`; both are given in the same parent.
    #[must_use]
    pub fn seen_from(self, frame: Self) -> Self {
        Self::new(
            frame.inverse_point(self.position),
            frame.rotation.inverse() * self.rotation,
        )
    }
}

/// `a * b` is the frame `b`, given in `a`, seen from `a`'s parent.
impl Mul for Pose {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        Self::new(self.point(b.position), self.rotation * b.rotation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vec2;
    use proptest::prelude::*;

    fn pose() -> impl Strategy<Value = Pose> {
        (-1e3..1e3_f64, -1e3..1e3_f64, -10.0..10.0_f64)
            .prop_map(|(x, y, angle)| Pose::new(vec2(x, y), Rot::from_angle(angle)))
    }

    proptest! {
        #[test]
        fn seen_from_and_mul_are_inverse(a in pose(), b in pose()) {
            let back = a * b.seen_from(a);
            prop_assert!((back.position - b.position).length() < 1e-11);
            prop_assert!((back.rotation * b.rotation.inverse()).angle().abs() < 1e-14);
        }

        #[test]
        fn inverse_is_the_parent_seen_from_here(a in pose()) {
            let p = vec2(2.0, -7.0);
            prop_assert!((a.inverse().point(p) - a.inverse_point(p)).length() < 1e-11);
        }
    }
}
