//! Free bodies that land, and held ones that take off.

use carom_math::SimTime;

use super::{Cause, Foreseen};
use crate::events::resolve::{BUDGET, PairImpact};
use crate::model::graph::pair_of;
use crate::model::narrow::{NOISE, SUNK, TOUCH, look, opening_speed, pace};
use crate::motion::flight::fly;
use crate::store::pairs::PairContact;
use crate::{BodyIx, BodyKind, Mode, PairIx, Two, World};

/// Landings of two bodies on each other at one instant.
const LANDINGS: u32 = 16;

impl World {
    /// What is pressed together and does not bounce stays in contact from now on. What takes off and lands again at one instant, where
    /// a search and the contacts that a look finds do not agree, is the engine's.
    pub(super) fn begins_to_last(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        let (last, when, count) = self.free.lasting;
        let count = if last == (a, b) && when == time {
            count + 1
        } else {
            1
        };
        self.free.lasting = ((a, b), time, count);
        if count > LANDINGS {
            self.report.unresolved += 1;
            self.join(a, time);
            return self.join(b, time);
        }
        self.land_both((a, b), time);
    }

    /// Impacts that outrun their budget have come to their limit: a common stop of all that touches, at this instant.
    pub(super) fn collapse(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        self.land_both((a, b), time);
        let Some(place) = self.pair_of(impact) else {
            let (one, two) = (self.bodies.get(a), self.bodies.get(b));
            let speed = opening_speed(one, two, time, impact.points[0], impact.normal);
            self.report_collapse((a, b), 0.5 * speed * speed, time);
            self.report.collapsed += 1;
            return;
        };
        let pair = self.pairs.get_mut(place);
        // Its budget in the sub-step is used up by this one.
        pair.begin_budget(time, self.clock.h);
        (pair.impacts, pair.spent) = (1, BUDGET);
        self.strike_held(impact, time);
    }

    /// An impact on a body that a contact island held until now: with all that holds it. What strikes a member of the engine waits at
    /// its surface for the next sub-step.
    pub(super) fn strike_held(&mut self, impact: &Foreseen, time: SimTime) {
        let (a, b) = impact.bodies;
        let mut woke = false;
        for index in [a, b] {
            if self.bodies.get(index).is_asleep() {
                self.wake(index, time);
                woke = true;
            }
            self.hand_back_of(index, time);
        }
        let is_stepped = |index: BodyIx| self.bodies.get(index).is_stepped();
        if woke && !is_stepped(a) && !is_stepped(b) {
            // Nothing held it.
            return self.strike_free_body(impact, time);
        }
        if [a, b]
            .iter()
            .any(|index| self.bodies.get(*index).in_engine())
        {
            self.join(a, time);
            return self.join(b, time);
        }
        let (first, second) = impact.colliders;
        self.broad
            .pair_with(&mut self.bodies, &mut self.pairs, first, &[second]);
        let Some(place) = self.pair_of(impact) else {
            return;
        };
        let normal = if self.pairs.get(place).colliders == impact.colliders {
            impact.normal
        } else {
            -impact.normal
        };
        self.strike_pair(&PairImpact {
            time,
            pair: place,
            normal,
            points: impact.points.clone(),
        });
    }

    fn pair_of(&self, impact: &Foreseen) -> Option<PairIx> {
        pair_of(&self.bodies, &self.pairs, impact.bodies.0, impact.colliders)
    }

    /// Something holds this body from now on, or is too near to tell: it gets its method before time goes on. Whether it moved by
    /// events.
    pub(crate) fn land(&mut self, index: BodyIx, time: SimTime) -> bool {
        let lands = self.leave_flight(index, time);
        if lands {
            self.redirect(index, time);
            self.gain_contact(index, time);
        }
        lands
    }

    pub(super) fn land_both(&mut self, (a, b): Two<BodyIx>, time: SimTime) {
        self.land(a, time);
        self.land(b, time);
    }

    /// As [`Self::land`], of a body that is about to be solved for with the island that it touches.
    pub(crate) fn land_first(&mut self, index: BodyIx, time: SimTime) {
        if self.leave_flight(index, time) {
            self.redirect(index, time);
            self.part_far(index, time);
        }
    }

    /// Forgets the pairs of a body that its boxes have left: a free body's reach farther.
    fn part_far(&mut self, index: BodyIx, time: SimTime) {
        let keeps = |place: &PairIx| {
            self.broad
                .keeps(&self.bodies, self.pairs.get(*place).colliders)
        };
        let pairs = self.bodies.get(index).pairs.iter();
        let far: Vec<PairIx> = pairs.filter(|place| !keeps(place)).copied().collect();
        for place in far {
            self.part(place, time);
        }
    }

    /// A free body leaves flight; whether it was free.
    fn leave_flight(&mut self, index: BodyIx, time: SimTime) -> bool {
        if self.hand_back_of(index, time) {
            return true;
        }
        let state = self.bodies.get_mut(index);
        if state.kind != BodyKind::Dynamic || !state.goes_by_events() {
            return false;
        }
        state.land();
        // Events predicted for a free body are stale.
        self.bodies.renew(index);
        self.free.vanish(&mut self.bodies, index);
        self.unsettle(index, time);
        // What was too large for the grid keeps its box, and has met no pairs with it.
        self.meet_near(index);
        true
    }

    /// A body that nothing holds any more flies from event to event.
    pub(crate) fn take_off(&mut self, index: BodyIx, time: SimTime) {
        self.solve_modes_anew(index, time, Some(index));
        self.end_unsettled(index);
        for place in self.bodies.get(index).pairs.clone() {
            let other = self.pairs.get(place).other(index);
            if !self.bodies.get(other).is_held() {
                self.part(place, time);
            }
        }
        let bends = self.bodies.bends(index);
        let state = self.bodies.get_mut(index);
        state.take_off();
        state.set_piece(if bends { time } else { SimTime::NEVER });
        self.bodies.renew(index);
        self.joins.note_flight(&self.bodies, index);
        self.foresee(index, time, Cause::Deflected, None);
    }

    /// Bodies that woke, lost their support, or have another velocity fly at once if nothing holds them.
    pub(crate) fn drop_unheld(&mut self, bodies: &[BodyIx], time: SimTime) {
        for &index in bodies {
            if !self.hangs(index, time) {
                continue;
            }
            fly(&mut self.bodies, index, time);
            self.take_off(index, time);
        }
    }

    /// Whether a body has no method yet, nothing that does not fly holds it, and nothing overlaps it.
    fn hangs(&mut self, index: BodyIx, time: SimTime) -> bool {
        let state = self.bodies.get(index);
        let stepped = self.settings.mode == Mode::Stepped;
        if stepped || !state.is_unsolved() {
            return false;
        }
        for k in 0..self.bodies.get(index).pairs.len() {
            let place = self.bodies.get(index).pairs[k];
            let pair = self.pairs.get_mut(place);
            let flies = self.bodies.get(pair.other(index)).is_free();
            if pair.fresh {
                look(&self.bodies, pair, time);
            }
            let (a, b) = self.bodies.both(pair.bodies);
            let (rounding, size) = (NOISE * pace(a, b, time), a.reach.min(b.reach));
            // Impacts with what flies are those of a free body.
            let holds = |contact: &PairContact| {
                let mut points = contact.points.iter();
                points.any(|point| {
                    point.separation < -SUNK * size
                        || !flies
                            && point.separation <= TOUCH * size
                            && opening_speed(a, b, time, point.position, contact.normal) <= rounding
                })
            };
            if pair.contacts.iter().any(holds) {
                return false;
            }
        }
        true
    }

    /// A body gets its method before time goes on.
    pub(crate) fn unsettle(&mut self, index: BodyIx, time: SimTime) {
        // A group that is taken apart may have met a member, and joined.
        if self.bodies.get(index).in_engine() {
            return;
        }
        if !self.is_substepping() {
            self.clock.catch_up(time);
        }
        self.raise_free();
        self.unsettled.insert(index);
    }

    /// Bodies look for free bodies by boxes in the world from now on.
    pub(crate) fn raise_free(&mut self) {
        if !self.free.is_raised() {
            self.free.raise(&self.bodies);
        }
        self.lower_free_boxes_later();
    }

    /// A body has its method.
    pub(crate) fn end_unsettled(&mut self, index: BodyIx) {
        if self.unsettled.remove(&index) {
            self.lower_free_boxes_later();
        }
    }

    /// If no body waits for its method, free bodies need no boxes in the world: after a tick, since an analytic
    /// island that changes its mode lands and is let go of at one instant.
    pub(crate) fn lower_free_boxes_later(&mut self) {
        if self.unsettled.is_empty() {
            self.free.raised_until = self.clock.next() + self.settings.tick;
        }
    }

    /// Takes the boxes of free bodies from the world once no search has needed them for a tick.
    pub(crate) fn lower_idle(&mut self, time: SimTime) {
        if self.free.is_raised() && self.unsettled.is_empty() && self.free.raised_until <= time {
            self.free.lower();
        }
    }
}
