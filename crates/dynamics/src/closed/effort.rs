//! What closed forms cost an island: one that changes too often for them, or has none, is moved by the engine.
//!
//! A judgement of an island takes as long as the engine needs for hundreds of its sub-steps. So every body has an account:
//! its island pays a judgement a body for each judgement, and time pays it back. Where an account is overdrawn the island joins
//! with the next sub-step. The account is the body's alone: no island feels another.

use std::collections::BTreeSet;

use carom_math::{SimTime, Vec2};

use super::store::Closed;
use crate::World;
use crate::heavy::{BEARS, mass_ratio};
use crate::modes::BodyMove;
use crate::sleep::Tree;
use crate::state::BodyState;
use crate::touching::Gathered;

/// Judgements that a body may have ahead of time.
const AHEAD: f64 = 24.0;

/// Ticks that pay for one judgement of one body.
const PAID: f64 = 60.0;

/// Sub-steps in lasting contact without a closed form that use up what a body may have ahead.
const UNSOLVED: f64 = 64.0;

/// An island keeps its method while something that touches in it turns by more in a tick, in rad, or flies farther in a sub-step, in
/// its reach: the engine's contacts are as old as its tick.
const SWIFT: f64 = 0.2;

/// A change of velocity or acceleration that is a smaller part of it is none.
const SAME: f64 = 1e-6;

/// Ticks for which a body that was swift counts as one that is: a blow makes it swift and an impact stops it, again and again.
const LASTS: f64 = 4.0;

/// What a body's islands spent by an instant, in judgements.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Account {
    at: SimTime,
    spent: f64,
    /// When it was swift the last time.
    swift: Option<SimTime>,
}

impl Account {
    /// Spends `cost` at `time`, in ticks of `tick` seconds; whether it is overdrawn.
    fn spend(&mut self, cost: f64, time: SimTime, tick: f64) -> bool {
        let paid = (time - self.at) / (PAID * tick);
        self.spent = (self.spent - paid).max(0.0);
        self.at = time;
        let is_overdrawn = self.spent > AHEAD;
        self.spent += cost;
        is_overdrawn
    }
}

impl Closed {
    /// Bodies that spent too much join with the next sub-step.
    pub(crate) const fn has_overdrawn(&self) -> bool {
        !self.overdrawn.is_empty()
    }

    /// A body that was inserted has spent nothing.
    pub(crate) fn open_account(&mut self, index: u32) {
        if let Some(account) = self.accounts.get_mut(index as usize) {
            *account = Account::default();
        }
    }

    fn account(&mut self, index: u32) -> &mut Account {
        let at = index as usize;
        if at >= self.accounts.len() {
            self.accounts.resize(at + 1, Account::default());
        }
        &mut self.accounts[at]
    }

    /// Whether a body was swift within the last few ticks of `tick` seconds.
    fn was_swift(&self, index: u32, time: SimTime, tick: f64) -> bool {
        let account = self.accounts.get(index as usize);
        let swift = account.and_then(|account| account.swift);
        swift.is_some_and(|swift| time - swift < LASTS * tick)
    }
}

/// Whether a body moves otherwise from `time` on.
fn changes(state: &BodyState, moved: &BodyMove, time: SimTime) -> bool {
    let (motion, reach) = (&state.motion, state.reach);
    let differ = |was: Vec2, is: Vec2, turned: f64, turns: f64| {
        let step = (is - was).length().max((turns - turned).abs() * reach);
        let size = was.length().max(turned.abs() * reach);
        step > SAME * size
    };
    state.is_dynamic()
        && (differ(
            state.velocity_at(time),
            moved.velocity,
            state.spin_at(time),
            moved.spin,
        ) || differ(
            motion.acceleration,
            moved.acceleration,
            motion.angular_acceleration,
            moved.angular_acceleration,
        ))
}

impl World {
    /// Members of an island with a new mode pay for it, unless they go on as they were: over a seam of tiles, or by the next
    /// stretch of a path.
    pub(super) fn pay_for(&mut self, gathered: &Gathered, moves: &[BodyMove], time: SimTime) {
        if !self.may_join() {
            return;
        }
        let mut both = gathered.places.iter().zip(moves);
        if both.any(|(&index, moved)| changes(self.bodies.get(index), moved, time)) {
            let members = gathered.dynamic();
            for &index in &members {
                self.note_swift(index, time);
            }
            self.pay(&members, time);
        }
    }

    /// Members of an island that is judged pay for it.
    pub(super) fn pay(&mut self, members: &[u32], time: SimTime) {
        let cost = members.len() as f64;
        self.spend(members, cost, time);
    }

    fn spend(&mut self, members: &[u32], cost: f64, time: SimTime) {
        if !self.may_join() {
            return;
        }
        let tick = self.settings.tick;
        let was = self.is_substepping();
        for &index in members {
            if self.closed.account(index).spend(cost, time, tick) {
                self.closed.overdrawn.push(index);
            }
        }
        if !was && self.closed.has_overdrawn() {
            self.clock.catch_up(time);
        }
    }

    /// What lasts in contact without a closed form pays for each sub-step.
    pub(crate) fn pay_unsolved(&mut self, index: u32, time: SimTime) {
        self.spend(&[index], AHEAD / UNSOLVED, time);
    }

    /// Analytic islands that spent too much join, unless they rest; the bodies among the others that have no closed form.
    pub(crate) fn join_overdrawn(&mut self, time: SimTime) -> Vec<u32> {
        let mut overdrawn = core::mem::take(&mut self.closed.overdrawn);
        if overdrawn.is_empty() {
            return overdrawn;
        }
        overdrawn.sort_unstable();
        overdrawn.dedup();
        let mut loose = Vec::new();
        for index in overdrawn {
            if !self.bodies.is_alive(index) || self.bodies.get(index).asleep {
                continue;
            }
            let Some(group) = self.closed.get(self.bodies.get(index).membership.group) else {
                if self.bodies.get(index).is_held() {
                    loose.push(index);
                }
                continue;
            };
            let members: Vec<u32> = group.members.iter().map(|(index, _)| *index).collect();
            if group.sleeps || self.stays(&members, time) {
                continue;
            }
            for index in members {
                self.join(index, time);
            }
        }
        self.lower_flyers_later();
        loose
    }

    /// Roots of the islands of `loose` that join. `tree`: sub-stepped bodies in touch.
    pub(crate) fn overdrawn_roots(
        &mut self,
        loose: &[u32],
        tree: &mut Tree,
        time: SimTime,
    ) -> BTreeSet<u32> {
        let mut roots: BTreeSet<u32> = loose.iter().map(|index| tree.root(*index)).collect();
        if roots.is_empty() {
            return roots;
        }
        let stepped = self.stepped.iter().map(|index| (tree.root(*index), *index));
        let mut islands: Vec<(u32, u32)> =
            stepped.filter(|(root, _)| roots.contains(root)).collect();
        islands.sort_unstable();
        for island in islands.chunk_by(|one, other| one.0 == other.0) {
            let members: Vec<u32> = island.iter().map(|(_, index)| *index).collect();
            if self.stays(&members, time) {
                roots.remove(&island[0].0);
            }
        }
        roots
    }

    /// Whether an island keeps its method, whatever it spent. If so, it is not asked again before it spent as much anew.
    fn stays(&mut self, members: &[u32], time: SimTime) -> bool {
        let stays = self.is_beyond_engine(members, time);
        if stays {
            for &index in members {
                self.closed.account(index).spent = 0.0;
            }
        }
        stays
    }

    /// Whether an island has mass ratios, spins or speeds that the engine does not resolve, or is borne by nothing: the engine
    /// keeps no angular momentum.
    fn is_beyond_engine(&self, members: &[u32], time: SimTime) -> bool {
        let mut is_borne = false;
        for &index in members {
            let state = self.bodies.get(index);
            if self.closed.was_swift(index, time, self.settings.tick) {
                return true;
            }
            for place in &state.pairs {
                let pair = self.pairs.get(*place);
                let other = self.bodies.get(pair.other(index));
                if mass_ratio([state.inverse_mass, other.inverse_mass]) > BEARS {
                    return true;
                }
                if pair.touching {
                    if [state, other].iter().any(|body| self.is_swift(body, time)) {
                        return true;
                    }
                    is_borne |= !other.is_dynamic() || other.asleep || other.in_engine;
                }
            }
        }
        !is_borne
    }

    /// Notes that a body was swift, if it is.
    pub(crate) fn note_swift(&mut self, index: u32, time: SimTime) {
        if self.is_swift(self.bodies.get(index), time) {
            self.closed.account(index).swift = Some(time);
        }
    }

    fn is_swift(&self, state: &BodyState, time: SimTime) -> bool {
        let speed = state.velocity_at(time).length();
        state.spin_at(time).abs() * self.settings.tick > SWIFT
            || speed * self.clock.h > SWIFT * state.reach
    }
}
