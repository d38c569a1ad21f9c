//! Bodies that move, and bodies that came to rest in the last step.

use carom_math::Vec2;

use super::slots::{grown, number};
use super::state::BodyState;

/// No place in the list.
const NONE: u32 = u32::MAX;

/// Places of bodies that move, and of those with a changed motion. A flight that goes on costs nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved {
    /// Bodies with a motion changed since the last step ended, each once.
    changed: Vec<u32>,
    is_changed: Vec<bool>,
    /// Bodies that move, and where each body is in this list.
    moving: Vec<u32>,
    place: Vec<u32>,
    /// Bodies at rest with a motion changed in the last step.
    stopped: Vec<u32>,
}

impl Moved {
    /// A body has another motion.
    pub(crate) fn note(&mut self, index: u32) {
        grown(&mut self.place, index, NONE);
        if !core::mem::replace(grown(&mut self.is_changed, index, false), true) {
            self.changed.push(index);
        }
    }

    /// A step is over: `moves` tells whether a body moves, or that it is not there any more.
    pub(crate) fn end_step(&mut self, moves: impl Fn(u32) -> Option<bool>) {
        self.stopped.clear();
        let mut changed = core::mem::take(&mut self.changed);
        for index in changed.drain(..) {
            self.is_changed[index as usize] = false;
            match moves(index) {
                Some(true) => self.enter(index),
                Some(false) => {
                    self.leave(index);
                    self.stopped.push(index);
                }
                None => self.leave(index),
            }
        }
        self.changed = changed;
    }

    /// Places of bodies that moved in the last step.
    pub(crate) fn indices(&self) -> impl Iterator<Item = u32> + '_ {
        self.moving.iter().chain(&self.stopped).copied()
    }

    fn enter(&mut self, index: u32) {
        if self.place[index as usize] == NONE {
            self.place[index as usize] = number(self.moving.len());
            self.moving.push(index);
        }
    }

    fn leave(&mut self, index: u32) {
        let place = core::mem::replace(&mut self.place[index as usize], NONE);
        if place != NONE {
            self.moving.swap_remove(place as usize);
            if let Some(moved) = self.moving.get(place as usize) {
                self.place[*moved as usize] = place;
            }
        }
    }
}

/// Whether a body is elsewhere a moment later.
pub(crate) fn moves(state: &BodyState) -> bool {
    let motion = &state.motion;
    let still = motion.velocity == Vec2::ZERO
        && motion.acceleration == Vec2::ZERO
        && motion.spin == 0.0
        && motion.angular_acceleration == 0.0;
    !still || state.flight.is_some()
}
