//! Lines to stdout and stderr that never end a command: a closed pipe is the end of listening, not a crash.
//!
//! A line that finds no room on stdout is remembered, and the command does not end as if all had been written.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static ASIDE: AtomicBool = AtomicBool::new(false);

/// Why the first line that was not written was not.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// From now on lines go to stderr: stdout is taken by what the command makes.
pub fn step_aside() {
    ASIDE.store(true, Ordering::Relaxed);
}

/// Prints a line; a reader that went away is no error.
pub fn line(text: Arguments<'_>) {
    if ASIDE.load(Ordering::Relaxed) {
        aside(text);
    } else {
        keep(writeln!(io::stdout().lock(), "{text}"));
    }
}

/// Prints a line to stderr, for the eye: where there is no room for it, there is none for a complaint.
pub fn aside(text: Arguments<'_>) {
    let _unseen = writeln!(io::stderr().lock(), "{text}");
}

/// Remembers why something could not be written to stdout; a closed pipe is no error.
pub fn keep(written: io::Result<()>) {
    if let Err(error) = written
        && !is_closed_pipe(&error)
    {
        // The first one is told.
        let _later = LOST.set(error);
    }
}

/// Why a line is missing on stdout, if one is.
pub(crate) fn lost() -> Option<&'static io::Error> {
    LOST.get()
}

/// Whether an error says that the reader of a pipe went away.
pub fn is_closed_pipe(error: &io::Error) -> bool {
    error.kind() == ErrorKind::BrokenPipe
}

/// `tell!("…")`: a line to stderr.
#[macro_export]
macro_rules! tell {
    ($($format:tt)*) => {
        $crate::out::aside(format_args!($($format)*))
    };
}
pub use tell;

/// `say!("…")`: a line to stdout.
#[macro_export]
macro_rules! say {
    ($($format:tt)*) => {
        $crate::out::line(format_args!($($format)*))
    };
}
pub use say;
