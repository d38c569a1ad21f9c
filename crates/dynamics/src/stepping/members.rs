//! A sub-step of the members of the engine in [`crate::Mode::Hybrid`] and [`crate::Mode::Exact`].

use carom_math::{SimTime, Vec2};

use super::Stepping;
use crate::{BodyKind, World};

impl World {
    /// Before a sub-step: changes by a caller enter the engine, islands that are met wake, and bodies that may be met join.
    pub(crate) fn gather_members(&mut self, time: SimTime) {
        if self.bodies.member_count() == 0 {
            return;
        }
        let at_tick = self.resume(time);
        if at_tick {
            self.tell_touches(time);
            self.disperse(time);
            self.stopwatch.lap(|p| &mut p.sleep);
        }
        let mut searches = self.find_contacts(time) || at_tick || self.joins.is_restless();
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
        self.pairs.sort(&self.bodies, &self.stepped);
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
            let mut drivers = core::mem::take(&mut self.joins.drivers);
            let bodies = &self.bodies;
            drivers.retain(|index| {
                bodies.is_alive(*index) && bodies.get(*index).kind == BodyKind::Kinematic
            });
            for &index in &drivers {
                self.bodies.touch(index);
            }
            self.joins.drivers = drivers;
        }
        self.joins.reached = time;
        phase == 0
    }

    /// Contacts of the sub-step that begins; whether some body came, or deviates from its predicted motion.
    fn find_contacts(&mut self, time: SimTime) -> bool {
        let Some(mut stepping) = self.stepping.take() else {
            return false;
        };
        if !self.bodies.touched.is_empty() {
            self.enter_changed(&mut stepping, time, time);
        }
        let deviates = self.search_contacts(&mut stepping);
        self.tell_sleep(&mut stepping, time);
        self.tell_impacts(&mut stepping, time);
        self.stepping = Some(stepping);
        self.take_woken(time);
        deviates
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
            return;
        }
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        self.end_motions(&mut stepping);
        if !self.bodies.touched.is_empty() {
            self.enter_changed(&mut stepping, time, time);
            self.search_contacts(&mut stepping);
            self.tell_sleep(&mut stepping, time);
        }
        self.pull_members(&mut stepping);
        let forced = self.forced_members(&stepping);
        // `begin` was called: the clock is at the end of this sub-step.
        stepping.note_places(self.settings.history > 0 || self.clock.is_within(self.unseen_until));
        self.substep_engine(&mut stepping);
        self.book_work(&stepping, &forced);
        self.joins.reached = self.clock.next();
        self.joins.unwritten = true;
        self.lay_members(&mut stepping);
        if self.settings.history > 0 {
            self.write_all(&stepping);
        }
        self.stepping = Some(stepping);
        let woken = self.joins.woken.clone();
        self.take_woken(time);
        // They are where the engine has moved them.
        self.bodies.touched.retain(|index| !woken.contains(index));
    }

    /// Members that a caller changed in the midst of a sub-step pass through nothing in the rest of it.
    pub(crate) fn carry_members(&mut self) {
        if self.bodies.member_count() > 0
            && self.joins.reached == self.clock.next()
            && let Some(mut stepping) = self.stepping.take()
        {
            // Bodies that joined since, or woke elsewhere, wait for the next sub-step.
            let is_carried = |index: &u32| {
                let state = self.bodies.get(*index);
                stepping.id(*index).is_some() && (state.in_engine() || !state.is_dynamic())
            };
            let touched = self.bodies.touched.clone();
            let (carried, mut others) = touched.into_iter().partition(is_carried);
            self.bodies.touched = carried;
            self.enter_within(&mut stepping);
            self.bodies.touched.append(&mut others);
            self.stepping = Some(stepping);
            self.take_woken(self.clock.now);
        }
    }

    /// Motions and touches of all members, where a caller may read them.
    pub(crate) fn write_members(&mut self, time: SimTime) {
        if core::mem::take(&mut self.joins.unwritten)
            && let Some(mut stepping) = self.stepping.take()
        {
            if self.settings.history == 0 && !self.clock.is_within(time) {
                // No pose is read within the last sub-step.
                stepping.note_places(false);
            }
            self.write_all(&stepping);
            if !self.clock.is_within(time) {
                self.tell_sleep(&mut stepping, time);
                self.tell_impacts(&mut stepping, time);
            }
            self.stepping = Some(stepping);
            self.tell_touches(time);
        } else if self.joins.has_guests
            && !self.clock.is_within(time)
            && let Some(mut stepping) = self.stepping.take()
        {
            self.end_motions(&mut stepping);
            self.tell_sleep(&mut stepping, time);
            self.tell_impacts(&mut stepping, time);
            self.stepping = Some(stepping);
        }
    }

    pub(super) fn tell_touches(&mut self, time: SimTime) {
        if let Some(mut stepping) = self.stepping.take() {
            self.tell_changed_touches(&mut stepping, time);
            self.stepping = Some(stepping);
        }
    }

    /// Places and turns of members that a caller's force acts on.
    fn forced_members(&self, stepping: &Stepping) -> Vec<(u32, Vec2, f64)> {
        let members = self
            .forced
            .iter()
            .filter(|index| self.bodies.get(**index).in_engine());
        members
            .filter_map(|index| {
                let state = stepping.state(*index)?;
                Some((*index, state.pose.position, state.turned))
            })
            .collect()
    }

    /// What the caller's forces and kinematic bodies did in the last sub-step.
    fn book_work(&mut self, stepping: &Stepping, forced: &[(u32, Vec2, f64)]) {
        for &(index, from, turned) in forced {
            if let Some(now) = stepping.state(index) {
                let state = self.bodies.get(index);
                let way = now.pose.position - from;
                let work = state.force().dot(way) + state.torque() * (now.turned - turned);
                self.joins.forced.add(work);
            }
        }
        for &index in &self.joins.drivers {
            let work = stepping.id(index).map(|id| stepping.engine.work_of(id));
            if let Some(Ok(work)) = work {
                self.joins.driven.add(work);
            }
        }
    }
}
