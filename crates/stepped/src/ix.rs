//! Numbers of what an engine keeps: each kind has its own type, so that none is taken for another.

use core::fmt;
use core::ops::{Index, IndexMut};

use carom_geometry::Aabb;
use carom_math::Pose;

use crate::bodies::number;
use crate::outline::Outline;
use crate::pieces::{Disc, Owner, Piece};
use crate::record::{Limit, Record, Sleeper};
use crate::rows::{Contact, Line, Quad};

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
    /// A body that is awake, or all that are fixed: its place in the lists of lines.
    LineIx: Line, Quad, [Quad; 2], Pose, Limit, BodyIx, bool, f64;
    /// An island asleep.
    IslandIx: Option<Vec<Sleeper>>;
    /// A contact of two pieces.
    ContactIx: Contact;
    /// A convex piece of a body.
    PieceIx: Piece, Owner, Outline, Aabb, Disc, u8;
}

/// A contact in the list of one of its bodies: its number × 2 + side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry(u32);

impl Entry {
    pub(crate) const NONE: Self = Self(u32::MAX);

    pub(crate) const fn of(contact: ContactIx, side: usize) -> Self {
        Self(contact.0 << 1 | (side == 1) as u32)
    }

    /// Contact and side; `None` at the end of a list.
    pub(crate) fn end(self) -> Option<(ContactIx, usize)> {
        (self != Self::NONE).then_some((ContactIx(self.0 >> 1), (self.0 & 1) as usize))
    }
}

impl LineIx {
    /// Of empty lanes.
    pub(crate) const EMPTY: Self = Self(0);
    /// Of all fixed bodies.
    pub(crate) const GROUND: Self = Self(1);
}

impl PieceIx {
    /// So many from this one on.
    pub(crate) fn run(self, count: u32) -> impl Iterator<Item = Self> + Clone {
        (self.0..self.0 + count).map(Self)
    }
}
