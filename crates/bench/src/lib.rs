//! Engines side by side: run time against error.
//!
//! Nothing is measured here yet. The crate has its place outside the default members, so that
//! neither of the README's two commands will ever build another engine.
