//! What a run did to physics, assessed by the same `f64` code for every engine.
//!
//! Nothing here is shared with an engine: the separating-axis rule and the grid of candidates are its own.

mod grid;
mod overlap;
mod solid;
#[cfg(test)]
mod tests;
mod unrest;

use carom_math::{Vec2, cross};
use carom_scenes::{PlainBody, PlainKind, PlainScene};
use serde::{Deserialize, Serialize};

use self::overlap::Overlaps;
use crate::engine::{Body, Engine, State};

pub use unrest::Unrest;

/// The verdict on a state of a scene. Bodies that are not finite count in [`Quality::non_finite`] alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Kinetic, rotational and potential energy of the dynamic bodies, with the engine's masses, in J.
    #[serde(with = "crate::number")]
    pub energy: f64,
    /// Of the dynamic bodies, in kg m/s.
    #[serde(with = "crate::number::pair")]
    pub momentum: [f64; 2],
    /// Of the dynamic bodies about the origin, in kg m²/s.
    #[serde(with = "crate::number")]
    pub angular_momentum: f64,
    /// Deepest overlap of two shapes of different bodies, at least one of them dynamic, in m, ≥ 0. Segments are left out.
    #[serde(with = "crate::number")]
    pub overlap_max: f64,
    /// Mean over the overlapping pairs, in m.
    #[serde(with = "crate::number")]
    pub overlap_mean: f64,
    /// How many pairs of shapes overlap.
    pub overlap_pairs: usize,
    /// Highest centre of a dynamic body, in m: whether a pile still stands.
    #[serde(with = "crate::number")]
    pub highest: f64,
    /// Dynamic bodies with a centre not strictly inside the scene's region.
    pub escaped: usize,
    /// Bodies with a number, or an energy, that is not finite.
    pub non_finite: usize,
}

/// Where an engine's bodies are at an instant, and what they weigh: to be assessed later.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    states: Vec<State>,
    masses: Vec<Body>,
}

impl Snapshot {
    /// Reads the first `bodies` bodies of an engine.
    #[must_use]
    pub fn of(engine: &dyn Engine, bodies: usize) -> Self {
        Self {
            states: (0..bodies).map(|i| engine.state(i)).collect(),
            masses: (0..bodies).map(|i| engine.body(i)).collect(),
        }
    }

    /// The verdict.
    #[must_use]
    pub fn assess(&self, scene: &PlainScene) -> Quality {
        let mut verdict = Quality {
            highest: f64::NEG_INFINITY,
            ..Quality::default()
        };
        let mut momentum = Vec2::ZERO;
        for ((body, state), mass) in scene.bodies.iter().zip(&self.states).zip(&self.masses) {
            let energy = energy(scene, state, *mass);
            if !finite(state) || !energy.is_finite() {
                verdict.non_finite += 1;
            } else if body.kind == PlainKind::Dynamic {
                verdict.energy += energy;
                momentum += mass.mass * state.velocity;
                verdict.angular_momentum += mass.mass * cross(state.position, state.velocity);
                verdict.angular_momentum += mass.inertia * state.spin;
                verdict.highest = verdict.highest.max(state.position.y);
                verdict.escaped += usize::from(outside(scene, state.position));
            }
        }
        verdict.momentum = momentum.to_array();
        if !verdict.highest.is_finite() {
            verdict.highest = 0.0;
        }

        let overlaps = Overlaps::of(scene, &self.states);
        verdict.overlap_max = overlaps.deepest();
        verdict.overlap_mean = overlaps.mean();
        verdict.overlap_pairs = overlaps.pairs();
        verdict
    }

    /// Farthest that the centre of a dynamic body is from where it is in a later snapshot, in m.
    #[must_use]
    pub fn drift(&self, later: &Self, scene: &PlainScene) -> f64 {
        let moves = scene.bodies.iter().zip(&self.states).zip(&later.states);
        moves
            .filter(|((body, from), to)| is_assessed(body, from) && finite(to))
            .map(|((_, from), to)| from.position.distance(to.position))
            .fold(0.0, f64::max)
    }
}

/// Assesses where an engine's bodies are.
#[must_use]
pub fn assess(scene: &PlainScene, engine: &dyn Engine) -> Quality {
    Snapshot::of(engine, scene.bodies.len()).assess(scene)
}

/// m v²/2 + I ω²/2 − m g·x, in J.
fn energy(scene: &PlainScene, state: &State, body: Body) -> f64 {
    let translation = 0.5 * body.mass * state.velocity.length_squared();
    let rotation = 0.5 * body.inertia * state.spin * state.spin;
    translation + rotation - body.mass * scene.gravity.dot(state.position)
}

fn outside(scene: &PlainScene, centre: Vec2) -> bool {
    scene.region.is_some_and(|[low, high]| {
        !(low.x < centre.x && centre.x < high.x && low.y < centre.y && centre.y < high.y)
    })
}

fn is_assessed(body: &PlainBody, state: &State) -> bool {
    body.kind == PlainKind::Dynamic && finite(state)
}

fn finite(state: &State) -> bool {
    state.position.is_finite()
        && state.velocity.is_finite()
        && state.angle.is_finite()
        && state.spin.is_finite()
}
