//! What a run did to physics, judged by the same `f64` code for every engine.

use carom_scenes::PlainScene;
use serde::{Deserialize, Serialize};

use crate::engine::{Engine, State};

/// The verdict on a state of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// Kinetic, rotational and potential energy of the dynamic bodies, with the engine's masses, in J.
    pub energy: f64,
    /// Deepest overlap of two shapes of different bodies, at least one of them dynamic, in m, ≥ 0.
    pub overlap_max: f64,
    /// Mean over the overlapping pairs, in m.
    pub overlap_mean: f64,
    /// How many pairs overlap.
    pub overlap_pairs: usize,
    /// Dynamic bodies whose centre is not strictly inside the scene's region.
    pub escaped: usize,
    /// Bodies with a number that is not finite.
    pub non_finite: usize,
}

/// Judges where an engine's bodies are.
#[must_use]
pub fn judge(scene: &PlainScene, engine: &dyn Engine) -> Quality {
    let states: Vec<State> = (0..scene.bodies.len()).map(|i| engine.state(i)).collect();
    let finite = |state: &State| {
        let numbers = [
            state.position.x,
            state.position.y,
            state.angle,
            state.velocity.x,
            state.velocity.y,
            state.spin,
        ];
        numbers.iter().all(|x| x.is_finite())
    };
    Quality {
        non_finite: states.iter().filter(|state| !finite(state)).count(),
        ..Quality::default()
    }
}
