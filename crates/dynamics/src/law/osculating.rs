//! The parabola that touches a flight at an instant, and how far it is from the flight later.
//!
//! With J a bound on the third derivative of the path the two part by at most `J h³/6` within h seconds.

use carom_collision::Motion;

/// A bound on the third derivative of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Jerk {
    /// For as long as the law is known, in m/s³.
    Most(f64),
    /// With damping c in 1/s: how fast the rest of the law changes, in m/s³, and the acceleration at the start, in m/s².
    Damped {
        law: f64,
        acceleration: f64,
        damping: f64,
    },
    /// About a Newtonian centre: µ in m³/s², distance in m and speed in m/s at the start.
    Newton {
        strength: f64,
        distance: f64,
        speed: f64,
    },
}

/// A parabola, and how fast a flight leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Osculating {
    pub(crate) motion: Motion,
    pub(crate) jerk: Jerk,
    /// The same of the angle, times the body's reach.
    pub(crate) twist: Jerk,
}

impl Jerk {
    /// The bound for `h` seconds, in m/s³; infinite where `h` is too long to say.
    ///
    /// Within w metres of a start at r from the centre `|∇f| ≤ G = 2 µ/(r − w)³`. While `v ≤ V` and `a ≤ A`,
    /// `J ≤ G V`, `A ≤ a₀ + J h`, `V ≤ v₀ + A h`: so `J = G (v₀ + a₀ h)/(1 − G h²)`, if all of that stays within w.
    ///
    /// With damping `x″ = a − c v`, so `x‴ = a′ − c x″` and `|x″(t) − x″(0)| ≤ |x″(0)| (1 − e^(−ct)) + |a′| t`. Of the first
    /// the parabola leaves out no more than `c |x″(0)| h³/6`, nor than `|x″(0)| h²/2`, which is less where c h > 3.
    pub(crate) fn over(self, h: f64) -> f64 {
        let (strength, distance, speed) = match self {
            Self::Most(most) => return most,
            Self::Damped {
                law,
                acceleration,
                damping,
            } => return law + (damping * acceleration).min(3.0 * acceleration / h),
            Self::Newton {
                strength,
                distance,
                speed,
            } => (strength, distance, speed),
        };
        let pull = strength / (distance * distance);
        let way = 1.25 * (speed + pull * h) * h;
        let near = distance - way;
        let gradient = 2.0 * strength / (near * near * near);
        let left = 1.0 - gradient * h * h;
        let jerk = gradient * (speed + pull * h) / left;
        if near > 0.0 && left > 0.0 && (speed + (pull + jerk * h) * h) * h <= way {
            jerk
        } else {
            f64::INFINITY
        }
    }
}

impl Osculating {
    /// Of a body that is on its parabola.
    pub(crate) const fn of(motion: Motion) -> Self {
        Self {
            motion,
            jerk: Jerk::Most(0.0),
            twist: Jerk::Most(0.0),
        }
    }

    /// How far any point of the body is from where the parabola has it, at most, within `h` seconds, in m.
    pub(crate) fn left_out(&self, h: f64) -> f64 {
        let third = self.jerk.over(h) + self.twist.over(h);
        if third == 0.0 {
            return 0.0;
        }
        third * (h * h * h) * (1.0 / 6.0)
    }

    /// The parabola, said to be that far off.
    pub(crate) fn for_seconds(&self, h: f64) -> Motion {
        Motion {
            left_out: self.left_out(h),
            ..self.motion
        }
    }
}
