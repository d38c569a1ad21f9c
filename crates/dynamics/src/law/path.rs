//! Paths of islands that contacts hold: where each of their bodies is for a while.

use core::fmt::Debug;

use carom_math::{Rot, SimTime, Vec2, perp};

use super::pendulum::Pendulum;

/// Where a body is and how it moves at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Centre of mass, in m.
    pub(crate) centre: Vec2,
    pub(crate) rotation: Rot,
    /// In m/s.
    pub(crate) velocity: Vec2,
    /// In rad/s.
    pub(crate) spin: f64,
}

impl Place {
    pub(crate) fn point(&self, local: Vec2) -> Vec2 {
        self.centre + self.rotation * local
    }

    pub(crate) fn velocity_of(&self, point: Vec2) -> Vec2 {
        self.velocity + perp(point - self.centre) * self.spin
    }
}

/// Where bodies are for a while.
pub(crate) trait Path: Debug + Send + Sync {
    fn start(&self) -> SimTime;

    /// In s.
    fn length(&self) -> f64;

    /// How many bodies it has.
    fn bodies(&self) -> usize;

    /// All bodies `t` seconds after the start, into `places`.
    fn write_places(&self, t: f64, places: &mut Vec<Place>) {
        places.clear();
        places.extend((0..self.bodies()).map(|body| {
            let (centre, velocity, angle, spin) = self.body_after(body, t);
            Place {
                centre,
                rotation: self.rotation(body).turned(angle),
                velocity,
                spin,
            }
        }));
    }

    /// Rotation of a body at the start.
    fn rotation(&self, body: usize) -> Rot;

    /// Centre, velocity, angle since the start, and spin of a body `t` seconds after it.
    fn body_after(&self, body: usize, t: f64) -> (Vec2, Vec2, f64, f64);

    /// Acceleration of a body's centre, in m/s², and of its angle, in rad/s², `t` seconds after the start.
    fn acceleration_after(&self, body: usize, t: f64) -> (Vec2, f64);

    /// Bound on the third derivative of a body's path, in m/s³, and of its angle, in rad/s³.
    fn jerk(&self, body: usize) -> (f64, f64);

    /// All bodies `t` seconds after the start.
    fn places_after(&self, t: f64) -> Vec<Place> {
        let mut places = Vec::new();
        self.write_places(t, &mut places);
        places
    }
}

/// One body turns about a point that stays; all others stay.
#[derive(Clone, Debug)]
pub(crate) struct Swing {
    pub(crate) start: SimTime,
    /// In s.
    pub(crate) length: f64,
    /// Of all bodies at the start.
    pub(crate) places: Vec<Place>,
    /// Which one turns.
    pub(crate) body: usize,
    /// In m.
    pub(crate) pivot: Vec2,
    pub(crate) pendulum: Pendulum,
    /// Bounds on the first three derivatives of its angle as long as the path is known.
    pub(crate) bounds: [f64; 3],
}

impl Swing {
    /// From the pivot to the centre of mass at the start.
    fn arm(&self) -> Vec2 {
        self.places[self.body].centre - self.pivot
    }
}

impl Path for Swing {
    fn start(&self) -> SimTime {
        self.start
    }

    fn length(&self) -> f64 {
        self.length
    }

    fn bodies(&self) -> usize {
        self.places.len()
    }

    fn rotation(&self, body: usize) -> Rot {
        self.places[body].rotation
    }

    fn body_after(&self, body: usize, t: f64) -> (Vec2, Vec2, f64, f64) {
        if body != self.body {
            return (self.places[body].centre, Vec2::ZERO, 0.0, 0.0);
        }
        let (angle, spin) = self.pendulum.after(t);
        let arm = Rot::from_angle(angle) * self.arm();
        (self.pivot + arm, perp(arm) * spin, angle, spin)
    }

    fn acceleration_after(&self, body: usize, t: f64) -> (Vec2, f64) {
        if body != self.body {
            return (Vec2::ZERO, 0.0);
        }
        let (angle, spin) = self.pendulum.after(t);
        let arm = Rot::from_angle(angle) * self.arm();
        let angular = self.pendulum.acceleration(angle);
        (perp(arm) * angular - arm * (spin * spin), angular)
    }

    fn jerk(&self, body: usize) -> (f64, f64) {
        if body != self.body {
            return (0.0, 0.0);
        }
        // x‴ = φ‴ perp r − 3 φ′ φ″ r − φ′³ perp r
        let [spin, angular, twist] = self.bounds;
        let turned = twist + 3.0 * spin * angular + spin * spin * spin;
        (turned * self.arm().length(), twist)
    }
}
