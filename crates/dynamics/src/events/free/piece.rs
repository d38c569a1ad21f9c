//! Free bodies in a field or with damping: pieces of a law, each a parabola.

use carom_math::SimTime;

use crate::motion::flight::begin_piece;
use crate::{BodyIx, World};

impl World {
    /// Gives a free body in a field or with damping the piece of its law that begins at `time`, if it has none that goes on.
    ///
    /// All predictions for a free body are for its piece, and all its searches end with it.
    pub(super) fn follow_law(&mut self, index: BodyIx, time: SimTime) {
        // Its law is its group's.
        if self.bodies.get(index).moves_analytically() {
            if self.piece_ends(index, time) {
                self.closed.begin_next_piece(&mut self.bodies, index, time);
            }
            return;
        }
        if !self.bodies.bends(index) {
            self.bodies.get_mut(index).set_piece(SimTime::NEVER);
            return;
        }
        let state = self.bodies.get(index);
        if state.flight.is_none() || self.piece_ends(index, time) {
            let end = begin_piece(&mut self.bodies, index, time);
            self.bodies.get_mut(index).set_piece(end);
            self.work.piece();
        }
    }

    /// Whether the motion of a free body stands for its law until now, and no longer.
    pub(super) fn piece_ends(&self, index: BodyIx, time: SimTime) -> bool {
        self.bodies.get(index).piece() <= time
    }
}
