//! Contact islands in closed form: what slides, rolls, tips or rests moves without sub-steps until its contact mode changes.
//!
//! To read in this order: [`touching`] (which bodies hang together by touch at an instant, as plain data), [`modes`] (rows that
//! do not change with time: accelerations, forces, modes and the next change, as pure functions), [`tipping`] (rows that turn
//! with their bodies: the same with dense output), [`islands`] (such islands in a world: where they begin, move, rest and end).

pub(crate) mod islands;
pub(crate) mod modes;
pub(crate) mod tipping;
pub(crate) mod touching;
