//! The law of a flight that no quadratic is: kept beside the motion, which serves prediction.

use std::sync::Arc;

use carom_collision::Motion;
use carom_math::{Rot, SimTime, Vec2};

use super::damped::damped;
use super::integrate::{Rim, Stretch};
use super::kepler::Conic;
use super::osculating::{Jerk, Osculating};
use super::path::Path;

/// Where a flying body is from `start` on, to rounding or to the world's error for fields.
#[derive(Clone, Debug)]
pub(crate) struct Flight {
    start: SimTime,
    law: Law,
    turn: Turn,
}

/// Where the centre of mass is.
#[derive(Clone, Debug)]
enum Law {
    Damped {
        place: Vec2,
        velocity: Vec2,
        pull: Vec2,
        damping: f64,
    },
    /// With the radius of the core, where it comes so near.
    Conic { conic: Conic, core: Option<f64> },
    /// One after the other.
    Stretches(Vec<Stretch>),
    /// Held by contacts: the path of an island, and which of its bodies this is.
    Held { path: Arc<Path>, body: usize },
}

/// How the body turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub(crate) rotation: Rot,
    /// In rad/s.
    pub(crate) spin: f64,
    /// Angular acceleration, in rad/s².
    pub(crate) pull: f64,
    /// In 1/s.
    pub(crate) damping: f64,
}

impl Flight {
    /// Under a constant pull, in m/s², and linear damping, in 1/s.
    pub(crate) fn damped(
        start: SimTime,
        (place, velocity): (Vec2, Vec2),
        pull: Vec2,
        damping: f64,
        turn: Turn,
    ) -> Self {
        let law = Law::Damped {
            place,
            velocity,
            pull,
            damping,
        };
        Self { start, law, turn }
    }

    /// On a conic, outside a core: `None` if it may enter that within `h` seconds.
    pub(crate) fn conic(
        start: SimTime,
        conic: Conic,
        core: f64,
        h: f64,
        turn: Turn,
    ) -> Option<Self> {
        let core = (conic.nearest() <= core).then_some(core);
        let law = Law::Conic { conic, core };
        let flight = Self { start, law, turn };
        flight.holds(start, h).then_some(flight)
    }

    /// Of a body of an island that turns about its contacts.
    pub(crate) fn held(path: Arc<Path>, body: usize) -> Self {
        let turn = Turn {
            rotation: path.rotation(body),
            spin: 0.0,
            pull: 0.0,
            damping: 0.0,
        };
        Self {
            start: path.start(),
            law: Law::Held { path, body },
            turn,
        }
    }

    /// Under any law, for at least `h` seconds or one stretch, leaving out `error` metres a second. No stretch is
    /// planned for more than the longest, and none is shorter than the shortest: that steps over an edge of a field.
    pub(crate) fn integrated(
        start: SimTime,
        (mut place, mut velocity): (Vec2, Vec2),
        law: &impl Fn(Vec2, Vec2) -> Vec2,
        h: f64,
        (shortest, longest): (f64, f64),
        (error, rims): (f64, &[Rim]),
        turn: Turn,
    ) -> Self {
        let mut stretches = Vec::with_capacity(1);
        let (mut left, mut reach) = (h, longest);
        // Rounding leaves no stretch of its own.
        while left > 1e-12 * h || stretches.is_empty() {
            let lengths = (shortest, reach);
            let stretch = Stretch::follow(law, place, velocity, lengths, error, rims);
            (place, velocity) = stretch.at(stretch.length);
            left -= stretch.length;
            reach = left;
            stretches.push(stretch);
        }
        Self {
            start,
            law: Law::Stretches(stretches),
            turn,
        }
    }

    /// Whether the law is known from `time` on for `h` seconds.
    pub(crate) fn holds(&self, time: SimTime, h: f64) -> bool {
        let t = time - self.start;
        match &self.law {
            Law::Damped { .. } | Law::Conic { core: None, .. } => true,
            Law::Conic {
                conic,
                core: Some(core),
            } => conic.time_outside(t, *core) > h,
            Law::Stretches(stretches) => {
                let whole: f64 = stretches.iter().map(|stretch| stretch.length).sum();
                t + h <= whole * (1.0 + 1e-12)
            }
            Law::Held { path, .. } => t + h <= path.length() * (1.0 + 1e-12),
        }
    }

    /// Seconds from `time` on for which the law is surely known, at most `longest`.
    pub(crate) fn lasts(&self, time: SimTime, longest: f64) -> f64 {
        let t = time - self.start;
        let known = match &self.law {
            Law::Damped { .. } | Law::Conic { core: None, .. } => longest,
            Law::Conic {
                conic,
                core: Some(core),
            } => conic.time_outside(t, *core),
            Law::Stretches(stretches) => stretches.iter().map(|s| s.length).sum::<f64>() - t,
            Law::Held { path, .. } => path.length() - t,
        };
        if known < longest { known } else { longest }
    }

    /// Whether some of it leaves out more than the world's error for fields.
    pub(crate) fn misses(&self) -> bool {
        matches!(&self.law, Law::Stretches(all) if all.iter().any(|stretch| stretch.misses))
    }

    /// Whether nothing holds the body.
    pub(crate) const fn is_free(&self) -> bool {
        !matches!(self.law, Law::Held { .. })
    }

    /// The parabola that touches the flight at `time`, and how fast that leaves it. `reach` is that of the body.
    pub(crate) fn osculating(&self, time: SimTime, reach: f64) -> Osculating {
        let (x, v, angle, spin) = self.all_at(time);
        let turn = &self.turn;
        let rotation = self.turned_by(angle);
        let mut angular_acceleration = turn.pull - turn.damping * spin;
        let mut twist = turn.damping * angular_acceleration.abs();
        let (acceleration, jerk) = match &self.law {
            // d³x/dt³ = −c a, and a falls off.
            Law::Damped { pull, damping, .. } => {
                let acceleration = *pull - v * *damping;
                (acceleration, Jerk::Most(damping * acceleration.length()))
            }
            Law::Conic { conic, .. } => conic.bends(x, v),
            Law::Stretches(stretches) => {
                let (mut t, last) = (time - self.start, stretches.len() - 1);
                let mut k = 0;
                while k < last && t > stretches[k].length {
                    t -= stretches[k].length;
                    k += 1;
                }
                let most = stretches.iter().map(Stretch::jerk).fold(0.0, f64::max);
                (stretches[k].acceleration(t), Jerk::Most(most))
            }
            Law::Held { path, body } => {
                let jerk;
                (jerk, twist) = path.jerk(*body);
                let acceleration;
                (acceleration, angular_acceleration) =
                    path.acceleration_after(*body, time - self.start);
                (acceleration, Jerk::Most(jerk))
            }
        };
        Osculating {
            motion: Motion {
                start: time,
                centre: x,
                velocity: v,
                acceleration,
                rotation,
                spin,
                angular_acceleration,
                left_out: 0.0,
            },
            jerk,
            twist: twist * reach,
        }
    }

    /// Place in m and velocity in m/s of the centre of mass.
    pub(crate) fn at(&self, time: SimTime) -> (Vec2, Vec2) {
        let t = time - self.start;
        match &self.law {
            Law::Damped {
                place,
                velocity,
                pull,
                damping,
            } => {
                let (x, along) = damped(velocity.x, pull.x, *damping, t);
                let (y, up) = damped(velocity.y, pull.y, *damping, t);
                (*place + Vec2::new(x, y), Vec2::new(along, up))
            }
            Law::Conic { conic, .. } => conic.at(t),
            Law::Stretches(stretches) => {
                let (mut t, last) = (t, stretches.len() - 1);
                for stretch in &stretches[..last] {
                    if t <= stretch.length {
                        return stretch.at(t);
                    }
                    t -= stretch.length;
                }
                stretches[last].at(t)
            }
            Law::Held { path, body } => {
                let (place, velocity, ..) = path.body_after(*body, t);
                (place, velocity)
            }
        }
    }

    /// Rotation, and spin in rad/s.
    pub(crate) fn turn_at(&self, time: SimTime) -> (Rot, f64) {
        let (angle, spin) = self.angle_at(time);
        (self.turned_by(angle), spin)
    }

    /// Rotation where it turned by an angle since the start, in rad.
    pub(crate) fn turned_by(&self, angle: f64) -> Rot {
        self.turn.rotation.turned(angle)
    }

    /// Centre and velocity, angle since the start and spin.
    pub(crate) fn all_at(&self, time: SimTime) -> (Vec2, Vec2, f64, f64) {
        if let Law::Held { path, body } = &self.law {
            return path.body_after(*body, time - self.start);
        }
        let ((centre, velocity), (angle, spin)) = (self.at(time), self.angle_at(time));
        (centre, velocity, angle, spin)
    }

    /// Angle since the start, in rad, and spin in rad/s.
    pub(crate) fn angle_at(&self, time: SimTime) -> (f64, f64) {
        let (turn, t) = (&self.turn, time - self.start);
        if let Law::Held { .. } = self.law {
            let (_, _, angle, spin) = self.all_at(time);
            return (angle, spin);
        }
        damped(turn.spin, turn.pull, turn.damping, t)
    }
}
