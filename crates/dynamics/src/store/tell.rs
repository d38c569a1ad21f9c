//! What is told of pairs: begins and ends of touch, and contact modes, each once.

use carom_math::SimTime;

use super::bodies::Bodies;
use super::pairs::{Pair, Shapes};
use crate::{ContactMode, EventKind, Events};

impl Events {
    /// Tells that a pair began or ceased to touch, if that is new: so begins and ends of a pair come in turns.
    pub(crate) fn tell_touch(&mut self, bodies: &Bodies, pair: &mut Pair, time: SimTime) {
        if pair.touching == pair.told {
            return;
        }
        pair.told = pair.touching;
        // Torn off, or left at the very end of a path, it opened without a mode solve; and what lands again begins a mode anew.
        if !pair.touching && pair.mode.is_some() {
            self.tell_mode(bodies, pair, ContactMode::Open, time);
        }
        self.push_touch(bodies, pair.shapes(), pair.touching, time);
    }

    /// Tells how a contact in closed form moves from now on, if that is new.
    pub(crate) fn tell_mode(
        &mut self,
        bodies: &Bodies,
        pair: &mut Pair,
        mode: ContactMode,
        time: SimTime,
    ) {
        if pair.mode != Some(mode) {
            pair.mode = Some(mode);
            let (a, b) = (bodies.get(pair.bodies.0).id, bodies.get(pair.bodies.1).id);
            self.push(time, EventKind::Mode { a, b, mode });
        }
    }

    /// Tells that two shapes began or ceased to touch.
    pub(crate) fn push_touch(
        &mut self,
        bodies: &Bodies,
        shapes: Shapes,
        begins: bool,
        time: SimTime,
    ) {
        let [one, other] = shapes.map(|(index, _)| bodies.get(index));
        let (a, b) = (one.id, other.id);
        let shapes = (one.shape_of(shapes[0].1), other.shape_of(shapes[1].1));
        let kind = if begins {
            EventKind::Begin { a, b, shapes }
        } else {
            EventKind::End { a, b, shapes }
        };
        self.push(time, kind);
    }
}
