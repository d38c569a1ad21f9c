//! Small worlds with a known answer.

mod bounce;
mod bullets;
mod corner;
mod cradle;
mod discs;
mod drop;
mod eccentric;
mod far;
mod friction;
mod galperin;
mod gas;
mod horizon;
mod load;
mod metric;
mod order;
mod pairs;
mod pile;
mod plan;
mod projectile;
mod refined;
mod rolling;
mod slivers;
mod spin;
mod stack;
#[cfg(test)]
mod tests;
mod thesis;
mod trial;
mod worlds;

pub use metric::{Kind, Metric};
pub use order::order;
pub use plan::{RATES, points};
pub use trial::{Run, Trial};

use crate::engine::EngineError;

/// Numbers by the name of their metric; one that is missing is said as [`Metric::missing`] has it.
pub type Values = Vec<(String, f64)>;

/// A world with a known answer.
#[derive(Debug)]
pub struct Case {
    /// Its number in the list and what it is about: `01_projectile`.
    pub name: &'static str,
    /// In a sentence.
    pub about: &'static str,
    /// What comes out; the first is the one of the chart.
    pub metrics: &'static [Metric],
    /// Steps per simulated second at which it is run.
    pub rates: &'static [u32],
    /// Whether it is run with several numbers of sub-steps as well.
    pub sweeps_substeps: bool,
    /// The rates of a quick run; none: left out of it.
    pub quick: &'static [u32],
    /// Builds, steps and reads a world.
    pub measure: fn(&mut Trial) -> Result<Values, EngineError>,
}

/// All cases, in order.
pub const CASES: &[Case] = &[
    projectile::CASE,
    bounce::CASE,
    drop::CASE,
    discs::CASE,
    corner::CASE,
    eccentric::CASE,
    galperin::CASE,
    friction::CASE,
    rolling::CASE,
    cradle::CASE,
    spin::CASE,
    gas::POLYGONS,
    stack::CASE,
    load::CASE,
    bullets::CASE,
    slivers::CASE,
    far::CASE,
    gas::DISCS,
    pairs::CASE,
    thesis::CASE,
    pile::CASE,
];
