//! Bodies that move, and bodies that came to rest in the last step.

use carom_math::Vec2;

use super::slots::List;
use super::state::BodyState;
use crate::{BodyIx, Ix, MoverIx};

/// Places of bodies that move, and of those with a changed motion. A flight that goes on costs nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved {
    /// Bodies with a motion changed since the last step ended, each once.
    changed: Vec<BodyIx>,
    is_changed: List<BodyIx, bool>,
    /// Bodies that move, and where each body is in this list.
    moving: List<MoverIx, BodyIx>,
    place: List<BodyIx, MoverIx>,
    /// Bodies at rest with a motion changed in the last step.
    stopped: Vec<BodyIx>,
}

impl Moved {
    /// A body has another motion.
    pub(crate) fn note(&mut self, index: BodyIx) {
        self.place.grown(index, MoverIx::NONE);
        if !core::mem::replace(self.is_changed.grown(index, false), true) {
            self.changed.push(index);
        }
    }

    /// A step is over: `moves` tells whether a body moves, or that it is not there any more.
    pub(crate) fn end_step(&mut self, moves: impl Fn(BodyIx) -> Option<bool>) {
        self.stopped.clear();
        let mut changed = core::mem::take(&mut self.changed);
        for index in changed.drain(..) {
            self.is_changed[index] = false;
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
    pub(crate) fn indices(&self) -> impl Iterator<Item = BodyIx> + '_ {
        self.moving.iter().chain(&self.stopped).copied()
    }

    fn enter(&mut self, index: BodyIx) {
        if self.place[index] == MoverIx::NONE {
            self.place[index] = self.moving.push(index);
        }
    }

    fn leave(&mut self, index: BodyIx) {
        let place = core::mem::replace(&mut self.place[index], MoverIx::NONE);
        if place != MoverIx::NONE {
            self.moving.swap_remove(place.at());
            if let Some(moved) = self.moving.get(place) {
                self.place[*moved] = place;
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
