//! What an impact does: pure functions from velocities before to velocities after.

mod body;
mod law;
mod routh;
#[cfg(test)]
mod tests;

pub(crate) use body::Response;
pub use body::{ImpactBody, ImpactContact, Outcome};
pub use law::{ImpactLaw, newton, poisson, resolve, stronge};
