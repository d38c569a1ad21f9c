//! How long a chaotic scene can be predicted.

use carom_scenes::{PlainKind, PlainScene};

use super::worlds::larger;
use super::{Run, Trial};
use crate::engine::EngineError;

/// How far the first moving body is shifted, in m: in double precision.
const SHIFT: f64 = 1e-12;

/// In single precision, where 1e-12 m is no other place.
const SHIFT_SINGLE: f64 = 1e-5;

/// From here on two runs are not the same any more, in m.
const PARTED: f64 = 1e-3;

/// The last time up to `end`, in s, at which a shift of one body at the start has moved no body by 1 mm.
///
/// The shift is 1e-12 m along x of the scene's first dynamic body, 1e-5 m for engines in single precision. After this
/// time only invariants tell anything. Not metered.
///
/// # Errors
/// If the engine is not built in or refuses the scene.
pub(super) fn horizon(trial: &Trial, scene: &PlainScene, end: f64) -> Result<f64, EngineError> {
    let mut shifted = scene.clone();
    let mut bodies = shifted.bodies.iter_mut();
    if let Some(body) = bodies.find(|body| body.kind == PlainKind::Dynamic) {
        body.position.x += if trial.engine().is_single() {
            SHIFT_SINGLE
        } else {
            SHIFT
        };
    }
    let mut run = trial.reference(scene, trial.hz())?;
    let mut other = trial.reference(&shifted, trial.hz())?;
    let mut together = 0.0;
    while run.goes_on(end) {
        run.step();
        other.step();
        let apart = distance(&run, &other, scene);
        if apart >= PARTED || apart.is_nan() {
            break;
        }
        together = run.time();
    }
    Ok(together)
}

/// The largest distance between the places of a body in two runs, in m.
pub(super) fn distance(a: &Run<'_>, b: &Run<'_>, scene: &PlainScene) -> f64 {
    let distances =
        dynamic_bodies(scene).map(|body| a.state(body).position.distance(b.state(body).position));
    distances.fold(0.0, larger)
}

/// Indices of the bodies that move.
pub(super) fn dynamic_bodies(scene: &PlainScene) -> impl Iterator<Item = usize> {
    let bodies = scene.bodies.iter().enumerate();
    bodies
        .filter(|(_, body)| body.kind == PlainKind::Dynamic)
        .map(|(index, _)| index)
}
