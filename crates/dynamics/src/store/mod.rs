//! What a world keeps of its bodies and pairs, and the doors through which it changes.
//!
//! To read in this order: [`state`] (a body, and the colliders that carry its shapes), [`now`] (what its law of flight says), [`bodies`] (all of them; its `change` is
//! the one door through which a motion changes), [`regime`] (which method moves a body, and which transitions there are),
//! [`pairs`] (pairs of shapes, and what they remember). The others are parts of these: of a body
//! [`mass`], [`membership`] in an island, the [`course`] of a free one ([`swept`], [`zeno`]), what is [`uncommon`]; of all bodies
//! [`pull`], [`history`] and [`moved`]. [`tell`] has the events that follow from a pair, [`clock`] the grid of
//! sub-steps; [`slots`] are lists by number, and numbered places as pairs and islands have them.

pub(crate) mod bodies;
pub(crate) mod clock;
pub(crate) mod course;
mod damping;
pub(crate) mod few;
mod history;
pub(crate) mod mass;
pub(crate) mod membership;
pub(crate) mod moved;
pub(crate) mod pairs;
pub(crate) mod pull;
pub(crate) mod regime;
pub(crate) mod slots;
pub(crate) mod state;
pub(crate) mod swept;
mod tell;
pub(crate) mod uncommon;
pub(crate) mod zeno;
