//! What carom's commands have in common: how they end, tell, and write.
//!
//! `xtask` and the laboratory's driver stand on it, so that a user meets one behaviour: exit code 0, 1, 2, 130 or 143, one line
//! for an error, Ctrl-C that keeps what is done, and files that are whole or not there.

pub mod clock;
pub mod exit;
pub mod files;
pub mod interrupt;
pub mod number;
pub mod out;
pub mod progress;
mod usage;

pub use usage::usage;
