//! Names of bodies that outlive them.

use core::fmt;

use crate::BodyIx;

/// A body of a world: small, copyable, never dangling.
///
/// The generation tells a removed body from the one that took its place. Two worlds that were built alike, and a world and its
/// clone, have equal ids for equal bodies, so that their events can be compared: an id of another world is not told from
/// one of this world's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    pub(crate) index: BodyIx,
    pub(crate) generation: u32,
}

impl BodyId {
    /// Position of the body in its world, below the number of bodies that were ever there at once.
    #[must_use]
    pub const fn index(self) -> usize {
        self.index.0 as usize
    }
}

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "body {}", self.index.0)?;
        if self.generation > 0 {
            write!(f, " (generation {})", self.generation)?;
        }
        Ok(())
    }
}
