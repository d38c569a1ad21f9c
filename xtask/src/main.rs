//! The command line of carom: commands and flags, nothing else.
//!
//! A command is a module of its name; `exit` holds what its end means.

mod accuracy;
mod ci;
mod clock;
mod demo;
mod exit;
mod files;
mod film;
mod flags;
mod inertia;
mod interrupt;
mod list;
mod out;
mod parallel;
mod progress;
mod reference;
mod render;
mod scene;
mod scratch;
mod simulate;
mod stress;
mod summary;
mod values;

use std::process::ExitCode;

use clap::Parser as _;
use clap::error::ErrorKind;

use flags::{Cli, Command};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(&error),
    };
    let outcome = match &cli.command {
        Command::Demo(args) => demo::run(args),
        Command::Render(args) => render::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Inertia(args) => inertia::run(args),
        Command::List => list::run(),
        Command::Reference(args) => reference::run(args),
        Command::Accuracy(args) => accuracy::run(args),
        Command::Stress(args) => stress::run(args),
        Command::Ci => ci::run(),
    };
    match outcome {
        Ok(end) => end.code(),
        Err(failure) => failure.report(),
    }
}

/// Help goes to stdout; a wrong value gets one line, other wrong usage clap's own hints.
fn usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::ValueValidation | ErrorKind::InvalidValue => {
            let text = error.render().to_string();
            // What clap says up to the first empty line: the value, the flag, and what is possible.
            let first = text.split("\n\n").next().unwrap_or_default();
            exit::Failure::new(first.strip_prefix("error: ").unwrap_or(first)).report()
        }
        _ => {
            // A closed pipe while printing help is no error.
            let _ = error.print();
            ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
        }
    }
}
