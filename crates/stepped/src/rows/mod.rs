//! What is solved: contacts in blocks of eight, bodies in lines.

mod block;
mod bounce;
mod bounce_budget;
mod colour;
mod deep;
mod extra_sweeps;
mod free;
mod graph;
mod integrate;
mod kernel;
mod lanes;
mod law;
mod line;
mod plain;
mod renew;
mod restitution;
mod rotating;
mod shifted;

#[cfg(test)]
mod tests;
mod transfer;
mod transpose;
mod turn_back;
mod ways;
mod widest;

pub(crate) use block::{Block, Cold, LANES, OPEN, Pressed, lanes};
pub(crate) use bounce_budget::Before;
pub(crate) use colour::Colour;
pub(crate) use deep::Deep;
pub(crate) use extra_sweeps::ExtraSweeps;
pub(crate) use free::FreePairs;
pub(crate) use graph::{Contact, Graph, HARD, Touched};
pub(crate) use integrate::{correct, displace, velocity_before, warm_start};
pub(crate) use kernel::{Pass, sweep};
pub(crate) use law::Law;
pub(crate) use line::{Line, Quad, quotient};
pub(crate) use renew::renew;
pub(crate) use restitution::{Arrival, REST, arrivals, bounce};
pub(crate) use rotating::{RotatingRows, Side};
pub(crate) use shifted::{Shifted, turn_shifted};
pub(crate) use transpose::{Numbers, Wide, any};
pub(crate) use ways::Ways;
pub(crate) use widest::widest;
