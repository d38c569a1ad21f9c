//! Lasting contacts: the soft sub-step law.
//!
//! ```text
//! row ─► lanes (colours, blocks of eight) ─► kernel (wide sweeps; plain: their slow twin)
//!        lines (bodies, warm start)       ─► rig: both, and one sub-step
//! ```
//! [`row`] and [`soft`] hold the same law for rows that are rebuilt in every sub-step.

mod budget;
mod coast;
mod kernel;
mod lanes;
#[cfg(test)]
mod plain;
mod rig;
mod row;
mod soft;
#[cfg(test)]
mod tests;
mod transpose;
mod wide;
mod zone;

pub(crate) use budget::Budget;
pub(crate) use lanes::RowId;
pub(crate) use rig::{Member, Pull, Rig};
pub(crate) use row::{Row, SolverBody};
pub(crate) use soft::{Law, sweep, warm_start};
pub(crate) use wide::Line;
