//! A body's motion as a function of time: quadratic in position and in angle.

use carom_math::{Pose, Rot, SimTime, Vec2, cross_scalar};

/// Where a frame is at every instant from `start` on.
///
/// ```text
/// centre(t) = centre + velocity u + acceleration u²/2        u = t − start, in s
/// angle(t)  = angle  + spin u     + angular_acceleration u²/2
/// ```
///
/// Exact for a body in a uniform field; for anything else a piece of the true path, which stays
/// within `left_out` metres of it. Shapes that move along are given about `centre`.
///
/// # Examples
/// ```
/// use carom_collision::Motion;
/// use carom_math::{SimTime, vec2};
/// let thrown = Motion {
///     velocity: vec2(3.0, 4.0),                                // m/s
///     acceleration: vec2(0.0, -10.0),                          // m/s²
///     ..Motion::resting(vec2(0.0, 0.0))
/// };
/// assert_eq!(thrown.centre_at(SimTime::from_secs(0.5)), vec2(1.5, 0.75));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The instant that the other fields belong to.
    pub start: SimTime,
    /// Centre of mass at `start`, in m.
    pub centre: Vec2,
    /// Velocity of the centre at `start`, in m/s.
    pub velocity: Vec2,
    /// Acceleration of the centre, in m/s².
    pub acceleration: Vec2,
    /// Rotation at `start`.
    pub rotation: Rot,
    /// Angular velocity at `start`, in rad/s, counter-clockwise.
    pub spin: f64,
    /// Angular acceleration, in rad/s².
    pub angular_acceleration: f64,
    /// Largest distance between this path and the true one, in m; 0 if the path is exact.
    pub left_out: f64,
}

impl Motion {
    /// At rest at `centre` since the start of time, not turned.
    #[must_use]
    pub const fn resting(centre: Vec2) -> Self {
        Self {
            start: SimTime::ZERO,
            centre,
            velocity: Vec2::ZERO,
            acceleration: Vec2::ZERO,
            rotation: Rot::IDENTITY,
            spin: 0.0,
            angular_acceleration: 0.0,
            left_out: 0.0,
        }
    }

    /// Centre of mass at `time`, in m.
    #[must_use]
    pub fn centre_at(&self, time: SimTime) -> Vec2 {
        self.centre + self.travel(time - self.start)
    }

    /// Velocity of the centre at `time`, in m/s.
    #[must_use]
    pub fn velocity_at(&self, time: SimTime) -> Vec2 {
        self.velocity + self.acceleration * (time - self.start)
    }

    /// Angular velocity at `time`, in rad/s.
    #[must_use]
    pub fn spin_at(&self, time: SimTime) -> f64 {
        self.spin + self.angular_acceleration * (time - self.start)
    }

    /// Rotation at `time`.
    #[must_use]
    pub fn rotation_at(&self, time: SimTime) -> Rot {
        self.rotation.turned(self.turn(time - self.start))
    }

    /// Frame of the centre at `time`.
    #[must_use]
    pub fn pose_at(&self, time: SimTime) -> Pose {
        Pose::new(self.centre_at(time), self.rotation_at(time))
    }

    /// Velocity at `time` of the body's point that is at `point` then, in m/s.
    #[must_use]
    pub fn velocity_of_point(&self, point: Vec2, time: SimTime) -> Vec2 {
        self.velocity_at(time) + cross_scalar(self.spin_at(time), point - self.centre_at(time))
    }

    /// How far the centre moves in the first `elapsed` seconds, in m.
    #[must_use]
    pub fn travel(&self, elapsed: f64) -> Vec2 {
        (self.velocity + self.acceleration * (0.5 * elapsed)) * elapsed
    }

    /// How far the frame turns in the first `elapsed` seconds, in rad, whole turns included.
    #[must_use]
    pub fn turn(&self, elapsed: f64) -> f64 {
        (self.spin + 0.5 * self.angular_acceleration * elapsed) * elapsed
    }

    /// The same motion, told from `time` on.
    #[must_use]
    pub fn rebased(&self, time: SimTime) -> Self {
        let elapsed = time - self.start;
        if elapsed == 0.0 {
            return *self;
        }
        Self {
            start: time,
            centre: self.centre + self.travel(elapsed),
            velocity: self.velocity + self.acceleration * elapsed,
            rotation: self.rotation.turned(self.turn(elapsed)),
            spin: self.spin + self.angular_acceleration * elapsed,
            ..*self
        }
    }

    /// Whether all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.centre.is_finite()
            && self.velocity.is_finite()
            && self.acceleration.is_finite()
            && self.rotation.x_axis().is_finite()
            && self.spin.is_finite()
            && self.angular_acceleration.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_rebased_motion_is_the_same_motion(
            v in -20.0..20.0_f64, g in -20.0..20.0_f64, w in -50.0..50.0_f64, alpha in -50.0..50.0_f64,
            first in 0.0..1.0_f64, second in 0.0..1.0_f64,
        ) {
            let motion = Motion {
                velocity: vec2(v, -v),
                acceleration: vec2(0.0, g),
                spin: w,
                angular_acceleration: alpha,
                ..Motion::resting(vec2(3.0, 4.0))
            };
            let (early, late) = (SimTime::from_secs(first), SimTime::from_secs(first + second));
            let rebased = motion.rebased(early);
            prop_assert!((rebased.centre_at(late) - motion.centre_at(late)).length() < 1e-13);
            prop_assert!((rebased.velocity_at(late) - motion.velocity_at(late)).length() < 1e-13);
            let turned = rebased.rotation_at(late) * motion.rotation_at(late).inverse();
            prop_assert!(turned.angle().abs() < 1e-12);
        }
    }
}
