//! `cargo xtask` as a user meets it. What it shares with the program `carom` is tested there.

mod demo;
mod laboratory;
// One list of what is expected of a run.
#[path = "../../../crates/cli/tests/cli/ran.rs"]
mod ran;
mod reference;
mod stress;
mod usage;

use std::path::Path;

use ran::{Ran, names};

/// Runs `cargo xtask` with these arguments in `folder`.
fn xtask_in(folder: &Path, args: &[&str]) -> Ran {
    ran::run(env!("CARGO_BIN_EXE_xtask"), folder, args)
}

/// Runs `cargo xtask` in the folder of the package.
fn xtask(args: &[&str]) -> Ran {
    xtask_in(Path::new(env!("CARGO_MANIFEST_DIR")), args)
}
