//! Bounding circles in motion: what most partners of a search are looked at by, and no more.

use carom_math::{SimTime, Vec2};

use super::FreeBodies;
use super::foresee::both_in_grid;
use crate::BodyIx;
use crate::broad::free_fall_frame::{Frame, Track};
use crate::broad::window::{self, Window};
use crate::store::bodies::Bodies;
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
        if self.bends || other.bends {
            return window.map(Window::until_its_horizon);
        }
        window
    }
}

/// A search for neighbours in the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    circle: Circle,
    /// It falls as the frame does.
    falls: bool,
}

/// The circle of a free body with the motion that it looked round with: 64 bytes, where the body has ten times as many.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(super) struct Registered {
    since: SimTime,
    centre: Vec2,
    velocity: Vec2,
    reach: f64,
    /// It falls as the frame does.
    falls: bool,
}

impl Registered {
    pub(super) fn of(state: &BodyState, frame: &Frame) -> Self {
        let motion = &state.motion;
        Self {
            since: motion.start,
            centre: motion.centre,
            velocity: motion.velocity,
            reach: state.reach,
            falls: motion.acceleration == frame.acceleration() && state.flight.is_none(),
        }
    }
}

impl FreeBodies {
    /// Of a body that looks round: its circle, and whether it falls as the frame does, if it is in the grid.
    pub(super) fn looks(&self, bodies: &Bodies, body: BodyIx, time: SimTime) -> Look {
        let state = bodies.get(body);
        let known = self.circles.get(body);
        let known = known.filter(|_| state.course.cells.is_some());
        Look {
            circle: Circle::of(state, time),
            falls: known.is_some_and(|known| known.falls),
        }
    }

    /// When the circle of a body in the grid overlaps that of one that looks round.
    #[inline]
    pub(super) fn window(
        &self,
        bodies: &Bodies,
        look: &Look,
        body: BodyIx,
        time: SimTime,
    ) -> Option<Window> {
        let (own, acceleration) = (&look.circle, self.frame.acceleration());
        match self.circles.get(body) {
            // The bits of [`Circle::of`] and [`Circle::meets`].
            Some(known) if known.falls && look.falls => {
                let u = time - known.since;
                let centre = known.centre + (known.velocity + acceleration * (0.5 * u)) * u;
                let velocity = known.velocity + acceleration * u;
                window::of_even_circles(
                    centre - own.track.centre,
                    velocity - own.track.velocity,
                    own.reach + known.reach,
                )
            }
            _ => own.meets(&Circle::of(bodies.get(body), time)),
        }
    }

    /// Until when two free bodies have looked for each other.
    pub(super) fn common_horizon(&self, a: &BodyState, b: &BodyState) -> SimTime {
        if both_in_grid(a, b) {
            self.horizon(a).min(self.horizon(b))
        } else {
            // The larger one is in the tree, and met where the other looks down.
            a.course.ground.min(b.course.ground)
        }
    }
}
