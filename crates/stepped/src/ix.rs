//! Numbers of what an engine keeps: each kind has its own type, so that none is taken for another.

use core::fmt;
use core::ops::{Index, IndexMut};

use carom_geometry::Aabb;

use crate::bodies::number;
use crate::outline::Outline;
use crate::pieces::{Disc, Owner, Piece};
use crate::record::Record;

/// Types of numbers, and what the lists hold that are read by them.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident: $($of:ty),*;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(crate) struct $name(pub(crate) u32);

        impl $name {
            pub(crate) const NONE: Self = Self(u32::MAX);

            pub(crate) const fn new(at: usize) -> Self { Self(number(at)) }
            pub(crate) const fn at(self) -> usize { self.0 as usize }
        }

        /// As the bare number.
        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result { self.0.fmt(f) }
        }

        $(
            impl Index<$name> for Vec<$of> {
                type Output = $of;

                #[inline]
                fn index(&self, place: $name) -> &$of { &self[place.at()] }
            }

            impl IndexMut<$name> for Vec<$of> {
                #[inline]
                fn index_mut(&mut self, place: $name) -> &mut $of { &mut self[place.at()] }
            }
        )*
    )*};
}

numbers! {
    /// A body: its slot, which is taken again once it is removed.
    BodyIx: Record;
    /// A convex piece of a body.
    PieceIx: Piece, Owner, Outline, Aabb, Disc, u8;
}

impl PieceIx {
    /// So many from this one on.
    pub(crate) fn run(self, count: u32) -> impl Iterator<Item = Self> + Clone {
        (self.0..self.0 + count).map(Self)
    }
}
