//! Which method moves a body now: one word for what a body's flags say together, and which of their combinations there are.

use crate::closed::Membership;
use crate::free::Course;
use crate::state::BodyState;
use crate::{BodyKind, Mode, World};

/// What moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Regime {
    /// Nothing, ever.
    Fixed,
    /// The velocity that the caller gave it.
    Kinematic,
    /// Its law of flight, until its next event.
    Free,
    /// The closed form of its contact island, until its contact mode changes.
    Analytic,
    /// Sub-steps, pair by pair.
    Held,
    /// Sub-steps of the engine.
    Stepped,
    /// Nothing, until it is touched.
    Asleep,
}

impl Regime {
    /// What a body's flags say together.
    ///
    /// # Errors
    /// What contradicts itself.
    pub(crate) fn of(state: &BodyState, mode: Mode) -> Result<Self, &'static str> {
        let (free, moves) = (state.course.is_free, state.course.moves_analytically);
        let closed = state.membership.is_closed();
        if state.kind != BodyKind::Dynamic {
            let held =
                state.in_engine || state.asleep || state.rests_analytically || moves || closed;
            return match (held, state.kind) {
                (true, _) => Err("what is not dynamic is in no island, and does not sleep"),
                (_, BodyKind::Fixed) if free => Err("a fixed body is not free"),
                (_, BodyKind::Fixed) => Ok(Self::Fixed),
                _ => Ok(Self::Kinematic),
            };
        }
        if state.rests_analytically && !(state.asleep && closed) {
            return Err("a body at analytic rest sleeps in an analytic island");
        }
        if moves && !(free && closed) {
            return Err("a body in analytic motion is free in an analytic island");
        }
        if state.asleep {
            return match free || state.in_engine && closed {
                true => Err("a sleeper is not free, nor in the engine in an analytic island"),
                false => Ok(Self::Asleep),
            };
        }
        if state.in_engine {
            return match free || closed {
                true => Err("a stepped body is neither free nor analytic"),
                false => Ok(Self::Stepped),
            };
        }
        if free && closed && !moves {
            return Err("a free body of an analytic island is in analytic motion");
        }
        Ok(match (closed, free, mode) {
            (true, ..) => Self::Analytic,
            (_, true, _) => Self::Free,
            (_, _, Mode::Stepped) => Self::Stepped,
            _ => Self::Held,
        })
    }
}

impl BodyState {
    /// Nothing moves it until it is touched: asleep, or in an analytic island at rest.
    pub(crate) const fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Its analytic island rests: treated as asleep, but reported awake to the caller until its time.
    pub(crate) const fn rests_analytically(&self) -> bool {
        self.rests_analytically
    }

    /// Moves with its analytic island, without sub-steps, until the island's mode changes.
    pub(crate) const fn moves_analytically(&self) -> bool {
        self.course.moves_analytically
    }

    /// Moves in closed form from event to event: free, kinematic, or in analytic motion.
    pub(crate) const fn goes_by_events(&self) -> bool {
        self.course.is_free
    }

    /// Moved by the engine in hybrid mode, or asleep in it.
    pub(crate) const fn in_engine(&self) -> bool {
        self.in_engine
    }

    /// What is new where it is, and awake, flies if it moves: in [`Mode::Stepped`] the engine has it.
    pub(crate) fn arrive(&mut self, mode: Mode) {
        self.course.is_free = match self.kind {
            BodyKind::Fixed => false,
            BodyKind::Kinematic => true,
            BodyKind::Dynamic => mode != Mode::Stepped,
        };
    }

    /// What was taken out of the world moves no more.
    pub(crate) fn vanish(&mut self) {
        self.kind = BodyKind::Fixed;
        self.course = Course::default();
    }

    /// Nothing holds it any more.
    pub(crate) fn take_off(&mut self) {
        self.course.is_free = true;
    }

    /// Something holds it from now on, or its analytic island is given back to the sub-steps.
    pub(crate) fn land(&mut self) {
        (self.course.is_free, self.course.moves_analytically) = (false, false);
        self.course.void_searches();
    }

    /// It belongs to an analytic island.
    pub(crate) fn enter_island(&mut self, membership: Membership) {
        self.membership = membership;
    }

    /// Its analytic island is no more.
    pub(crate) fn leave_island(&mut self) {
        self.membership = Membership::default();
    }

    /// Its analytic island leaves the sub-steps, and moves.
    pub(crate) fn begin_analytic_motion(&mut self) {
        (self.course.is_free, self.course.moves_analytically) = (true, true);
    }

    /// Its analytic island leaves the sub-steps, and rests.
    pub(crate) fn begin_analytic_rest(&mut self) {
        (self.asleep, self.rests_analytically) = (true, true);
    }

    /// The engine moves it from now on.
    pub(crate) fn join(&mut self) {
        self.in_engine = true;
    }

    /// The engine moves it no more.
    pub(crate) fn leave(&mut self) {
        self.in_engine = false;
    }

    /// It sleeps from now on, where it is; whether it left the sub-steps by that.
    pub(crate) fn fall_asleep(&mut self) -> bool {
        self.asleep = true;
        !core::mem::take(&mut self.rests_analytically)
    }

    /// What moved a sleeper before moves it again; whether the caller took it for asleep.
    pub(crate) fn wake(&mut self) -> bool {
        self.asleep = false;
        !core::mem::take(&mut self.rests_analytically)
    }
}

impl World {
    /// Whether every body is moved by one method, in builds that check so.
    pub(crate) fn check_regimes(&self) {
        if cfg!(debug_assertions) {
            for state in self.bodies.iter() {
                self.check_regime(state.id.index);
            }
        }
    }

    /// Whether a body is moved by one method, in builds that check so.
    pub(crate) fn check_regime(&self, index: u32) {
        if cfg!(debug_assertions) {
            let state = self.bodies.get(index);
            if let Err(why) = Regime::of(state, self.settings.mode) {
                panic!("{}: {why}", state.id);
            }
        }
    }
}
