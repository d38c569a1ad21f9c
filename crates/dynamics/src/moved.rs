//! Which bodies move, and which have come to rest in the last step.

use crate::state::BodyState;

/// No place in the list.
const NONE: u32 = u32::MAX;

/// Bodies that move or were moved, by their places. What only flies on costs nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved {
    /// Whose motions changed since the last step ended, each once.
    changed: Vec<u32>,
    is_changed: Vec<bool>,
    /// Who moves, and where each body is in this list.
    moving: Vec<u32>,
    place: Vec<u32>,
    /// Whose motions changed in the last step, and who rests now.
    stopped: Vec<u32>,
}

impl Moved {
    /// A body has another motion.
    pub(crate) fn note(&mut self, index: u32) {
        let at = index as usize;
        if at >= self.place.len() {
            self.place.resize(at + 1, NONE);
            self.is_changed.resize(at + 1, false);
        }
        if !core::mem::replace(&mut self.is_changed[at], true) {
            self.changed.push(index);
        }
    }

    /// A step is over: `moves` tells whether a body moves, or that it is not there any more.
    pub(crate) fn end_step(&mut self, moves: impl Fn(u32) -> Option<bool>) {
        self.stopped.clear();
        for index in core::mem::take(&mut self.changed) {
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
    }

    /// Places of bodies that moved in the last step.
    pub(crate) fn indices(&self) -> impl Iterator<Item = u32> + '_ {
        self.moving.iter().chain(&self.stopped).copied()
    }

    fn enter(&mut self, index: u32) {
        if self.place[index as usize] == NONE {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "no more than there are bodies"
            )]
            let end = self.moving.len() as u32;
            self.place[index as usize] = end;
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
    let still = motion.velocity == carom_math::Vec2::ZERO
        && motion.acceleration == carom_math::Vec2::ZERO
        && motion.spin == 0.0
        && motion.angular_acceleration == 0.0;
    !still || state.flight.is_some()
}
