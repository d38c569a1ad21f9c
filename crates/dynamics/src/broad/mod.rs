//! Broad phase: which bodies may meet, by boxes and circles swept over their motions.
//!
//! To read in this order: [`tree`] (bodies that stand, and pairs of those in contact), [`grid`] (free bodies over the
//! cells that they sweep), [`free_fall_frame`] (the frame in which these have constant velocities), [`window`] (from when to when
//! two things are near enough to meet).

pub(crate) mod free_fall_frame;
pub(crate) mod grid;
pub(crate) mod tree;
pub(crate) mod window;
