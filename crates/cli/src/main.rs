//! The program `carom`.

use std::process::ExitCode;

use carom_cli::{Command, EXIT_CODES};
use clap::Parser;

/// Rigid bodies in the plane: scenes to pictures, films and tables.
#[derive(Debug, Parser)]
#[command(after_help = format!("{EXIT_CODES}\nStart here: {{carom}} render thesis --seconds 2"))]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

fn main() -> ExitCode {
    carom_cli::run("carom", |cli: &Cli| cli.command.run())
}
