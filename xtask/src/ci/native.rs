//! The golden pictures and files again, by a build for this very processor: `cargo test` builds for any of its kind.

use std::path::Path;
use std::process::Command;

use super::succeeds;
use crate::exit::Failure;
use crate::laboratory::cargo_in;

/// What has no part in a pixel or a byte is built fast: worlds at time 0, and what the tests stand on.
const ASIDE: [&str; 7] = [
    "carom-impact",
    "carom-dynamics",
    "proptest",
    "rand",
    "regex-syntax",
    "rustix",
    "tempfile",
];

pub(super) fn check(root: &Path) -> Result<bool, Failure> {
    let mut command = cargo_in(root);
    // A target that is named gets a folder of its own, and its flags do not reach what runs while building: that is there.
    command
        .args(["test", "--package", "carom-render", "--lib", "--target"])
        .arg(host()?)
        .args(["--config", "profile.dev.debug=false"]);
    for package in ASIDE {
        let level = format!("profile.dev.package.{package}.opt-level=0");
        command.args(["--config", &level]);
    }
    command
        .args(["--", "golden"])
        .env("RUSTFLAGS", "-C target-cpu=native");
    succeeds(&mut command)
}

/// This machine as rustc names it.
fn host() -> Result<String, Failure> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("-vV").output()?;
    let told = String::from_utf8_lossy(&output.stdout);
    let host = told.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or_else(|| Failure::new("rustc -vV does not say the host".to_owned()))?;
    Ok(host.to_owned())
}
