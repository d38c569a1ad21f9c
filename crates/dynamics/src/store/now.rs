//! Where a body is at an instant by the law of its flight, all of it at once: a law costs elliptic functions, or a sum of polynomials.

use carom_math::{SimTime, Vec2};

use super::state::BodyState;
use super::uncommon::Lag;

/// Where a body is at an instant, and how it moves there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    pub(crate) centre: Vec2,
    pub(crate) velocity: Vec2,
    pub(crate) spin: f64,
    /// Since its law of flight began, in rad; without one since its motion did.
    angle: f64,
    /// Since its motion began, in rad.
    pub(crate) turn: f64,
}

impl BodyState {
    /// Ends a piece of a flight in a motion that begins `now`: from there on it is free of its law.
    pub(crate) fn close(&mut self, now: &Now) {
        if let Some(flight) = self.flight.take() {
            self.motion.centre = now.centre;
            self.motion.rotation = flight.turned_by(now.angle);
            self.motion.left_out = 0.0;
        }
        (self.motion.velocity, self.motion.spin) = (now.velocity, now.spin);
        self.set_lag(Lag::NONE);
    }

    /// Where it is at `time` and how it moves there, if that is no parabola's to say: its law is asked once.
    pub(crate) fn by_law(&self, time: SimTime) -> Option<Now> {
        let motion = &self.motion;
        if let Some(flight) = &self.flight {
            let (centre, velocity, angle, spin) = flight.all_at(time);
            let turn = angle - flight.angle_at(motion.start).0;
            return Some(Now {
                centre,
                velocity,
                spin,
                angle,
                turn,
            });
        }
        let lag = self.lag();
        (*lag != Lag::NONE).then(|| {
            let elapsed = time - motion.start;
            let turn = motion.turn(elapsed);
            Now {
                centre: motion.centre_at(time),
                velocity: motion.velocity_at(time) + lag.at(elapsed),
                spin: motion.spin_at(time) + lag.spin_at(elapsed),
                angle: turn,
                turn,
            }
        })
    }
}
