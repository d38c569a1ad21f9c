//! The frame in which free bodies look for each other: it falls as they do.
//!
//! Under one uniform field free bodies have constant velocities in it, so that a search holds for as long as
//! they take to travel a part of a cell there, however fast all of them fall.

use carom_collision::Motion;
use carom_math::{SimTime, Vec2};

/// A frame of reference with an origin that moves by `velocity u + acceleration u²/2` from `since` on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Frame {
    since: SimTime,
    /// Where it is then, in m.
    origin: Vec2,
    velocity: Vec2,
    acceleration: Vec2,
}

/// Centre, velocity and acceleration of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Track {
    pub(crate) centre: Vec2,
    pub(crate) velocity: Vec2,
    pub(crate) acceleration: Vec2,
}

impl Track {
    /// Of a motion in the world.
    pub(crate) fn of(motion: &Motion, time: SimTime) -> Self {
        Self {
            centre: motion.centre_at(time),
            velocity: motion.velocity_at(time),
            acceleration: motion.acceleration,
        }
    }

    /// Seconds to travel `way` metres along either axis, at most.
    pub(crate) fn seconds_for(&self, way: f64) -> f64 {
        let (v, a) = (self.velocity.abs(), self.acceleration.abs());
        let along = |v: f64, a: f64| 2.0 * way / (v + (v * v + 2.0 * a * way).sqrt());
        let (x, y) = (along(v.x, a.x), along(v.y, a.y));
        if x < y { x } else { y }
    }

    /// Where the centre is after `elapsed` seconds.
    pub(crate) fn centre_after(&self, elapsed: f64) -> Vec2 {
        self.centre + (self.velocity + self.acceleration * (0.5 * elapsed)) * elapsed
    }
}

impl Frame {
    /// A frame that falls by `acceleration` from rest at the start of time.
    pub(crate) fn falling(acceleration: Vec2) -> Self {
        Self {
            acceleration,
            ..Self::default()
        }
    }

    /// The frame from `time` on, faster by `velocity`. Its origin stays with it: seen from where all fell from, boxes of
    /// what fell for a day would be rounded to kilometres.
    pub(crate) fn boosted(&self, time: SimTime, velocity: Vec2) -> Self {
        Self {
            since: time,
            origin: self.origin_at(time),
            velocity: self.velocity + self.acceleration * (time - self.since) + velocity,
            acceleration: self.acceleration,
        }
    }

    /// Where a point of the world is in the frame at `time`.
    pub(crate) fn point(&self, point: Vec2, time: SimTime) -> Vec2 {
        point - self.origin_at(time)
    }

    fn origin_at(&self, time: SimTime) -> Vec2 {
        let u = time - self.since;
        self.origin + (self.velocity + self.acceleration * (0.5 * u)) * u
    }

    /// A body's track as the frame sees it.
    pub(crate) fn track(&self, track: &Track, time: SimTime) -> Track {
        Track {
            centre: self.point(track.centre, time),
            velocity: track.velocity - self.velocity - self.acceleration * (time - self.since),
            acceleration: track.acceleration - self.acceleration,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_math::vec2;

    #[test]
    fn what_falls_with_the_frame_keeps_its_velocity_in_it() {
        let gravity = vec2(0.0, -10.0);
        let thrown = Motion {
            velocity: vec2(3.0, 4.0),
            acceleration: gravity,
            ..Motion::resting(vec2(1.0, 2.0))
        };
        let frame = Frame::falling(gravity).boosted(SimTime::from_secs(1.0), vec2(0.5, 0.0));
        for t in [1.0, 2.0, 30.0] {
            let time = SimTime::from_secs(t);
            let seen = frame.track(&Track::of(&thrown, time), time);
            assert_eq!(
                (seen.velocity, seen.acceleration),
                (vec2(2.5, 4.0), Vec2::ZERO)
            );
            // The origin has fallen by 5 m when it gets faster.
            let path = vec2(4.0, 6.0) + vec2(2.5, 4.0) * (t - 1.0);
            assert!((seen.centre - path).length() < 1e-11);
        }
    }
}
