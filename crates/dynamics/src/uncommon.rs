//! What few bodies have, kept beside them.

use carom_math::{SimTime, Vec2};

/// What few bodies have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uncommon {
    /// How gravity and fields act on it, as a factor: 1 for most.
    pub(crate) gravity_scale: f64,
    /// Until when a flyer's motion stands for the law that it flies by; for ever where it is the law.
    pub(crate) piece: SimTime,
    /// Of velocity and spin, in 1/s.
    pub(crate) damping: (f64, f64),
    /// Force and torque of the present step.
    pub(crate) force: Vec2,
    pub(crate) torque: f64,
    /// Force and torque that the next step begins with.
    pub(crate) pending: (Vec2, f64),
    /// What the velocity has beyond the motion's along the present piece of a flight in a field.
    pub(crate) lag: Lag,
}

impl Uncommon {
    pub(crate) const NONE: Self = Self {
        gravity_scale: 1.0,
        piece: SimTime::NEVER,
        damping: (0.0, 0.0),
        force: Vec2::ZERO,
        torque: 0.0,
        pending: (Vec2::ZERO, 0.0),
        lag: Lag::NONE,
    };
}

/// The difference of the cubic through both ends of a piece, in place and velocity, and the
/// parabola that serves for prediction and meets the end in place alone.
///
/// ```text
/// v(u) = v₀ + A u + L u (3 u/h − 2)         L h: what the parabola's velocity lacks at the end
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lag {
    /// L, in m/s².
    pub(crate) rate: Vec2,
    /// The same for the spin, in rad/s².
    pub(crate) angular: f64,
    /// h, in s.
    pub(crate) length: f64,
}

impl Lag {
    pub(crate) const NONE: Self = Self {
        rate: Vec2::ZERO,
        angular: 0.0,
        length: 0.0,
    };

    pub(crate) fn at(self, u: f64) -> Vec2 {
        if self.length == 0.0 {
            return Vec2::ZERO;
        }
        self.rate * (u * (3.0 * u / self.length - 2.0))
    }

    pub(crate) fn spin_at(self, u: f64) -> f64 {
        if self.length == 0.0 {
            return 0.0;
        }
        self.angular * (u * (3.0 * u / self.length - 2.0))
    }
}
