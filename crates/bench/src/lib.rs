//! Engines side by side: run time against error.
//!
//! ```text
//! PlainScene ─► Engine (carom, Box2D, Rapier, Chipmunk) ─► states ─► quality, errors ─► rows ─► tables, charts
//! ```
//!
//! Every engine is given the same bodies, and assessed by the same `f64` code. A run is a [`Job`] in a process of its
//! own (`engine-run`), because builds of one engine for different instruction sets cannot share an executable; the
//! driver (`carom-bench`, started by `cargo xtask accuracy` and `cargo xtask speed`) rotates the processes.

mod callgrind;
mod cases;
mod clock;
mod engine;
mod engines;
mod job;
mod number;
mod quality;
mod speed;

pub use callgrind::{CallgrindError, Instructions, count_instructions};
pub use cases::{CASES, Case, Kind, Metric, RATES, Run, Trial, Values, order, points};
pub use clock::{CpuClock, peak_memory};
pub use engine::{Body, Counters, Engine, EngineError, Mode, Setup, State};
pub use engines::{EngineName, UnknownEngine, built, open};
pub use job::{Job, Point, Reading, run};
pub use quality::{Quality, Snapshot, Unrest, assess};
pub use speed::{Limits, SpeedJob, SpeedReading, StageReading};
