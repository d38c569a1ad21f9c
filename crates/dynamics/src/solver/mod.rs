//! Lasting contacts: the soft sub-step law, one row a contact.

mod row;
mod soft;

pub(crate) use row::{Row, SolverBody};
pub(crate) use soft::{Law, relax, solve};
