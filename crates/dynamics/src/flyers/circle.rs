//! Bounding circles in motion: what most partners of a search are looked at by, and no more.

use carom_math::{SimTime, Vec2};

use super::Flyers;
use super::frame::{Frame, Track};
use super::window::{self, Window};
use crate::Filter;
use crate::state::{BodyState, Collider};

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
        if self.bends || other.bends {
            return window.map(Window::until_its_horizon);
        }
        window
    }
}

/// The circle of a flyer with the motion that it looked round with: 64 bytes, where the body has ten times as many.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(super) struct Registered {
    since: SimTime,
    centre: Vec2,
    velocity: Vec2,
    reach: f64,
    /// It falls as the frame does.
    falls: bool,
    /// It has one shape, which touches all that have the usual filter.
    plain: bool,
}

impl Registered {
    pub(super) fn of(state: &BodyState, colliders: &[Collider], frame: &Frame) -> Self {
        let motion = &state.motion;
        Self {
            since: motion.start,
            centre: motion.centre,
            velocity: motion.velocity,
            reach: state.reach,
            falls: motion.acceleration == frame.acceleration() && state.flight.is_none(),
            plain: state.is_dynamic()
                && matches!(&*state.colliders, [one] if colliders[*one as usize].filter == Filter::default()),
        }
    }
}

impl Flyers {
    /// Until when two bodies of the grid have looked for each other, if both touch whatever is usual.
    pub(super) fn common_horizon(&self, a: u32, b: u32) -> Option<SimTime> {
        let [a, b] = [a, b].map(|body| body as usize);
        let plain = self.circles.get(a)?.plain && self.circles.get(b)?.plain;
        plain.then(|| self.horizons[a].min(self.horizons[b]))
    }

    /// The circle at `time` of a body in the grid, if it falls as the frame does: the bits of [`Circle::of`].
    pub(super) fn circle(&self, body: u32, time: SimTime) -> Option<Circle> {
        let known = self
            .circles
            .get(body as usize)
            .filter(|known| known.falls)?;
        let (u, acceleration) = (time - known.since, self.frame.acceleration());
        let track = Track {
            centre: known.centre + (known.velocity + acceleration * (0.5 * u)) * u,
            velocity: known.velocity + acceleration * u,
            acceleration,
        };
        Some(Circle {
            track,
            reach: known.reach,
            bends: false,
        })
    }
}
