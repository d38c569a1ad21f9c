//! Plain values that cross the door of a world: what a caller hands in, and what it reads afterwards.
//!
//! They know no body, no store and no law of motion, so that everything else may know them. Whatever is handed in is checked
//! once, where it enters. To read first: [`body_def`] and [`material`] (what a body is), [`settings`] (how a world computes),
//! [`event`] and [`report`] (what a step tells).

pub(crate) mod body_def;
pub(crate) mod contact;
pub(crate) mod error;
pub(crate) mod event;
pub(crate) mod field;
pub(crate) mod filter;
pub(crate) mod force;
pub(crate) mod id;
pub(crate) mod ix;
pub(crate) mod ledger;
pub(crate) mod material;
pub(crate) mod profile;
pub(crate) mod report;
pub(crate) mod settings;
#[cfg(feature = "serde")]
mod wire;
