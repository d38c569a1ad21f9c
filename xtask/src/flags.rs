//! The commands and their flags.

use std::ffi::OsString;
use std::path::PathBuf;

use carom_cli::{EXIT_CODES, ModeFlag};
use clap::{Args, Parser, Subcommand};

/// Rigid bodies in the plane: scenes to pictures, films, tables and charts.
#[derive(Debug, Parser)]
#[command(after_help = format!("{EXIT_CODES}\nStart here: {{carom}} demo"))]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What can be done.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run the thesis's scene and the flying balls: frames, film, contact sheet, energy chart
    Demo(DemoArgs),
    /// What the program `carom` does
    #[command(flatten)]
    Carom(carom_cli::Command),
    /// Answer a folder of reference cases and check the answers
    Reference(ReferenceArgs),
    /// Run time against error, as table, CSV and chart
    #[command(disable_help_flag = true)]
    Accuracy(Passed),
    /// Milliseconds a step and what they bought, scene by scene, as table, CSV and chart
    #[command(disable_help_flag = true)]
    Speed(Passed),
    /// Cases that break physics engines, each with its measured number
    Stress(StressArgs),
    /// All that CI checks: format, lints, docs, tests, demo, outside crate
    Ci,
}

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  cargo xtask demo\n  cargo xtask demo --quick --out /tmp/demo")]
pub(crate) struct DemoArgs {
    /// One second of small frames instead of ten seconds at the scenes' own sizes
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder for the pictures; what an earlier demo wrote there is replaced, nothing else
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub(crate) out: PathBuf,
}

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    cargo xtask reference tests/reference/open\n  \
    cargo xtask reference tests/reference/open --list\n  \
    cargo xtask reference tests/reference/open --mode hybrid\n  \
    cargo xtask reference tests/reference/open --transform 7 --json answers.json")]
pub(crate) struct ReferenceArgs {
    /// Folder with reference files (*.json)
    pub(crate) dir: PathBuf,
    /// Writes every answer as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// A line for each case: `pass ID`, or `fall short ID: why`
    #[arg(long)]
    pub(crate) list: bool,
    /// Asks each case mirrored, turned, shifted and relabelled (all exact) and maps the answer back
    #[arg(long, value_name = "SEED")]
    pub(crate) transform: Option<u64>,
    /// Mode of the worlds that are played; single impacts, mass properties and times of impact know none
    #[arg(long, value_enum, default_value_t = ModeFlag::Exact)]
    pub(crate) mode: ModeFlag,
}

/// What the laboratory's own program reads: `cargo xtask accuracy --help` is answered by it too.
#[derive(Args, Debug)]
pub(crate) struct Passed {
    /// Flags; --help lists them
    #[arg(
        trailing_var_arg = true,
        allow_hyphen_values = true,
        value_name = "FLAGS"
    )]
    pub(crate) args: Vec<OsString>,
}

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  cargo xtask stress\n  cargo xtask stress --case column")]
pub(crate) struct StressArgs {
    /// Only the case of this number or name
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Option<String>,
}
