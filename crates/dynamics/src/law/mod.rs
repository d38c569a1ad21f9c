//! Where a body is by its law, as pure functions of time: free flight in closed form in a uniform field, with damping and about a
//! Newtonian centre, and of what turns about a corner; by an integrator of order 15 in any other field, and where contacts hold several bodies.
//!
//! To read in this order: [`flight`] (the law that is kept beside a motion, whichever it is), [`damped`], [`kepler`], [`pendulum`],
//! [`collocated`], [`integrate`] and [`path`] (the laws themselves), [`osculating`] (the parabola that touches a law, and how far it is off).

pub(crate) mod collocated;
pub(crate) mod damped;
pub(crate) mod flight;
pub(crate) mod integrate;
pub(crate) mod kepler;
pub(crate) mod osculating;
pub(crate) mod path;
pub(crate) mod pendulum;
