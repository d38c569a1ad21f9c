//! The store of bodies, and the one door through which a motion changes.

use std::sync::Arc;

use carom_collision::{Hull, Motion, part};
use carom_geometry::{Aabb, Shape};
use carom_math::{SimTime, Sum, Vec2};

use super::damping::damping_loss;
use super::few::Few;
use super::history::History;
use super::moved::{Moved, moves};
use super::pull::Pull;
use super::regime::Members;
use super::slots::List;
use super::state::{BodyState, Collider};
use super::uncommon::Lag;
use crate::impact::ImpactBody;
use crate::{BodyError, BodyId, BodyIx, ColliderIx, EnergyLedger, Ix, Mode, Settings, Two};

/// Running sums of the energy ledger's columns, with twice the digits.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EnergyBook {
    pub(crate) impacts: Sum,
    pub(crate) friction: Sum,
    pub(crate) forces: Sum,
    pub(crate) external: Sum,
    pub(crate) scheme: Sum,
    /// Given to members of the engine by impacts, which have booked it.
    pub(crate) struck: Sum,
}

/// All bodies of a world, with the places that removed ones left.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    list: List<BodyIx, BodyState>,
    /// Raised by every change of a motion: what was predicted with another version is stale. Apart from the bodies, since
    /// a check of a prediction reads nothing else.
    versions: List<BodyIx, u32>,
    alive: List<BodyIx, bool>,
    free: Vec<BodyIx>,
    /// The shapes of all bodies, and places among them that are free.
    pub(crate) colliders: List<ColliderIx, Collider>,
    pub(crate) free_colliders: Vec<ColliderIx>,
    pub(crate) history: History,
    pub(crate) book: EnergyBook,
    pub(crate) pull: Pull,
    /// Length of a sub-step, in s: what counts as short where no sub-steps are made, too.
    pub(crate) h: f64,
    /// Flights since the last report that leave out more than [`Pull::error`], as short as their stretches are.
    pub(crate) inaccurate: u64,
    /// Bodies that came, went, woke or were changed since the last sub-step; only where the list is
    /// read.
    pub(crate) touched: Vec<BodyIx>,
    pub(crate) notes_touched: bool,
    pub(crate) moved: Moved,
    pub(crate) members: Members,
}

impl Bodies {
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            history: History::new(settings.history),
            pull: Pull {
                gravity: settings.gravity,
                error: settings.field_error,
                ..Pull::default()
            },
            h: settings.h(),
            notes_touched: settings.mode == Mode::Stepped,
            ..Self::default()
        }
    }

    /// Makes room for so many more.
    pub(crate) fn reserve(&mut self, more: usize) {
        self.list.reserve_exact(more);
        self.versions.reserve_exact(more);
        self.alive.reserve_exact(more);
        self.colliders.reserve_exact(more);
    }

    /// The id that the next body gets.
    pub(crate) fn next_id(&self) -> Result<BodyId, BodyError> {
        const LIMIT: usize = u32::MAX as usize;
        if let Some(&index) = self.free.last() {
            let generation = self.list[index].id.generation + 1;
            return Ok(BodyId { index, generation });
        }
        let index = u32::try_from(self.list.len()).map_err(|_| BodyError::Full {
            what: "bodies",
            limit: LIMIT,
        })?;
        Ok(BodyId {
            index: BodyIx::new(index),
            generation: 0,
        })
    }

    /// Notes that a body differs from its solver's copy.
    pub(crate) fn touch(&mut self, index: BodyIx) {
        let state = self.list.get(index);
        if self.notes_touched || state.is_some_and(|state| state.in_engine() || state.is_guest) {
            self.touched.push(index);
            // A caller may change a body any number of times between two sub-steps.
            if self.touched.len() > 2 * self.list.len() + 64 {
                self.touched.sort_unstable();
                self.touched.dedup();
            }
        }
    }

    pub(crate) fn is_alive(&self, index: BodyIx) -> bool {
        self.alive[index]
    }

    pub(crate) fn insert(&mut self, state: BodyState) {
        self.touch(state.id.index);
        self.moved.note(state.id.index);
        let index = state.id.index;
        if index.at() == self.list.len() {
            self.list.push(state);
            self.versions.push(0);
            self.alive.push(true);
        } else {
            self.free.pop();
            self.history.forget(state.id.index);
            // Versions only grow, also from body to body: nothing foreseen for one is another's.
            self.versions[index] = self.versions[index].wrapping_add(1);
            self.list[index] = state;
            self.alive[index] = true;
        }
    }

    /// Takes a body out; its place is used again unless its generations are used up.
    pub(crate) fn remove(&mut self, index: BodyIx) {
        // Nothing that was foreseen comes true.
        self.renew(index);
        let state = &mut self.list[index];
        state.vanish();
        state.colliders = Few::default();
        state.pairs.clear();
        self.alive[index] = false;
        if state.id.generation < u32::MAX {
            self.free.push(index);
        }
    }

    pub(crate) fn find(&self, id: BodyId) -> Result<BodyIx, BodyError> {
        let known = self.list.get(id.index);
        if known.is_some_and(|state| state.id == id) && self.alive[id.index] {
            Ok(id.index)
        } else {
            Err(BodyError::Stale(id))
        }
    }

    /// Places of all living bodies, in order.
    pub(crate) fn indices(&self) -> impl Iterator<Item = BodyIx> + use<'_> {
        let all = self.alive.each();
        all.filter(|(_, alive)| **alive).map(|(index, _)| index)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &BodyState> {
        self.list
            .iter()
            .zip(&*self.alive)
            .filter(|(_, alive)| **alive)
            .map(|(state, _)| state)
    }

    /// How many places there are, living or not.
    pub(crate) fn places(&self) -> usize {
        self.list.len()
    }

    pub(crate) fn get(&self, index: BodyIx) -> &BodyState {
        &self.list[index]
    }

    /// For everything but the motion: that changes through [`Bodies::change`].
    pub(crate) fn get_mut(&mut self, index: BodyIx) -> &mut BodyState {
        &mut self.list[index]
    }

    /// How often the motion of a body has changed.
    pub(crate) fn version(&self, index: BodyIx) -> u32 {
        self.versions[index]
    }

    /// The motion of a body from `motion.start` on, turned by `angle` in all; the log keeps what it did till then.
    pub(crate) fn go_on_as(&mut self, index: BodyIx, motion: &Motion, angle: f64) {
        let state = &mut self.list[index];
        let whose = (index, state.mass.centroid);
        self.history
            .replaced(whose, &state.motion, None, motion.start);
        (state.motion, state.turned) = (*motion, angle);
        state.set_lag(Lag::NONE);
    }

    /// Two bodies.
    pub(crate) fn both(&self, (a, b): Two<BodyIx>) -> (&BodyState, &BodyState) {
        (self.get(a), self.get(b))
    }

    /// Two shapes.
    pub(crate) fn solids(&self, (a, b): Two<ColliderIx>) -> [&Arc<Shape>; 2] {
        [a, b].map(|at| &self.colliders[at].solid)
    }

    /// A convex part of a shape.
    pub(crate) fn hull(&self, collider: ColliderIx, number: u32) -> Hull<'_> {
        part(&self.colliders[collider].solid, number as usize)
    }

    /// Gives a body its velocities after an impact; whether it has a mass that moves.
    pub(crate) fn end_impact(&mut self, index: BodyIx, time: SimTime, after: &ImpactBody) -> bool {
        let moves = after.inverse_mass > 0.0;
        if moves {
            self.change(index, time, |motion| {
                (motion.velocity, motion.spin) = (after.velocity, after.spin);
            });
        }
        moves
    }

    /// Gives all shapes of a body the same box.
    pub(crate) fn set_boxes(&mut self, index: BodyIx, bounds: Aabb) {
        for &at in &self.list[index].colliders {
            self.colliders[at].fat = bounds;
        }
    }

    /// What was predicted with a body's motion is stale from now on.
    pub(crate) fn renew(&mut self, index: BodyIx) {
        let version = &mut self.versions[index];
        *version = version.wrapping_add(1);
        self.moved.note(index);
    }

    /// Stops a body with numbers that are no longer finite at its last known place.
    pub(crate) fn stop(&mut self, index: BodyIx, time: SimTime) {
        // Its last box is the only record of where it was.
        let known = self.get(index).colliders.iter();
        let mut boxes = known.map(|at| self.colliders[*at].fat.centre());
        let last = boxes.find(|centre| centre.is_finite());
        let state = self.get_mut(index);
        let Motion {
            centre, rotation, ..
        } = state.motion;
        let centre = Some(centre).filter(|centre| centre.is_finite()).or(last);
        let rotation = Some(rotation).filter(|rotation| rotation.x_axis().is_finite());
        state.motion = Motion {
            start: time,
            rotation: rotation.unwrap_or_default(),
            ..Motion::resting(centre.unwrap_or_default())
        };
        if !state.turned.is_finite() {
            state.turned = 0.0;
        }
        state.uncommon_mut().gravity_scale = 0.0;
        state.flight = None;
        state.set_piece(SimTime::NEVER);
        self.renew(index);
    }

    /// A step is over: from now on [`Self::moved`] tells of it.
    pub(crate) fn end_step(&mut self) {
        let Self {
            list, alive, moved, ..
        } = self;
        moved.end_step(|index| alive[index].then(|| moves(&list[index])));
    }

    /// Bodies that moved in the last step, and are there.
    pub(crate) fn moved(&self) -> impl Iterator<Item = &BodyState> {
        let there = self.moved.indices().filter(|index| self.is_alive(*index));
        there.map(|index| self.get(index))
    }

    /// Whether a body flies along anything but a parabola.
    pub(crate) fn bends(&self, index: BodyIx) -> bool {
        let state = self.get(index);
        state.is_dynamic() && (!self.pull.fields.is_empty() || state.is_damped())
    }

    /// Acceleration in m/s², and angular acceleration in rad/s², of a dynamic body that nothing holds.
    pub(crate) fn freely(&self, index: BodyIx, time: SimTime) -> (Vec2, f64) {
        let state = self.get(index);
        let (linear, angular) = state.damping();
        let pull = if self.pull.fields.is_empty() {
            self.pull.gravity
        } else {
            self.pull.at(state.centre_at(time))
        };
        let acceleration = state.gravity_scale() * pull + state.force() * state.inverse_mass
            - state.velocity_at(time) * linear;
        let turning = state.torque() * state.inverse_inertia - angular * state.spin_at(time);
        (acceleration, turning)
    }

    /// What accelerates a body at a place besides contacts and damping, in m/s² and rad/s²; a field that is not finite there
    /// accelerates nothing.
    pub(crate) fn pull_on(&self, index: BodyIx, centre: Vec2) -> (Vec2, f64) {
        let state = self.get(index);
        if !state.is_dynamic() {
            return (Vec2::ZERO, 0.0);
        }
        let pull =
            state.gravity_scale() * self.pull.at(centre) + state.force() * state.inverse_mass;
        let pull = if pull.is_finite() { pull } else { Vec2::ZERO };
        (pull, state.torque() * state.inverse_inertia)
    }

    /// The one door for changes of a motion: closes the piece that ends at `time`, books its
    /// energy, logs it, and opens the next one with a new version.
    pub(crate) fn change(
        &mut self,
        index: BodyIx,
        time: SimTime,
        change: impl FnOnce(&mut Motion),
    ) {
        self.touch(index);
        let state = &self.list[index];
        let now = state.at(time);
        if let Some(piece) = self.piece(state, time, || now) {
            self.book.forces.add(piece.forces);
            self.book.scheme.add(piece.scheme);
        }
        let state = &mut self.list[index];
        let whose = (index, state.mass.centroid);
        self.history
            .replaced(whose, &state.motion, state.flight.as_ref(), time);
        state.motion = now.0;
        state.turned += now.1;
        state.flight = None;
        state.set_lag(Lag::NONE);
        if state.in_engine() {
            let before = state.kinetic_energy(time);
            change(&mut state.motion);
            let after = state.kinetic_energy(time);
            self.book.struck.add(after - before);
        } else {
            change(&mut state.motion);
        }
        self.renew(index);
    }

    /// What forces and the scheme did along the present piece of a motion up to `time`.
    ///
    /// Along a quadratic piece the kinetic energy changes by exactly `m a·Δx + I α Δθ`. None where gravity is all. `now`: what
    /// [`BodyState::at`] says of that instant.
    fn piece(
        &self,
        state: &BodyState,
        time: SimTime,
        now: impl FnOnce() -> (Motion, f64),
    ) -> Option<Piece> {
        let motion = &state.motion;
        let free = state.gravity_scale() * self.pull.gravity;
        // The account of members is kept in `stepping::join`.
        if !state.is_dynamic()
            || state.in_engine()
            || (motion.acceleration == free
                && motion.angular_acceleration == 0.0
                && state.force() == Vec2::ZERO
                && !self.bends(state.id.index))
        {
            return None;
        }
        let elapsed = time - motion.start;
        let mass = state.mass.mass;
        let (now, turn) = now();
        let (mut travel, lag) = (motion.travel(elapsed), state.lag());
        let (straight, turning) = if state.flight.is_none() && *lag == Lag::NONE {
            let along = motion.acceleration.dot(travel);
            (along, motion.angular_acceleration * turn)
        } else {
            if state.flight.is_some() {
                travel = now.centre - motion.centre;
            }
            let (velocity, spin) = (
                motion.velocity + lag.at(0.0),
                motion.spin + lag.spin_at(0.0),
            );
            let along = (now.velocity - velocity).dot(0.5 * (now.velocity + velocity));
            (along, (now.spin - spin) * (0.5 * (now.spin + spin)))
        };
        let kinetic = mass * straight + state.turning_inertia() * turning;
        let mut potential = -mass * free.dot(travel);
        for field in &self.pull.fields {
            let (from, to) = (motion.centre, motion.centre + travel);
            potential +=
                mass * state.gravity_scale() * (field.potential(to) - field.potential(from));
        }
        let forces = state.force().dot(travel) + state.torque() * turn - damping_loss(state, time);
        Some(Piece {
            forces,
            scheme: kinetic + potential - forces,
        })
    }

    /// Mechanical energy of one body, kinetic and potential, in J.
    pub(crate) fn energy_of(&self, index: BodyIx, time: SimTime) -> f64 {
        let state = &self.list[index];
        state.kinetic_energy(time) + self.potential_of(state, time)
    }

    /// Potential energy of one body, in J.
    pub(crate) fn potential_of(&self, state: &BodyState, time: SimTime) -> f64 {
        if !state.is_dynamic() {
            return 0.0;
        }
        let centre = state.centre_at(time);
        state.mass.mass * state.gravity_scale() * self.pull.potential(centre)
    }

    pub(crate) fn ledger(&self, time: SimTime) -> EnergyLedger {
        let (mut kinetic, mut potential) = (Sum::ZERO, Sum::ZERO);
        let mut book = self.book;
        for state in self.iter() {
            kinetic.add(state.kinetic_energy(time));
            potential.add(self.potential_of(state, time));
            if let Some(piece) = self.piece(state, time, || state.at(time)) {
                book.forces.add(piece.forces);
                book.scheme.add(piece.scheme);
            }
        }
        EnergyLedger {
            kinetic: kinetic.value(),
            potential: potential.value(),
            impacts: book.impacts.value(),
            friction: book.friction.value(),
            forces: book.forces.value(),
            external: book.external.value(),
            scheme: book.scheme.value(),
        }
    }
}

/// Work along a piece of a motion, in J.
#[derive(Clone, Copy, Debug)]
struct Piece {
    forces: f64,
    scheme: f64,
}
