//! What can be wrong with what enters.

use carom_math::Pose;
use thiserror::Error;

use crate::BodyId;

/// Why a value was refused; the engine is as it was.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EngineError {
    /// A number is out of its range.
    #[error("{field} is {value}: it must be {allowed}")]
    Value {
        /// The field, as in `BodyInput::mass`.
        field: &'static str,
        /// What it was.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A body that moves has a piece without end.
    #[error("piece {piece} is a half-plane: only a fixed body can have one")]
    Unbounded {
        /// Index of the piece.
        piece: usize,
    },
    /// No body has this id: it was removed. An id of another engine is refused only where no body here has an equal one.
    #[error("{0:?} is not in this engine")]
    Stale(BodyId),
}

/// Refuses what is not a finite number.
pub(crate) fn finite(field: &'static str, value: f64) -> Result<(), EngineError> {
    check(field, value, value.is_finite(), "finite")
}

/// Refuses a pose with what is not a finite number; `fields` are those of x, y, cosine and sine.
pub(crate) fn finite_pose(fields: [&'static str; 4], pose: Pose) -> Result<(), EngineError> {
    let (at, turn) = (pose.position, pose.rotation);
    let values = [at.x, at.y, turn.cos(), turn.sin()];
    (fields.into_iter().zip(values)).try_for_each(|(field, value)| finite(field, value))
}

/// Refuses what is not a finite number above zero.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), EngineError> {
    let good = value.is_finite() && value > 0.0;
    check(field, value, good, "finite and above 0")
}

/// Refuses what is not a finite number, or below zero.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<(), EngineError> {
    let good = value.is_finite() && value >= 0.0;
    check(field, value, good, "finite and not below 0")
}

/// Refuses what is not `good`.
pub(crate) fn check(
    field: &'static str,
    value: f64,
    good: bool,
    allowed: &'static str,
) -> Result<(), EngineError> {
    if good {
        Ok(())
    } else {
        Err(EngineError::Value {
            field,
            value,
            allowed,
        })
    }
}
