//! What a world keeps of its bodies and pairs, and the doors through which it changes.
//!
//! To read in this order: [`state`] (a body, and the colliders that carry its shapes), [`bodies`] (all of them; its `change` is
//! the one door through which a motion changes), [`regime`] (which method moves a body, and which transitions there are),
//! [`pairs`] (pairs of shapes, and what they remember from sub-step to sub-step). The others are parts of these.

pub(crate) mod bodies;
mod damping;
mod few;
mod history;
mod left_paths;
pub(crate) mod mass;
mod moved;
pub(crate) mod pairs;
pub(crate) mod regime;
pub(crate) mod state;
mod tell;
pub(crate) mod uncommon;
