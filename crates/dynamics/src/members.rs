//! Members of the engine in [`crate::Mode::Hybrid`] and [`crate::Mode::Exact`]: their sub-steps, and which bodies join them.

use std::collections::BTreeSet;

use carom_math::{SimTime, Vec2};

use crate::stepping::Stepping;
use crate::stepping::rules::Rules;
use crate::store::clock::whole;
use crate::{BodyIx, BodyKind, Mode, World};

impl World {
    /// Before a sub-step: changes by a caller enter the engine, islands that are met wake, and bodies that may be met join.
    pub(crate) fn gather_members(&mut self, time: SimTime) {
        if self.bodies.member_count() == 0 {
            return;
        }
        let at_tick = self.resume(time);
        if at_tick {
            self.tell_members_touches(time);
            self.disperse(time);
        }
        let mut searches = self.find_contacts(time) || at_tick || !self.joins.restless.is_empty();
        let mut asks_all = at_tick;
        while searches {
            let near = self.outsiders_near(time, asks_all);
            (searches, asks_all) = (!near.is_empty(), false);
            for index in near {
                self.join(index, time);
            }
            if searches {
                self.find_contacts(time);
            }
        }
        self.stopwatch.lap(|p| &mut p.contacts);
    }

    /// The engine was left alone while no body was awake in it, and kinematic bodies went on; whether a tick begins.
    fn resume(&mut self, time: SimTime) -> bool {
        let Some(stepping) = &mut self.stepping else {
            return false;
        };
        let phase = self.clock.phase(self.settings.substeps_per_tick());
        let slept = stepping.engine.set_phase(phase);
        if slept || phase == 0 {
            let bodies = &mut self.bodies;
            self.joins.drivers.retain(|index| {
                bodies.is_alive(*index) && bodies.get(*index).kind == BodyKind::Kinematic
            });
            for &index in &self.joins.drivers {
                bodies.touch(index);
            }
        }
        self.joins.reached = time;
        phase == 0
    }

    /// Contacts of the sub-step that begins; whether some body came, or deviates from its predicted motion.
    fn find_contacts(&mut self, time: SimTime) -> bool {
        let deviates = self.with_engine(|world, stepping| {
            if !world.bodies.touched.is_empty() {
                world.enter_changed(stepping, time, time);
            }
            let deviates = world.search_contacts(stepping);
            world.tell_sleep(stepping, time);
            world.tell_impacts(stepping, time);
            deviates
        });
        if deviates.is_some() {
            self.take_woken(time);
        }
        deviates.unwrap_or(false)
    }

    /// Bodies that woke in the engine are its members, with all that slept in touch with them.
    pub(crate) fn take_woken(&mut self, time: SimTime) {
        for index in core::mem::take(&mut self.joins.woken) {
            if !self.bodies.is_alive(index) {
                continue;
            }
            if self.bodies.get(index).in_engine() {
                self.leave_pairs(index, time);
                continue;
            }
            for index in self.woken_with(index, time) {
                self.join(index, time);
            }
        }
    }

    /// Moves all members on by one sub-step.
    pub(crate) fn step_members(&mut self, time: SimTime) {
        if self.bodies.member_count() == 0 {
            self.joins.reached = self.clock.next();
            return;
        }
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        stepping.end_motions(&mut self.bodies, &self.clock);
        if !self.bodies.touched.is_empty() {
            self.enter_changed(&mut stepping, time, time);
            self.search_contacts(&mut stepping);
            self.tell_sleep(&mut stepping, time);
        }
        self.push_in_substep(&mut stepping, time);
        stepping.pull(&self.bodies);
        let forced = self.forced_members(&stepping);
        // `begin` was called: the clock is at the end of this sub-step.
        stepping
            .note_places(self.bodies.history.is_kept() || self.clock.is_within(self.unseen_until));
        self.substep_engine(&mut stepping);
        self.book_forces(&stepping, &forced);
        self.joins.reached = self.clock.next();
        self.joins.unwritten = true;
        stepping.lay_members(&mut self.bodies, self.clock.next());
        if self.bodies.history.is_kept() {
            stepping.write_all(&mut self.bodies, &self.clock);
        }
        self.stepping = Some(stepping);
        let woken = self.joins.woken.clone();
        self.take_woken(time);
        // They are where the engine has moved them.
        self.bodies.touched.retain(|index| !woken.contains(index));
    }

    /// Members that a caller changed in the midst of a sub-step pass through nothing in the rest of it: the engine goes on with those
    /// that it moved through the sub-step, and all others stand.
    pub(crate) fn carry_members(&mut self) {
        if self.bodies.member_count() == 0 || self.bodies.touched.is_empty() {
            return;
        }
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        let was_made = self.joins.reached == self.clock.next();
        let touched = core::mem::take(&mut self.bodies.touched);
        let is_carried = |index: &BodyIx| {
            let state = self.bodies.get(*index);
            was_made && stepping.id(*index).is_some() && (state.in_engine() || !state.is_dynamic())
        };
        let (carried, mut others) = touched.into_iter().partition(is_carried);
        self.bodies.touched = carried;
        self.enter_within(&mut stepping);
        self.stepping = Some(stepping);
        for &index in &others {
            let state = self.bodies.get(index);
            let goes = state.motion.velocity != Vec2::ZERO || state.motion.spin != 0.0;
            if self.bodies.is_alive(index) && state.in_engine() && goes {
                self.wait(index, self.clock.now);
            }
        }
        self.bodies.touched.append(&mut others);
        self.take_woken(self.clock.now);
    }

    /// Motions and touches of all members, where a caller may read them.
    pub(crate) fn write_members(&mut self, time: SimTime) {
        let unwritten = core::mem::take(&mut self.joins.unwritten);
        let is_within = self.clock.is_within(time);
        if !unwritten && (is_within || !self.joins.has_guests) {
            return;
        }
        self.with_engine(|world, stepping| {
            if unwritten {
                if !world.bodies.history.is_kept() && !is_within {
                    // No pose is read within the last sub-step.
                    stepping.note_places(false);
                }
                stepping.write_all(&mut world.bodies, &world.clock);
            } else {
                stepping.end_motions(&mut world.bodies, &world.clock);
            }
            if !is_within {
                world.tell_sleep(stepping, time);
                world.tell_impacts(stepping, time);
            }
            if unwritten {
                world.tell_touches(stepping, time);
            }
        });
    }

    /// Begins and ends of touch of members since this was last called.
    pub(crate) fn tell_members_touches(&mut self, time: SimTime) {
        self.with_engine(|world, stepping| world.tell_touches(stepping, time));
    }

    /// Places and turns of members that a caller's force acts on.
    fn forced_members(&self, stepping: &Stepping) -> Vec<(BodyIx, Vec2, f64)> {
        let mut members = self.all_forced();
        members.retain(|index| self.bodies.get(*index).in_engine());
        let place = |index: BodyIx| {
            let state = stepping.state(index)?;
            Some((index, state.pose.position, state.turned))
        };
        members.into_iter().filter_map(place).collect()
    }

    /// What the caller's forces did in the last sub-step.
    fn book_forces(&mut self, stepping: &Stepping, forced: &[(BodyIx, Vec2, f64)]) {
        for &(index, from, turned) in forced {
            if let Some(now) = stepping.state(index) {
                let state = self.bodies.get(index);
                let way = now.pose.position - from;
                let work = state.force().dot(way) + state.torque() * (now.turned - turned);
                self.joins.forced.add(work);
            }
        }
    }

    /// What kinematic bodies did in the last sub-step.
    pub(crate) fn book_drive(&mut self, stepping: &Stepping) {
        for &index in &self.joins.drivers {
            let work = stepping.id(index).map(|id| stepping.engine.work_of(id));
            if let Some(Ok(work)) = work {
                self.joins.driven.add(work);
            }
        }
    }

    /// Bodies outside that may meet members before the next tick, in order.
    fn outsiders_near(&mut self, time: SimTime, asks_all: bool) -> BTreeSet<BodyIx> {
        let rules = Rules {
            bodies: &self.bodies,
            broad: &self.broad,
        };
        let tick = self.clock.tick(self.settings.substeps_per_tick());
        let Some(stepping) = &mut self.stepping else {
            return BTreeSet::new();
        };
        self.joins
            .outsiders_near(stepping, rules, &self.unsettled, (time, tick), asks_all)
    }

    /// A free body with a new motion joins if it may meet a member before the next sub-step begins.
    pub(crate) fn meet_members(&mut self, index: BodyIx, time: SimTime) {
        // Most worlds of free bodies have no members, and the grid's instants are sums with care.
        if self.bodies.member_count() == 0 {
            return;
        }
        self.joins.restless.push(index);
        let left = self.clock.next() - time;
        let near = left > 0.0
            && self.bodies.get(index).is_free()
            && (self.meets_waiting(index, (time, left))
                || self.stepping.as_ref().is_some_and(|stepping| {
                    self.joins.reached == self.clock.next()
                        && stepping.nears_member(
                            self.rules(),
                            self.joins.reached,
                            index,
                            (time, left),
                        )
                }));
        if near {
            self.join(index, time);
        }
    }

    /// Kinematic bodies are known to the engine from its first member on.
    pub(crate) fn invite_drivers(&mut self) {
        if !core::mem::replace(&mut self.joins.has_guests, true) {
            for index in self.joins.drivers.clone() {
                if self.bodies.is_alive(index) {
                    self.show_engine(index);
                }
            }
        }
    }

    /// Has the engine know a body that rests or drives.
    pub(crate) fn show_engine(&mut self, index: BodyIx) {
        let state = self.bodies.get_mut(index);
        if state.kind == BodyKind::Kinematic {
            self.joins.drivers.insert(index);
        }
        if !self.joins.has_guests || state.in_engine() || !state.rests_or_drives() {
            return;
        }
        state.is_guest = true;
        self.bodies.touch(index);
    }

    /// Counts an impact that changed the motions of `bodies`, at the price of `lost`: bodies that strike each other too often join.
    pub(crate) fn rush(&mut self, bodies: &[BodyIx], lost: f64, time: SimTime) {
        if self.settings.mode != Mode::Hybrid || bodies.is_empty() {
            return;
        }
        let tick = whole(time, self.settings.tick);
        if self.joins.rush.is_before(tick) {
            self.end_rush(time);
        }
        let was_substepping = self.is_substepping();
        let at_once = self.joins.rush.count(bodies, lost, tick);
        if !was_substepping && self.joins.rush.is_due() {
            self.clock.catch_up(time);
        }
        if at_once {
            self.end_rush(time);
        }
    }

    /// Bodies that struck each other too often join the engine.
    pub(crate) fn end_rush(&mut self, time: SimTime) {
        if !self.joins.rush.is_due() {
            return;
        }
        for index in self.joins.rush.take_due() {
            if self.bodies.is_alive(index) {
                self.join(index, time);
            }
        }
        self.lower_free_boxes_later();
    }
}
