//! What an impact does: pure functions from velocities before to velocities after.

mod body;
mod coulomb;
#[cfg(test)]
mod heaps;
mod held;
mod law;
mod pivots;
pub(crate) mod project;
mod restitution;
mod rough;
#[cfg(test)]
mod rough_tests;
mod routh;
mod rows;
mod several;
#[cfg(test)]
mod several_tests;
mod sweeps;
#[cfg(test)]
mod tests;

pub use body::{ImpactBody, ImpactContact, Outcome};
pub(crate) use held::held;
pub use law::{ImpactLaw, jam, newton, poisson, resolve, stronge};
pub use several::{
    Several, SharedContact, SharedOutcome, blend, generalised_reflections, newton_lcp, several,
};
pub(crate) use sweeps::{Moving, Sweeper, Swept};
