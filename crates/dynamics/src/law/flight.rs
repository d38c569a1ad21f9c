//! The law of a flight that no quadratic is: kept beside the motion, which serves prediction.

use std::sync::Arc;

use carom_collision::Motion;
use carom_math::{Rot, SimTime, Vec2};

use super::damped::damped;
use super::integrate::Stretch;
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
    Conic {
        conic: Conic,
        core: Option<f64>,
    },
    Stretch(Stretch),
    /// Held by contacts: the path of an island, and which of its bodies this is.
    Held {
        path: Arc<dyn Path>,
        body: usize,
    },
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
        let outside = core.is_none_or(|core| conic.time_outside(0.0, core) > h);
        let law = Law::Conic { conic, core };
        outside.then_some(Self { start, law, turn })
    }

    /// Of a body of an island that turns about its contacts.
    pub(crate) fn held(path: Arc<dyn Path>, body: usize) -> Self {
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

    /// Under any law, for one stretch of the integrator.
    pub(crate) fn integrated(start: SimTime, stretch: Stretch, turn: Turn) -> Self {
        let law = Law::Stretch(stretch);
        Self { start, law, turn }
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
            Law::Stretch(stretch) => stretch.path.length() - t,
            Law::Held { path, .. } => path.length() - t,
        };
        if known < longest { known } else { longest }
    }

    /// Whether some of it leaves out more than the world's error for fields.
    pub(crate) fn misses(&self) -> bool {
        matches!(&self.law, Law::Stretch(stretch) if stretch.misses)
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
        let mut twist = Jerk::Damped {
            law: 0.0,
            acceleration: angular_acceleration.abs() * reach,
            damping: turn.damping,
        };
        let (acceleration, jerk) = match &self.law {
            Law::Damped { pull, damping, .. } => {
                let acceleration = *pull - v * *damping;
                let jerk = Jerk::Damped {
                    law: 0.0,
                    acceleration: acceleration.length(),
                    damping: *damping,
                };
                (acceleration, jerk)
            }
            Law::Conic { conic, .. } => conic.bends(x, v),
            Law::Stretch(stretch) => {
                let (acceleration, _) = stretch.path.acceleration_after(0, time - self.start);
                // A number that is none bounds nothing.
                let jerk = Jerk::Damped {
                    law: stretch.jerk().max(0.0),
                    acceleration: acceleration.length().max(0.0),
                    damping: stretch.path.damping,
                };
                (acceleration, jerk)
            }
            Law::Held { path, body } => {
                let (jerk, turning) = path.jerk(*body);
                twist = Jerk::Most(turning * reach);
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
            twist,
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
            Law::Stretch(stretch) => stretch.at(t),
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
