//! How two bodies move against each other at a point of contact.

use carom_math::{SimTime, Vec2, cross_scalar};

use super::narrow::TOUCH;
use crate::store::pairs::PairContact;
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
    pub(crate) fn of(state: &BodyState, time: SimTime) -> Self {
        Self {
            centre: state.centre_at(time),
            velocity: state.velocity_at(time),
            spin: state.spin_at(time),
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

/// How a point of two bodies moves along the normal.
pub(crate) fn approach_at(
    (a, b): (&BodyState, &BodyState),
    (point, normal): (Vec2, Vec2),
    time: SimTime,
    rest: f64,
) -> Approach {
    let ends = (RigidState::of(a, time), RigidState::of(b, time));
    approach(ends, point, normal, rest)
}

/// Whether a touch neither opens nor closes: a group in closed form may hold it.
pub(crate) fn stays(
    (a, b): (&BodyState, &BodyState),
    contact: &PairContact,
    time: SimTime,
    rest: f64,
) -> bool {
    let ends = (RigidState::of(a, time), RigidState::of(b, time));
    let touch = TOUCH * a.reach.min(b.reach);
    let mut stays = false;
    for point in contact.points.iter().filter(|p| p.separation <= touch) {
        match approach(ends, point.position, contact.normal, rest) {
            Approach::Stays => stays = true,
            Approach::Closes(_) => return false,
            Approach::Leaves(_) => {}
        }
    }
    stays
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
