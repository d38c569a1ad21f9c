//! Paths of islands that contacts hold: where each of their bodies is for a while.

use carom_math::{Rot, SimTime, Vec2, perp};

use super::collocated::Collocated;
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
#[derive(Clone, Debug)]
pub(crate) enum Path {
    Collocated(Collocated),
    Swing(Swing),
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

impl Path {
    pub(crate) const fn start(&self) -> SimTime {
        match self {
            Self::Collocated(path) => path.start,
            Self::Swing(swing) => swing.start,
        }
    }

    /// In s.
    pub(crate) const fn length(&self) -> f64 {
        match self {
            Self::Collocated(path) => path.length,
            Self::Swing(swing) => swing.length,
        }
    }

    /// All bodies `t` seconds after the start.
    pub(crate) fn places_after(&self, t: f64) -> Vec<Place> {
        let mut places = Vec::new();
        self.write_places(t, &mut places);
        places
    }

    /// [`Self::places_after`] into `places`.
    pub(crate) fn write_places(&self, t: f64, places: &mut Vec<Place>) {
        match self {
            Self::Collocated(path) => path.write_places(t, places),
            Self::Swing(swing) => {
                places.clear();
                places.extend_from_slice(&swing.places);
                let (centre, velocity, angle, spin) = swing.body_after(swing.body, t);
                let rotation = swing.places[swing.body].rotation.turned(angle);
                places[swing.body] = Place {
                    centre,
                    rotation,
                    velocity,
                    spin,
                };
            }
        }
    }

    /// Rotation of a body at the start.
    pub(crate) fn rotation(&self, body: usize) -> Rot {
        match self {
            Self::Collocated(path) => path.rotation(body),
            Self::Swing(swing) => swing.places[body].rotation,
        }
    }

    /// Centre, velocity, angle since the start, and spin of a body `t` seconds after it.
    pub(crate) fn body_after(&self, body: usize, t: f64) -> (Vec2, Vec2, f64, f64) {
        match self {
            Self::Collocated(path) => path.body_after(body, t),
            Self::Swing(swing) => swing.body_after(body, t),
        }
    }

    /// Acceleration of a body's centre, in m/s², and of its angle, in rad/s², `t` seconds after the start.
    pub(crate) fn acceleration_after(&self, body: usize, t: f64) -> (Vec2, f64) {
        match self {
            Self::Collocated(path) => path.acceleration_after(body, t),
            Self::Swing(swing) => swing.acceleration_after(body, t),
        }
    }

    /// Bound on the third derivative of a body's path, in m/s³, and of its angle, in rad/s³.
    pub(crate) fn jerk(&self, body: usize) -> (f64, f64) {
        match self {
            Self::Collocated(path) => path.jerk(body),
            Self::Swing(swing) => swing.jerk(body),
        }
    }
}

impl Swing {
    /// From the pivot to the centre of mass at the start.
    fn arm(&self) -> Vec2 {
        self.places[self.body].centre - self.pivot
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
