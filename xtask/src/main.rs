//! The commands for work on carom: those of the program `carom`, and what only a clone of the repository can do.
//!
//! A command is a module of its name.

mod ci;
mod demo;
mod flags;
mod laboratory;
mod random;
mod reference;
mod scratch;
mod stress;

use std::process::ExitCode;

pub(crate) use carom_cli::{
    clock, exit, files, film, interrupt, out, parallel, relay, render, scene, summary,
};

use flags::{Cli, Command};

fn main() -> ExitCode {
    carom_cli::run("cargo xtask", |cli: &Cli| match &cli.command {
        Command::Demo(args) => demo::run(args),
        Command::Carom(command) => command.run(),
        Command::Reference(args) => reference::run(args),
        Command::Accuracy(passed) => laboratory::run("accuracy", passed),
        Command::Speed(passed) => laboratory::run("speed", passed),
        Command::Stress(args) => stress::run(args),
        Command::Ci => ci::run(),
    })
}
