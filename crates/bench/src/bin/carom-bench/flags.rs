//! The two commands and their flags.

use std::path::PathBuf;

use carom_bench::EngineName;
use clap::{Args, Parser, Subcommand};

/// Engines side by side: run time against error.
#[derive(Debug, Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    version,
    after_help = "Exit codes: 0 done, 2 bad usage or input, 129 hung up, 130 interrupted, 143 terminated."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What can be measured.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run time against error: cases with a known answer, as table, CSV and charts
    Accuracy(AccuracyArgs),
    /// Milliseconds a step and what they bought, scene by scene, as table, CSV and charts
    Speed(SpeedArgs),
}

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    cargo xtask accuracy --quick\n  \
    cargo xtask accuracy --peers --out out/accuracy\n  \
    cargo xtask accuracy --case projectile --engine carom --engine rapier\n  \
    cargo xtask accuracy --from out/accuracy/accuracy.csv --out out/again\n\n\
    Written to DIR: accuracy.csv, accuracy.md, a chart a case and overview as PNG and SVG (light and dark), rows.jsonl.\n\
    Every job is a process of its own; its reading is in rows.jsonl as soon as it is there. Ctrl-C keeps what is\n\
    measured, --resume adds the rest. The full run has steps of 1/30 to 1/3840 s and is built with fat LTO; Box2D needs\n\
    a C compiler, Chipmunk its library (apt install libchipmunk-dev): what is missing is left out, with a line.\n\
    Box2D and Rapier answer with eight lanes as with four: the wide builds run only if they are named. A curve is not\n\
    followed to more steps once a job of it was stopped at --limit.")]
pub(crate) struct AccuracyArgs {
    /// A few rates of the cheaper cases, built as for development: under a minute without peers
    #[arg(long)]
    pub(crate) quick: bool,
    #[command(flatten)]
    pub(crate) chosen: Chosen,
    /// Only this case, by name or number; may be repeated
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Vec<String>,
    /// Draws tables and charts from a file that an earlier run wrote; measures nothing
    #[arg(long, value_name = "CSV", conflicts_with_all = ["quick", "peers", "engine", "case", "resume", "limit"])]
    pub(crate) from: Option<PathBuf>,
    /// Folder for tables and charts
    #[arg(long, value_name = "DIR", default_value = "out/accuracy")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) how: How,
}

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    cargo xtask speed --scene e --scene a\n  \
    cargo xtask speed --peers --out out/speed\n  \
    cargo xtask speed --lively --engine carom --engine box2d-avx2\n  \
    cargo xtask speed --peers --growth\n  \
    cargo xtask speed --peers --crossing\n  \
    cargo xtask speed --engine carom --engine box2d-sse2 --threads 1,2\n  \
    cargo xtask speed --instructions --scene i --scene h\n  \
    cargo xtask speed --profile\n\n\
    Written to DIR: speed.csv, speed.md, charts as PNG and SVG (light and dark), rows.jsonl.\n\
    In each repetition, scene by scene, every engine runs once with its defaults, in an order that rotates. Besides, in\n\
    the first repetition only: reading all poses after each step, carom's other modes, the peers tuned for accuracy.\n\
    All peers on all scenes take about ten minutes beyond carom's own time on two 2.6 GHz cores.\n\
    Times are CPU time of one thread; wall time where there are several. The machine should be quiet.")]
pub(crate) struct SpeedArgs {
    #[command(flatten)]
    pub(crate) chosen: Chosen,
    /// Only this scene, by name or letter (a to i); may be repeated
    #[arg(long, value_name = "NAME")]
    pub(crate) scene: Vec<String>,
    /// Repetitions; the tables have their median
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=99))]
    pub(crate) repeat: u32,
    /// Numbers of threads
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) threads: Vec<u32>,
    /// Scenes in which much moves instead: what falls, is stirred, driven or thrown, and many small islands
    #[arg(long, conflicts_with_all = ["scene", "growth", "crossing"])]
    pub(crate) lively: bool,
    /// Growth curves instead: a pile, a gas and free bodies from 200 to 200,000; an engine goes no further once a step takes 250 ms
    #[arg(long, conflicts_with_all = ["scene", "repeat", "threads"])]
    pub(crate) growth: bool,
    /// Gases of the same bodies instead, ever denser: at how many impacts exact motion costs as much as each peer
    #[arg(long, conflicts_with_all = ["growth", "scene", "repeat", "threads"])]
    pub(crate) crossing: bool,
    /// Instructions a step instead of times, counted by valgrind's callgrind: the same on a busy machine; some fifty times slower
    #[arg(long, conflicts_with_all = ["growth", "crossing", "profile", "repeat", "threads"])]
    pub(crate) instructions: bool,
    /// Steps before the counted ones, at most the scene's own
    #[arg(long, value_name = "N", default_value_t = 5, requires = "instructions", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) warm_up: u32,
    /// Steps to count the instructions of, at most the scene's own
    #[arg(long, value_name = "N", default_value_t = 5, requires = "instructions", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) steps: u32,
    /// Where the time of a step goes instead, stage by stage, as the engine's own clock tells it: carom and Box2D
    #[arg(long, conflicts_with_all = ["growth", "crossing", "repeat", "threads"])]
    pub(crate) profile: bool,
    /// Built as for development, in seconds: not for comparing times
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder for tables and charts [default: out/speed, out/lively, out/growth, out/crossing, out/instructions or out/profile]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) how: How,
}

/// Which engines.
#[derive(Args, Debug)]
pub(crate) struct Chosen {
    /// Beside carom, all peers that can be built here
    #[arg(long)]
    pub(crate) peers: bool,
    /// Only this engine: carom, box2d-sse2, box2d-avx2, rapier, rapier-8, rapier-f64, chipmunk; may be repeated
    #[arg(long, value_name = "NAME")]
    pub(crate) engine: Vec<EngineName>,
}

/// How a run is done, whatever it measures.
#[derive(Args, Debug)]
pub(crate) struct How {
    /// Writes the table as JSON too
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Keeps the rows of an earlier run in the same folder, measures only what is missing
    #[arg(long)]
    pub(crate) resume: bool,
    /// Seconds after which a job is stopped and counts as failed
    #[arg(long, value_name = "S", default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) limit: u32,
}
