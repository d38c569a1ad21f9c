//! Joins and leaves in [`crate::Mode::Hybrid`] and [`crate::Mode::Exact`]: which bodies the engine moves.
//!
//! ```text
//! free, analytic, held ─► near a member within the tick, or in an island without a closed form ─► member
//! member ─► no contact for three ticks, and no body near ─► free
//! ```
//! Kinematic bodies are its guests, and so are fixed ones and those that sleep outside of the engine where members are near
//! (`guests`): it knows them, and moves only members that meet them.

use std::collections::{BTreeMap, BTreeSet};

use carom_collision::{BoxTree, Motion};
use carom_geometry::Aabb;
use carom_math::{SimTime, Sum, Vec2};
use carom_stepped::State;

use super::rush::Rush;
use crate::model::graph::neighbours;
use crate::store::bodies::Bodies;
use crate::store::pairs::Shapes;
use crate::store::uncommon::Lag;
use crate::{BodyIx, EnergyLedger, Mode, World};

/// More bodies than this that wake, or land, at once join the engine.
pub(crate) const FEW: usize = 16;

/// Groups of more bodies in touch than this have too many rows ([`crate::analytic::touching`]): no closed form is tried.
pub(crate) const MANY: usize = 64;

/// A member flies after more ticks than these without a contact.
const IDLE: u8 = 2;

/// What the boundary to the engine keeps of its members.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joins {
    /// The engine had a member: bodies that come to rest are guests from now on.
    pub(crate) has_guests: bool,
    /// Kinematic bodies, and some that were.
    pub(crate) drivers: BTreeSet<BodyIx>,
    /// Bodies that woke in the engine.
    pub(crate) woken: Vec<BodyIx>,
    /// Bodies that joined in the midst of a sub-step, and stand where they are until it ends.
    pub(crate) waiting: Vec<BodyIx>,
    /// How many of them are known to those that would meet them.
    pub(crate) known: usize,
    /// Shapes that touched when one of their bodies joined: the caller was told.
    pub(crate) told: Vec<Shapes>,
    /// Members that had no contact at the last ticks, and at how many.
    idle: BTreeMap<BodyIx, u8>,
    /// Bodies that took to flight, and some that landed since.
    pub(crate) aloft: BTreeSet<BodyIx>,
    /// Bodies outside with motions that are newer than the last search for bodies that join.
    pub(crate) restless: Vec<BodyIx>,
    /// Where bodies outside go until the tick of this number ends: what comes to the engine in it, or goes elsewhere, asks for them
    /// there. Of those with newer motions there are boxes of the older ones, too. None if some took to flight that are not in it.
    pub(super) ahead: Option<(u64, BoxTree)>,
    /// Motions are older than the engine.
    pub(crate) unwritten: bool,
    /// Where the engine's last sub-step ended.
    pub(crate) reached: SimTime,
    /// Bodies of the engine that a caller's forces act on, or did in its last sub-step.
    pub(crate) pushed: BTreeSet<BodyIx>,
    /// Until when forces of the present step are known.
    pub(crate) forced_until: SimTime,
    pub(crate) rush: Rush,
    /// Energy of all bodies that left less that of all that joined, in J.
    pub(crate) balance: Sum,
    /// Work of kinematic bodies, and of the caller's forces, in J.
    pub(crate) driven: Sum,
    pub(crate) forced: Sum,
}

impl Joins {
    /// Notes that a body flies.
    pub(crate) fn note_flight(&mut self, bodies: &Bodies, index: BodyIx) {
        if bodies.member_count() > 0 {
            self.restless.push(index);
        } else {
            self.ahead = None;
        }
        self.aloft.insert(index);
    }
}

impl World {
    /// Whether the engine has members, or will with its next sub-step.
    pub(crate) const fn is_substepping(&self) -> bool {
        self.bodies.member_count() > 0 || self.joins.rush.is_due() || self.closed.has_exhausted()
    }

    /// Bodies in touch of which one has no solution of its contact modes join.
    pub(crate) fn join_unsolved(&mut self, time: SimTime) {
        let joining: BTreeSet<BodyIx> = self.unsolved_islands().into_iter().flatten().collect();
        self.unsettled.retain(|index| !joining.contains(index));
        for index in joining {
            self.join(index, time);
        }
    }

    /// Islands of bodies in touch in sub-steps of which one has no closed form.
    pub(crate) fn unsolved_islands(&self) -> Vec<Vec<BodyIx>> {
        let (mut seen, mut islands) = (BTreeSet::new(), Vec::new());
        for &index in &self.unsettled {
            if !self.bodies.get(index).is_unsolved() || !seen.insert(index) {
                continue;
            }
            let (mut island, mut next) = (vec![index], 0);
            while let Some(&index) = island.get(next) {
                next += 1;
                let others = neighbours(&self.bodies, &self.pairs, index);
                let held = others.filter(|other| self.bodies.get(*other).is_held());
                island.extend(held.filter(|other| seen.insert(*other)));
            }
            islands.push(island);
        }
        islands
    }

    /// Bodies that woke together join if they are many, before closed forms are tried; whether they did.
    pub(crate) fn many_woke(&mut self, woken: &[BodyIx], time: SimTime) -> bool {
        let exact = self.settings.mode == Mode::Exact;
        if woken.len() <= if exact { MANY } else { FEW } {
            return false;
        }
        for &index in woken {
            self.join(index, time);
        }
        true
    }

    /// From now on the engine moves this body. In the middle of a sub-step it stands where it is until the next.
    pub(crate) fn join(&mut self, index: BodyIx, time: SimTime) {
        let state = self.bodies.get(index);
        if !state.is_outside() {
            return;
        }
        let group = state.membership.group;
        self.dissolve(group, time);
        // A body that leaves a path searches for pairs, and may have met a member.
        if self.bodies.get(index).in_engine() {
            return;
        }
        if !self.is_substepping() {
            self.clock.catch_up(time);
        }
        self.invite_drivers();
        if self.bodies.get(index).goes_by_events() {
            self.bodies.get_mut(index).land();
            self.free.vanish(&mut self.bodies, index);
        } else {
            self.end_unsettled(index);
        }
        self.bodies.change(index, time, |_| {});
        self.joins.balance.add(-self.bodies.energy_of(index, time));
        self.bodies.join(index);
        self.take_force(index, time);
        let state = self.bodies.get_mut(index);
        state.member = false;
        self.bodies.touch(index);
        self.leave_pairs(index, time);
        self.wait(index, time);
    }

    /// A body that joins once the engine has made a sub-step, or in the midst of one, stands where it is until that ends: so the engine
    /// takes it, and so it is shown, with the velocity that it keeps.
    pub(crate) fn wait(&mut self, index: BodyIx, time: SimTime) {
        let begins = time <= self.clock.last() && self.joins.reached < self.clock.next();
        if begins || !self.clock.is_within(time) {
            return;
        }
        self.joins.waiting.push(index);
        let state = self.bodies.get(index);
        let velocity = (state.velocity_at(time), state.spin_at(time));
        let motion = Motion {
            start: time,
            rotation: state.rotation_at(time),
            ..Motion::resting(state.centre_at(time))
        };
        let turned = state.turned_at(time);
        self.bodies.go_on_as(index, &motion, turned);
        let lag = Lag::of_even((Vec2::ZERO, 0.0), velocity, velocity, self.clock.h);
        self.bodies.get_mut(index).set_lag(lag);
        self.bodies.renew(index);
    }

    /// Counts what stands until the next sub-step: nothing else says so, and what touches it goes on meanwhile.
    pub(crate) fn report_waiting(&mut self, time: SimTime) {
        let mut waiting = self.joins.waiting.clone();
        waiting.retain(|index| self.bodies.is_alive(*index) && self.bodies.get(*index).in_engine());
        // Some began to stand more than once.
        waiting.sort_unstable();
        waiting.dedup();
        self.report.handed_over += waiting.len() as u64;
        if !self.clock.is_within(time) {
            self.joins.waiting.clear();
            self.joins.known = 0;
        }
    }

    /// Takes a body's boxes and pairs from the world: the engine has its own. What touches goes on to touch.
    pub(crate) fn leave_pairs(&mut self, index: BodyIx, time: SimTime) {
        for place in self.bodies.get(index).pairs.clone() {
            let Some(pair) = self.take_pair(place, time) else {
                continue;
            };
            if pair.told {
                self.joins.told.push(pair.shapes());
            }
        }
        self.broad.forget(&mut self.bodies, index);
        self.bodies.set_boxes(index, Aabb::EMPTY);
    }

    /// A member leaves, with the motion that it has at `time`: its next regime is for the caller to choose.
    pub(crate) fn leave(&mut self, index: BodyIx, time: SimTime) {
        if self.leave_engine(index, time) {
            self.tell_members_touches(time);
        }
        self.end_told(index, time);
        self.take_woken(time);
        self.end_membership(index, time);
    }

    /// A body that joined within a sub-step and leaves in it touches nothing any more: the engine, which would say so, never knew it.
    fn end_told(&mut self, index: BodyIx, time: SimTime) {
        let events = &mut self.events;
        self.joins.told.retain(|shapes| {
            let stays = shapes.iter().all(|shape| shape.0 != index);
            if !stays {
                events.push_touch(&self.bodies, *shapes, false, time);
            }
            stays
        });
    }

    /// A body that the engine does not know any more is no member.
    fn end_membership(&mut self, index: BodyIx, time: SimTime) {
        if !self.bodies.get(index).in_engine() {
            return;
        }
        self.bodies.change(index, time, |_| {});
        self.joins.balance.add(self.bodies.energy_of(index, time));
        self.bodies.leave(index);
        let state = self.bodies.get_mut(index);
        state.member = false;
        self.bodies.renew(index);
        self.release_force(index, time);
    }

    /// The engine will not move a body any more, which flies from `time` on: forces go on as those of a free body.
    fn release_force(&mut self, index: BodyIx, time: SimTime) {
        if !self.joins.pushed.remove(&index) {
            return;
        }
        let state = self.bodies.get_mut(index);
        let before = state.kinetic_energy(time);
        let (inverse_mass, inverse_inertia) = (state.inverse_mass, state.inverse_inertia);
        let centre = state.centre_at(time);
        let acts = state.uncommon_mut();
        acts.owe_until(time, self.clock.h);
        (acts.force, acts.torque) = core::mem::take(&mut acts.pending);
        let (owed, turning) = core::mem::take(&mut acts.owed);
        let (pull, twist) = self.bodies.pull_on(index, centre);
        self.bodies.change(index, time, |motion| {
            motion.velocity += owed * inverse_mass;
            motion.spin += turning * inverse_inertia;
            (motion.acceleration, motion.angular_acceleration) = (pull, twist);
        });
        let after = self.bodies.get(index).kinetic_energy(time);
        self.bodies.book.forces.add(after - before);
    }

    /// The engine moves a body from `time` on that was free: a force goes on as in its sub-steps.
    fn take_force(&mut self, index: BodyIx, time: SimTime) {
        let state = self.bodies.get_mut(index);
        if state.force() == Vec2::ZERO && state.torque() == 0.0 {
            return;
        }
        let acts = state.uncommon_mut();
        acts.pending = (acts.force, acts.torque);
        acts.acted = time;
        self.joins.pushed.insert(index);
    }

    /// Members that nothing touches or nears for a while fly from here on. At the start of a tick.
    pub(crate) fn disperse(&mut self, time: SimTime) {
        let Some(mut stepping) = self.stepping.take() else {
            return;
        };
        stepping.engine.prepare_queries();
        let before = core::mem::take(&mut self.joins.idle);
        let mut gone = BTreeSet::new();
        for state in stepping.engine.without_contact() {
            let index = super::place(&state);
            if !self.bodies.get(index).in_engine() {
                continue;
            }
            let ticks = before.get(&index).map_or(1, |ticks| ticks + 1);
            let ahead = (time, 2.0 * self.settings.tick);
            let leaves = ticks > IDLE && {
                // What a long step has not written yet is as old as the step.
                self.write_flight(&state, time);
                !stepping.nears_member(self.rules(), self.joins.reached, index, ahead)
            };
            if leaves {
                gone.insert(index);
            } else {
                self.joins.idle.insert(index, ticks.min(IDLE));
            }
        }
        self.stepping = Some(stepping);
        for &index in &gone {
            // What it touched is told below.
            self.leave_engine(index, time);
            self.take_woken(time);
            self.end_membership(index, time);
            self.take_off(index, time);
        }
        if !gone.is_empty() {
            self.tell_members_touches(time);
        }
    }

    /// The motion of a member from `time` on if nothing meets it.
    fn write_flight(&mut self, state: &State, time: SimTime) {
        let index = super::place(state);
        let (pull, twist) = self.bodies.pull_on(index, state.pose.position);
        let motion = Motion {
            start: time,
            velocity: state.velocity.0,
            acceleration: pull,
            rotation: state.pose.rotation,
            spin: state.velocity.1,
            angular_acceleration: twist,
            ..Motion::resting(state.pose.position)
        };
        self.bodies.go_on_as(index, &motion, state.turned);
    }

    /// Potential energy of all members, in J.
    pub(crate) fn potential_of_members(&self) -> f64 {
        let members = self.bodies.iter().filter(|state| state.in_engine());
        let of = |state| self.bodies.potential_of(state, self.clock.now);
        members.map(of).collect::<Sum>().value()
    }

    /// The columns of the ledger that members have.
    pub(crate) fn book_members(&self, ledger: &mut EnergyLedger) {
        let mut gained = self.joins.balance;
        for state in self.bodies.iter().filter(|state| state.in_engine()) {
            gained.add(state.kinetic_energy(self.clock.now));
            gained.add(self.bodies.potential_of(state, self.clock.now));
        }
        gained.add(-self.bodies.book.struck.value());
        let engine = self.stepping.as_ref().map(|stepping| &stepping.engine);
        let heat = engine.map_or(0.0, carom_stepped::Engine::friction_heat);
        let lost = engine.map_or(0.0, carom_stepped::Engine::impact_losses);
        let belts = engine.map_or(0.0, carom_stepped::Engine::belt_work);
        let (driven, forced) = (self.joins.driven.value() + belts, self.joins.forced.value());
        ledger.impacts += lost;
        ledger.friction += heat;
        ledger.external += driven;
        ledger.forces += forced;
        // What other rows and push-outs did is what the energies tell beside that.
        ledger.scheme += gained.value() + lost + heat - driven - forced;
    }
}
