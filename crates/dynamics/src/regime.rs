//! Which method moves a body now: one word for what a body's flags say together, and which of their combinations there are.

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
        let (flies, glides) = (state.course.flies, state.course.glides);
        let closed = state.membership.is_closed();
        if state.kind != BodyKind::Dynamic {
            let held = state.in_engine || state.asleep || state.dozes || glides || closed;
            return match (held, state.kind) {
                (true, _) => Err("what is not dynamic is in no island, and does not sleep"),
                (_, BodyKind::Fixed) if flies => Err("what is fixed does not fly"),
                (_, BodyKind::Fixed) => Ok(Self::Fixed),
                _ => Ok(Self::Kinematic),
            };
        }
        if state.dozes && !(state.asleep && closed) {
            return Err("what dozes sleeps in an analytic island");
        }
        if glides && !(flies && closed) {
            return Err("what glides flies in an analytic island");
        }
        if state.asleep {
            return match flies || state.in_engine && closed {
                true => Err("what sleeps does not fly, nor in the engine in an analytic island"),
                false => Ok(Self::Asleep),
            };
        }
        if state.in_engine {
            return match flies || closed {
                true => Err("what is stepped neither flies nor is analytic"),
                false => Ok(Self::Stepped),
            };
        }
        if flies && closed && !glides {
            return Err("what flies in an analytic island glides");
        }
        Ok(match (closed, flies, mode) {
            (true, ..) => Self::Analytic,
            (_, true, _) => Self::Free,
            (_, _, Mode::Stepped) => Self::Stepped,
            _ => Self::Held,
        })
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
