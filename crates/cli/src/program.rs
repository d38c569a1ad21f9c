//! From the arguments of a program to its exit code, in the name by which it was called.

use std::process::ExitCode;

use clap::Parser;

use crate::exit::Outcome;
use crate::flags::Command;
use crate::{check, inertia, list, merge, render, simulate, sweep, usage};

/// What help texts have in the place of the program's name.
const NAME: &str = "{carom}";

/// What each exit code means, for the end of a help text.
pub const EXIT_CODES: &str = "Exit codes: 0 done, 1 a check fell short, 2 bad usage or input, 129 hung up, 130 interrupted, 143 terminated.";

/// Version and features of this build: `0.1.0 (features: parallel)`.
pub const VERSION: &str = if cfg!(feature = "parallel") {
    concat!(env!("CARGO_PKG_VERSION"), " (features: parallel)")
} else {
    concat!(env!("CARGO_PKG_VERSION"), " (features: none)")
};

impl Command {
    /// Does what the command says.
    ///
    /// # Errors
    /// Whatever stops it: bad input, a file that cannot be read or written.
    pub fn run(&self) -> Outcome {
        match self {
            Self::Render(args) => render::run(args),
            Self::Merge(args) => merge::run(args),
            Self::Simulate(args) => simulate::run(args),
            Self::Sweep(args) => sweep::run(args),
            Self::Inertia(args) => inertia::run(args),
            Self::List => list::run(),
            Self::Check(args) => check::run(args),
        }
    }
}

/// Reads the arguments of this process as those of `program` ("carom", "cargo xtask"), runs `command` on them, and gives
/// the exit code.
#[must_use]
pub fn run<P: Parser>(program: &'static str, command: impl FnOnce(&P) -> Outcome) -> ExitCode {
    let matches = named(P::command(), program).try_get_matches();
    let parsed = match matches.and_then(|mut matches| P::from_arg_matches_mut(&mut matches)) {
        Ok(parsed) => parsed,
        Err(error) => return usage(&error),
    };
    match command(&parsed) {
        Ok(end) => end.code(),
        Err(failure) => failure.report(),
    }
}

/// The command, its subcommands and their help texts in the name of the program that was called.
#[must_use]
pub fn named(command: clap::Command, program: &'static str) -> clap::Command {
    in_name(command, program)
        .name(program)
        .bin_name(program)
        .version(VERSION)
}

fn in_name(mut command: clap::Command, program: &str) -> clap::Command {
    if let Some(text) = command.get_after_help() {
        let text = text.to_string().replace(NAME, program);
        command = command.after_help(text);
    }
    command
        .mut_args(|arg| match arg.get_help() {
            Some(help) => {
                let help = help.to_string().replace(NAME, program);
                arg.help(help)
            }
            None => arg,
        })
        .mut_subcommands(|sub| in_name(sub, program))
}
