//! How two bodies move against each other at a point of contact.

use carom_math::{SimTime, Vec2, cross_scalar};

use crate::store::state::BodyState;

/// Opening speed below which a touch neither opens nor closes, as a part of the speeds it is made of.
pub(crate) const CLOSED: f64 = 1e-9;

/// Where a body is, and how it moves, at an instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigidState {
    /// Centre of mass, in m.
    pub(crate) centre: Vec2,
    /// In m/s.
    pub(crate) velocity: Vec2,
    /// In rad/s.
    pub(crate) spin: f64,
}

impl RigidState {
    /// A law of flight costs elliptic functions, or a sum of polynomials: it is asked once.
    pub(crate) fn of(state: &BodyState, time: SimTime) -> Self {
        let (centre, velocity, spin) = if let Some(flight) = &state.flight {
            let (centre, velocity, _, spin) = flight.all_at(time);
            (centre, velocity, spin)
        } else {
            let (centre, velocity) = (state.centre_at(time), state.velocity_at(time));
            (centre, velocity, state.spin_at(time))
        };
        Self {
            centre,
            velocity,
            spin,
        }
    }

    /// Velocity of the body's point at `point`, in m/s.
    pub(crate) fn velocity_of(&self, point: Vec2) -> Vec2 {
        self.velocity + cross_scalar(self.spin, point - self.centre)
    }
}

/// What a touch does, by more than rounding; at which speed, in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Approach {
    Leaves(f64),
    Stays,
    Closes(f64),
}

/// What a point of two bodies does along the normal; `rest`: their rest speed, in m/s.
pub(crate) fn approach(
    ends: (RigidState, RigidState),
    point: Vec2,
    normal: Vec2,
    rest: f64,
) -> Approach {
    let (rate, size) = opening(ends, point, normal);
    let rounding = CLOSED * (size + rest);
    if rate > rounding {
        Approach::Leaves(rate)
    } else if rate < -rounding {
        Approach::Closes(-rate)
    } else {
        Approach::Stays
    }
}

/// Speed at which a point opens, and the sum of the speeds that it is made of, in m/s.
pub(crate) fn opening(ends: (RigidState, RigidState), point: Vec2, normal: Vec2) -> (f64, f64) {
    let of = |body: RigidState| {
        let turning = cross_scalar(body.spin, point - body.centre);
        (
            body.velocity + turning,
            body.velocity.length() + turning.length(),
        )
    };
    let ((v_a, size_a), (v_b, size_b)) = (of(ends.0), of(ends.1));
    ((v_b - v_a).dot(normal), size_a + size_b)
}
