//! What few bodies have, kept beside them.

use carom_math::{SimTime, Vec2};

/// What few bodies have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Uncommon {
    /// How gravity and fields act on it, as a factor: 1 for most.
    pub(crate) gravity_scale: f64,
    /// Until when a free body's motion stands for the law that it flies by; for ever where it is the law.
    pub(crate) piece: SimTime,
    /// Of velocity and spin, in 1/s.
    pub(crate) damping: (f64, f64),
    /// Its island may fall asleep.
    pub(crate) sleep_allowed: bool,
    /// Force and torque of the present step; of what the engine moves their means over its sub-step.
    pub(crate) force: Vec2,
    pub(crate) torque: f64,
    /// Force and torque that the next step begins with; of what the engine moves those of the present one, too.
    pub(crate) pending: (Vec2, f64),
    /// Until when these have acted in the engine, and what it still owes of earlier ones, in N·s and N·m·s.
    pub(crate) acted: SimTime,
    pub(crate) owed: (Vec2, f64),
    /// What the velocity has beyond the motion's along its present piece.
    pub(crate) lag: Lag,
}

impl Uncommon {
    pub(crate) const NONE: Self = Self {
        gravity_scale: 1.0,
        piece: SimTime::NEVER,
        damping: (0.0, 0.0),
        sleep_allowed: true,
        force: Vec2::ZERO,
        torque: 0.0,
        pending: (Vec2::ZERO, 0.0),
        acted: SimTime::ZERO,
        owed: (Vec2::ZERO, 0.0),
        lag: Lag::NONE,
    };

    /// The engine, with sub-steps of `h` seconds, owes what acted until `time`.
    pub(crate) fn owe_until(&mut self, time: SimTime, h: f64) {
        let (force, torque) = self.pending;
        let since = time - self.acted;
        if since.abs() > ROUNDED * h {
            self.owed.0 += force * since;
            self.owed.1 += torque * since;
        }
        self.acted = time;
    }

    /// Means over the sub-step of `h` seconds from `start` on of what acts in it up to `end`, and of what is owed.
    pub(crate) fn act(&mut self, start: SimTime, end: SimTime, h: f64) {
        self.owe_until(start, h);
        let left = end - start;
        let left = if left < h * (1.0 - ROUNDED) { left } else { h };
        let (owed, turning) = core::mem::take(&mut self.owed);
        (self.force, self.torque) = self.pending;
        if left < h || owed != Vec2::ZERO || turning != 0.0 {
            self.force = (owed + self.force * left) / h;
            self.torque = (turning + self.torque * left) / h;
        }
        self.acted = start + left;
    }
}

/// Part of a sub-step by which steps may miss its ends: sums of `dt` are rounded.
const ROUNDED: f64 = 1e-9;

/// What a velocity has beyond that of the motion, which tells the place.
///
/// Of a body that was stopped within a sub-step: what it had before and has afterwards, less the mean that brings it to where it
/// stopped.
///
/// ```text
/// v(u) = v₀ + A u + K + B u
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lag {
    /// K in m/s, and B in m/s².
    pub(crate) mean: (Vec2, Vec2),
    /// The same for the spin, in rad/s and rad/s².
    pub(crate) mean_spin: (f64, f64),
}

impl Lag {
    pub(crate) const NONE: Self = Self {
        mean: (Vec2::ZERO, Vec2::ZERO),
        mean_spin: (0.0, 0.0),
    };

    /// Of a body that goes evenly while its velocity changes from one to another within `h`: in m/s and in rad/s.
    pub(crate) fn of_even(even: (Vec2, f64), from: (Vec2, f64), to: (Vec2, f64), h: f64) -> Self {
        Self {
            mean: (from.0 - even.0, (to.0 - from.0) / h),
            mean_spin: (from.1 - even.1, (to.1 - from.1) / h),
        }
    }

    pub(crate) fn at(self, u: f64) -> Vec2 {
        self.mean.0 + self.mean.1 * u
    }

    pub(crate) fn spin_at(self, u: f64) -> f64 {
        self.mean_spin.0 + self.mean_spin.1 * u
    }
}
