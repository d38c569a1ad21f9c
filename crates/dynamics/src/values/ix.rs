//! Numbers of what a world keeps: each kind has its own type, so that none is taken for another.

use core::fmt;

/// Of A and of B.
pub(crate) type Two<T> = (T, T);

/// A place in a list.
pub(crate) trait Ix: Copy {
    /// No place.
    const NONE: Self;

    fn new(number: u32) -> Self;
    fn number(self) -> u32;

    fn at(self) -> usize {
        self.number() as usize
    }
}

macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(crate) struct $name(pub(super) u32);

        impl Ix for $name {
            const NONE: Self = Self(u32::MAX);

            fn new(number: u32) -> Self { Self(number) }
            fn number(self) -> u32 { self.0 }
        }

        /// As the bare number.
        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result { self.0.fmt(f) }
        }
    )*};
}

numbers! {
    /// A body.
    BodyIx
    /// A shape of a body.
    ColliderIx
    /// A pair of shapes.
    PairIx
    /// Of the bodies that move.
    MoverIx
    /// An analytic island.
    IslandIx
    /// A foreseen impact of free bodies.
    ImpactIx
}
