//! What can be wrong with a value at the door of a world.

use carom_geometry::ShapeError;
use carom_math::Vec2;
use thiserror::Error;

use crate::BodyId;

/// Why a body was not made or not changed. The world is as it was.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BodyError {
    /// A number is NaN or infinite.
    #[error("{field} is {value}, not a finite number")]
    NotFinite {
        /// The field of the definition or the argument.
        field: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number lies beyond what a world computes with.
    #[error("{field} is {value:e}, beyond the limit of {limit:e}")]
    TooLarge {
        /// The field of the definition or the argument.
        field: &'static str,
        /// What it was.
        value: f64,
        /// Largest magnitude that is accepted.
        limit: f64,
    },
    /// A number must not be negative.
    #[error("{field} is {value}, below 0")]
    Negative {
        /// The field of the definition or the argument.
        field: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number must be above zero.
    #[error("{field} is {value}, not above 0")]
    NotPositive {
        /// The field of the definition or the argument.
        field: &'static str,
        /// What it was.
        value: f64,
    },
    /// Restitution must lie in 0..1.
    #[error("restitution is {value}, outside 0..1")]
    Restitution {
        /// What it was.
        value: f64,
    },
    /// A body needs at least one shape.
    #[error("the body has no shape")]
    NoShape,
    /// The shapes of a moving body have no mass, and none is given.
    #[error("the shapes of the moving body have no mass (density {density}), and none is given")]
    NoMass {
        /// Density of the first shape, in kg/m².
        density: f64,
    },
    /// A half-plane has no end and no mass: only a body that never moves can wear it.
    #[error("shape {shape} is a half-plane, which only a fixed body can have")]
    HalfPlaneMoves {
        /// Which of the body's shapes.
        shape: usize,
    },
    /// The id belongs to a body that was removed, or to another world that had more bodies (see [`BodyId`]).
    #[error("{0} is not in this world")]
    Stale(BodyId),
    /// Only a kinematic body goes where it is told.
    #[error("{0} is not kinematic")]
    NotKinematic(BodyId),
    /// The body has fewer shapes.
    #[error("{body} has {count} shapes: there is no shape {shape}")]
    NoSuchShape {
        /// The body.
        body: BodyId,
        /// Which shape was asked for, from 0.
        shape: usize,
        /// How many there are.
        count: usize,
    },
    /// A pair needs two bodies.
    #[error("{0} cannot form a pair with itself")]
    SameBody(BodyId),
    /// There is no room for more bodies or shapes.
    #[error("a world holds at most {limit} {what}")]
    Full {
        /// Bodies or shapes.
        what: &'static str,
        /// How many.
        limit: usize,
    },
    /// The shape is not valid where it is used.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// Why a world was not made, or its settings were not changed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A number is NaN or infinite.
    #[error("settings.{field} is {value}, not a finite number")]
    NotFinite {
        /// The field.
        field: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number must be above zero.
    #[error("settings.{field} is {value}, not above 0")]
    NotPositive {
        /// The field.
        field: &'static str,
        /// What it was.
        value: f64,
    },
    /// A number lies outside its range.
    #[error("settings.{field} is {value}, outside {low}..{high}")]
    OutOfRange {
        /// The field.
        field: &'static str,
        /// What it was.
        value: f64,
        /// Smallest accepted value.
        low: f64,
        /// Largest accepted value.
        high: f64,
    },
    /// These cannot change once a world is made: [`World::set_settings`](crate::World::set_settings).
    #[error("{} cannot change once a world is made: make another one", named(.fields))]
    Fixed {
        /// The fields that differ from the world's.
        fields: Vec<&'static str>,
    },
    /// The stepped engine cannot do with it.
    #[error("settings: {refused}")]
    Stepped {
        /// What the engine says.
        refused: carom_stepped::EngineError,
    },
}

fn named(fields: &[&str]) -> String {
    let all: Vec<_> = fields
        .iter()
        .map(|field| format!("settings.{field}"))
        .collect();
    all.join(", ")
}

/// Largest coordinate, speed, spin or component of gravity that a world accepts, in its unit.
///
/// Above it squares of differences lose the last metre: 1e12² · 2⁻⁵² is 2e8.
pub const WORLD_LIMIT: f64 = 1e12;

pub(crate) fn check_finite(field: &'static str, value: f64) -> Result<(), BodyError> {
    check_limit(field, value, WORLD_LIMIT)
}

/// Largest mass or moment of inertia that a world accepts, in kg or kg·m²: half a sun; energies stay
/// finite at the largest speed.
const MASS_LIMIT: f64 = 1e30;

pub(crate) fn check_mass(field: &'static str, value: f64) -> Result<(), BodyError> {
    check_limit(field, value, MASS_LIMIT)
}

fn check_limit(field: &'static str, value: f64, limit: f64) -> Result<(), BodyError> {
    if !value.is_finite() {
        Err(BodyError::NotFinite { field, value })
    } else if value.abs() > limit {
        Err(BodyError::TooLarge {
            field,
            value,
            limit,
        })
    } else {
        Ok(())
    }
}

pub(crate) fn check_not_negative(field: &'static str, value: f64) -> Result<(), BodyError> {
    check_finite(field, value)?;
    if value < 0.0 {
        return Err(BodyError::Negative { field, value });
    }
    Ok(())
}

pub(crate) fn check_positive(field: &'static str, value: f64) -> Result<(), BodyError> {
    if value <= 0.0 {
        return Err(BodyError::NotPositive { field, value });
    }
    Ok(())
}

pub(crate) fn check_vec2(
    x_field: &'static str,
    y_field: &'static str,
    v: Vec2,
) -> Result<(), BodyError> {
    check_finite(x_field, v.x)?;
    check_finite(y_field, v.y)
}
