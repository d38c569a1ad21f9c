//! The boundary to the engine of `carom-stepped`: of all awake bodies in [`crate::Mode::Stepped`], of its members in
//! [`crate::Mode::Hybrid`] and [`crate::Mode::Exact`].
//!
//! ```text
//! changes ─► engine ─► sub-steps of the engine ─► motions, begins and ends of touch, sleep
//! (enter)                                         (write, touch, rest)
//! ```
//! The engine knows bodies by slots of its own. It is told what a caller changed before the sub-step that follows, and
//! motions are written once at the end of a step, or of each sub-step for a log.
//!
//! A world goes through its sub-steps in [`crate::engine`] and [`crate::members`]. To read in this order: this file, [`enter`], [`rules`],
//! [`write`], [`touch`], [`rest`]; then, for members, [`join`] (which bodies the engine moves: [`near`] and [`rush`] say which
//! join) and [`guests`] (which others it knows).

mod between;
mod enter;
mod guests;
mod join;
pub(crate) mod near;
mod rest;
pub(crate) mod rules;
pub(crate) mod rush;
mod touch;
mod within;
mod write;

use std::collections::BTreeMap;

use carom_geometry::Aabb;
use carom_math::Pose;
use carom_stepped::{Engine, EngineError, Impact, Softness, State, Touch};

use crate::store::pairs::Shapes;
use crate::store::slots::List;
use crate::values::error::SettingsError;
use crate::{BodyIx, ColliderIx, Ix, Mode, Settings};

pub(crate) use join::{Joins, MANY};
pub(crate) use within::is_blow;

/// The engine, and which bodies of the world its bodies are.
#[derive(Clone, Debug)]
pub(crate) struct Stepping {
    pub(crate) engine: Engine,
    /// The engine's name of each body, by place in the world.
    ids: List<BodyIx, Option<carom_stepped::BodyId>>,
    /// Where each member was searched around: all that rests there is a guest. By place in the world.
    covered: List<BodyIx, Aabb>,
    /// Greatest width of a shape of several convex pieces that the engine was given, in m: its box may be where no piece is.
    pub(crate) widest: f64,
    /// Shapes of several convex pieces that touch, the one of the earlier body first: how many pairs of theirs.
    touching: BTreeMap<Shapes, u32>,
    /// Bodies that fell asleep or woke since that was told.
    slept: Vec<carom_stepped::BodyId>,
    /// Scratch.
    changes: Vec<Touch>,
    impacts: Vec<Impact>,
    /// Where bodies were before the last sub-step, where that is asked for: body, pose and turn.
    places: Vec<(BodyIx, Pose, f64)>,
    /// Poses may be read within the sub-step.
    asked: bool,
}

impl Stepping {
    /// The engine of a world with these settings.
    pub(crate) fn of(settings: &Settings) -> Result<Box<Self>, SettingsError> {
        let mut engine = Engine::new(carom_stepped::Settings {
            gravity: settings.gravity,
            tick: settings.tick,
            substeps: settings.substeps_per_tick(),
            softness: softness_of(settings),
            sleep: sleep_of(settings),
            hard_discs: if settings.mode == Mode::Exact {
                MANY
            } else {
                0
            },
            ..carom_stepped::Settings::default()
        })
        .map_err(|refused| SettingsError::Stepped { refused })?;
        engine.note_impacts(true);
        Ok(Box::new(Self {
            engine,
            ids: List::default(),
            covered: List::default(),
            widest: 0.0,
            touching: BTreeMap::new(),
            slept: Vec::new(),
            changes: Vec::new(),
            impacts: Vec::new(),
            places: Vec::new(),
            asked: false,
        }))
    }

    /// Takes over what may change of a world's settings, but for gravity.
    pub(crate) fn set_settings(&mut self, old: &Settings, new: &Settings) {
        if old.contact != new.contact {
            accepted(self.engine.set_softness(softness_of(new)));
        }
        if old.sleep != new.sleep {
            accepted(self.engine.set_sleep(sleep_of(new)));
        }
    }

    /// Takes a body out of the engine.
    pub(crate) fn remove(&mut self, index: BodyIx) {
        if let Some(id) = self.id(index) {
            accepted(self.engine.remove(id));
            self.ids[index] = None;
        }
    }

    /// The engine's name of a body.
    pub(crate) fn id(&self, index: BodyIx) -> Option<carom_stepped::BodyId> {
        self.ids.get(index).copied().flatten()
    }

    /// The engine's state of a body.
    pub(crate) fn state(&self, index: BodyIx) -> Option<State> {
        self.engine.state(self.id(index)?).ok()
    }
}

/// The engine refuses nothing that it is told: all numbers were checked where they entered the world.
pub(crate) fn accepted(told: Result<(), EngineError>) {
    debug_assert!(told.is_ok(), "{told:?}");
}

const fn softness_of(settings: &Settings) -> Softness {
    let contact = &settings.contact;
    Softness {
        compliance: contact.compliance,
        frequency: contact.frequency,
        damping_ratio: contact.damping_ratio,
        over_relaxation: contact.over_relaxation,
        push_out: contact.push_out,
    }
}

fn sleep_of(settings: &Settings) -> Option<carom_stepped::Sleep> {
    settings.sleep.map(|sleep| carom_stepped::Sleep {
        speed: 0.0,
        slow: sleep.speed,
        after: sleep.time,
    })
}

/// The world's place of a body of the engine.
pub(crate) fn place(state: &State) -> BodyIx {
    body(state.tag)
}

/// The world's body with a tag.
#[expect(clippy::cast_possible_truncation, reason = "tags are places")]
fn body(tag: u64) -> BodyIx {
    BodyIx::new(tag as u32)
}

/// The world's shape that a piece of the engine is, or is a part of.
#[expect(clippy::cast_possible_truncation, reason = "tags are places")]
fn collider(tag: u64) -> ColliderIx {
    ColliderIx::new(tag as u32)
}
