//! A sub-step of the crowds of [`crate::Mode::Hybrid`].

use carom_math::{SimTime, Vec2};

use crate::broad::swept_box;
use crate::{BodyKind, World};

impl World {
    /// Moves all members on by one sub-step.
    pub(crate) fn step_crowds(&mut self, time: SimTime, h: f64) {
        self.take_crowd_changes(time);
        if self.pool.crowd.members == 0 {
            return;
        }
        self.drive(time);
        let look = self.pool.until_look == 0;
        if look {
            self.tell_touches(time);
            if let Some(sleep) = self.settings.sleep {
                self.rest(sleep, time);
            }
            self.disperse(time);
            self.stopwatch.lap(|p| &mut p.sleep);
        }
        if look {
            let newcomers = &mut self.pool.crowd.newcomers;
            self.pool.moved.append(newcomers);
            self.box_drivers(time);
            self.pool.seats.zone();
            self.pool.until_look = self.settings.substeps_per_tick();
            self.look_around(time);
            self.scout(time);
        } else if self.is_restless() {
            self.look_between(time);
        }
        // A look may wake sleepers, and those who join find others.
        loop {
            self.admit_fringe(time, h);
            if self.pool.crowd.newcomers.is_empty() {
                break;
            }
            self.welcome(time);
        }
        self.stopwatch.lap(|p| &mut p.contacts);
        self.pool.until_look -= 1;
        let before: Vec<(u32, Vec2, f64)> = self.forced_lines().collect();
        // Lines move the members from here on: who fell asleep and woke at this look has one that is newer than its motion.
        self.bodies.touched.clear();
        self.substep();
        self.book_drivers();
        self.book_belts();
        for (index, d, turn) in before {
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            let (line, state) = (
                &self.pool.seats.rig.lines[slot as usize],
                self.bodies.get(index),
            );
            let work = state.force().dot(line.d() - d) + state.torque() * (line.turn() - turn);
            self.pool.crowd.forced.add(work);
        }
        self.pool.crowd.unwritten = true;
        if self.settings.history > 0 {
            self.write_crowds();
        }
    }

    /// Motions of all members, where somebody may ask for them.
    pub(crate) fn write_crowds(&mut self) {
        if core::mem::take(&mut self.pool.crowd.unwritten) {
            // Who joins in the midst of a sub-step has another motion from then on, whether a step ends before or after it.
            let mut newcomers = self.pool.crowd.newcomers.clone();
            newcomers.sort_unstable();
            self.write_motions(&newcomers);
        }
    }

    /// The motions of a pair's members, for who looks at it in the midst of a sub-step.
    pub(crate) fn write_members_of(&mut self, place: u32) {
        if !self.pool.crowd.unwritten {
            return;
        }
        let (a, b) = self.pairs.get(place).bodies;
        for index in [a, b] {
            let is_new = self.pool.crowd.newcomers.contains(&index);
            if let Some(slot) = self.pool.seats.slot(index)
                && self.bodies.get(index).in_crowd
                && !is_new
            {
                self.write_motion(slot, self.clock.last());
            }
        }
    }

    /// Takes over what a caller changed since the last sub-step.
    fn take_crowd_changes(&mut self, time: SimTime) {
        let mut touched = core::mem::take(&mut self.bodies.touched);
        touched.sort_unstable();
        touched.dedup();
        for index in touched.drain(..) {
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            let state = self.bodies.get(index);
            let belongs = state.in_crowd || !state.is_dynamic();
            if !(belongs && self.bodies.is_alive(index) && self.pool.seats.fits(slot, state)) {
                self.leave(index, slot);
                continue;
            }
            let pull = super::seats::pull_of(&self.bodies, state, state.motion.centre_at(time));
            self.pool.seats.follow(slot, state, time);
            self.pool.seats.rig.set_pull(slot, pull);
            self.pool.moved.push(index);
            self.pool.until_look = 0;
        }
        self.bodies.touched = touched;
        self.pool.seats.close_up();
    }

    /// Kinematic bodies move as they do, whatever their lines say.
    fn drive(&mut self, time: SimTime) {
        let mut drivers = core::mem::take(&mut self.pool.crowd.drivers);
        drivers.retain(|&index| {
            let Some(slot) = self.pool.seats.slot(index) else {
                return false;
            };
            let state = self.bodies.get(index);
            let drives = state.kind == BodyKind::Kinematic;
            if drives {
                self.pool.seats.follow(slot, state, time);
            }
            drives
        });
        self.pool.crowd.drivers = drivers;
    }

    /// Boxes of kinematic bodies for two ticks, and the members in them.
    fn box_drivers(&mut self, time: SimTime) {
        let tick = self.settings.tick;
        for k in 0..self.pool.crowd.drivers.len() {
            let index = self.pool.crowd.drivers[k];
            for slot in 0..self.bodies.get(index).colliders.len() {
                let state = self.bodies.get(index);
                let at = state.colliders[slot];
                let collider = &self.colliders[at as usize];
                let ahead = |ticks: f64| swept_box(collider, &state.motion, time, ticks * tick);
                if collider
                    .tight
                    .as_ref()
                    .is_some_and(|tight| tight.contains(ahead(1.0)))
                {
                    continue;
                }
                let tight = ahead(2.0);
                self.colliders[at as usize].tight = Some(Box::new(tight));
                for other in self.broad.in_tree(&self.colliders, tight) {
                    if self
                        .bodies
                        .get(self.colliders[other as usize].body)
                        .in_crowd
                    {
                        self.pair_flyer(index, other);
                    }
                }
            }
        }
    }

    /// What kinematic bodies put in: impulse × their own velocity, row by row.
    fn book_drivers(&mut self) {
        let rig = &self.pool.seats.rig;
        for &index in &self.pool.crowd.drivers {
            let Some(slot) = self.pool.seats.slot(index) else {
                continue;
            };
            let line = &rig.lines[slot as usize];
            let (v, w) = (line.v(), line.w());
            if v == Vec2::ZERO && w == 0.0 {
                continue;
            }
            for place in &self.bodies.get(index).pairs {
                for id in self.pairs.rows_of(*place) {
                    let work = rig.driven_work(id);
                    self.pool.crowd.driven.add(work);
                }
            }
        }
    }

    /// What belts put in: friction impulse × the speed at which the surfaces run along.
    fn book_belts(&mut self) {
        let mut belts = core::mem::take(&mut self.pool.crowd.belts);
        belts.sort_unstable();
        belts.dedup();
        belts.retain(|&place| {
            let Some(pair) = self.pairs.find(place) else {
                return false;
            };
            let speed = pair.material.tangent_speed;
            let mut runs = false;
            for id in pair.contacts.iter().filter_map(|contact| contact.row) {
                runs = speed != 0.0;
                let work = self.pool.seats.rig.row(id).jt * speed;
                self.pool.crowd.driven.add(work);
            }
            runs
        });
        self.pool.crowd.belts = belts;
    }

    /// Contacts for those who joined since the last look.
    fn welcome(&mut self, time: SimTime) {
        let mut newcomers = core::mem::take(&mut self.pool.crowd.newcomers);
        newcomers.retain(|index| self.bodies.get(*index).in_crowd);
        newcomers.sort_unstable();
        self.look_at_pairs(&newcomers, time, false);
    }

    fn forced_lines(&self) -> impl Iterator<Item = (u32, Vec2, f64)> + use<'_> {
        let members = self.forced.iter().filter_map(|&index| {
            let slot = self.pool.seats.slot(index)?;
            let line = &self.pool.seats.rig.lines[slot as usize];
            Some((index, line.d(), line.turn()))
        });
        members.filter(|(index, ..)| self.bodies.get(*index).kind == BodyKind::Dynamic)
    }
}
