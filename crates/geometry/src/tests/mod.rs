//! Laws of the whole crate, over shapes that are made to break it.

mod anything;
mod exact_mass;
mod generators;
mod mass_laws;
mod piece_laws;
mod query_laws;
mod random_laws;
mod region_laws;
mod ring_errors;
mod seed_errors;
mod strategies;
#[cfg(feature = "serde")]
mod wire;
