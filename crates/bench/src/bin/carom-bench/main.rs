//! The driver of the laboratory: commands and flags, nothing else.
//!
//! ```text
//! flags ─► plan (jobs in turn) ─► builds (an executable per instruction set) ─► process (a job each) ─► store (rows.jsonl)
//!                                                                     rows ─► accuracy | speed: CSV, tables, charts, JSON
//! ```

#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare exact results"))]

mod accuracy;
mod builds;
mod flags;
mod head;
mod measure;
mod picture;
mod plan;
mod process;
mod speed;
mod store;
mod text;

use std::process::ExitCode;

use clap::Parser as _;

pub(crate) use carom_cli::{clock, exit, files, interrupt, out, progress};

use flags::{Cli, Command};

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return carom_cli::usage(&error),
    };
    let outcome = match &cli.command {
        Command::Accuracy(args) => accuracy::run(args),
        Command::Speed(args) => speed::run(args),
    };
    match outcome {
        Ok(end) => end.code(),
        Err(failure) => failure.report(),
    }
}
