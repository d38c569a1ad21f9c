//! Small worlds with a known answer.

mod projectile;
mod trial;

pub use trial::{Run, Trial};

use crate::engine::EngineError;

/// What a case measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Metric {
    /// As the tables write it.
    pub name: &'static str,
    /// SI, or `1` for a ratio.
    pub unit: &'static str,
    /// How to read it.
    pub kind: Kind,
}

/// How a number is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 0 is right: it goes into charts, and its order of convergence is looked at.
    Error,
    /// A measured value; the text says what is right.
    Value,
}

/// Numbers by the name of their metric.
pub type Values = Vec<(&'static str, f64)>;

/// A world with a known answer.
#[derive(Debug)]
pub struct Case {
    /// Its number in the list of nineteen and what it is about: `01_projectile`.
    pub name: &'static str,
    /// In a sentence.
    pub about: &'static str,
    /// What comes out; the first is the one of the chart.
    pub metrics: &'static [Metric],
    /// Builds, steps and reads a world.
    pub measure: fn(&mut Trial) -> Result<Values, EngineError>,
}

/// All cases, in order.
pub const CASES: &[Case] = &[projectile::CASE];
