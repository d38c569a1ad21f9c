//! The C interfaces of Box2D v3 and Chipmunk, made safe.
//!
//! Only what the laboratory needs: a world is built from a [`PlainScene`](carom_scenes::PlainScene), stepped, and read.
//! Bodies are named by the order in which they were added. All `unsafe` of the workspace is in this crate; each engine
//! is a feature, and without features it is empty.

#[cfg(feature = "box2d")]
pub mod box2d;
#[cfg(any(feature = "box2d", feature = "chipmunk"))]
mod checked;
#[cfg(feature = "chipmunk")]
pub mod chipmunk;

#[cfg(any(feature = "box2d", feature = "chipmunk"))]
pub use state::State;

#[cfg(any(feature = "box2d", feature = "chipmunk"))]
mod state {
    use carom_math::Vec2;

    /// A body now, as its engine has it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct State {
        /// Centre of mass, in m.
        pub centre: Vec2,
        /// In rad.
        pub angle: f64,
        /// Of the centre of mass, in m/s.
        pub velocity: Vec2,
        /// In rad/s.
        pub spin: f64,
    }
}
