//! The command line of carom: commands and flags, nothing else.
//!
//! A command is a module of its name; `exit` holds what its end means.

mod ci;
mod demo;
mod film;
mod flags;
mod inertia;
mod laboratory;
mod list;
mod merge;
mod parallel;
mod random;
mod reach;
mod reference;
mod relay;
mod render;
mod scene;
mod scratch;
mod simulate;
mod stress;
mod summary;
mod values;

use std::process::ExitCode;

pub(crate) use carom_command::{clock, exit, files, interrupt, number, out, progress};

use clap::Parser as _;

use flags::{Cli, Command};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return carom_command::usage(&error),
    };
    let outcome = match &cli.command {
        Command::Demo(args) => demo::run(args),
        Command::Render(args) => render::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Inertia(args) => inertia::run(args),
        Command::List => list::run(),
        Command::Reference(args) => reference::run(args),
        Command::Accuracy(passed) => laboratory::run("accuracy", passed),
        Command::Speed(passed) => laboratory::run("speed", passed),
        Command::Stress(args) => stress::run(args),
        Command::Ci => ci::run(),
    };
    match outcome {
        Ok(end) => end.code(),
        Err(failure) => failure.report(),
    }
}
