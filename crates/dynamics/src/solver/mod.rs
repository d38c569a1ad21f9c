//! Lasting contacts: the soft sub-step law.
//!
//! ```text
//! row ─► lanes (colours, blocks of eight) ─► kernel (wide sweeps; plain: their slow twin)
//!        lines (bodies, warm start)       ─► rig: both, and one sub-step
//! ```
//! [`row`] and [`soft`] hold the same law for rows that are rebuilt in every sub-step.

#[allow(dead_code, reason = "steps take it up next")]
mod kernel;
#[allow(dead_code, reason = "steps take it up next")]
mod lanes;
#[cfg(test)]
mod plain;
#[allow(dead_code, reason = "steps take it up next")]
mod rig;
mod row;
mod soft;
#[cfg(test)]
mod tests;
#[allow(dead_code, reason = "steps take it up next")]
mod wide;

#[allow(unused_imports, reason = "steps take it up next")]
pub(crate) use lanes::RowId;
#[allow(unused_imports, reason = "steps take it up next")]
pub(crate) use rig::Rig;
pub(crate) use row::{Row, SolverBody};
pub(crate) use soft::{Law, relax, solve};
