//! Bounding circles in motion: what most partners of a search are looked at by, and no more.

use carom_math::SimTime;

use crate::broad::free_fall_frame::Track;
use crate::broad::window::{self, Window};
use crate::store::state::BodyState;

/// The bounding circle of a body at an instant, in motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    track: Track,
    reach: f64,
    /// Its track is near its path for a while, and no more.
    bends: bool,
}

impl Circle {
    pub(super) fn of(state: &BodyState, time: SimTime) -> Self {
        Self {
            track: Track::of(&state.motion, time),
            reach: state.reach + state.motion.left_out,
            bends: state.flight.is_some(),
        }
    }

    /// When it overlaps another one, from now on.
    pub(super) fn meets(&self, other: &Self) -> Option<Window> {
        let (a, b) = (&self.track, &other.track);
        let window = window::of_circles(
            b.centre - a.centre,
            b.velocity - a.velocity,
            b.acceleration - a.acceleration,
            self.reach + other.reach,
        );
        let bends = self.bends || other.bends;
        window.map(|window| Window {
            to: if bends { f64::INFINITY } else { window.to },
            ..window
        })
    }
}
