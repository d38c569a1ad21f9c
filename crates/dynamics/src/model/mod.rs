//! Plain data and pure functions of two bodies: where they touch, how they move against each other there, how hard they press.
//!
//! To read in this order: [`narrow`] (contacts of a pair at an instant, and what counts as touch, rest and rounding), [`ghost`]
//! (contacts with hidden sides of flush fixed pieces, which do not exist), [`edges`] (what of a hull lies along a contact),
//! [`approach`] (whether a point opens, stays or closes), [`gap`] (the second derivative of a gap), [`press`] (how hard two bodies
//! press, by turning too), [`graph`] (which bodies touch, and which hang together).

pub(crate) mod approach;
pub(crate) mod edges;
pub(crate) mod gap;
pub(crate) mod ghost;
pub(crate) mod graph;
pub(crate) mod narrow;
pub(crate) mod press;
