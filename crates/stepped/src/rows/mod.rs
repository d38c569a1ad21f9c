//! What is solved: contacts in blocks of eight, bodies in lines.

mod block;
#[cfg(test)]
mod check;
mod colour;
mod graph;
mod integrate;
mod kernel;
mod law;
mod line;
#[cfg(test)]
mod plain;
mod renew;
mod restitution;
#[cfg(test)]
mod tests;
mod transpose;

pub(crate) use block::{Block, Cold, LANES, OPEN};
pub(crate) use graph::Graph;
pub(crate) use integrate::{correct, displace, warm_start};
pub(crate) use kernel::{Pass, eight_lanes, sweep};
pub(crate) use law::Law;
pub(crate) use line::{Line, Quad};
pub(crate) use renew::renew;
pub(crate) use restitution::{Arrival, arrivals, bounce};
pub(crate) use transpose::{Numbers, Wide, any};
