//! Events: what free bodies meet and when, impacts, and what becomes of them.
//!
//! To read in this order: [`free`] (free bodies, with a calendar queue that lives across steps: searches, impacts, landings),
//! [`event_queue`] and [`predict`] (impacts within a sub-step: of bodies that it moves, in order of time and pair; what closes
//! again by a [`micro_bounce`]), [`resolve`] (an impact that is due), [`shock`] (one on a body that others hold), [`wake`]
//! (what it wakes).

pub(crate) mod event_queue;
pub(crate) mod free;
mod micro_bounce;
pub(crate) mod predict;
pub(crate) mod resolve;
pub(crate) mod shock;
pub(crate) mod wake;
