//! Failure reports of other engines, case by case of the list of 48, each with its public report.

mod collision;
mod geometry;
mod impacts;
mod motion;
