//! What an impact does: pure functions from velocities before to velocities after.

mod body;
mod law;
pub(crate) mod project;
mod routh;
mod several;
#[cfg(test)]
mod several_tests;
#[cfg(test)]
mod tests;

pub(crate) use body::Response;
pub use body::{ImpactBody, ImpactContact, Outcome};
pub use law::{ImpactLaw, newton, poisson, resolve, stronge};
pub use several::{SharedContact, SharedOutcome, blend, generalised_reflections, newton_lcp};
