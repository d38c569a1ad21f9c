//! Events: what free bodies meet and when, impacts, and what becomes of them.
//!
//! To read in this order: [`free`] (free bodies, with a calendar queue that lives across steps: searches, impacts, landings),
//! [`resolve`] (an impact on what a contact island held), [`shock`] (one on a body that others hold).

pub(crate) mod free;
pub(crate) mod resolve;
pub(crate) mod shock;
