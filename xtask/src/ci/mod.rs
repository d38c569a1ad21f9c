//! `ci`: every check of the project, in the order in which a failure costs least.

mod native;
mod outside;
mod packages;
mod pictures;
mod words;

use std::path::Path;
use std::process::{Command, ExitStatus};

use crate::clock::Clock;
use crate::exit::{End, Failure, Outcome};
use crate::laboratory::{self, cargo_in};
use crate::out::say;
use crate::scratch::Scratch;

/// A check: whether it passed, or why it could not be made.
type Check = fn(&Path) -> Result<bool, Failure>;

/// Proptest's variable for the seed of all questions.
const SEED: &str = "PROPTEST_RNG_SEED";

pub(crate) fn run() -> Outcome {
    let root = laboratory::workspace();
    let all = Clock::start();
    let steps: [(&str, Check); 12] = [
        ("words: none of .ci/retired-words", words::check),
        ("format: cargo fmt --check", |root| {
            cargo(root, &["fmt", "--all", "--check"])
        }),
        ("lints: cargo clippy, warnings denied", |root| {
            cargo(root, &["clippy", "--all-targets", "--", "-D", "warnings"])
        }),
        ("docs: cargo doc, warnings denied", |root| {
            let mut command = cargo_in(root);
            command
                .args(["doc", "--no-deps"])
                .env("RUSTDOCFLAGS", "-D warnings");
            succeeds(&mut command)
        }),
        // The README's example is among the doc tests.
        ("tests: cargo test", |root| cargo(root, &["test"])),
        (
            "pictures: the same with every instruction of this processor",
            native::check,
        ),
        // No default member: without peers it needs neither a C compiler nor their crates.
        ("laboratory: clippy and tests of carom-bench", |root| {
            let package = ["--package", "carom-bench"];
            let lints = ["clippy", "--all-targets", "--", "-D", "warnings"];
            Ok(cargo(root, &[&lints[..1], &package, &lints[1..]].concat())?
                && cargo(root, &[&["test"][..], &package].concat())?)
        }),
        ("features: lints and tests with all of them", features),
        ("demo: cargo xtask demo --quick", demo),
        ("examples: cargo run --example", packages::examples),
        (
            "outside crates: geometry, collision, render, carom alone",
            outside::check,
        ),
        ("packages: cargo package", packages::pack),
    ];
    for (number, (name, step)) in steps.iter().enumerate() {
        say!("== {} of {}: {name}", number + 1, steps.len());
        let clock = Clock::start();
        let passed = step(&root)?;
        let how = if passed { "passed" } else { "FAILED" };
        say!("== {how} in {:.1} s: {name}", clock.seconds());
        if !passed {
            return Ok(End::Short);
        }
    }
    say!(
        "== all {} checks passed in {:.1} s",
        steps.len(),
        all.seconds()
    );
    Ok(End::Done)
}

/// What is off by default: threads, other libraries' vectors, reading and writing.
fn features(root: &Path) -> Result<bool, Failure> {
    let all = "--all-features";
    let lints = ["clippy", "--all-targets", all, "--", "-D", "warnings"];
    let mut tests = vec!["test", all];
    for package in [
        "carom-math",
        "carom-geometry",
        "carom-impact",
        "carom-dynamics",
        "carom",
    ] {
        tests.extend(["--package", package]);
    }
    Ok(cargo(root, &lints)? && cargo(root, &tests)?)
}

/// The demo of the README, quick and into a temporary folder, and a look at what it wrote.
fn demo(root: &Path) -> Result<bool, Failure> {
    let scratch = Scratch::new("demo")?;
    let out = scratch.path().join("demo");
    let mut command = cargo_in(root);
    command
        .args(["xtask", "demo", "--quick", "--out"])
        .arg(&out);
    Ok(succeeds(&mut command)? && pictures::check(&out)?)
}

/// Cargo, with the same cases in its property tests every time: a commit passes or fails for good.
///
/// Plain `cargo test` draws new ones, and so does this where the caller has set another seed.
fn cargo(root: &Path, args: &[&str]) -> Result<bool, Failure> {
    let seed = std::env::var(SEED).unwrap_or_else(|_| "1".to_owned());
    succeeds(cargo_in(root).args(args).env(SEED, seed))
}

fn succeeds(command: &mut Command) -> Result<bool, Failure> {
    let status: ExitStatus = command.status().map_err(|error| {
        Failure::new(format!(
            "cannot start {}: {error}",
            command.get_program().display()
        ))
    })?;
    Ok(status.success())
}
