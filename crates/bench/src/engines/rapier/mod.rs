//! Rapier, in both precisions from one source.

#[cfg(feature = "rapier-f64")]
mod double;
#[cfg(feature = "rapier")]
mod single;

#[cfg(feature = "rapier-f64")]
pub(super) use double::open as open_double;
#[cfg(feature = "rapier")]
pub(super) use single::open as open_single;
