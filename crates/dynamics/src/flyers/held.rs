//! Bodies that begin to be held, or cease to: they land, and take off.

use carom_math::SimTime;

use super::{Cause, Foreseen};
use crate::flight::fly;
use crate::narrow::{NOISE, opening_speed, pace};
use crate::pairs::PairContact;
use crate::{BodyKind, Mode, World};

impl World {
    /// What is pressed together and does not bounce stays in contact from now on.
    pub(super) fn begins_to_last(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        self.land(a, time);
        self.land(b, time);
        let found = self
            .bodies
            .get(a)
            .pairs
            .iter()
            .copied()
            .find(|&place| self.pairs.get(place).colliders == impact.colliders);
        if let Some(place) = found {
            let pair = self.pairs.get_mut(place);
            (pair.lasting, pair.touching) = (true, true);
            self.events.tell_touch(&self.bodies, pair, time);
            self.predict(place, time);
            self.regroup(impact.bodies.0, time);
            self.regroup(impact.bodies.1, time);
        }
    }

    /// From now on the sub-steps move this body: something holds it, or is too near to tell.
    pub(crate) fn land(&mut self, index: u32, time: SimTime) {
        if self.alight(index, time) {
            self.deflected(index, time);
        }
    }

    /// As [`Self::land`], at the start of a sub-step, which predicts all pairs when it is over, and judges the groups
    /// that it touches once all have landed.
    pub(crate) fn land_first(&mut self, index: u32, time: SimTime) {
        if self.alight(index, time) {
            self.steer(index, time);
            self.part_far(index, time);
        }
    }

    /// Forgets the pairs of a body that its boxes have left: a flyer's reach farther than those of a sub-step.
    fn part_far(&mut self, index: u32, time: SimTime) {
        let keeps = |place: &u32| self.broad.keeps(&self.colliders, self.pairs.shapes(*place));
        let pairs = self.bodies.get(index).pairs.iter();
        let far: Vec<u32> = pairs.filter(|place| !keeps(place)).copied().collect();
        for place in far {
            self.part(place, time);
        }
    }

    /// Puts a flyer among those that are sub-stepped; whether it was one.
    fn alight(&mut self, index: u32, time: SimTime) -> bool {
        if self.hand_back_of(index, time) {
            return true;
        }
        let state = self.bodies.get_mut(index);
        if state.kind != BodyKind::Dynamic || !state.course.flies {
            return false;
        }
        state.course.land();
        state.idle = 0;
        // What was foreseen for a flyer is stale.
        self.bodies.renew(index);
        self.flyers.vanish(&mut self.bodies, index);
        self.enlist(index, time);
        // What was too large for the grid keeps its box, and has met no pairs with it.
        self.meet_near(index);
        true
    }

    /// A body that nothing holds any more flies from event to event.
    pub(crate) fn take_off(&mut self, index: u32, time: SimTime) {
        self.leave_group(index, time);
        self.discharge(index);
        for place in self.bodies.get(index).pairs.clone() {
            let other = self.pairs.get(place).other(index);
            if !self.bodies.get(other).is_held() {
                self.part(place, time);
            }
        }
        let bends = self.bodies.bends(index);
        let state = self.bodies.get_mut(index);
        state.course.flies = true;
        // What a sub-step gave it is no piece of its own.
        state.set_piece(if bends { time } else { SimTime::NEVER });
        self.bodies.renew(index);
        self.note_flight(index);
        self.foresee(index, time, Cause::Deflected, None);
    }

    /// Bodies that woke, lost their support, or have another velocity fly at once if nothing holds them: until the next sub-step
    /// begins they would hang in the air, or rise without weight.
    pub(crate) fn drop_unheld(&mut self, bodies: &[u32], time: SimTime) {
        for &index in bodies {
            if !self.hangs(index, time) {
                continue;
            }
            if !self.bodies.bends(index) {
                fly(&mut self.bodies, index, time, self.clock.h);
            }
            self.take_off(index, time);
        }
    }

    /// Whether a body is sub-stepped with nothing near that does not fly.
    fn hangs(&mut self, index: u32, time: SimTime) -> bool {
        let state = self.bodies.get(index);
        let stepped = self.settings.mode == Mode::Stepped;
        if stepped || !state.is_held() || state.membership.is_closed() {
            return false;
        }
        for k in 0..self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[k];
            let pair = self.pairs.get_mut(place);
            if self.bodies.get(pair.other(index)).is_flying() {
                // What strikes it strikes a flyer.
                continue;
            }
            if pair.fresh {
                self.narrow
                    .look(&self.bodies, &self.colliders, pair, time, self.clock.h);
            }
            let (a, b) = (
                self.bodies.get(pair.bodies.0),
                self.bodies.get(pair.bodies.1),
            );
            let rounding = NOISE * pace(a, b, time);
            let holds = |contact: &PairContact| {
                let mut points = contact.points.iter();
                points.any(|point| {
                    opening_speed(a, b, time, point.position, contact.normal) <= rounding
                })
            };
            if pair.contacts.iter().any(holds) {
                return false;
            }
        }
        true
    }

    /// Whether an impact is one on members of groups, which land then: they are struck with all that holds them.
    pub(super) fn strikes_gliders(&mut self, impact: &Foreseen, time: SimTime) -> bool {
        let ends = [impact.bodies.0, impact.bodies.1];
        let glides = |index: u32| self.bodies.get(index).course.glides;
        if !ends.iter().any(|index| glides(*index)) {
            return false;
        }
        let before = ends.map(|index| self.bodies.get(index).in_impact(time));
        let strikes = self.approaches(impact, &before);
        if strikes {
            for index in ends {
                self.hand_back_of(index, time);
            }
        }
        strikes
    }

    /// Adds a body to those that are sub-stepped.
    pub(crate) fn enlist(&mut self, index: u32, time: SimTime) {
        // A group that is taken apart may have met a member, and joined.
        if self.bodies.get(index).in_engine {
            return;
        }
        if !self.is_substepping() {
            self.clock.catch_up(time);
        }
        if !self.flyers.is_raised() {
            // Bodies look for flyers by boxes in the world from now on.
            self.narrow(time);
            self.flyers.raise(&self.bodies);
        }
        if let Err(at) = self.stepped.binary_search(&index) {
            self.stepped.insert(at, index);
            self.pairs.reorder();
        }
    }

    /// Takes a body from those that are sub-stepped.
    pub(crate) fn discharge(&mut self, index: u32) {
        if let Ok(at) = self.stepped.binary_search(&index) {
            self.stepped.remove(at);
            self.pairs.reorder();
            self.lower_flyers_later();
        }
    }

    /// Takes bodies from those that are sub-stepped, which are given in order; [`Self::lower_flyers_later`] is for the caller.
    pub(crate) fn discharge_all(&mut self, gone: &[u32]) {
        self.stepped
            .retain(|index| gone.binary_search(index).is_err());
        self.pairs.reorder();
    }

    /// If no body is sub-stepped pair by pair any more, flyers need no boxes in the world: after a tick, since an analytic
    /// island that changes its mode lands and is let go of at one instant.
    pub(crate) fn lower_flyers_later(&mut self) {
        if self.stepped.is_empty() {
            self.flyers.raised_until = self.clock.next() + self.settings.tick;
        }
    }

    /// Takes the boxes of flyers from the world once no search has needed them for a tick.
    pub(crate) fn lower_idle(&mut self, time: SimTime) {
        if self.flyers.is_raised() && self.stepped.is_empty() && self.flyers.raised_until <= time {
            self.flyers.lower();
        }
    }
}
