//! The commands of carom as a library: what the program `carom` and the workspace's `cargo xtask` both do.
//!
//! [`Command`] is a list of [clap](https://docs.rs/clap) subcommands that another program can take into its own list;
//! [`run`] reads the arguments, runs what they ask for and gives the exit code. Every command ends alike: exit code 0
//! done, 1 a check fell short, 2 bad usage or input (one line that begins with `error: `), 129 the
//! terminal hung up, 130 interrupted, 143 terminated. Files appear whole or not at all; Ctrl-C keeps what is done, so that a table of `simulate` ends there.
//!
//! # Examples
//! ```
//! use carom_cli::{Command, exit::End};
//! use clap::Parser;
//!
//! #[derive(Parser)]
//! struct Mine {
//!     #[command(subcommand)]
//!     command: Command,
//! }
//! let mine = Mine::try_parse_from(["mine", "inertia", "0,0 2,0 2,1 0,1", "--density", "3"])?;
//! assert_eq!(mine.command.run().unwrap(), End::Done);     // prints area, centroid, moments, mass and inertia
//! # Ok::<(), clap::Error>(())
//! ```

mod check;
pub mod clock;
pub mod exit;
mod field;
pub mod files;
pub mod film;
mod flags;
mod inertia;
pub mod interrupt;
mod list;
mod merge;
pub mod number;
pub mod out;
pub mod parallel;
mod program;
pub mod progress;
mod reach;
pub mod relay;
pub mod render;
pub mod scene;
mod simulate;
pub mod summary;
mod sweep;
mod usage;
pub mod values;

pub use flags::{
    CheckArgs, Command, Format, InertiaArgs, MergeArgs, ModeFlag, OverlayFlag, PackingFlag,
    RenderArgs, SimulateArgs, StyleFlag, SweepArgs,
};
pub use program::{EXIT_CODES, VERSION, named, run};
pub use sweep::{Axis, Column};
pub use usage::usage;
