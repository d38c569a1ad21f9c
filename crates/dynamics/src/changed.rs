//! What follows from a changed motion: boxes, pairs, predictions, and sleepers that wake.

use carom_geometry::Aabb;
use carom_math::SimTime;

use crate::broad::tree::{Overlapping, part};
use crate::events::free::Cause;
use crate::model::graph::neighbours;
use crate::model::narrow::look;
use crate::store::bodies::Bodies;
use crate::store::pairs::Pair;
use crate::{BodyIx, ColliderIx, EventKind, Mode, PairIx, World};

impl World {
    /// A body with a new motion: its events are predicted again, and so are those of the contact group that it was or is in.
    pub(crate) fn deflected(&mut self, index: BodyIx, time: SimTime) {
        if self.settings.mode == Mode::Stepped {
            // The next sub-step takes it from here.
            return self.bodies.touch(index);
        }
        self.hand_back_of(index, time);
        self.redirect(index, time);
        self.regroup(index, time);
    }

    /// A body with a new motion: its events are predicted anew, or it has another box.
    pub(crate) fn redirect(&mut self, index: BodyIx, time: SimTime) {
        if self.bodies.get(index).is_asleep() {
            self.wake(index, time);
        }
        let state = self.bodies.get(index);
        if state.in_engine() {
            return;
        }
        if state.goes_by_events() {
            return self.foresee(index, time, Cause::Arrived, None);
        }
        let left = (self.clock.next() - time).max(0.0);
        self.refit(index, time, left, true);
        // What rests from now on may lie in the way of what flies.
        if !self.bodies.get(index).is_stepped() {
            self.show(index, time);
        }
    }

    /// Predicts impacts of all free bodies near a body that rests with it.
    pub(crate) fn show(&mut self, index: BodyIx, time: SimTime) {
        let mut free = Vec::new();
        for &at in &self.bodies.get(index).colliders.clone() {
            let bounds = self.bodies.colliders[at].fat;
            self.free.overlapping(&self.bodies, bounds, &mut free);
            for &body in &free {
                self.approach_shape(body, at, time, Cause::Arrived);
            }
            // Those in the tree are few and large.
            for other in self.broad.in_tree(&self.bodies, bounds) {
                let owner = self.bodies.colliders[other].body;
                if self.bodies.get(owner).goes_by_events() {
                    self.approach_shape(owner, at, time, Cause::Arrived);
                }
            }
        }
    }

    /// What lies beside a body that started asleep must be known before either is struck.
    pub(crate) fn look_at_fresh(&mut self, time: SimTime) {
        for place in core::mem::take(&mut self.pairs.fresh) {
            let Some(pair) = self.pairs.find(place).filter(|pair| pair.fresh) else {
                continue;
            };
            let (a, b) = pair.bodies;
            if self.bodies.get(a).is_stepped() || self.bodies.get(b).is_stepped() {
                continue;
            }
            let pair = self.pairs.get_mut(place);
            pair.fresh = false;
            look(&self.bodies, pair, time);
        }
    }

    /// Wakes a body and all sleepers that it touches, and so on.
    pub(crate) fn wake(&mut self, index: BodyIx, time: SimTime) {
        let woken = self.woken_with(index, time);
        self.resume_woken(&woken, time);
    }

    /// Ends the sleep of a body and all sleepers that it touches, and so on; returns them.
    pub(crate) fn woken_with(&mut self, index: BodyIx, time: SimTime) -> Vec<BodyIx> {
        if self.is_engines(index) {
            self.wake_in_engine(index, time);
            return Vec::new();
        }
        self.look_at_fresh(time);
        self.wake_all(vec![index], time)
    }

    /// Ends the sleep of bodies, the last one first, and of all sleepers that they touch, and so on: those that the engine has it
    /// wakes, all others are returned.
    fn wake_all(&mut self, mut waking: Vec<BodyIx>, time: SimTime) -> Vec<BodyIx> {
        let (mut members, mut others) = (Vec::new(), Vec::new());
        while let Some(index) = waking.pop() {
            let state = self.bodies.get(index);
            if !state.is_asleep() {
                continue;
            }
            if state.in_engine() {
                members.push(index);
                continue;
            }
            others.push(index);
            let id = state.id;
            if self.bodies.wake(index) {
                self.events.push(time, EventKind::Awake(id));
            }
            waking.extend(neighbours(&self.bodies, &self.pairs, index));
        }
        for index in members {
            self.wake_in_engine(index, time);
        }
        others
    }

    /// Wakes all sleepers that touch a body, and itself: what held them has changed.
    pub(crate) fn wake_around(&mut self, index: BodyIx, time: SimTime) {
        if self.is_engines(index) {
            return self.wake_in_engine(index, time);
        }
        self.hand_back_of(index, time);
        for slot in 0..self.bodies.get(index).pairs.len() {
            let pair = self.pairs.get(self.bodies.get(index).pairs[slot]);
            self.hand_back_of(pair.other(index), time);
        }
        self.look_at_fresh(time);
        let mut waking: Vec<BodyIx> = neighbours(&self.bodies, &self.pairs, index).collect();
        waking.reverse();
        waking.push(index);
        let woken = self.wake_all(waking, time);
        self.resume_woken(&woken, time);
    }

    /// Bodies that woke get their method anew; their pairs with the free bodies near them are made.
    pub(crate) fn resume_woken(&mut self, woken: &[BodyIx], time: SimTime) {
        if self.settings.mode == Mode::Stepped {
            return;
        }
        let mut were_analytic = false;
        for &index in woken {
            let membership = self.bodies.get(index).membership;
            were_analytic |= membership.is_closed();
            self.dissolve(membership.group, time);
        }
        if !were_analytic && self.many_woke(woken, time) {
            return;
        }
        for &index in woken {
            self.unsettle(index, time);
        }
        for &index in woken {
            self.meet_near(index);
        }
        self.drop_unheld(woken, time);
    }

    /// Makes the pairs of a body's boxes in the tree with what is near them, free bodies too.
    pub(crate) fn meet_near(&mut self, index: BodyIx) {
        let free = |bodies: &Bodies, bounds: Aabb, near: &mut Vec<BodyIx>| {
            self.free.overlapping(bodies, bounds, near);
        };
        for slot in 0..self.bodies.get(index).colliders.len() {
            let at = self.bodies.get(index).colliders[slot];
            if self.bodies.colliders[at].node.is_some() {
                self.broad
                    .meet(&mut self.bodies, &mut self.pairs, at, Some(&free));
            }
        }
    }

    /// Pairs of a free body with shapes of bodies that wait for their method.
    pub(crate) fn pair_free_body(&mut self, index: BodyIx, shapes: &[ColliderIx]) {
        for slot in 0..self.bodies.get(index).colliders.len() {
            let mine = self.bodies.get(index).colliders[slot];
            self.broad
                .pair_with(&mut self.bodies, &mut self.pairs, mine, shapes);
        }
    }

    /// Brings the boxes of a body up to date for the next `h` seconds; `meets`: free bodies in the new ones are found.
    pub(crate) fn refit(&mut self, index: BodyIx, time: SimTime, h: f64, meets: bool) {
        let free = |bodies: &Bodies, bounds: Aabb, near: &mut Vec<BodyIx>| {
            self.free.overlapping(bodies, bounds, near);
        };
        let free: &Overlapping<'_> = &free;
        self.broad.refit(
            &mut self.bodies,
            &mut self.pairs,
            index,
            time,
            h,
            meets.then_some(free),
        );
        self.look_down_first(time);
    }

    /// Takes a pair out and says so if it touched.
    pub(crate) fn part(&mut self, place: PairIx, time: SimTime) {
        if let Some(mut pair) = self.take_pair(place, time) {
            pair.touching = false;
            self.events.tell_touch(&self.bodies, &mut pair, time);
        }
    }

    /// Takes a pair out; a group that it held together is taken apart.
    pub(crate) fn take_pair(&mut self, place: PairIx, time: SimTime) -> Option<Pair> {
        self.hand_back_by(place, time);
        let pair = part(&mut self.bodies, &mut self.pairs, place)?;
        self.loosen(place, pair.bodies, time);
        Some(pair)
    }
}
