//! Where a body is by its law: free flight in closed form in a uniform field, with damping and about a Newtonian centre; by an
//! integrator of order 15 in any other field.
//!
//! To read in this order: [`law`] (the law that is kept beside a motion, whichever it is), [`damped`], [`kepler`] and
//! [`integrate`] (the laws themselves), [`osculating`] (the parabola that touches a law, and how far it is off), [`flight`] (what
//! a body is given of it), [`first_touch`] (impacts of what flies by a law).

mod damped;
pub(crate) mod first_touch;
pub(crate) mod flight;
pub(crate) mod integrate;
mod kepler;
pub(crate) mod law;
mod osculating;
#[cfg(test)]
mod tests;
