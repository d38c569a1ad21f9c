//! One integration-test binary: laws, stability, twins, regressions.

#![allow(clippy::float_cmp, reason = "tests compare exact results on purpose")]

mod asleep;
mod belts;
mod boxes;
mod break_shot;
mod calls;
mod conservation;
mod determinism;
mod documents;
mod errors;
mod failures;
mod fields;
mod filters;
mod forces;
mod gases;
mod house;
mod impacts;
mod large_islands;
mod large_piles;
mod lasting;
mod laws;
mod moved;
mod observing;
mod odd;
mod readme;
mod regressions;
mod rocking;
mod round;
mod scripts;
mod setters;
mod settings;
mod skipping;
mod small_islands;
mod stability;
mod stepped;
mod stepped_cases;
mod stepped_changes;
mod stepped_laws;
mod stepped_slopes;
mod stepped_swift;
mod tipping;
mod twins;
mod work;
