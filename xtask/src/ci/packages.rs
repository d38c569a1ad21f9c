//! What goes to a registry: packed as it would be, with its licences, and every example run.

use std::path::Path;

use super::{Scratch, succeeds};
use crate::exit::Failure;
use crate::laboratory::cargo_in;
use crate::out::say;

/// What stays here: other engines, the tests of the whole, these commands.
const UNPUBLISHED: [&str; 4] = ["carom-bench", "carom-c-peers", "carom-tests", "xtask"];

/// What each package must hold, beside its sources.
const INSIDE: [&str; 3] = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"];

/// Examples with their packages and short arguments, so that all take seconds.
const EXAMPLES: [(&str, &str, &[&str]); 5] = [
    ("carom-geometry", "large", &[]),
    ("carom-dynamics", "discs", &["heaps", "0.5"]),
    ("carom-dynamics", "sliders", &["50"]),
    ("carom-dynamics", "sleepers", &["100"]),
    ("carom-tests", "fields", &[]),
];

/// Packs all that is published. Not built from the packages: that is the same sources once more, and takes minutes.
pub(super) fn pack(root: &Path) -> Result<bool, Failure> {
    let mut command = cargo_in(root);
    command.args([
        "package",
        "--workspace",
        "--no-verify",
        "--allow-dirty",
        "--quiet",
    ]);
    for package in UNPUBLISHED {
        command.args(["--exclude", package]);
    }
    if !succeeds(&mut command)? {
        return Ok(false);
    }
    let list = ["package", "--list", "--allow-dirty", "--quiet", "--package"];
    let mut complete = true;
    for package in published(root)? {
        let output = cargo_in(root).args(list).arg(&package).output()?;
        let files = String::from_utf8_lossy(&output.stdout).into_owned();
        for file in INSIDE {
            if !files.lines().any(|line| line == file) {
                say!("{package}: {file} is missing in its package");
                complete = false;
            }
        }
    }
    Ok(complete)
}

/// The names of the packages that go to a registry.
fn published(root: &Path) -> Result<Vec<String>, Failure> {
    let output = cargo_in(root)
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .output()?;
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let packages = metadata["packages"].as_array().cloned().unwrap_or_default();
    let names = packages
        .iter()
        .filter_map(|package| package["name"].as_str());
    let published = names.filter(|name| !UNPUBLISHED.contains(name));
    Ok(published.map(str::to_owned).collect())
}

/// Runs the examples; a picture of each is not looked at, that they end well is.
pub(super) fn examples(root: &Path) -> Result<bool, Failure> {
    for (package, example, args) in EXAMPLES {
        if !example_runs(root, package, example, args)? {
            return Ok(false);
        }
    }
    let scratch = Scratch::new("sheets")?;
    let sheets = scratch.path().to_string_lossy().into_owned();
    example_runs(root, "carom-scenes", "sheets", &[&sheets, "cradle"])
}

fn example_runs(root: &Path, package: &str, example: &str, args: &[&str]) -> Result<bool, Failure> {
    let mut command = cargo_in(root);
    command
        .args([
            "run",
            "--quiet",
            "--package",
            package,
            "--example",
            example,
            "--",
        ])
        .args(args)
        .stdout(std::process::Stdio::null());
    let ran = succeeds(&mut command)?;
    if !ran {
        say!("example {example} of {package} failed");
    }
    Ok(ran)
}
