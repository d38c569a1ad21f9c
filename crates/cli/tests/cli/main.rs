//! The program `carom` as a user meets it: what is printed, what is written, and the exit code.

#[cfg(unix)]
mod bounded;
mod check;
mod endless;
mod full;
mod inertia;
mod kill;
mod merge;
mod names;
mod output;
mod ran;
mod scenes;
#[cfg(unix)]
mod signals;
mod simulate;
mod sweep;
mod usage;

use std::path::Path;

use ran::{Ran, names};

/// The program.
const CAROM: &str = env!("CARGO_BIN_EXE_carom");

/// Runs `carom` with these arguments in `folder`.
fn carom_in(folder: &Path, args: &[&str]) -> Ran {
    ran::run(CAROM, folder, args)
}

/// Runs `carom` in the folder of the package.
fn carom(args: &[&str]) -> Ran {
    carom_in(Path::new(env!("CARGO_MANIFEST_DIR")), args)
}
