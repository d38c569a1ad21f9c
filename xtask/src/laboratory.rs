//! `accuracy` and `speed`: the laboratory's own program, `carom-bench`, does them; here is the door.
//!
//! It is no default member, so it is built when it is asked for. Flags, help and exit codes are its own.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::exit::{Failure, Outcome};
use crate::flags::Passed;

/// Becomes `carom-bench COMMAND FLAGS…`, so that signals and the exit code go through.
pub(crate) fn run(command: &str, passed: &Passed) -> Outcome {
    // The user's folder stays, so that paths mean what they say.
    let mut cargo = Command::new(cargo());
    cargo
        .args([
            "run",
            "--quiet",
            "--package",
            "carom-bench",
            "--manifest-path",
        ])
        .arg(workspace().join("Cargo.toml"))
        .args(["--", command])
        .args(&passed.args);
    let error = replace(&mut cargo);
    Err(Failure::new(format!("cannot start cargo: {error}")))
}

#[cfg(unix)]
fn replace(command: &mut Command) -> std::io::Error {
    std::os::unix::process::CommandExt::exec(command)
}

#[cfg(not(unix))]
fn replace(command: &mut Command) -> std::io::Error {
    match command.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(2)),
        Err(error) => error,
    }
}

/// The cargo that started us.
fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// The same, in a folder.
pub(crate) fn cargo_in(folder: &Path) -> Command {
    let mut command = Command::new(cargo());
    command.current_dir(folder);
    command
}

/// The folder of the workspace: the one above this package.
pub(crate) fn workspace() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package).to_path_buf()
}
