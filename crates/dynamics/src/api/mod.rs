//! The public interface: what a caller makes, asks, reads and changes later; no mechanics.
//!
//! To read in this order: [`world`] (bodies in, bodies out, what is read of all), [`body`] (a body as it is read), [`query`] (rays,
//! points, boxes, casts), [`change`] (places, velocities, impulses, forces, fields), [`setters`] (what a body was inserted with,
//! and the settings), [`pair_rules`] (what is said of two bodies alone). Plain values lie in [`crate::values`].

pub(crate) mod body;
mod change;
mod contact;
mod pair_rules;
pub(crate) mod query;
mod setters;
pub(crate) mod world;
