//! Gives bodies their motions by the laws that they fly by.
//!
//! To read in this order: [`flight`] (what a body is given of its flight: the parabola itself, or a piece of a law),
//! [`first_touch`] (impacts of what flies by laws, found by such parabolas).

pub(crate) mod first_touch;
pub(crate) mod flight;
#[cfg(test)]
mod tests;
